/* lga_sand.c - fhp2 and sandpile in the plain form: node by node, by the table of collisions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Collisions of the sandpile may leave more than one rest grain on a node; then all but one walk at
 * random until each finds a node without.  The walks go one after the other in the order of the
 * nodes where they start, so that the result depends on nothing else.  Gravity reads the lattice as
 * it is after that.
 */
#include "model/lga/lga.h"

#include <assert.h>

static unsigned bit(int direction) { return 1u << direction; }

/* Replaces (moving, rest) of a node by the outcome of its collision. */
static bool collide(struct lga *lga, uint32_t site)
{
    const unsigned moving = lga->moving[site], rest = lga->rest[site];
    assert(rest <= 1);
    const bool loss = lga_plain_die(lga, LGA_DIE_LOSS, site);
    const struct lga_case *entry = &lga->table->sand[loss][moving][rest];
    if (entry->count == 0) return false;
    const bool second = entry->count > 1 && !lga_plain_die(lga, LGA_DIE_SIDE, site);
    const struct lga_outcome *outcome = &entry->outcome[second];
    if (outcome->rest < rest && !lga_plain_die(lga, LGA_DIE_KICK, site)) return false;
    lga->moving[site] = outcome->moving;
    lga->rest[site] = outcome->rest;
    return true;
}

static void spread(struct lga *lga, uint32_t site, bool heap)
{
    if (lga->rest[site] <= 1) return;
    const uint32_t surplus = lga->rest[site] - 1u;
    lga->rest[site] = 1;
    lga_walk(lga, site, surplus, heap);
}

/* In the order of the fast form: word by word, bit by bit. */
static void spread_row(struct lga *lga, uint32_t row, bool heap)
{
    const uint32_t columns = lga->lattice.columns;
    for (uint32_t w = 0; w < lga->words; w++) {
        for (uint32_t x = w; x < columns; x += lga->words) {
            const uint32_t n = row * columns + x;
            if (lga->kind[n] == LGA_FLUID) spread(lga, n, heap);
        }
    }
}

static int downward(const struct lga *lga, enum lga_die_kind kind, uint32_t site)
{
    return lga_plain_die(lga, kind, site) ? 4 : 5;
}

/* FHP-II: movers that rise turn down and keep their momentum along x; a rest grain starts down. */
static void fall_gas(struct lga *lga, uint32_t site)
{
    unsigned moving = lga->moving[site];
    if (!lga_plain_die(lga, LGA_DIE_FALL, site)) return;
    if ((moving & bit(1)) && !(moving & bit(5))) moving ^= bit(1) | bit(5);
    if ((moving & bit(2)) && !(moving & bit(4))) moving ^= bit(2) | bit(4);
    const int d = downward(lga, LGA_DIE_FALL_SIDE, site);
    if (lga->rest[site] && !(moving & bit(d)) && lga->kind[lga->beside[site][d]] != LGA_WALL) {
        lga->rest[site]--;
        moving |= bit(d);
    }
    lga->moving[site] = (uint8_t)moving;
}

enum { LOAD_RESTS = 1, LOAD_MOVES = 2 };        /* what `load` tells of a node here */

/* Sandpile: a rest grain starts down if the node there has none. */
static void fall_sand(struct lga *lga, uint32_t site)
{
    if (!lga->rest[site] || !lga_plain_die(lga, LGA_DIE_FALL, site)) return;
    const int d = downward(lga, LGA_DIE_FALL_SIDE, site);
    const uint32_t to = lga->beside[site][d];
    const unsigned forbidden = lga->rule.strict ? LOAD_RESTS | LOAD_MOVES : LOAD_RESTS;
    if (lga->kind[to] == LGA_WALL || lga->moving[site] & bit(d)) return;
    if (lga->kind[to] == LGA_FLUID && lga->load[to] & forbidden) return;
    lga->rest[site]--;
    lga->moving[site] |= (uint8_t)bit(d);
}

/* Sandpile: one of the movers bends down, any of those that have a free slot there and neither a
 * rest grain nor a wall in the way.  (Bent into the plate at once, a grain that bounced off it
 * would never leave its node, and a heap would have no tail.) */
static void bend_sand(struct lga *lga, uint32_t site)
{
    const unsigned moving = lga->moving[site];
    if (moving == 0 || !lga_plain_die(lga, LGA_DIE_BEND, site)) return;
    static const int down[LGA_DIRECTIONS] = {5, 5, 4, 4, -1, -1};
    const int again = downward(lga, LGA_DIE_BEND_SIDE, site);
    unsigned able = 0;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        const int to = down[d] < 0 ? again : down[d];
        const uint32_t below = lga->beside[site][to];
        if (moving & bit(to) || lga->kind[below] == LGA_WALL) continue;
        if (lga->kind[below] == LGA_FLUID && lga->load[below] & LOAD_RESTS) continue;
        able |= moving & bit(d);
    }
    if (able == 0) return;
    const int from = lga_plain_mover(lga, site, able);
    const int to = down[from] < 0 ? again : down[from];
    lga->moving[site] = (uint8_t)((moving & ~bit(from)) | bit(to));
}

/* Everything that points here comes. */
static unsigned arriving(const struct lga *lga, uint32_t site)
{
    unsigned sum = 0;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        const uint32_t from = lga->beside[site][(d + 3) % LGA_DIRECTIONS];
        if (lga->kind[from] == LGA_FLUID) sum |= lga->moving[from] & bit(d);
    }
    return sum;
}

void lga_sand_collide(struct lga *lga)
{
    const uint32_t sites = lga->sites;
    const bool sandpile = lga->rule.method == LGA_SANDPILE;
    uint64_t collisions = 0;
    lga_plain_roll(lga);
    #pragma omp parallel for reduction(+ : collisions) if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        lga->admitted[n] = lga->kind[n] == LGA_FLUID && lga->moving[n] && collide(lga, n);
        collisions += lga->admitted[n];
    }
    lga_plain_note(lga);
    for (uint32_t row = 0; row < lga->lattice.rows && sandpile; row++) {
        spread_row(lga, row, false);
    }
    #pragma omp parallel for if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        lga->load[n] = (uint8_t)((lga->rest[n] ? LOAD_RESTS : 0)
                                 | (lga->moving[n] ? LOAD_MOVES : 0));
    }
    #pragma omp parallel for if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        if (!lga->rule.gravity || lga->kind[n] != LGA_FLUID || !lga->load[n]) continue;
        if (!sandpile) fall_gas(lga, n);
        else fall_sand(lga, n);
        if (sandpile && lga->rule.fly) bend_sand(lga, n);
    }
    #pragma omp parallel for if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        lga->admitted[n] = lga->kind[n] == LGA_FLUID ? (uint8_t)arriving(lga, n) : 0;
    }
    lga->collisions += collisions;
}

/* A mover that comes to the heap stops; what is more than one grain walks, and is part of the heap
 * where it comes to rest.  So is, from below, a rest grain that lies on two grains of the heap or
 * on the floor.  A node of the heap whose grain has gone is one no more. */
void lga_sand_settle(struct lga *lga)
{
    for (uint32_t n = 0; n < lga->sites; n++) {
        lga->heap[n] &= lga->kind[n] == LGA_FLUID && lga->rest[n] > 0;
        if (!lga->heap[n]) continue;
        lga->rest[n] = (uint8_t)(lga->rest[n] + __builtin_popcount(lga->moving[n]));
        lga->moving[n] = 0;
    }
    for (uint32_t row = 0; row < lga->lattice.rows; row++) spread_row(lga, row, true);
    for (uint32_t n = 0; n < lga->sites; n++) {
        if (lga->kind[n] != LGA_FLUID || !lga->rest[n]) continue;
        const uint32_t left = lga->beside[n][4], right = lga->beside[n][5];
        lga->heap[n] |= (lga->kind[left] == LGA_WALL || lga->heap[left])
                     && (lga->kind[right] == LGA_WALL || lga->heap[right]);
    }
}

bool lga_sand_allocate(struct lga *lga)
{
    return arena_array(&lga->arena, &lga->heap, lga->rule.heap ? lga->sites : 0);
}
