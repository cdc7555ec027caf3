/* h5md_pack.h - a finished trajectory.h5, laid out so that equal runs give equal bytes.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef H5MD_PACK_H
#define H5MD_PACK_H

#include "base/error.h"

#include <stdbool.h>

/* Replaces the closed trajectory at `path` by a copy without holes, whole or not at all.  False if
 * it cannot be read or written; the old file is then as it was. */
bool h5md_pack(const char *path, struct error *error);

#endif
