/* pack.h - random packings without overlap, up to dense ones.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PACK_H
#define PACK_H

#include "scene/wall.h"

#include <stdbool.h>
#include <stdint.h>

struct pack {
    uint32_t count, fixed;      /* discs to place; discs behind them in the arrays that stay */
    double  *x, *y;             /* in: first guesses, inside the region; out: the packing */
    const double *radius;
    double   fraction;          /* of the area, about: how long to shake */
    uint32_t side_count;        /* the region's sides: segments with the inside to their left */
    const struct wall *sides;
    uint32_t wall_count;        /* what else must not be overlapped */
    const struct wall *walls;
    double box[4];              /* of the world */
    bool wraps_x, wraps_y;
    uint64_t seed;
};

enum pack_outcome { PACK_DONE, PACK_JAMMED, PACK_MEMORY };

/* Moves the discs until none overlaps another, a side or a wall.  JAMMED: `*scale` is the factor
 * by which all radii would have to shrink. */
enum pack_outcome pack_solve(struct pack *pack, double *scale);

#endif
