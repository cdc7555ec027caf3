/* dsmc_move.c - a step: collide, fly, sort.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A thread takes a run of blocks of cells.  It collides the grains of a block, moves them and
 * counts them into their new cells while they are in its cache; one pass over memory does all
 * that.  A second one copies each grain to its new place: destinations first, for some hundred
 * grains, then the copies, which so do not wait for each other.  Every thread counts for itself,
 * and its share of a cell follows that of the thread before: grains keep their order whatever the
 * number of threads.
 */
#include "model/dsmc/dsmc_move.h"

#include "base/rng.h"
#include "model/dsmc/dsmc_collide.h"
#include "model/dsmc/dsmc_flow.h"
#include "model/dsmc/dsmc_flight.h"
#include "model/dsmc/dsmc_heap.h"
#include "model/dsmc/dsmc_vector.h"
#include "model/dsmc/dsmc_walls.h"

#include <math.h>
#include <omp.h>
#include <string.h>

enum {
    PARALLEL_MIN = 4000,        /* grains; for fewer a second thread costs more than it brings */
    SCATTER = 512               /* grains whose destinations are found at a time */
};

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
                      uint32_t *restrict places, bool walls, bool shear)
{
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
        places[dsmc_flight_one(&finder, p)]++;
    }
}

/* The same where nothing is in the way: no walls, no open or sheared borders. */
FORCE_INLINE void fly_freely(struct dsmc *dsmc, const struct dsmc_flight *f, struct run run,
                             uint32_t *restrict places)
{
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
        p += v * time + fall;
        const vector8 up = (vector8)((mask8)by & (p < below));
        const vector8 down = (vector8)((mask8)by & (p >= above));
        p = p + up - down;
        *at = p;
        dsmc_flight_two(&finder, &p, cell);
        places[cell[0]]++;
        places[cell[1]]++;
    }
    if (i == run.last) return;
    vector4 *at = (vector4 *)(void *)&grains[i];
    const vector4 v = {(*at)[2], (*at)[3], (*at)[2], (*at)[3]};
    const vector4 p = dsmc_flight_inside(f, *at + (v * f->time + f->fall));
    *at = p;
    places[dsmc_flight_one(&finder, p)]++;
}

CLONES static void fly_free(struct dsmc *dsmc, const struct dsmc_flight *f, struct run run,
                            uint32_t *places)
{
    fly_freely(dsmc, f, run, places);
}

/* X(name, walls, shear): the loops that exist beside */
#define LOOPS(X)                                                                                \
    X(open, false, false) X(walls, true, false) X(shear, false, true) X(both, true, true)

#define X(name, walls, shear)                                                                   \
    CLONES static void fly_##name(struct dsmc *dsmc, const struct dsmc_flight *f,               \
                                  struct run run, uint32_t *places)                             \
    {                                                                                           \
        fly(dsmc, f, run, places, walls, shear);                                                \
    }
LOOPS(X)
#undef X

static void fly_block(struct dsmc *dsmc, const struct dsmc_flight *f, struct run run,
                      uint32_t *places)
{
    const bool walls = dsmc->walls.first, shear = f->image.speed != 0;
    if (walls) (shear ? fly_both : fly_walls)(dsmc, f, run, places);
    else if (shear) fly_shear(dsmc, f, run, places);
    else if (dsmc->ax.periodic && dsmc->ay.periodic) fly_free(dsmc, f, run, places);
    else fly_open(dsmc, f, run, places);
}

/* ---- sort ----------------------------------------------------------------------------------- */

/* What travels through the records of grains that have been copied, from the first one of the
 * thread on: two names a record, or one with what else a grain carries. */
struct __attribute__((may_alias)) carry { uint32_t place, tag; };
struct __attribute__((may_alias)) luggage {
    struct carry carry;
    float spin;
    struct dsmc_contacts contacts;
};
_Static_assert(sizeof(struct luggage) == sizeof(struct dsmc_grain), "luggage fits a record");

CLONES static void count(const struct dsmc *dsmc, uint32_t *restrict places, uint32_t first,
                         uint32_t last)
{
    const struct dsmc_finder finder = dsmc_flight_finder(dsmc);
    const vector4 *restrict grains = (const vector4 *)(const void *)dsmc->grains;
    for (uint32_t i = first; i < last; i++) places[dsmc_flight_one(&finder, grains[i])]++;
}

/* Turns the threads' counts into places: `first` of the cells of share `t`, in two passes. */
static void find_places(struct dsmc *dsmc, uint32_t t, uint32_t team, uint32_t *starts)
{
    const uint32_t from = (uint32_t)((uint64_t)dsmc->cells * t / team);
    const uint32_t to = (uint32_t)((uint64_t)dsmc->cells * (t + 1) / team);
    uint32_t sum = 0;
    for (uint32_t q = 0; q < team; q++) {
        const uint32_t *places = dsmc->places + (size_t)q * dsmc->cells;
        for (uint32_t c = from; c < to; c++) sum += places[c];
    }
    starts[t] = sum;
#pragma omp barrier
    uint32_t at = 0;
    for (uint32_t q = 0; q < t; q++) at += starts[q];
    for (uint32_t c = from; c < to; c++) {
        dsmc->first[c] = at;
        for (uint32_t q = 0; q < team; q++) {
            uint32_t *place = &dsmc->places[(size_t)q * dsmc->cells + c];
            const uint32_t n = *place;
            *place = at;
            at += n;
        }
    }
    if (t + 1 == team) dsmc->first[dsmc->cells] = at;
#pragma omp barrier
}

/* Copies n grains, from the first of a share on (`done` before them), and packs what they carry. */
FORCE_INLINE void copy_grains(const struct dsmc *dsmc, uint32_t first, uint32_t done, uint32_t n,
                              const uint32_t *restrict place)
{
    const vector4 *from = (const vector4 *)(const void *)&dsmc->grains[first + done];
    vector4 *restrict to = (vector4 *)(void *)dsmc->sorted;
    const uint32_t *restrict tags = &dsmc->tags[first + done];
    struct carry *carries = (struct carry *)(void *)&dsmc->grains[first] + done;
    struct luggage *luggage = (struct luggage *)(void *)&dsmc->grains[first] + done;
    const bool loaded = dsmc->spins || dsmc->contacts;
    for (uint32_t k = 0; !loaded && k < n; k++) {
        to[place[k]] = from[k];
        carries[k] = (struct carry){place[k], tags[k]};
    }
    for (uint32_t k = 0; loaded && k < n; k++) {
        to[place[k]] = from[k];
        luggage[k].carry = (struct carry){place[k], tags[k]};
    }
    for (uint32_t k = 0; dsmc->spins && k < n; k++) {
        luggage[k].spin = dsmc->spins[first + done + k];
    }
    for (uint32_t k = 0; dsmc->contacts && k < n; k++) {
        luggage[k].contacts = dsmc->contacts[first + done + k];
    }
}

CLONES static void scatter(const struct dsmc *dsmc, uint32_t *restrict places, uint32_t first,
                           uint32_t last)
{
    const struct dsmc_finder finder = dsmc_flight_finder(dsmc);
    const vector4 *from = (const vector4 *)(const void *)dsmc->grains;
    uint32_t place[SCATTER];
    for (uint32_t i = first; i < last; i += SCATTER) {
        const uint32_t n = last - i < SCATTER ? last - i : SCATTER;
        uint32_t m = 0;
        for (; m + 1 < n; m += 2) {
            dsmc_flight_two(&finder, (const vector8 *)(const void *)&from[i + m], &place[m]);
        }
        if (m < n) place[m] = dsmc_flight_one(&finder, from[i + m]);
        for (uint32_t k = 0; k < n; k++) {
            place[k] = places[place[k]]++;
            __builtin_prefetch(&dsmc->sorted[place[k]], 1);
        }
        copy_grains(dsmc, first, i - first, n, place);
    }
}

static void deliver(struct dsmc *dsmc, uint32_t first, uint32_t last)
{
    const struct carry *carries = (const struct carry *)(const void *)&dsmc->grains[first];
    const struct luggage *luggage = (const struct luggage *)(const void *)&dsmc->grains[first];
    uint32_t *restrict tags = dsmc->tags;
    const uint32_t n = last - first;
    const bool loaded = dsmc->spins || dsmc->contacts;
    for (uint32_t k = 0; !loaded && k < n; k++) tags[carries[k].place] = carries[k].tag;
    for (uint32_t k = 0; loaded && k < n; k++) {
        const struct luggage *l = &luggage[k];
        tags[l->carry.place] = l->carry.tag;
        if (dsmc->spins) dsmc->spins[l->carry.place] = l->spin;
        if (dsmc->contacts) dsmc->contacts[l->carry.place] = l->contacts;
    }
}

/* Where the share of thread t begins, in grains: at a block, so that shares are nearly equal. */
static uint32_t share_block(const struct dsmc *dsmc, uint32_t t, uint32_t team)
{
    const uint32_t wanted = (uint32_t)((uint64_t)dsmc->count * t / team);
    uint32_t low = 0, high = dsmc->blocks;
    if (t == team) return high;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (dsmc->first[dsmc_collide_cell(dsmc, middle)] < wanted) low = middle + 1;
        else high = middle;
    }
    return low;
}

/* Other threads may still be delivering when it returns. */
static void sort_share(struct dsmc *dsmc, uint32_t t, uint32_t team, uint32_t *starts,
                       uint32_t first, uint32_t last)
{
    uint32_t *places = dsmc->places + (size_t)t * dsmc->cells;
    find_places(dsmc, t, team, starts);
    scatter(dsmc, places, first, last);
#pragma omp barrier
    deliver(dsmc, first, last);
}

static void finish_sort(struct dsmc *dsmc)
{
    struct dsmc_grain *old = dsmc->grains;
    dsmc->grains = dsmc->sorted;
    dsmc->sorted = old;
    dsmc->ax = dsmc->next_ax;
    dsmc->ay = dsmc->next_ay;
}

void dsmc_move_sort(struct dsmc *dsmc)
{
    uint32_t start;
    lay_grid(dsmc, dsmc->steps);
    memset(dsmc->places, 0, dsmc->cells * sizeof *dsmc->places);
    count(dsmc, dsmc->places, 0, dsmc->count);
    sort_share(dsmc, 0, 1, &start, 0, dsmc->count);
    finish_sort(dsmc);
}

/* ---- a step --------------------------------------------------------------------------------- */

/* Collides, moves and counts the grains of some blocks. */
static void do_blocks(struct dsmc *dsmc, const struct dsmc_flight *flight, uint32_t from,
                      uint32_t to, uint32_t *places, struct dsmc_sums *sums)
{
    for (uint32_t block = from; block < to; block++) {
        const uint32_t first = dsmc->first[dsmc_collide_cell(dsmc, block)];
        const uint32_t last = dsmc->first[dsmc_collide_cell(dsmc, block + 1)];
        if (first == last) continue;
        dsmc_collide(dsmc, block, sums);
        if (dsmc->full) continue;
        fly_block(dsmc, flight, (struct run){first, last, block}, places);
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

static void do_share(struct dsmc *dsmc, const struct dsmc_flight *flight, uint32_t *starts)
{
    const uint32_t t = (uint32_t)omp_get_thread_num(), team = (uint32_t)omp_get_num_threads();
    const effects_t flows = EFFECT_OUTFLOW | EFFECT_SCREEN | EFFECT_INFLOW;
    const bool flow = dsmc->effects & flows;
    const uint32_t from = share_block(dsmc, t, team), to = share_block(dsmc, t + 1, team);
    uint32_t *places = dsmc->places + (size_t)t * dsmc->cells;
    uint32_t first = dsmc->first[dsmc_collide_cell(dsmc, from)];
    uint32_t last = dsmc->first[dsmc_collide_cell(dsmc, to)];
    struct dsmc_sums sums = {
        .impacts = dsmc->impacts ? dsmc->impacts + (size_t)t * dsmc->tally.impact.bins : NULL};
    if (dsmc->full) dsmc_heap_load(dsmc, t, team, from, to);
    else memset(places, 0, dsmc->cells * sizeof *places);
    do_blocks(dsmc, flight, from, to, places, &sums);
    dsmc->sums[t] = sums;
#pragma omp barrier
    if (dsmc->full) dsmc_heap_sweep(dsmc, &dsmc->sums[t]);
#pragma omp master
    do_alone(dsmc);
#pragma omp barrier
    if (dsmc->full && !dsmc->unsorted) return;          /* a heap at rest keeps its order */
    if (dsmc->full && team == 1 && !flow) {
        for (uint32_t c = 0; c < dsmc->cells; c++) places[c] = dsmc->load[c];
    } else if (flow) {                                  /* the counts are of other grains */
        memset(places, 0, dsmc->cells * sizeof *places);
        first = (uint32_t)((uint64_t)dsmc->count * t / team);
        last = (uint32_t)((uint64_t)dsmc->count * (t + 1) / team);
        count(dsmc, places, first, last);
#pragma omp barrier
    }
    sort_share(dsmc, t, team, starts, first, last);
}

void dsmc_move_step(struct dsmc *dsmc)
{
    uint32_t starts[dsmc->threads];
    dsmc_walls_place(dsmc);
    lay_grid(dsmc, dsmc->steps + 1);
    const struct dsmc_flight flight = dsmc_flight_of(dsmc);
    memset(dsmc->sums, 0, dsmc->threads * sizeof *dsmc->sums);
#pragma omp parallel num_threads((int)dsmc->threads) if (dsmc->count >= PARALLEL_MIN)
    do_share(dsmc, &flight, starts);
    if (!dsmc->full || dsmc->unsorted) finish_sort(dsmc);
    dsmc->unsorted = false;
    for (uint32_t t = 0; t < dsmc->threads; t++) {
        dsmc->collisions += dsmc->sums[t].collisions;
        dsmc->rejected += dsmc->sums[t].rejected;
        dsmc->tangential_count += dsmc->sums[t].tangential;
    }
}
