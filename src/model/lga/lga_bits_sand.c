/* lga_bits_sand.c - the sandpile in planes of bits, until its rows are streamed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * First all rows collide in their places.  Then the surplus grains walk, one after the other.  Then
 * rest grains start down, row by row into the ring, while the rows below still stand as they were.
 * Bending the way of movers needs one of up to six chosen at random, node by node.
 */
#include "model/lga/lga_bits.h"

bool lga_bits_sand_allocate(struct lga *lga)
{
    return arena_array(&lga->arena, &lga->bits->surplus,
                       (size_t)2 * lga->lattice.rows * lga->bits->words);
}

static void spread(struct lga *lga, uint32_t row)
{
    const uint32_t words = lga->bits->words;
    const uint64_t *low = lga->bits->surplus + (size_t)2 * row * words, *high = low + words;
    for (uint32_t w = 0; w < words; w++) {
        for (uint64_t any = low[w] | high[w]; any; any &= any - 1) {
            const uint32_t b = (uint32_t)__builtin_ctzll(any);
            const uint32_t surplus = (uint32_t)(2 * (high[w] >> b & 1) + (low[w] >> b & 1));
            lga_walk(lga, row * lga->lattice.columns + b * words + w, surplus, false);
        }
    }
}

uint64_t lga_bits_sand_stop(struct lga *lga, const struct lga_kernel *kernel)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t rows = lga->lattice.rows;
    const bool lossy = lga->dice.of[LGA_DIE_LOSS].threshold > 0;
    uint64_t collisions = 0;
    #pragma omp parallel for reduction(+ : collisions) if (lga->sites >= LGA_LOOP_MIN)
    for (uint32_t y = 0; y < rows; y++) {
        uint64_t *low = bits->surplus + (size_t)2 * y * bits->words;
        const struct lga_row_stop row = {
            .words = bits->words, .dice = &lga->dice, .planes = lga_bits_row(lga, y), .low = low,
            .high = low + bits->words,
            .held = lga->trapped, .wall = lga_bits_wall(lga, y),
            .key = lga_dice_key((struct lga_dice_source){lga->seed, lga->ticks, y, 0})
        };
        collisions += kernel->stop(&row);
    }
    for (uint32_t y = 0; y < rows && lossy; y++) spread(lga, y);
    return collisions;
}

/* Which nodes of a row stop a grain that wants to start towards them; walls are another matter. */
static void find_taken(const uint64_t *planes, const uint64_t *wall, uint32_t words, bool strict,
                       uint64_t *taken)
{
    const uint32_t first = strict ? 0 : LGA_DIRECTIONS;
    for (uint32_t w = 0; w < words; w++) {
        uint64_t any = 0;
        for (uint32_t p = first; p < LGA_PLANES; p++) any |= planes[p * words + w];
        taken[w] = any & ~wall[w];
    }
}

static bool has(const uint64_t *row, uint32_t w, uint32_t b) { return row[w] >> b & 1; }

static void bend(const struct lga *lga, uint32_t y, const struct lga_row_fall *row,
                 const uint64_t *resting_left, const uint64_t *resting_right)
{
    const uint32_t words = row->words;
    for (uint32_t w = 0; w < words; w++) {
        for (uint64_t left = row->bend[w]; left; left &= left - 1) {
            const uint32_t b = (uint32_t)__builtin_ctzll(left);
            unsigned moving = 0;
            for (uint32_t d = 0; d < LGA_DIRECTIONS; d++) {
                moving |= (unsigned)has(row->out + d * row->stride, w, b) << d;
            }
            int from;
            const uint32_t site = y * lga->lattice.columns + b * words + w;
            const int to = lga_sand_bend(lga, site, moving, has(row->bend_side, w, b), &from);
            if (moving >> to & 1 || has(to == 4 ? resting_left : resting_right, w, b)) continue;
            row->out[(uint32_t)from * row->stride + w] &= ~(1ull << b);
            row->out[(uint32_t)to * row->stride + w] |= 1ull << b;
        }
    }
}

void lga_bits_sand_fall(const struct lga *lga, const struct lga_kernel *kernel, uint32_t y,
                        uint64_t *out, uint64_t *scratch)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t below = y == 0 ? lga->lattice.rows - 1 : y - 1;
    const int left = y & 1 ? 0 : -1, right = left + 1;
    const uint64_t *wall = lga_bits_wall(lga, below), *planes = lga_bits_row(lga, below);
    uint64_t *taken = scratch, *resting = scratch + bits->stride;
    find_taken(planes, wall, bits->words, lga->rule.strict, taken);
    lga_bits_join(lga, taken);
    const struct lga_row_fall row = {
        .words = bits->words, .stride = bits->stride, .held = lga->trapped,
        .wall = lga_bits_wall(lga, y),
        .dice = &lga->dice, .in = lga_bits_row(lga, y), .out = out,
        .key = lga_dice_key((struct lga_dice_source){lga->seed, lga->ticks, y, 1}),
        .bend = scratch + 2 * bits->stride, .bend_side = scratch + 3 * bits->stride,
        .wall_left = wall + left, .wall_right = wall + right,
        .taken_left = taken + left, .taken_right = taken + right
    };
    kernel->fall(&row);
    if (!lga->rule.fly || !lga->dice.of[LGA_DIE_BEND].threshold) return;
    find_taken(planes, wall, bits->words, false, resting);
    lga_bits_join(lga, resting);
    bend(lga, y, &row, resting + left, resting + right);
}
