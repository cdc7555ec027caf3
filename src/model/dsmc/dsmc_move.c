/* dsmc_move.c - a step: collide, fly, sort.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A thread takes a run of blocks of cells.  It collides the grains of a block, moves them and
 * counts them into their new cells while they are in its cache; one pass over memory does all
 * that.  A second one, the sort, copies each grain to its new place.
 */
#include "model/dsmc/dsmc_move.h"

#include "base/rng.h"
#include "model/dsmc/dsmc_collide.h"
#include "model/dsmc/dsmc_flow.h"
#include "model/dsmc/dsmc_flight.h"
#include "model/dsmc/dsmc_heap.h"
#include "model/dsmc/dsmc_sort.h"
#include "model/dsmc/dsmc_vector.h"
#include "model/dsmc/dsmc_walls.h"

#include <math.h>
#include <omp.h>
#include <string.h>

enum { PARALLEL_MIN = 4000 };   /* grains; for fewer a second thread costs more than it brings */

static const uint64_t shift_key = 0x7368696674;         /* "shift": apart from other streams */

/* ---- the grid ------------------------------------------------------------------------------- */

/* Shifts a grid by a share of a cell, -1/2 .. 1/2.  Where it does not wrap, the border cells grow
 * or shrink, and solid borders keep the centres of grains away. */
static struct dsmc_axis shifted(struct dsmc_axis axis, float shift)
{
    axis.offset = axis.wraps ? 0.5f - shift : -shift;
    axis.beyond = axis.wraps ? 0 : axis.cells - 1;
    axis.first = axis.last = 1;
    if (axis.wraps || axis.cells == 1) return axis;
    axis.first = 1 + shift - axis.border[0];
    axis.last = 1 - shift - axis.border[1];
    return axis;
}

/* Dense: another grid every step, so that no grain always shares its cell with the same ones. */
static void lay_grid(struct dsmc *dsmc, uint64_t step)
{
    float sx = 0, sy = 0;
    if (dsmc->settings.method == DSMC_DENSE) {
        const uint64_t word = rng_keyed(dsmc->seed, shift_key, step, 0);
        sx = (float)(uint32_t)(word >> 40) * 0x1p-24f - 0.5f;
        sy = (float)(uint32_t)(word >> 8 & 0xffffff) * 0x1p-24f - 0.5f;
    }
    dsmc->next_ax = shifted(dsmc->ax, sx);
    dsmc->next_ay = shifted(dsmc->ay, sy);
}

/* ---- flight --------------------------------------------------------------------------------- */

struct run { uint32_t first, last, block; };    /* grains first .. last - 1 of a block of cells */

/* Moves the grains of a block and counts them into their new cells. */
FORCE_INLINE void fly(struct dsmc *dsmc, const struct dsmc_flight *flight, struct run run,
                      struct dsmc_share *share, bool walls, bool shear)
{
    struct dsmc_share mine = *share;
    uint32_t *restrict load = dsmc->load;
    vector4 *restrict grains = (vector4 *)(void *)dsmc->grains;
    const struct dsmc_flight f = *flight;
    const struct dsmc_finder finder = dsmc_flight_finder(dsmc);
    for (uint32_t i = run.first; i < run.last; i++) {
        vector4 p = grains[i];
        const vector4 v = {p[2], p[3], p[2], p[3]};
        const vector4 way = v * f.time + f.fall;
        const bool far = walls && !(way[0] * way[0] + way[1] * way[1] <= f.stride2);
        if (walls && (far || dsmc_walls_near(dsmc, p[0], p[1]))) {
            dsmc_walls_fly(dsmc, i, f.time[0], run.block);
            p = grains[i];
        } else {
            p += way;
        }
        if (shear) p = dsmc_flight_sheared(&f, p);
        p = dsmc_flight_inside(&f, p);
        grains[i] = p;
        dsmc_sort_arrive(&mine, load, dsmc_flight_one(&finder, p));
    }
    share->gone = mine.gone;
}

/* The same where nothing is in the way: no walls, and the grid wraps in both directions.
 * `falls`: there is gravity; `alone`: there is one share, so that nobody leaves it. */
FORCE_INLINE void fly_freely(struct dsmc *dsmc, const struct dsmc_flight *f, struct run run,
                             struct dsmc_share *share, bool falls, bool alone)
{
    struct dsmc_share mine = *share;
    uint32_t *restrict load = dsmc->load;
    struct dsmc_grain *restrict grains = dsmc->grains;
    const struct dsmc_finder finder = dsmc_flight_finder(dsmc);
    const vector8 time = TWICE(f->time), fall = TWICE(f->fall), by = TWICE(f->by);
    const vector8 below = TWICE(f->below), above = TWICE(f->above);
    uint32_t cell[2];
    uint32_t i = run.first;
    for (; i + 1 < run.last; i += 2) {
        vector8 *at = (vector8 *)(void *)&grains[i];
        vector8 p = *at;
        const vector8 v = {p[2], p[3], p[2], p[3], p[6], p[7], p[6], p[7]};
        p += falls ? v * time + fall : v * time;
        const vector8 up = (vector8)((mask8)by & (p < below));
        const vector8 down = (vector8)((mask8)by & (p >= above));
        p = p + up - down;
        *at = p;
        dsmc_flight_two(&finder, &p, true, cell);
        if (alone) {
            load[cell[0]]++;
            load[cell[1]]++;
        } else {
            dsmc_sort_arrive(&mine, load, cell[0]);
            dsmc_sort_arrive(&mine, load, cell[1]);
        }
    }
    if (i < run.last) {
        vector4 *at = (vector4 *)(void *)&grains[i];
        const vector4 v = {(*at)[2], (*at)[3], (*at)[2], (*at)[3]};
        const vector4 p = dsmc_flight_inside(f, *at + (v * f->time + f->fall));
        *at = p;
        dsmc_sort_arrive(&mine, load, dsmc_flight_one(&finder, p));
    }
    share->gone = mine.gone;
}

/* X(name, falls, alone) */
#define FREE_LOOPS(X)                                                                           \
    X(free, false, false) X(free_alone, false, true) X(fall, true, false) X(fall_alone, true, true)

#define X(name, falls, alone)                                                                   \
    CLONES static void fly_##name(struct dsmc *dsmc, const struct dsmc_flight *f,               \
                                  struct run run, struct dsmc_share *share)                     \
    {                                                                                           \
        fly_freely(dsmc, f, run, share, falls, alone);                                          \
    }
FREE_LOOPS(X)
#undef X

/* X(name, walls, shear): the loops that exist beside */
#define LOOPS(X)                                                                                \
    X(open, false, false) X(walls, true, false) X(shear, false, true) X(both, true, true)

#define X(name, walls, shear)                                                                   \
    CLONES static void fly_##name(struct dsmc *dsmc, const struct dsmc_flight *f,               \
                                  struct run run, struct dsmc_share *share)                     \
    {                                                                                           \
        fly(dsmc, f, run, share, walls, shear);                                                 \
    }
LOOPS(X)
#undef X

static void fly_block(struct dsmc *dsmc, const struct dsmc_flight *f, struct run run,
                      struct dsmc_share *share)
{
    const bool walls = dsmc->walls.first, shear = f->image.speed != 0;
    const bool falls = dsmc->effects & EFFECT_GRAVITY, alone = share->cells == dsmc->cells;
    if (walls) (shear ? fly_both : fly_walls)(dsmc, f, run, share);
    else if (shear) fly_shear(dsmc, f, run, share);
    else if (!dsmc_flight_wraps(dsmc)) fly_open(dsmc, f, run, share);
    else if (falls) (alone ? fly_fall_alone : fly_fall)(dsmc, f, run, share);
    else (alone ? fly_free_alone : fly_free)(dsmc, f, run, share);
}

void dsmc_move_sort(struct dsmc *dsmc)
{
    lay_grid(dsmc, dsmc->steps);
    dsmc_sort_all(dsmc);
    dsmc_sort_end(dsmc);
}

/* ---- a step --------------------------------------------------------------------------------- */

/* Collides, moves and counts the grains of a share. */
static void do_blocks(struct dsmc *dsmc, const struct dsmc_flight *flight, struct dsmc_share *share,
                      struct dsmc_sums *sums)
{
    for (uint32_t block = share->block; block < share->block_end; block++) {
        const uint32_t first = dsmc->first[dsmc_collide_cell(dsmc, block)];
        const uint32_t last = dsmc->first[dsmc_collide_cell(dsmc, block + 1)];
        if (first == last) continue;
        dsmc_collide(dsmc, block, sums);
        if (dsmc->full) continue;
        fly_block(dsmc, flight, (struct run){first, last, block}, share);
    }
}

static void collect_impacts(struct dsmc *dsmc)
{
    const uint32_t bins = dsmc->tally.impact.bins;
    for (uint32_t k = 0; dsmc->impacts && k < bins * dsmc->threads; k++) {
        dsmc->tally.impact.count[k % bins] += dsmc->impacts[k];         /* whole numbers: exact */
        dsmc->impacts[k] = 0;
    }
}

/* What changes the number of grains, or needs them one after the other. */
static void do_alone(struct dsmc *dsmc)
{
    collect_impacts(dsmc);
    for (uint32_t t = 0; t < dsmc->threads; t++) dsmc->unsorted |= dsmc->sums[t].moved;
    dsmc_walls_collect(dsmc);
    dsmc->steps++;
    dsmc->steps_here++;
    dsmc_flow_pass(dsmc);
}

static void do_share(struct dsmc *dsmc, const struct dsmc_flight *flight)
{
    const uint32_t t = (uint32_t)omp_get_thread_num(), team = (uint32_t)omp_get_num_threads();
    const bool flow = dsmc->effects & (EFFECT_OUTFLOW | EFFECT_SCREEN | EFFECT_INFLOW);
    struct dsmc_sums sums = {
        .impacts = dsmc->impacts ? dsmc->impacts + (size_t)t * dsmc->tally.impact.bins : NULL};
    dsmc_sort_begin(dsmc, t, team);
    if (dsmc->full) dsmc_heap_load(dsmc, t);
    do_blocks(dsmc, flight, &dsmc->shares[t], &sums);
    dsmc->sums[t] = sums;
#pragma omp barrier
    if (dsmc->full) dsmc_heap_sweep(dsmc, &dsmc->sums[t]);
#pragma omp master
    do_alone(dsmc);
#pragma omp barrier
    if (dsmc->full && !dsmc->unsorted) return;          /* a heap at rest keeps its order */
    if (flow) dsmc_sort_recount(dsmc, t, team);
    else if (dsmc->full) dsmc_sort_list(dsmc, t, DSMC_HEAP_ROWS);
    if (flow || dsmc->full) {
#pragma omp barrier
    }
    dsmc_sort_share(dsmc, t, team);
}

void dsmc_move_step(struct dsmc *dsmc)
{
    dsmc_walls_place(dsmc);
    lay_grid(dsmc, dsmc->steps + 1);
    const struct dsmc_flight flight = dsmc_flight_of(dsmc);
    memset(dsmc->sums, 0, dsmc->threads * sizeof *dsmc->sums);
#pragma omp parallel num_threads((int)dsmc->threads) if (dsmc->count >= PARALLEL_MIN)
    do_share(dsmc, &flight);
    if (!dsmc->full || dsmc->unsorted) dsmc_sort_end(dsmc);
    dsmc->unsorted = false;
    for (uint32_t t = 0; t < dsmc->threads; t++) {
        dsmc->collisions += dsmc->sums[t].collisions;
        dsmc->rejected += dsmc->sums[t].rejected;
        dsmc->tangential_count += dsmc->sums[t].tangential;
    }
}
