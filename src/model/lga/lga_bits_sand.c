/* lga_bits_sand.c - the sandpile in planes of bits, until its rows are streamed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * First all rows collide in their places.  Then the surplus grains walk, one after the other.  Then
 * rest grains start down and movers bend, row by row into the ring, while the rows below still
 * stand as they were.
 */
#include "model/lga/lga_bits.h"

bool lga_bits_sand_allocate(struct lga *lga)
{
    struct arena *arena = &lga->arena;
    struct lga_bits *bits = lga->bits;
    const size_t rows = lga->lattice.rows;
    const bool heap = lga->rule.heap;
    bits->digits = heap ? 3 : 2;
    return arena_array(arena, &bits->surplus, rows * bits->digits * bits->words)
        && arena_array(arena, &bits->spills, rows)
        && arena_array(arena, &bits->heap, heap ? rows * bits->stride : 0)
        && (!heap || lga_bits_allocate_real(lga));
}

/* Sends the surplus of a row on its ways, of which `digits` tell. */
static void spread(struct lga *lga, uint32_t row, uint32_t digits, bool heap)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t words = bits->words;
    const uint64_t *surplus = bits->surplus + (size_t)row * bits->digits * words;
    for (uint32_t w = 0; w < words && bits->spills[row]; w++) {
        uint64_t any = 0;
        for (uint32_t k = 0; k < digits; k++) any |= surplus[k * words + w];
        for (; any; any &= any - 1) {
            const uint32_t b = (uint32_t)__builtin_ctzll(any);
            uint32_t count = 0;
            for (uint32_t k = 0; k < digits; k++) {
                count |= (uint32_t)(surplus[k * words + w] >> b & 1) << k;
            }
            lga_walk(lga, row * lga->lattice.columns + b * words + w, count, heap);
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
        uint64_t *low = bits->surplus + (size_t)y * bits->digits * bits->words;
        const struct lga_row_stop row = {
            .words = bits->words, .dice = &lga->dice, .hits = lga_rate_row(lga, y),
            .planes = lga_bits_row(lga, y), .low = low,
            .high = low + bits->words, .spills = bits->spills + y,
            .held = lga->trapped, .wall = lga_bits_wall(lga, y),
            .key = lga_dice_key((struct lga_dice_source){lga->seed, lga->ticks, y, 0})
        };
        collisions += kernel->stop(&row);
    }
    for (uint32_t y = 0; y < rows && lossy; y++) spread(lga, y, 2, false);
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

void lga_bits_sand_fall(const struct lga *lga, const struct lga_kernel *kernel, uint32_t y,
                        uint64_t *out, uint64_t *scratch)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t below = y == 0 ? lga->lattice.rows - 1 : y - 1;
    const int left = y & 1 ? 0 : -1, right = left + 1;
    const uint64_t *wall = lga_bits_wall(lga, below), *planes = lga_bits_row(lga, below);
    uint64_t *taken = scratch, *resting = lga->rule.strict ? scratch + bits->stride : taken;
    const bool flies = lga->rule.fly && lga->rule.gravity;
    find_taken(planes, wall, bits->words, lga->rule.strict, taken);
    lga_bits_join(lga, taken);
    if (flies && lga->rule.strict) {
        find_taken(planes, wall, bits->words, false, resting);
        lga_bits_join(lga, resting);
    }
    const struct lga_row_fall row = {
        .words = bits->words, .stride = bits->stride, .held = lga->trapped, .fly = flies,
        .plate = bits->heap,
        .wall = lga_bits_wall(lga, y),
        .dice = &lga->dice, .in = lga_bits_row(lga, y), .out = out,
        .key = lga_dice_key((struct lga_dice_source){lga->seed, lga->ticks, y, 1}),
        .wall_left = wall + left, .wall_right = wall + right,
        .taken_left = taken + left, .taken_right = taken + right,
        .rest_left = resting + left, .rest_right = resting + right
    };
    kernel->fall(&row);
}

/* What came to the heap and found no room goes on walking; then, from below, rest grains that lie
 * on the heap or on a plate become part of it. */
void lga_bits_sand_settle(struct lga *lga, const struct lga_kernel *kernel)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t rows = lga->lattice.rows;
    for (uint32_t y = 0; y < rows; y++) spread(lga, y, bits->digits, true);
    lga_bits_join(lga, lga_bits_heap(lga, rows - 1));
    for (uint32_t y = 0; y < rows; y++) {
        const uint32_t below = y == 0 ? rows - 1 : y - 1;
        const int left = lga_bits_shift(y, 4), right = lga_bits_shift(y, 5);
        const uint64_t *wall = lga_bits_wall(lga, below), *heap = lga_bits_heap(lga, below);
        kernel->bind(&(struct lga_row_bind){
            .words = bits->words, .rest = lga_bits_row(lga, y) + LGA_DIRECTIONS * bits->words,
            .wall = lga_bits_wall(lga, y), .wall_left = wall + left, .wall_right = wall + right,
            .heap_left = heap + left, .heap_right = heap + right, .heap = lga_bits_heap(lga, y)
        });
        lga_bits_join(lga, lga_bits_heap(lga, y));
    }
}
