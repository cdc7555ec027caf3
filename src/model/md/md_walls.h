/* md_walls.h - contacts of grains with walls: segments, arcs and discs as exact geometry.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MD_WALLS_H
#define MD_WALLS_H

#include "model/md/md.h"

bool md_walls_create(struct md *md);

/* Places moving walls and gates at the present time. */
void md_walls_place(struct md *md);

/* Largest speed of any wall, for the life of a neighbour list. */
double md_walls_speed(const struct md *md);

/* Lists the grains near each wall; `order` gives old indices by new.  False: no room. */
bool md_walls_list(struct md *md, const uint32_t *order);

/* Adds the forces on the grains of strip t to `pushes`, on their rims to `twists` if that is there
 * (both indexed from the strip's first grain). */
void md_walls_push(struct md *md, uint32_t t, struct push *pushes, double *twists);

/* One touch of a grain with a wall, for looking. */
struct md_wall_touch {
    struct wall_nearest nearest;
    double overlap, lever, fx, fy, normal, tangential, spring, energy;
    bool   counts;              /* touches, and is not a joint already counted */
};
/* All touches of the links first..last-1, which belong to one grain. */
void md_walls_touch(const struct md *md, uint32_t first, uint32_t last,
                    struct md_wall_touch *out);

#endif
