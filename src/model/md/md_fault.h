/* md_fault.h - notices when the state stops being physical, and says which grain and why.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MD_FAULT_H
#define MD_FAULT_H

#include "model/md/md.h"

/* After a step: false, with md->fault filled, if an overlap passed the scene's limit, a number is
 * not finite, or a bound was hit. */
bool md_fault_check(struct md *md);

/* At a rebuild: has a grain got through a solid border? */
bool md_fault_escaped(struct md *md);

#endif
