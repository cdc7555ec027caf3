/* lga_dice.c - the probabilities of the lattice gases, cut to binary fractions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A bit that is set with probability P / 2^k costs k random words for 64 nodes, one for each digit
 * from the lowest that is not zero: "or" where the digit is 1, "and" where it is 0.  So a
 * probability gets as few digits as leave it right within a thousandth of itself and of its
 * complement, far less than the statistical error of any run, and certainty costs nothing.
 */
#include "model/lga/lga.h"

#include <assert.h>
#include <math.h>

enum { DIGITS_MAX = 24 };

static const double precision = 1e-3;

struct lga_die lga_dice_die(double probability)
{
    assert(probability >= 0);
    assert(probability <= 1);
    const double allowed = precision * fmin(probability, 1 - probability);
    for (int bits = 1; bits <= DIGITS_MAX; bits++) {
        const double threshold = rint(ldexp(probability, bits));
        if (threshold < 1 || threshold > ldexp(1, bits) - 1) continue;
        if (bits < DIGITS_MAX && fabs(ldexp(threshold, -bits) - probability) > allowed) continue;
        return (struct lga_die){(uint32_t)threshold, bits};
    }
    return (struct lga_die){probability > 0.5, 0};
}

/* One of up to six, all alike. */
static void set_pick(struct lga_dice *dice)
{
    dice->of[LGA_DIE_PICK_THIRD] = (struct lga_die){LGA_CUT_THIRD, LGA_CUT_BITS};
    dice->of[LGA_DIE_PICK_FIFTH] = (struct lga_die){LGA_CUT_FIFTH, LGA_CUT_BITS};
    dice->of[LGA_DIE_PICK_COIN] = dice->of[LGA_DIE_PICK_SECOND] = lga_dice_die(0.5);
}

static struct lga_dice dice_of_gmlg(const struct lga_rule *rule)
{
    struct lga_dice dice = {0};
    dice.of[LGA_DIE_SIDE] = lga_dice_die(0.5);
    dice.of[LGA_DIE_KICK] = lga_dice_die(rule->gain);
    dice.of[LGA_DIE_LOSS] = lga_dice_die(rule->inelastic);
    dice.of[LGA_DIE_WAY_THIRD] = lga_dice_die(1 / 3.0);
    dice.of[LGA_DIE_WAY_SIDE] = lga_dice_die(0.5);
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        dice.of[LGA_DIE_STOP + d] = lga_dice_die(rule->wall_stop);
    }
    if (!rule->gravity) return dice;
    dice.of[LGA_DIE_FALL] = dice.of[LGA_DIE_BEND] = lga_dice_die(rule->fall);
    dice.of[LGA_DIE_FALL_SIDE] = lga_dice_die(0.5);
    if (!rule->vertical) dice.of[LGA_DIE_BEND_SIDE] = lga_dice_die(0.5);
    dice.of[LGA_DIE_FRICTION_LEFT] = lga_dice_die(rule->friction);
    dice.of[LGA_DIE_FRICTION_RIGHT] = lga_dice_die(rule->friction);
    set_pick(&dice);
    dice.of[LGA_DIE_ADMIT_THIRD] = dice.of[LGA_DIE_PICK_THIRD];
    dice.of[LGA_DIE_ADMIT_FIFTH] = dice.of[LGA_DIE_PICK_FIFTH];
    for (int k = 0; k < 6; k++) dice.of[LGA_DIE_ADMIT_COIN + k] = lga_dice_die(0.5);
    return dice;
}

struct lga_dice lga_dice_of(const struct lga_rule *rule)
{
    struct lga_dice dice = {0};
    const bool sandpile = rule->method == LGA_SANDPILE, gravity = rule->gravity;
    if (rule->method == LGA_GMLG) return dice_of_gmlg(rule);
    dice.of[LGA_DIE_SIDE] = lga_dice_die(0.5);
    dice.of[LGA_DIE_KICK] = lga_dice_die(rule->gain * (1 - rule->loss));
    if (sandpile) dice.of[LGA_DIE_LOSS] = lga_dice_die(rule->loss);
    if (gravity) dice.of[LGA_DIE_FALL] = lga_dice_die(rule->fall);
    if (gravity) dice.of[LGA_DIE_FALL_SIDE] = lga_dice_die(0.5);
    if (gravity && sandpile && rule->fly) {
        dice.of[LGA_DIE_BEND] = lga_dice_die(rule->fall);
        dice.of[LGA_DIE_BEND_SIDE] = lga_dice_die(0.5);
        set_pick(&dice);
    }
    dice.of[LGA_DIE_MIRROR] = lga_dice_die(rule->smooth);
    if (rule->heap) dice.of[LGA_DIE_PLATE] = lga_dice_die(rule->loss);
    return dice;
}

/* Whole blocks.  Where that is more than the columns, there is room for the first one again. */
uint32_t lga_dice_words(uint32_t columns)
{
    return (columns + 64 * LGA_LANES - 1) / (64 * LGA_LANES) * LGA_LANES;
}

struct lga_dice_source lga_dice_now(const struct lga *lga, uint32_t row, enum lga_stage stage)
{
    const bool frozen = stage == LGA_STAGE_FRICTION && lga->rule.frozen;
    return (struct lga_dice_source){lga->seed, frozen ? UINT64_MAX - 2 : lga->ticks, row, stage};
}

enum lga_stage lga_dice_stage(const struct lga_rule *rule, enum lga_die_kind kind)
{
    if (kind >= LGA_DIE_STOP) return LGA_STAGE_STOP;
    if (kind >= LGA_DIE_ADMIT_THIRD) return LGA_STAGE_ADMIT;
    if (kind >= LGA_DIE_WAY_THIRD) return LGA_STAGE_WAYS;
    if (kind >= LGA_DIE_FRICTION_LEFT) return LGA_STAGE_FRICTION;
    return rule->method == LGA_SANDPILE && kind >= LGA_DIE_FALL ? LGA_STAGE_FALL
                                                                : LGA_STAGE_COLLIDE;
}

enum lga_simd lga_dice_simd(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("popcnt")) {
        return LGA_SIMD_AVX512;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt")) return LGA_SIMD_AVX2;
#endif
    return LGA_SIMD_BASE;
}
