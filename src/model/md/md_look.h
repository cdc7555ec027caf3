/* md_look.h - pictures of the present and sums over the grains; neither changes anything.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MD_LOOK_H
#define MD_LOOK_H

#include "model/md/md.h"

void md_look_observe(const void *state, struct grains *out);
void md_look_count(const void *state, struct counters *out);

#endif
