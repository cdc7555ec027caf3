/* ed_watch.h - what a scene wants counted while collisions happen: rates, counts of each grain,
 * impact parameters, collisional stress.  Called only if the scene asks for any of it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_WATCH_H
#define ED_WATCH_H

#include <stdbool.h>
#include <stdint.h>

struct ed;
struct ed_touch;

/* Grains i and j collide: (dx, dy) from i to j, (du, dv) the velocity of j against i before, and
 * (px, py) the momentum given to i. */
struct ed_blow { double dx, dy, du, dv, px, py; };

bool ed_watch_wanted(const struct ed *ed);

void ed_watch_pair(struct ed *ed, uint32_t i, uint32_t j, const struct ed_blow *blow,
                   bool elastic);

/* Grain i touches a wall that gives it momentum (px, py). */
void ed_watch_wall(struct ed *ed, uint32_t i, const struct ed_touch *touch, double px, double py,
                   bool elastic);

#endif
