/* md_check.h - is a state that was loaded one that could have been saved?
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MD_CHECK_H
#define MD_CHECK_H

#include "model/md/md.h"

/* Every index and count that the loops use as one, and the numbers that must be some.  NULL, or
 * what is wrong. */
const char *md_check(const struct md *md);

#endif
