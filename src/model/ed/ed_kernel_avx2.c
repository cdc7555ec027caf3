/* ed_kernel_avx2.c - the loop over events for x86-64 with AVX2, chosen when the program runs; see
 * ed_kernel.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#if defined __x86_64__ && defined __GNUC__
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif
#define SCAN_AVX2 1
#define KERNEL_SET ed_kernel_avx2
#include "model/ed/ed_kernel.h"
#ifdef __clang__
#pragma clang attribute pop
#endif
#endif
