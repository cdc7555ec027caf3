/* dsmc_walls.h - grains and solid walls.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_WALLS_H
#define DSMC_WALLS_H

#include "model/dsmc/dsmc.h"

bool dsmc_walls_create(struct dsmc *dsmc);

/* Places the walls at the present time and lists them anew where they have moved. */
void dsmc_walls_place(struct dsmc *dsmc);

/* Is any wall near? */
static inline uint32_t dsmc_walls_cell(const struct dsmc *dsmc, float x, float y)
{
    const struct dsmc_walls *walls = &dsmc->walls;
    float u = x * walls->per_x, v = y * walls->per_y;
    u = u > 0 ? u : 0;
    v = v > 0 ? v : 0;
    const uint32_t cx = u < (float)walls->nx ? (uint32_t)u : walls->nx - 1;
    const uint32_t cy = v < (float)walls->ny ? (uint32_t)v : walls->ny - 1;
    return cy * walls->nx + cx;
}

static inline bool dsmc_walls_near(const struct dsmc *dsmc, float x, float y)
{
    const uint32_t cell = dsmc_walls_cell(dsmc, x, y);
    return dsmc->walls.first[cell + 1] > dsmc->walls.first[cell];
}

/* Moves grain `i` for a time, bouncing off the walls; `block` says where impulses on obstacles are
 * summed up.  True if it met a wall that carries it against gravity (hsmc: a plate). */
bool dsmc_walls_fly(struct dsmc *dsmc, uint32_t i, float time, uint32_t block);

/* Shifts a grain, along walls where they are in the way; its velocity stays. */
void dsmc_walls_slide(const struct dsmc *dsmc, struct dsmc_grain *grain, float dx, float dy);

/* Does a wall still carry the grain? */
bool dsmc_walls_carries(const struct dsmc *dsmc, const struct dsmc_grain *grain);

/* Does the grain fit there, on the same side of all walls?  Coordinates count from the corner. */
bool dsmc_walls_clear(const struct dsmc *dsmc, const struct dsmc_grain *grain, double x, double y);

/* Adds what the blocks gave to the obstacles to the tally, in their order. */
void dsmc_walls_collect(struct dsmc *dsmc);

#endif
