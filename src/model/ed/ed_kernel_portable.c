/* ed_kernel_portable.c - the loop over events for any processor; see ed_kernel.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#define KERNEL_SET ed_kernel_portable
#include "model/ed/ed_kernel.h"
