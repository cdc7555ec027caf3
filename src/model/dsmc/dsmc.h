/* dsmc.h - the state of direct simulation Monte Carlo; only files of this folder include it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A step: collide within the cells, move, let in and out, sort by cell for the next step.  Grains
 * are 16-byte records that lie in memory cell by cell, so that a cell's grains are one short run.
 * Positions count from the lower left corner of the box, in single precision.
 *
 * A grain's name and what else it carries (`tags`, `spins`, `contacts`) lie in the same order.
 * They travel through the record that the sort has just emptied, so they need no second copy.
 */
#ifndef DSMC_H
#define DSMC_H

#include "base/arena.h"
#include "model/dsmc/dsmc_settings.h"
#include "model/model.h"
#include "model/source.h"

#include <math.h>

#define FORCE_INLINE static inline __attribute__((always_inline))

/* Addition, multiplication, division and square root round alike in all of them.  Clang gives such
 * a function a name that other files do not find. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("avx2", "default")))
#else
#define CLONES
#endif

struct dsmc_grain { _Alignas(16) float x; float y, vx, vy; };

struct dsmc_contacts { uint16_t now, last; };   /* collisions in this window and in the last */

enum {
    DSMC_BLOCK = 256,           /* cells that share random words: a part of one row */
    DSMC_HOOD = 2               /* cells to each side over which a density is taken: 5 x 5 */
};

/* What a tag holds beside the name. */
#define DSMC_RESTS 0x80000000u          /* hsmc: lies on a full cell */
#define DSMC_PLATE 0x40000000u          /* ... or on a wall */
#define DSMC_NAME  0x3fffffffu

/* One direction of the grid.  Cell k covers u in [k, k+1), u = x * per + offset; outside of the
 * grid u is clamped, so that border cells of a shifted grid are larger or smaller by the shift. */
struct dsmc_axis {
    uint32_t cells;
    float length;               /* of the box, rounded down */
    float per;                  /* 1 / cell */
    float offset;               /* of this step */
    uint32_t beyond;            /* the cell of greater u: the last, or 0 if it wraps */
    float first, last;          /* volume of the border cells, 1 inside */
    bool  wraps;                /* periodic, and not a sheared border */
    bool  periodic;
    float border[2];            /* distance that solid borders keep, in cells; 0: open */
};

struct dsmc_sums {              /* of one thread in one step */
    uint64_t collisions, rejected, tangential;
    double *impacts;            /* by impact parameter, since it was last collected; NULL: none */
    bool moved;                 /* hsmc: has a grain changed its cell? */
    char apart[24];             /* on its own cache line */
};

/* What one thread of a team does in a step: a run of blocks of cells, and the grains in them. */
struct dsmc_share {
    uint32_t block, block_end;
    uint32_t from, cells;       /* its cells, in this grid and in the next */
    uint32_t first, last;       /* its grains: first .. last - 1 */
    uint32_t gone, gone_max;    /* its grains that arrived in cells of other shares */
    uint32_t *away, *places;    /* [gone] those cells, and what place the sort gives them */
    uint32_t sum;               /* grains that its cells will hold */
    bool complete;              /* do its counts hold all grains, from wherever? */
    char apart[64];             /* the next one begins on another cache line */
};

/* Walls near each cell of a grid that stands still. */
struct dsmc_walls {
    uint32_t nx, ny;
    float    per_x, per_y;
    float    stride;            /* longest way between two looks at the walls */
    uint32_t *first;            /* [cell + 1] into near */
    uint32_t *near;
    uint32_t near_max;
    double   speed, moved, slack;       /* lists hold while moved < slack */
    bool     vary, stale;
    struct wall *now;
    bool    *here;
    struct tally_body *sums;    /* [block][body] */
};

struct dsmc {
    const struct scene *scene;
    struct dsmc_settings settings;
    effects_t effects;
    uint64_t  seed;

    double   dt, epoch;         /* time = epoch + steps_here * dt */
    uint64_t steps, steps_here;

    double   radius, mass, inertia;     /* of a simulated particle; radius of a grain */
    double   restitution;
    float    rate;              /* d dt / (V_cell weight): pairs per n (n - 1) v */
    float    displacement;      /* dense: d (1 + r) / (2 r) */
    float    half_impulse;      /* (1 + r) / 2 */
    float    friction, tangential, q;   /* of collisions; inertia = q m R^2 */

    uint32_t count, count_max, id_next;
    struct dsmc_grain *grains, *sorted;         /* now, and where the next sort puts them */
    uint32_t *tags;
    float    *spins;            /* NULL without rotation */
    struct dsmc_contacts *contacts;             /* NULL if nobody measures */

    struct dsmc_axis ax, ay;    /* the grid that the grains are sorted into */
    struct dsmc_axis next_ax, next_ay;          /* and that of the next step */
    uint32_t cells, blocks;
    uint32_t *first;            /* [cell + 1]: where each cell's grains begin */
    uint32_t *load;             /* grains in each cell of the next grid, while they move */
    uint32_t *load_apart;       /* where that lies; NULL: in `sorted`, which then is free */
    struct dsmc_share *shares;  /* [thread] */
    uint32_t threads;
    struct dsmc_sums *sums;     /* [thread] */
    double *impacts;            /* [thread][bin]; NULL if nobody asks */
    struct dsmc_walls walls;

    uint32_t full;              /* hsmc: grains that fill a cell; 0: no limit */
    bool     unsorted;          /* hsmc: some grain has changed its cell in this step */

    struct source_cursor *cursors;
    struct source_grain *batch;
    uint32_t batch_max;
    struct tally tally;
    double   window_length;
    uint64_t window;
    uint64_t collisions, rejected, tangential_count, grains_in, grains_out;
    struct arena arena;
};

static inline double dsmc_time(const struct dsmc *dsmc)
{
    return dsmc->epoch + (double)dsmc->steps_here * dsmc->dt;
}

/* Lees-Edwards: how fast the image of the box above moves, and how far it is ahead a step on. */
struct dsmc_image { float speed, way; };

static inline struct dsmc_image dsmc_image(const struct dsmc *dsmc)
{
    const double speed = dsmc->scene->shear_rate * (double)dsmc->ay.length;
    const double way = fmod(speed * (dsmc_time(dsmc) + dsmc->dt), (double)dsmc->ax.length);
    return (struct dsmc_image){(float)speed, (float)way};
}

/* A collision with the impact parameter b, a share of the diameter. */
static inline void dsmc_note_impact(const struct dsmc *dsmc, double *impacts, float b)
{
    const uint32_t bins = dsmc->tally.impact.bins;
    const uint32_t bin = (uint32_t)(fabsf(b) * (float)bins);
    impacts[bin < bins ? bin : bins - 1] += 1;
}

static inline uint32_t dsmc_axis_cell(const struct dsmc_axis *axis, float x)
{
    const float u = x * axis->per + axis->offset;
    const float most = 1e9f;                                    /* still a whole number */
    const int32_t k = u > -most ? (int32_t)(u < most ? u : most) : 0;   /* not a number: 0 */
    return k < 0 ? 0 : k < (int32_t)axis->cells ? (uint32_t)k : axis->beyond;
}

static inline uint32_t dsmc_cell(const struct dsmc_axis *ax, const struct dsmc_axis *ay, float x,
                                 float y)
{
    return dsmc_axis_cell(ay, y) * ax->cells + dsmc_axis_cell(ax, x);
}

/* Crowding factor chi of the area fraction nu.  A fraction beyond what discs can fill gets the
 * factor of the densest packings, so that overfull cells stay finite. */
static inline float dsmc_chi(int kind, float nu)
{
    if (kind == DSMC_FREE_VOLUME) {
        const float free = 1 - nu / 0.82f;
        return 1 / (free > 0.025f ? free : 0.025f);
    }
    const float crowd = nu < 0.9f ? nu : 0.9f, room = 1 - crowd;
    return (1 - 0.4375f * crowd) / (room * room);
}

#endif
