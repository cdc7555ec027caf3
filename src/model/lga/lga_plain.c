/* lga_plain.c - the random bits of the plain form: those of the fast one, all of a tick at once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/lga/lga.h"

#include <assert.h>

bool lga_plain_die(const struct lga *lga, enum lga_die_kind kind, uint32_t site)
{
    const uint64_t *bits = lga->rolled[kind];
    if (!bits) return lga->dice.of[kind].threshold;
    const uint32_t row = site / lga->lattice.columns, x = site % lga->lattice.columns;
    return bits[(size_t)row * lga->words + x % lga->words] >> (x / lga->words) & 1;
}

void lga_plain_roll(struct lga *lga)
{
    const uint32_t rows = lga->lattice.rows;
    #pragma omp parallel for if (lga->sites >= LGA_LOOP_MIN)
    for (uint32_t row = 0; row < rows; row++) {
        for (enum lga_stage stage = 0; stage < LGA_STAGES; stage++) {
            uint64_t *out[LGA_DICE] = {NULL};
            for (uint32_t k = 0; k < LGA_DICE; k++) {
                if (!lga->rolled[k] || lga_dice_stage(&lga->rule, k) != stage) continue;
                out[k] = lga->rolled[k] + (size_t)row * lga->words;
            }
            lga_bits_roll(&lga->dice, lga->simd, lga_dice_key(lga_dice_now(lga, row, stage)),
                          lga->words, out);
        }
    }
}

void lga_plain_note(struct lga *lga)
{
    if (!lga->rate.now) return;
    for (uint32_t n = 0; n < lga->sites; n++) if (lga->admitted[n]) lga_rate_note(lga, n);
}

bool lga_plain_allocate(struct lga *lga)
{
    const size_t words = (size_t)lga->lattice.rows * lga->words;
    for (int k = 0; k < LGA_DICE; k++) {
        const bool open = lga->dice.of[k].bits > 0;
        if (!arena_array(&lga->arena, &lga->rolled[k], open ? words : 0)) return false;
    }
    return true;
}

int lga_plain_third(bool third, bool coin) { return third ? 0 : coin ? 1 : 2; }

/* The rank of one of `count` things, all with equal chance. */
static int rank_of(int count, struct lga_pick dice)
{
    const int of_four = 2 * dice.coin + dice.second;
    switch (count) {
    case 1: return 0;
    case 2: return dice.coin;
    case 3: return lga_plain_third(dice.third, dice.coin);
    case 4: return of_four;
    case 5: return dice.fifth ? 4 : of_four;
    default: assert(count == 6);
    }
    return 2 * lga_plain_third(dice.third, dice.coin) + dice.second;
}

int lga_plain_pick(unsigned set, struct lga_pick dice)
{
    int before = rank_of(__builtin_popcount(set), dice), d = 0;
    while (!(set >> d & 1) || before-- > 0) d++;
    return d;
}

int lga_plain_mover(const struct lga *lga, uint32_t site, unsigned able)
{
    return lga_plain_pick(able, (struct lga_pick){
        lga_plain_die(lga, LGA_DIE_PICK_THIRD, site), lga_plain_die(lga, LGA_DIE_PICK_FIFTH, site),
        lga_plain_die(lga, LGA_DIE_PICK_COIN, site), lga_plain_die(lga, LGA_DIE_PICK_SECOND, site)
    });
}
