/* lga_table.c - every collision of the lattice gas, enumerated once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The state of a node is (moving, rest): 64 x 8 = 512 of them.  For each and for both columns the
 * table lists what can come out and how likely that is.  Mass and momentum are those of the input
 * in every line; the elastic column changes the energy (the number of movers) by +1 in
 * {i} + rest -> {i-1, i+1} and by -1 in its inverse, which cancel on average; the inelastic column
 * never raises it.  The elastic column without the loss is balanced: its transition probabilities
 * into every state add up to 1, so that all states of one mass and momentum are equally likely.
 */
#include "model/lga/lga.h"

#include <assert.h>

static unsigned bit(int direction) { return 1u << (direction % LGA_DIRECTIONS); }

static unsigned pair(int i) { return bit(i) | bit(i + 3); }

static bool is_triple(unsigned moving) { return moving == 0x15 || moving == 0x2a; }

static void add(struct lga_case *entry, unsigned moving, int rest, int weight)
{
    assert(entry->count < LGA_OUTCOMES);
    entry->outcome[entry->count++] = (struct lga_outcome){(uint8_t)moving, (uint8_t)rest,
                                                          (uint8_t)weight};
}

static void fill_elastic(struct lga_case *entry, unsigned moving, int rest)
{
    if (is_triple(moving)) add(entry, moving ^ 0x3f, rest, LGA_WEIGHT);
    for (int i = 0; i < LGA_DIRECTIONS; i++) {
        if (i < 3 && moving == pair(i)) {
            add(entry, pair(i + 1), rest, LGA_WEIGHT / 2);
            add(entry, pair(i + 2), rest, LGA_WEIGHT / 2);
        }
        const unsigned split = bit(i + 5) | bit(i + 1);
        if (moving == bit(i) && rest >= 1) add(entry, split, rest - 1, LGA_WEIGHT);
        if (moving == split && rest < LGA_ROOM) add(entry, bit(i), rest + 1, LGA_WEIGHT);
    }
}

/* What the head-on pairs leave behind: a triple stops; else one {i-1, i+1} merges into {i}, any of
 * them with equal chance. */
static void fill_remainder(struct lga_case *entry, unsigned moving, int rest, int weight)
{
    if (is_triple(moving) && rest + 3 <= LGA_ROOM) {
        add(entry, 0, rest + 3, weight);
        return;
    }
    int merging[LGA_DIRECTIONS], count = 0;
    for (int i = 0; i < LGA_DIRECTIONS; i++) {
        const unsigned split = bit(i + 5) | bit(i + 1);
        if ((moving & split) == split && !(moving & pair(i))) merging[count++] = i;
    }
    if (count == 0 || rest == LGA_ROOM) {
        add(entry, moving, rest, weight);
        return;
    }
    assert(weight % count == 0);
    for (int c = 0; c < count; c++) {
        const unsigned split = bit(merging[c] + 5) | bit(merging[c] + 1);
        add(entry, (moving & ~split) | bit(merging[c]), rest + 1, weight / count);
    }
}

/* Head-on pairs stop, two grains each, as many as there is room for; which ones is open if not all
 * of them can. */
static void fill_inelastic(struct lga_case *entry, unsigned moving, int rest)
{
    int present = 0, stopping = (LGA_ROOM - rest) / 2, ways = 0;
    for (int i = 0; i < 3; i++) present += (moving & pair(i)) == pair(i);
    if (stopping > present) stopping = present;
    for (int turn = 0; turn < 2; turn++) {      /* first count the ways, then add them */
        const int count = ways;
        for (unsigned chosen = 0; chosen < 8; chosen++) {
            if (__builtin_popcount(chosen) != stopping) continue;
            unsigned stopped = 0;
            for (int i = 0; i < 3; i++) if (chosen >> i & 1) stopped |= pair(i);
            if ((moving & stopped) != stopped) continue;
            if (turn == 0) ways++;
            else fill_remainder(entry, moving & ~stopped, rest + 2 * stopping, LGA_WEIGHT / count);
        }
    }
    if (entry->count == 1 && entry->outcome[0].moving == moving) entry->count = 0;
}

/* At most one rest grain goes into a collision.  The lossy column stops pairs and triples, with
 * more rest grains than a node may keep.  A pair's first way turns it by +60 degrees. */
static void fill_sand(struct lga_case *entry, bool lossy, unsigned moving, int rest)
{
    int present = 0;
    for (int i = 0; i < 3; i++) present += moving == pair(i);
    if (lossy && (present || is_triple(moving))) {
        add(entry, 0, rest + __builtin_popcount(moving), LGA_WEIGHT);
        return;
    }
    const unsigned split_by = bit(0) | bit(2);
    fill_elastic(entry, moving, rest);
    /* A merger would put a second grain to rest. */
    for (int i = 0; i < LGA_DIRECTIONS && rest == 1; i++) {
        if (moving == ((split_by << i | split_by >> (6 - i)) & 0x3f)) entry->count = 0;
    }
}

void lga_table_fill(struct lga_table *table)
{
    *table = (struct lga_table){0};
    for (unsigned moving = 0; moving < LGA_STATES; moving++) {
        for (int rest = 0; rest <= LGA_ROOM; rest++) {
            fill_elastic(&table->cases[LGA_ELASTIC][moving][rest], moving, rest);
            fill_inelastic(&table->cases[LGA_INELASTIC][moving][rest], moving, rest);
        }
        for (int rest = 0; rest <= 1; rest++) {
            fill_sand(&table->sand[LGA_ELASTIC][moving][rest], false, moving, rest);
            fill_sand(&table->sand[LGA_INELASTIC][moving][rest], true, moving, rest);
        }
    }
}

void lga_table_momentum(unsigned moving, int *twice_x, int *y)
{
    static const int px2[LGA_DIRECTIONS] = {2, 1, -1, -2, -1, 1};
    static const int py[LGA_DIRECTIONS] = {0, 1, 1, 0, -1, -1};
    *twice_x = *y = 0;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        if (!(moving >> d & 1)) continue;
        *twice_x += px2[d];
        *y += py[d];
    }
}
