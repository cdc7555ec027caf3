/* dsmc_flight.h - free flight of one step, and the cell in which it ends.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Written for records (x y vx vy) as a whole; a compiler keeps each in one register.
 */
#ifndef DSMC_FLIGHT_H
#define DSMC_FLIGHT_H

#include "model/dsmc/dsmc.h"
#include "model/dsmc/dsmc_vector.h"

/* The next grid as the loops want it: both directions of two grains at once. */
struct dsmc_finder {
    vector8 per, offset;
    mask8   cells, beyond;
    uint32_t columns;
};

static inline bool dsmc_flight_wraps(const struct dsmc *dsmc)
{
    return dsmc->next_ax.wraps && dsmc->next_ay.wraps;
}

static inline struct dsmc_finder dsmc_flight_finder(const struct dsmc *dsmc)
{
    const struct dsmc_axis *ax = &dsmc->next_ax, *ay = &dsmc->next_ay;
    const int32_t nx = (int32_t)ax->cells, ny = (int32_t)ay->cells;
    const int32_t bx = (int32_t)ax->beyond, by = (int32_t)ay->beyond;
    return (struct dsmc_finder){
        .per = {ax->per, ay->per, 0, 0, ax->per, ay->per, 0, 0},
        .offset = {ax->offset, ay->offset, 0, 0, ax->offset, ay->offset, 0, 0},
        .cells = {nx, ny, 1, 1, nx, ny, 1, 1}, .beyond = {bx, by, 0, 0, bx, by, 0, 0},
        .columns = ax->cells,
    };
}

/* The cells of two grains, as dsmc_cell() gives them.  What is no number, or too large for a whole
 * one, becomes negative and so 0.  `wraps`: the grid does, so all that is not inside is in 0. */
FORCE_INLINE void dsmc_flight_two(const struct dsmc_finder *f, const vector8 *p, bool wraps,
                                  uint32_t cell[2])
{
    mask8 k = __builtin_convertvector(*p * f->per + f->offset, mask8);
    if (wraps) {
        k &= (count8)k < (count8)f->cells;              /* what is negative counts as large */
    } else {
        const mask8 inside = k < f->cells;
        k = (k & inside) | (f->beyond & ~inside);
        k &= ~(k >> 31);
    }
    const words4 words = (words4)k;                             /* x below, y above */
    cell[0] = (uint32_t)(words[0] >> 32) * f->columns + (uint32_t)words[0];
    cell[1] = (uint32_t)(words[2] >> 32) * f->columns + (uint32_t)words[2];
}

/* Not a function: how such a register is returned differs between processors. */
#define TWICE(p) ((vector8){(p)[0], (p)[1], (p)[2], (p)[3], (p)[0], (p)[1], (p)[2], (p)[3]})

FORCE_INLINE uint32_t dsmc_flight_one(const struct dsmc_finder *f, vector4 p)
{
    const vector8 both = TWICE(p);
    uint32_t cell[2];
    dsmc_flight_two(f, &both, false, cell);
    return cell[0];
}

FORCE_INLINE vector4 dsmc_flight_chosen(vector4 a, vector4 b, mask4 which)
{
    return (vector4)(((mask4)a & which) | ((mask4)b & ~which));
}

/* Free flight of one step for records (x y vx vy). */
struct dsmc_flight {
    vector4 time;               /* dt for positions, 0 for velocities */
    vector4 fall;               /* g dt^2/2 and g dt */
    vector4 below, above, by;   /* periodic: what lies below or above comes back by a length */
    vector4 low, high;          /* solid borders: never beyond */
    struct dsmc_image image;    /* Lees-Edwards */
    float   stride2;            /* farther than that in a step: look at the walls on the way */
};

static inline struct dsmc_flight dsmc_flight_of(const struct dsmc *dsmc)
{
    const double *g = dsmc->scene->gravity, dt = dsmc->dt;
    const float inf = INFINITY;
    struct dsmc_flight f = {
        .time = {(float)dt, (float)dt, 0, 0},
        .fall = {(float)(0.5 * g[0] * dt * dt), (float)(0.5 * g[1] * dt * dt), (float)(g[0] * dt),
                 (float)(g[1] * dt)},
        .below = {-inf, -inf, -inf, -inf}, .above = {inf, inf, inf, inf},
        .low = {-inf, -inf, -inf, -inf}, .high = {inf, inf, inf, inf},
    };
    const struct scene *scene = dsmc->scene;
    const int lows[2] = {scene->left, scene->bottom}, highs[2] = {scene->right, scene->top};
    const float lengths[2] = {dsmc->ax.length, dsmc->ay.length};
    for (int k = 0; k < 2; k++) {
        if (lows[k] == BORDER_PERIODIC) {
            f.below[k] = 0;
            f.above[k] = f.by[k] = lengths[k];
        }
        if (lows[k] == BORDER_WALL) f.low[k] = 0;
        if (highs[k] == BORDER_WALL) f.high[k] = lengths[k];
    }
    f.image = dsmc_image(dsmc);
    f.stride2 = dsmc->walls.stride * dsmc->walls.stride;
    return f;
}

FORCE_INLINE vector4 dsmc_flight_inside(const struct dsmc_flight *f, vector4 p)
{
    p += (vector4)((mask4)f->by & (p < f->below));
    p -= (vector4)((mask4)f->by & (p >= f->above));
    p = dsmc_flight_chosen(f->low, p, p < f->low);
    return dsmc_flight_chosen(f->high, p, p > f->high);
}

/* What leaves at the top comes in at the bottom, slower by the speed of the image above. */
FORCE_INLINE vector4 dsmc_flight_sheared(const struct dsmc_flight *f, vector4 p)
{
    const float side = p[1] >= f->above[1] ? 1 : p[1] < 0 ? -1 : 0;
    if (side == 0) return p;
    p[0] -= side * f->image.way;
    p[2] -= side * f->image.speed;
    if (p[0] < 0) p[0] += f->above[0];
    return p;
}

#endif
