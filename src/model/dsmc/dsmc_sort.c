/* dsmc_sort.c - the sort by cell that ends a step.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A counting sort: grains are counted into the cells where they arrive, sums of the counts are
 * places, and one pass over memory copies each grain to its own: destinations first, for some
 * hundred grains, then the copies, which so do not wait for each other.
 *
 * Each thread of a team has a share of the cells and the grains in them, and counts and places what
 * stays there.  The few grains that go to another share are listed; the thread whose cells they
 * enter gives them their places.  In a cell grains keep the order of before, whatever the number of
 * threads: first come those from earlier shares, then its own, then those from later ones.
 *
 * Little memory is needed for that, 4 bytes a cell, `first`.  While grains are counted nobody needs
 * `sorted`, so the counts lie there; while they are copied nobody needs the old `first`, so it
 * tells where the next grain of each cell goes and in the end where the next cell begins.
 */
#include "model/dsmc/dsmc_sort.h"

#include "model/dsmc/dsmc_collide.h"

#include <math.h>
#include <string.h>

enum {
    SCATTER = 512,              /* grains whose destinations are found at a time */
    AWAY_ROWS = 4,              /* a list holds the grains of so many rows of cells: a grid shifts
                                   and a grain flies by less than one at each end of a share */
    AWAY_MIN = 256              /* ... but at least that many */
};

static double away_max(double grains, double rows, double threads)
{
    if (threads < 2) return 0;
    return fmin(grains, fmax(AWAY_MIN, AWAY_ROWS * grains / fmax(rows, 1)));
}

/* Do the counts fit into `sorted`? */
static bool load_fits(double grains, double cells)
{
    return cells * sizeof(uint32_t) <= grains * sizeof(struct dsmc_grain);
}

static void find_load(struct dsmc *dsmc)
{
    dsmc->load = dsmc->load_apart ? dsmc->load_apart : (uint32_t *)(void *)dsmc->sorted;
}

bool dsmc_sort_create(struct dsmc *dsmc)
{
    const uint32_t grains = dsmc->count_max, cells = dsmc->cells, threads = dsmc->threads;
    const uint32_t most = (uint32_t)away_max(grains, dsmc->ay.cells, threads);
    const size_t lists = (size_t)threads * most;
    const bool fits = load_fits(grains, cells);
    uint32_t *away, *places;
    if (!arena_array(&dsmc->arena, &dsmc->first, (size_t)cells + 1)
        || !arena_array(&dsmc->arena, &dsmc->load_apart, fits ? 0 : cells)
        || !arena_array(&dsmc->arena, &dsmc->shares, threads)
        || !arena_array(&dsmc->arena, &away, lists)
        || !arena_array(&dsmc->arena, &places, lists)) return false;
    find_load(dsmc);
    for (uint32_t t = 0; most > 0 && t < threads; t++) {
        dsmc->shares[t].away = away + (size_t)t * most;
        dsmc->shares[t].places = places + (size_t)t * most;
        dsmc->shares[t].gone_max = most;
    }
    return true;
}

double dsmc_sort_memory(double grains, double cells, double rows, double threads)
{
    const double lists = 2 * threads * away_max(grains, rows, threads);
    return sizeof(uint32_t) * (cells + lists + (load_fits(grains, cells) ? 0 : cells));
}

/* ---- shares --------------------------------------------------------------------------------- */

/* Where the share of thread t begins: at a block, so that shares have nearly the same number of
 * grains. */
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

static void forget_arrivals(struct dsmc *dsmc, struct dsmc_share *share)
{
    memset(&dsmc->load[share->from], 0, share->cells * sizeof *dsmc->load);
    share->gone = 0;
    share->complete = false;
}

void dsmc_sort_begin(struct dsmc *dsmc, uint32_t t, uint32_t team)
{
    struct dsmc_share *share = &dsmc->shares[t];
    share->block = share_block(dsmc, t, team);
    share->block_end = share_block(dsmc, t + 1, team);
    share->from = dsmc_collide_cell(dsmc, share->block);
    share->cells = dsmc_collide_cell(dsmc, share->block_end) - share->from;
    share->first = dsmc->first[share->from];
    share->last = dsmc->first[share->from + share->cells];
    forget_arrivals(dsmc, share);
}

/* ---- arrivals ------------------------------------------------------------------------------- */

/* Grains first .. last - 1 of a share. */
CLONES static void count(const struct dsmc *dsmc, struct dsmc_share *share, uint32_t first,
                         uint32_t last)
{
    const struct dsmc_finder finder = dsmc_flight_finder(dsmc);
    const vector4 *restrict grains = (const vector4 *)(const void *)dsmc->grains;
    struct dsmc_share mine = *share;
    for (uint32_t i = first; i < last; i++) {
        dsmc_sort_arrive(&mine, dsmc->load, dsmc_flight_one(&finder, grains[i]));
    }
    share->gone = mine.gone;
}

/* Some grains are gone and those behind them have moved up: not many in a step, so the shares of
 * before still hold most of the grains that are in their cells. */
void dsmc_sort_recount(struct dsmc *dsmc, uint32_t t, uint32_t team)
{
    struct dsmc_share *share = &dsmc->shares[t];
    if (share->first > dsmc->count) share->first = dsmc->count;
    if (share->last > dsmc->count || t + 1 == team) share->last = dsmc->count;
    forget_arrivals(dsmc, share);
    count(dsmc, share, share->first, share->last);
}

void dsmc_sort_list(struct dsmc *dsmc, uint32_t t, uint32_t rows)
{
    struct dsmc_share *share = &dsmc->shares[t];
    const struct dsmc_finder finder = dsmc_flight_finder(dsmc);
    const vector4 *grains = (const vector4 *)(const void *)dsmc->grains;
    share->complete = true;
    const uint64_t near = (rows + 1) * (uint64_t)dsmc->ax.cells;       /* blocks end within rows */
    const bool all = 2 * near >= share->cells;
    const uint32_t low = all ? share->last : dsmc->first[share->from + near];
    const uint32_t high = all ? share->last : dsmc->first[share->from + share->cells - near];
    for (uint32_t i = share->first; i < share->last; i++) {
        if (i == low) i = high;
        if (i >= share->last) break;
        const uint32_t cell = dsmc_flight_one(&finder, grains[i]);
        if (cell - share->from < share->cells) continue;
        dsmc_sort_arrive(share, dsmc->load, cell);
    }
}

/* ---- places --------------------------------------------------------------------------------- */

/* Counts those who come from other shares. */
static void count_guests(struct dsmc *dsmc, uint32_t t, uint32_t team)
{
    const struct dsmc_share *share = &dsmc->shares[t];
    for (uint32_t q = 0; q < team; q++) {
        const struct dsmc_share *other = &dsmc->shares[q];
        for (uint32_t k = 0; q != t && k < other->gone; k++) {
            if (other->away[k] - share->from < share->cells) dsmc->load[other->away[k]]++;
        }
    }
}

static uint32_t sum_of(const struct dsmc *dsmc, const struct dsmc_share *share)
{
    uint32_t sum = 0;
    for (uint32_t c = share->from; c < share->from + share->cells; c++) sum += dsmc->load[c];
    return sum;
}

/* From now on first[c + 1] is the place of the next grain of cell c, and load[c] where c ends. */
static void find_places(struct dsmc *dsmc, const struct dsmc_share *share, uint32_t at)
{
    if (share->from == 0) dsmc->first[0] = 0;
    for (uint32_t c = share->from; c < share->from + share->cells; c++) {
        dsmc->first[c + 1] = at;
        at += dsmc->load[c];
        dsmc->load[c] = at;
    }
}

/* Guests from earlier shares come first in their cells, those from later ones last. */
static void place_guests(struct dsmc *dsmc, uint32_t t, uint32_t team)
{
    const struct dsmc_share *share = &dsmc->shares[t];
    for (uint32_t q = 0; q < t; q++) {
        const struct dsmc_share *other = &dsmc->shares[q];
        for (uint32_t k = 0; k < other->gone; k++) {
            const uint32_t cell = other->away[k];
            if (cell - share->from < share->cells) other->places[k] = dsmc->first[cell + 1]++;
        }
    }
    for (uint32_t q = team - 1; q > t; q--) {
        const struct dsmc_share *other = &dsmc->shares[q];
        for (uint32_t k = other->gone; k-- > 0;) {
            const uint32_t cell = other->away[k];
            if (cell - share->from < share->cells) other->places[k] = --dsmc->load[cell];
        }
    }
}

/* first[c + 1] has gone through the places of this share's grains: the last guests follow. */
static void end_cells(struct dsmc *dsmc, uint32_t t, uint32_t team)
{
    const struct dsmc_share *share = &dsmc->shares[t];
    for (uint32_t q = t + 1; q < team; q++) {
        const struct dsmc_share *other = &dsmc->shares[q];
        for (uint32_t k = 0; k < other->gone; k++) {
            const uint32_t cell = other->away[k];
            if (cell - share->from < share->cells) dsmc->first[cell + 1]++;
        }
    }
}

/* ---- copies --------------------------------------------------------------------------------- */

/* What travels through the records of grains that have been copied, from the first one of the
 * thread on: two names a record, or one with what else a grain carries. */
struct __attribute__((may_alias)) carry { uint32_t place, tag; };
struct __attribute__((may_alias)) luggage {
    struct carry carry;
    float spin;
    struct dsmc_contacts contacts;
};
_Static_assert(sizeof(struct luggage) == sizeof(struct dsmc_grain), "luggage fits a record");

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

/* `alone`: there is one share, so that nobody leaves it. */
FORCE_INLINE void scatter_grains(const struct dsmc *dsmc, const struct dsmc_share *share,
                                 bool wraps, bool alone)
{
    const struct dsmc_finder finder = dsmc_flight_finder(dsmc);
    const vector4 *from = (const vector4 *)(const void *)dsmc->grains;
    const uint32_t first = share->first, last = share->last, begin = share->from;
    const uint32_t cells = share->cells, *away = share->places;
    uint32_t *restrict next = dsmc->first + 1;
    uint32_t place[SCATTER];
    for (uint32_t i = first; i < last; i += SCATTER) {
        const uint32_t n = last - i < SCATTER ? last - i : SCATTER;
        uint32_t m = 0;
        for (; m + 1 < n; m += 2) {
            dsmc_flight_two(&finder, (const vector8 *)(const void *)&from[i + m], wraps, &place[m]);
        }
        if (m < n) place[m] = dsmc_flight_one(&finder, from[i + m]);
        for (uint32_t k = 0; k < n; k++) {
            const uint32_t cell = place[k];
            place[k] = alone || cell - begin < cells ? next[cell]++ : *away++;
            __builtin_prefetch(&dsmc->sorted[place[k]], 1);
        }
        copy_grains(dsmc, first, i - first, n, place);
    }
}

/* X(name, wraps, alone) */
#define SCATTERS(X) X(any, false, false) X(wrapped, true, false) X(alone, true, true)

#define X(name, wraps, alone)                                                                   \
    CLONES static void scatter_##name(const struct dsmc *dsmc, const struct dsmc_share *share)  \
    {                                                                                           \
        scatter_grains(dsmc, share, wraps, alone);                                              \
    }
SCATTERS(X)
#undef X

static void scatter(const struct dsmc *dsmc, const struct dsmc_share *share)
{
    if (!dsmc_flight_wraps(dsmc)) scatter_any(dsmc, share);
    else if (share->cells == dsmc->cells) scatter_alone(dsmc, share);
    else scatter_wrapped(dsmc, share);
}

static void deliver(struct dsmc *dsmc, const struct dsmc_share *share)
{
    const struct dsmc_grain *grains = &dsmc->grains[share->first];
    const struct carry *carries = (const struct carry *)(const void *)grains;
    const struct luggage *luggage = (const struct luggage *)(const void *)grains;
    uint32_t *restrict tags = dsmc->tags;
    const uint32_t n = share->last - share->first;
    const bool loaded = dsmc->spins || dsmc->contacts;
    for (uint32_t k = 0; !loaded && k < n; k++) tags[carries[k].place] = carries[k].tag;
    for (uint32_t k = 0; loaded && k < n; k++) {
        const struct luggage *l = &luggage[k];
        tags[l->carry.place] = l->carry.tag;
        if (dsmc->spins) dsmc->spins[l->carry.place] = l->spin;
        if (dsmc->contacts) dsmc->contacts[l->carry.place] = l->contacts;
    }
}

/* ---- the whole ------------------------------------------------------------------------------ */

void dsmc_sort_all(struct dsmc *dsmc)
{
    struct dsmc_share whole = {.cells = dsmc->cells, .last = dsmc->count};
    forget_arrivals(dsmc, &whole);
    count(dsmc, &whole, 0, dsmc->count);
    find_places(dsmc, &whole, 0);
    scatter(dsmc, &whole);
    deliver(dsmc, &whole);
}

/* More grains have left a share than its list holds. */
static bool is_list_full(const struct dsmc *dsmc, uint32_t team)
{
    bool full = false;
    for (uint32_t q = 0; q < team; q++) full |= dsmc->shares[q].gone > dsmc->shares[q].gone_max;
    return full;
}

void dsmc_sort_share(struct dsmc *dsmc, uint32_t t, uint32_t team)
{
    struct dsmc_share *share = &dsmc->shares[t];
    if (is_list_full(dsmc, team)) {
        if (t == 0) dsmc_sort_all(dsmc);
        return;
    }
    if (!share->complete) count_guests(dsmc, t, team);
    share->sum = team > 1 ? sum_of(dsmc, share) : 0;            /* one alone begins at 0 */
#pragma omp barrier
    uint32_t before = 0;
    for (uint32_t q = 0; q < t; q++) before += dsmc->shares[q].sum;
    find_places(dsmc, share, before);
    place_guests(dsmc, t, team);
#pragma omp barrier
    scatter(dsmc, share);
#pragma omp barrier
    end_cells(dsmc, t, team);
    deliver(dsmc, share);
}

void dsmc_sort_end(struct dsmc *dsmc)
{
    struct dsmc_grain *old = dsmc->grains;
    dsmc->grains = dsmc->sorted;
    dsmc->sorted = old;
    find_load(dsmc);
    dsmc->ax = dsmc->next_ax;
    dsmc->ay = dsmc->next_ay;
}
