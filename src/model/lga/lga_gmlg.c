/* lga_gmlg.c - the gas with gravity and many rest grains: collide, fall, let in.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Every pass reads what the pass before wrote and writes only its own node, and every random
 * number has a name (seed, tick, site, draw), so the result depends neither on the order of the
 * loops nor on the number of threads.
 *
 * How many grains a node holds changes in streaming only.  So `load`, counted at the start of the
 * tick, tells in every later pass whether a node is full.
 */
#include "model/lga/lga.h"

#include "base/rng.h"

#include <math.h>

/* The random numbers of a node in a tick; those of one direction follow each other. */
enum draw {
    DRAW_COLUMN, DRAW_OUTCOME, DRAW_GAIN, DRAW_FALL, DRAW_SIDE, DRAW_FRICTION, DRAW_TURN,
    DRAW_MOVER, DRAW_TURN_SIDE, DRAW_ADMIT
};

static double draw(const struct lga *lga, uint32_t site, int which)
{
    return rng_unit(rng_keyed(lga->seed, lga->ticks, site, (uint64_t)which));
}

static bool chance(const struct lga *lga, uint32_t site, int which, double probability)
{
    if (probability <= 0) return false;
    return probability >= 1 || draw(lga, site, which) < probability;
}

static unsigned bit(int direction) { return 1u << direction; }
static int reverse(int direction) { return (direction + 3) % LGA_DIRECTIONS; }

static bool is_full(const struct lga *lga, uint32_t site)
{
    return lga->kind[site] == LGA_WALL
        || (lga->kind[site] == LGA_FLUID && lga->load[site] >= LGA_ROOM);
}

/* Replaces (moving, rest) of a node by one of the outcomes of its collision. */
static bool collide(struct lga *lga, uint32_t site)
{
    const unsigned moving = lga->moving[site], rest = lga->rest[site];
    if (moving == 0) return false;
    const enum lga_column column = chance(lga, site, DRAW_COLUMN, lga->rule.inelastic);
    const struct lga_case *entry = &lga->table->cases[column][moving][rest];
    if (entry->count == 0) return false;
    const struct lga_outcome *outcome = entry->outcome;
    if (entry->count > 1) {
        int left = (int)(LGA_WEIGHT * draw(lga, site, DRAW_OUTCOME));
        while (left >= outcome->weight) left -= outcome++->weight;
    }
    if (outcome->rest < rest && !chance(lga, site, DRAW_GAIN, lga->rule.gain)) return false;
    lga->moving[site] = outcome->moving;
    lga->rest[site] = outcome->rest;
    return true;
}

/* Gravity on a grain at rest.  H: it goes down to one of two sides; if the other side is full it
 * rolls, which friction may prevent unless the node has just been hit.  V: it goes straight down,
 * and rolls to one of two sides if that is full. */
static void fall(struct lga *lga, uint32_t site)
{
    if (lga->rest[site] == 0 || !chance(lga, site, DRAW_FALL, lga->rule.fall)) return;
    const uint32_t *beside = lga->beside[site];
    const bool left = draw(lga, site, DRAW_SIDE) < 0.5;
    int direction;
    bool rolls;
    if (lga->rule.vertical) {
        rolls = is_full(lga, beside[3]);
        direction = !rolls ? 3 : left ? 2 : 4;
    } else {
        direction = left ? 4 : 5;
        rolls = is_full(lga, beside[left ? 5 : 4]);
    }
    if (is_full(lga, beside[direction]) || lga->moving[site] & bit(direction)) return;
    if (rolls && !lga->hit[site] && chance(lga, site, DRAW_FRICTION, lga->rule.friction)) return;
    lga->rest[site]--;
    lga->moving[site] |= (uint8_t)bit(direction);
}

/* Gravity on one mover of the node, any of them: its path bends down.  H: 4 and 5 are drawn anew,
 * 1 -> 5 and 2 -> 4 keep the momentum along x. */
static void bend(struct lga *lga, uint32_t site)
{
    static const int down_vertical[LGA_DIRECTIONS] = {3, 2, 3, 3, 3, 4};
    static const int down_horizontal[LGA_DIRECTIONS] = {5, 5, 4, 4, -1, -1};
    const unsigned moving = lga->moving[site];
    if (moving == 0 || !chance(lga, site, DRAW_TURN, lga->rule.fall)) return;
    int left = (int)(draw(lga, site, DRAW_MOVER) * __builtin_popcount(moving)), from = 0;
    while (!(moving & bit(from)) || left-- > 0) from++;
    int to = lga->rule.vertical ? down_vertical[from] : down_horizontal[from];
    if (to < 0) to = draw(lga, site, DRAW_TURN_SIDE) < 0.5 ? 4 : 5;
    if (moving & bit(to) || is_full(lga, lga->beside[site][to])) return;
    lga->moving[site] = (uint8_t)((moving & ~bit(from)) | bit(to));
}

/* Which of the movers that point here may come.  Two that meet head-on on a link always swap; of
 * the others a random subset, as many as there is room for: sand must dilate to flow. */
static unsigned admit(const struct lga *lga, uint32_t site)
{
    unsigned arriving = 0, swapping = 0;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        const uint32_t from = lga->beside[site][reverse(d)];
        if (lga->kind[from] != LGA_FLUID || !(lga->moving[from] & bit(d))) continue;
        arriving |= bit(d);
        if (lga->moving[site] & bit(reverse(d))) swapping |= bit(d);
    }
    if (!lga->rule.gravity) return arriving;
    int waiting = __builtin_popcount(arriving & ~swapping);
    int room = LGA_ROOM - lga->load[site];
    if (waiting <= room) return arriving;
    unsigned admitted = swapping;
    for (int d = 0; d < LGA_DIRECTIONS && room > 0; d++) {
        if (!(arriving & ~swapping & bit(d))) continue;
        if (draw(lga, site, DRAW_ADMIT + d) * waiting-- < room) {
            admitted |= bit(d);
            room--;
        }
    }
    return admitted;
}

void lga_gmlg_collide(struct lga *lga)
{
    const uint32_t sites = lga->sites;
    uint64_t collisions = 0;
    #pragma omp parallel for if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        lga->load[n] = (uint8_t)(lga->rest[n] + __builtin_popcount(lga->moving[n]));
    }
    #pragma omp parallel for reduction(+ : collisions) if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        if (lga->kind[n] != LGA_FLUID || lga->load[n] == 0) continue;
        lga->hit[n] = lga->moving[n] != 0;
        collisions += collide(lga, n);
        if (!lga->rule.gravity) continue;
        fall(lga, n);
        bend(lga, n);
    }
    #pragma omp parallel for if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        lga->admitted[n] = lga->kind[n] == LGA_FLUID ? (uint8_t)admit(lga, n) : 0;
    }
    lga->collisions += collisions;
}
