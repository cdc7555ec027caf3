/* lga_gmlg.c - the gas with gravity and many rest grains in the plain form: collide, fall, let in.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Every pass reads what the pass before wrote and writes only its own node, so the result depends
 * neither on the order of the loops nor on the number of threads.
 *
 * How many grains a node holds changes in streaming only.  So `load`, counted at the start of the
 * tick, tells in every later pass whether a node is full.
 */
#include "model/lga/lga.h"

#include <assert.h>

static bool die(const struct lga *lga, uint32_t site, enum lga_die_kind kind)
{
    return lga_plain_die(lga, kind, site);
}

static unsigned bit(int direction) { return 1u << direction; }
static int reverse(int direction) { return (direction + 3) % LGA_DIRECTIONS; }

static bool is_full(const struct lga *lga, uint32_t site)
{
    return lga->kind[site] == LGA_WALL
        || (lga->kind[site] == LGA_FLUID && lga->load[site] >= LGA_ROOM);
}

/* Which outcome of its collision a node takes: of three or six the way in which pairs stop comes
 * first, then the way in which what they leave merges. */
static int outcome_of(const struct lga *lga, uint32_t site, int count)
{
    const int second = !die(lga, site, LGA_DIE_SIDE);
    if (count <= 2) return count == 2 ? second : 0;
    assert(count % 3 == 0);
    const int way = lga_plain_third(die(lga, site, LGA_DIE_WAY_THIRD),
                                 die(lga, site, LGA_DIE_WAY_SIDE));
    return count == 3 ? way : 2 * way + second;
}

/* Replaces (moving, rest) of a node by one of the outcomes of its collision. */
static bool collide(struct lga *lga, uint32_t site)
{
    const unsigned moving = lga->moving[site], rest = lga->rest[site];
    if (moving == 0) return false;
    const enum lga_column column = die(lga, site, LGA_DIE_LOSS) ? LGA_INELASTIC : LGA_ELASTIC;
    const struct lga_case *entry = &lga->table->cases[column][moving][rest];
    if (entry->count == 0) return false;
    const struct lga_outcome *outcome = &entry->outcome[outcome_of(lga, site, entry->count)];
    if (outcome->rest < rest && !die(lga, site, LGA_DIE_KICK)) return false;
    lga->moving[site] = outcome->moving;
    lga->rest[site] = outcome->rest;
    return true;
}

/* Gravity on a grain at rest.  H: it goes down to one of two sides; if the other side is full it
 * rolls, which friction may prevent unless the node has just been hit.  V: it goes straight down,
 * and rolls to one of two sides if that is full. */
static void fall(struct lga *lga, uint32_t site)
{
    if (lga->rest[site] == 0 || !die(lga, site, LGA_DIE_FALL)) return;
    const uint32_t *beside = lga->beside[site];
    const bool left = die(lga, site, LGA_DIE_FALL_SIDE);
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
    const bool kept = die(lga, site, left ? LGA_DIE_FRICTION_LEFT : LGA_DIE_FRICTION_RIGHT);
    if (rolls && kept && !lga->hit[site]) return;
    lga->rest[site]--;
    lga->moving[site] |= (uint8_t)bit(direction);
}

/* Gravity on a mover of the node, any of those that it can bend down: into a free slot, and not
 * towards a full node.  H: 4 and 5 are drawn anew, 1 -> 5 and 2 -> 4 keep the momentum along x. */
static void bend(struct lga *lga, uint32_t site)
{
    static const int down_vertical[LGA_DIRECTIONS] = {3, 2, 3, 3, 3, 4};
    static const int down_level[LGA_DIRECTIONS] = {5, 5, 4, 4, -1, -1};
    const unsigned moving = lga->moving[site];
    int to[LGA_DIRECTIONS];
    unsigned able = 0;
    if (moving == 0 || !die(lga, site, LGA_DIE_BEND)) return;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        to[d] = lga->rule.vertical ? down_vertical[d] : down_level[d];
        if (to[d] < 0) to[d] = die(lga, site, LGA_DIE_BEND_SIDE) ? 4 : 5;
        const bool free = !(moving & bit(to[d])) && !is_full(lga, lga->beside[site][to[d]]);
        if (free) able |= moving & bit(d);
    }
    if (able == 0) return;
    const int from = lga_plain_mover(lga, site, able);
    lga->moving[site] = (uint8_t)((moving & ~bit(from)) | bit(to[from]));
}

/* As many of the waiting as there is room for, any of them: either those who may come are picked,
 * or those who may not, whichever are fewer.  They are three at most; the third is one of four, and
 * the second shares no die with the first that the first has used. */
static unsigned let_in(const struct lga *lga, uint32_t site, unsigned waiting, int room)
{
    const int excess = __builtin_popcount(waiting) - room;
    if (excess <= 0) return waiting;
    const bool refuse = room > excess;
    const int picks = refuse ? excess : room;
    unsigned left = waiting;
    for (int k = 0; k < picks; k++) {
        const struct lga_pick dice = {die(lga, site, LGA_DIE_ADMIT_THIRD),
            die(lga, site, LGA_DIE_ADMIT_FIFTH), die(lga, site, LGA_DIE_ADMIT_COIN + 2 * k),
            die(lga, site, LGA_DIE_ADMIT_COIN + 2 * k + 1)};
        left &= ~bit(lga_plain_pick(left, dice));
    }
    return refuse ? left : waiting & ~left;
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
    const int room = lga->load[site] < LGA_ROOM ? LGA_ROOM - lga->load[site] : 0;
    return swapping | let_in(lga, site, arriving & ~swapping, room);
}

void lga_gmlg_collide(struct lga *lga)
{
    const uint32_t sites = lga->sites;
    uint64_t collisions = 0;
    lga_plain_roll(lga);
    #pragma omp parallel for if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        lga->load[n] = (uint8_t)(lga->rest[n] + __builtin_popcount(lga->moving[n]));
    }
    #pragma omp parallel for reduction(+ : collisions) if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        lga->admitted[n] = 0;
        if (lga->kind[n] != LGA_FLUID || lga->load[n] == 0) continue;
        lga->hit[n] = lga->moving[n] != 0;
        lga->admitted[n] = collide(lga, n);
        collisions += lga->admitted[n];
        if (!lga->rule.gravity) continue;
        fall(lga, n);
        bend(lga, n);
    }
    lga_plain_note(lga);
    #pragma omp parallel for if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        lga->admitted[n] = lga->kind[n] == LGA_FLUID ? (uint8_t)admit(lga, n) : 0;
    }
    lga->collisions += collisions;
}
