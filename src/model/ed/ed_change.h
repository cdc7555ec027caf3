/* ed_change.h - the rarer events: contacts with walls, grains that leave or enter, walls that
 * start, stop, open or close, and the end of a window of the collision rate.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_CHANGE_H
#define ED_CHANGE_H

#include <stdbool.h>
#include <stdint.h>

struct ed;

/* Grain i meets its partner, which is no grain.  True if it stays and wants a new prediction. */
bool ed_change_solid(struct ed *ed, uint32_t i);

/* Is (cx, cy) a cell outside the box, behind an open border? */
bool ed_change_leaves(const struct ed *ed, uint32_t cx, uint32_t cy);

/* Takes grain i out; the last grain moves into its place. */
void ed_change_remove(struct ed *ed, uint32_t i);

/* Scene time of the next change that no grain causes; INFINITY if there is none. */
double ed_change_next(const struct ed *ed);

/* Carries out every change that is due at that time. */
void ed_change_apply(struct ed *ed, double t);

#endif
