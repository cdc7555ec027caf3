/* lga_bits.c - FHP-II in planes of bits, and what all fast forms share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A tick reads each row once and writes it once.  Rows are collided, in order, into a ring of a few
 * rows that stays in the cache; a row is streamed from its own and its two neighbours' copies in
 * the ring back into its place, which nobody needs any more.  Bands of rows go to threads: all
 * bands first collide their first and last rows, which their neighbours read later.  The random
 * words of a row have a name (seed, tick, row), so neither order nor threads matter.
 */
#include "model/lga/lga_bits.h"

#include "base/rng.h"

#include <assert.h>
#include <omp.h>
#include <string.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#define KERNEL _base
#define KERNEL_TARGET
#define KERNEL_WIDTH 2
#include "model/lga/lga_kernel.h"
#if defined(__x86_64__)
#define KERNEL _avx2
#define KERNEL_TARGET __attribute__((target("avx2,popcnt")))
#define KERNEL_WIDTH 4
#include "model/lga/lga_kernel.h"
#define KERNEL _avx512
#define KERNEL_TARGET __attribute__((target("avx512f,popcnt")))
#define KERNEL_WIDTH 8
#include "model/lga/lga_kernel.h"
static const struct lga_kernel *const kernels[] = {&kernel_base, &kernel_avx2, &kernel_avx512};
#else
static const struct lga_kernel *const kernels[] = {&kernel_base, &kernel_base, &kernel_base};
#endif

/* Where the row of a node's neighbour in direction d lies, and by how many columns it is shifted
 * in even and odd rows. */
static const int row_step[LGA_DIRECTIONS] = {0, 1, 1, 0, -1, -1};
static const int column_step[2][LGA_DIRECTIONS] = {{1, 0, -1, -1, -1, 0}, {1, 1, 0, -1, 0, 1}};

void lga_bits_roll(const struct lga_dice *dice, enum lga_simd simd, uint64_t key, uint32_t words,
                   uint64_t *const out[LGA_DICE])
{
    kernels[simd]->roll(dice, key, words, out);
}

static uint32_t row_at(const struct lga *lga, uint32_t row, int step)
{
    const uint32_t rows = lga->lattice.rows;
    if (step > 0) return row + 1 == rows ? 0 : row + 1;
    if (step < 0) return row == 0 ? rows - 1 : row - 1;
    return row;
}

static uint64_t *plane(const struct lga_bits *bits, uint32_t row, uint32_t p)
{
    return bits->planes + ((size_t)row * bits->depth + p) * bits->words;
}

/* The first word of a row; the margin lies before it. */
static uint64_t *wall_row(const struct lga_bits *bits, uint32_t row)
{
    return bits->wall + (size_t)row * bits->stride + LGA_LANES;
}

/* Row k (0 first, 1 last, 2.. between) of a band's ring, at its first plane's first word. */
static uint64_t *ring_row(const struct lga_bits *bits, uint32_t band, uint32_t k)
{
    return bits->rings + ((size_t)band * LGA_RING + k) * LGA_RING_PLANES * bits->stride + LGA_LANES;
}

static void put_bit(uint64_t *row, uint32_t words, uint32_t column, uint64_t bit)
{
    uint64_t *word = &row[column % words];
    *word = (*word & ~(1ull << column / words)) | bit << column / words;
}

static uint64_t get_bit(const uint64_t *row, uint32_t words, uint32_t column)
{
    return row[column % words] >> (column / words) & 1;
}

/* The column behind the last one, if there is such a one. */
static void put_copy(const struct lga_bits *bits, uint64_t *row, uint64_t bit)
{
    uint64_t *word = &row[bits->copy_word];
    *word = (*word & ~(1ull << bits->copy_bit)) | bit << bits->copy_bit;
}

/* Joins the ends of a row: the column behind the last one is the first, and so on around. */
void lga_bits_join(const struct lga *lga, uint64_t *row) { lga_bits_join_planes(lga, row, 1); }

void lga_bits_join_planes(const struct lga *lga, uint64_t *row, uint32_t count)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t words = bits->words, last = bits->last_word, last_bit = bits->last_bit;
    const bool full = lga->lattice.columns == 64 * words;
    for (uint32_t p = 0; p < count; p++, row += bits->stride) {
        if (!full) put_copy(bits, row, row[0] & 1);
        row[-1] = (row[words - 1] << 1) | (row[last] >> last_bit & 1);
        row[words] = row[0] >> 1;
        if (full) row[words] |= row[0] << 63;
    }
}

int lga_bits_shift(uint32_t row, int direction) { return column_step[row & 1][direction]; }

void lga_bits_trim(const struct lga *lga, uint32_t row)
{
    const struct lga_bits *bits = lga->bits;
    if (lga->lattice.columns == 64 * bits->words) return;
    for (uint32_t p = 0; p < bits->depth; p++) {        /* the column that stands for the first */
        put_copy(bits, plane(bits, row, p), 0);
    }
}

void lga_bits_clean(const struct lga *lga, uint32_t row)
{
    const struct lga_bits *bits = lga->bits;
    for (uint32_t x = lga->lattice.columns; x < 64 * bits->words; x++) {
        for (uint32_t p = 0; p < bits->depth; p++) put_bit(plane(bits, row, p), bits->words, x, 0);
    }
}

bool lga_bits_allocate_real(struct lga *lga)
{
    struct lga_bits *bits = lga->bits;
    if (!arena_array(&lga->arena, &bits->real, bits->words)) return false;
    for (uint32_t x = 0; x < lga->lattice.columns; x++) put_bit(bits->real, bits->words, x, 1);
    return true;
}

uint64_t *lga_bits_row(const struct lga *lga, uint32_t row) { return plane(lga->bits, row, 0); }

uint64_t *lga_bits_wall(const struct lga *lga, uint32_t row) { return wall_row(lga->bits, row); }

uint64_t *lga_bits_heap(const struct lga *lga, uint32_t row)
{
    return lga->bits->heap + (size_t)row * lga->bits->stride + LGA_LANES;
}

bool lga_bits_allocate(struct lga *lga)
{
    struct arena *arena = &lga->arena;
    if (!arena_array(arena, &lga->bits, 1)) return false;
    struct lga_bits *bits = lga->bits;
    const uint32_t rows = lga->lattice.rows, threads = (uint32_t)omp_get_max_threads();
    bits->words = lga->words;
    bits->stride = bits->words + 2 * LGA_LANES;
    bits->last_word = (lga->lattice.columns - 1) % bits->words;
    bits->last_bit = (lga->lattice.columns - 1) / bits->words;
    bits->copy_word = lga->lattice.columns % bits->words;
    bits->copy_bit = lga->lattice.columns / bits->words;
    bits->bands = lga->sites < LGA_LOOP_MIN ? 1 : rows / 2 < threads ? rows / 2 : threads;
    const bool sandpile = lga->rule.method == LGA_SANDPILE, gmlg = lga->rule.method == LGA_GMLG;
    bits->depth = gmlg ? LGA_GMLG_PLANES : LGA_PLANES;
    const size_t ring = (size_t)LGA_RING * LGA_RING_PLANES * bits->stride;
    return arena_array(arena, &bits->planes, (size_t)rows * bits->depth * bits->words)
        && arena_array(arena, &bits->wall, (size_t)rows * bits->stride)
        && arena_array(arena, &bits->sink, lga->sinks ? (size_t)rows * bits->words : 0)
        && arena_array(arena, &bits->kinds, (size_t)bits->bands * lga->lattice.columns)
        && (gmlg ? lga_bits_gmlg_allocate(lga)
                 : arena_array(arena, &bits->rings, bits->bands * ring))
        && (!sandpile || lga_bits_sand_allocate(lga));
}

/* --- one tick --- */

static bool is_certain(struct lga_die die) { return die.bits == 0 && die.threshold == 1; }

static unsigned effects_of(const struct lga *lga)
{
    unsigned effects = lga->bits->effects;      /* walls and sinks */
    if (!is_certain(lga->dice.of[LGA_DIE_KICK])) effects |= LGA_BITS_LOSS;
    if (lga->rule.gravity) effects |= LGA_BITS_GRAVITY;
    if (lga->rate.now) effects |= LGA_BITS_RATE;
    if (lga->trapped) effects |= LGA_BITS_HELD | LGA_BITS_WALLS;
    const struct lga_die mirror = lga->dice.of[LGA_DIE_MIRROR];
    const bool mirrors = mirror.bits || mirror.threshold || lga->bits->heap;
    if ((effects & LGA_BITS_WALLS) && mirrors) effects |= LGA_BITS_MIRROR;
    return effects;
}

static uint64_t collide(const struct lga *lga, uint32_t y, uint64_t *out, unsigned effects)
{
    const struct lga_bits *bits = lga->bits;
    const struct lga_kernel *kernel = kernels[lga->simd];
    struct lga_row_collide row = {
        .words = bits->words, .stride = bits->stride, .effects = effects,
        .key = lga_dice_key((struct lga_dice_source){lga->seed, lga->ticks, y, 0}),
        .dice = &lga->dice, .in = plane(bits, y, 0), .out = out, .wall = wall_row(bits, y)
    };
    if (effects & LGA_BITS_RATE) row.hits = lga_rate_row(lga, y);
    if (effects & LGA_BITS_GRAVITY) {
        const uint64_t *below = wall_row(bits, row_at(lga, y, -1));
        row.wall_left = below + column_step[y & 1][4];
        row.wall_right = below + column_step[y & 1][5];
    }
    const bool rare = effects & (LGA_BITS_HELD | LGA_BITS_MIRROR);
    const unsigned index = effects & (LGA_BITS_LOSS | LGA_BITS_GRAVITY | LGA_BITS_RATE);
    return rare ? kernel->collide_any(&row) : kernel->collide[index](&row);
}

/* Row y as it is before streaming: row k of the band's ring. */
static uint64_t prepare(const struct lga *lga, uint32_t y, uint32_t band, uint32_t k,
                        unsigned effects)
{
    uint64_t *out = ring_row(lga->bits, band, k), collisions = 0;
    if (lga->rule.method == LGA_SANDPILE) {
        uint64_t *scratch = ring_row(lga->bits, band, LGA_RING - 1);
        lga_bits_sand_fall(lga, kernels[lga->simd], y, out, scratch);
    } else {
        collisions = collide(lga, y, out, effects);
    }
    lga_bits_join_planes(lga, out, LGA_DIRECTIONS);
    return collisions;
}

/* The nodes of a word whose movers a wall reflects like a mirror: by the same rule as in the plain
 * form, one by one, for they are few.  Where there is a heap, plates do so always, and what came
 * to the heap has stopped. */
static void reflect(const struct lga *lga, const struct lga_row_stream *row)
{
    const uint64_t *mirror = row->own[LGA_PLANE_MIRROR];
    const uint32_t words = row->words;
    for (uint32_t w = 0; w < words; w++) {
        uint64_t wall[LGA_DIRECTIONS], stuck = 0;
        for (int d = 0; d < LGA_DIRECTIONS; d++) {
            wall[d] = row->wall_from[(d + 3) % LGA_DIRECTIONS][w];
            stuck |= row->own[d][w] & wall[d];
        }
        uint64_t mirrors = mirror[w];
        if (row->heap) {
            mirrors |= wall[4] & wall[5] & ~(wall[0] | wall[1] | wall[2] | wall[3]);
            mirrors &= ~row->heap[w];
        }
        for (stuck &= mirrors & ~row->wall[w]; stuck; stuck &= stuck - 1) {
            const int b = __builtin_ctzll(stuck);
            if ((uint32_t)b * words + w >= lga->lattice.columns) continue;
            unsigned blocked = 0, moving = 0, now = 0;
            for (int d = 0; d < LGA_DIRECTIONS; d++) {
                blocked |= (unsigned)(wall[d] >> b & 1) << d;
                moving |= (unsigned)(row->own[d][w] >> b & 1) << d;
                now |= (unsigned)(row->out[(size_t)d * words + w] >> b & 1) << d;
            }
            now = lga_step_mirrored(blocked, moving & blocked, now);
            for (int d = 0; d < LGA_DIRECTIONS; d++) {
                uint64_t *word = &row->out[(size_t)d * words + w];
                *word = (*word & ~(1ull << b)) | (uint64_t)(now >> d & 1) << b;
            }
        }
    }
}

/* Where in the ring's row of their start the movers of direction d come from, in words. */
static ptrdiff_t source(const struct lga_bits *bits, uint32_t parity, int d)
{
    return d * (ptrdiff_t)bits->stride + column_step[parity][(d + 3) % LGA_DIRECTIONS];
}

static uint64_t stream(const struct lga *lga, uint32_t y, uint64_t *const ring[3], unsigned effects)
{
    const struct lga_bits *bits = lga->bits;
    const struct lga_kernel *kernel = kernels[lga->simd];
    struct lga_row_stream row = {
        .words = bits->words, .effects = effects, .out = plane(bits, y, 0),
        .wall = wall_row(bits, y),
        .sink = bits->sink ? bits->sink + (size_t)y * bits->words : NULL
    };
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        const int back = (d + 3) % LGA_DIRECTIONS, shift = column_step[y & 1][back];
        row.from[d] = ring[1 + row_step[back]] + source(bits, y & 1, d);
        row.wall_from[d] = wall_row(bits, row_at(lga, y, row_step[back])) + shift;
    }
    for (uint32_t p = 0; p < LGA_RING_PLANES; p++) row.own[p] = ring[1] + p * bits->stride;
    if (bits->heap) {
        row.heap = lga_bits_heap(lga, y);
        row.surplus = bits->surplus + (size_t)y * bits->digits * bits->words;
        row.real = bits->real;
        row.spills = bits->spills + y;
    }
    const bool rare = effects & (LGA_BITS_SINKS | LGA_BITS_HELD);
    const uint64_t left = bits->heap ? kernel->stream_heap(&row) : rare ? kernel->stream_any(&row)
                        : kernel->stream_walls(&row);
    if (effects & LGA_BITS_MIRROR) reflect(lga, &row);
    lga_bits_trim(lga, y);
    return left;
}

uint32_t lga_bits_band(const struct lga *lga, uint32_t band)
{
    return (uint32_t)((uint64_t)lga->lattice.rows * band / lga->bits->bands);
}

struct passed { uint64_t collisions, left; };

/* The rows around row y in the ring, as they are before streaming, of which the next one may still
 * have to be collided. */
static uint64_t advance_ring(const struct lga *lga, uint32_t y, uint32_t y1, uint32_t band,
                             unsigned effects, uint64_t *ring[3])
{
    const struct lga_bits *bits = lga->bits;
    ring[0] = ring[1];
    ring[1] = ring[2];
    if (y + 1 == y1) ring[2] = ring_row(bits, (band + 1) % bits->bands, 0);
    else if (y + 2 == y1) ring[2] = ring_row(bits, band, 1);
    else {
        ring[2] = ring_row(bits, band, 2 + y % 3);
        return prepare(lga, y + 1, band, 2 + y % 3, effects);
    }
    return 0;
}

static struct passed pass_band(const struct lga *lga, uint32_t band, unsigned effects)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t y0 = lga_bits_band(lga, band), y1 = lga_bits_band(lga, band + 1);
    const uint32_t before = (band + bits->bands - 1) % bits->bands;
    uint64_t *ring[3] = {NULL, ring_row(bits, before, 1), ring_row(bits, band, 0)};
    struct passed sum = {0};
    for (uint32_t y = y0; y < y1; y++) {
        sum.collisions += advance_ring(lga, y, y1, band, effects, ring);
        sum.left += stream(lga, y, ring, effects);
    }
    return sum;
}

/* The same for a lattice without walls: what a row of it has to look up is a few addresses. */
static struct passed pass_free(const struct lga *lga, uint32_t band, unsigned effects)
{
    const struct lga_bits *bits = lga->bits;
    const struct lga_kernel *kernel = kernels[lga->simd];
    const uint32_t y0 = lga_bits_band(lga, band), y1 = lga_bits_band(lga, band + 1);
    const uint32_t before = (band + bits->bands - 1) % bits->bands;
    uint64_t *ring[3] = {NULL, ring_row(bits, before, 1), ring_row(bits, band, 0)};
    ptrdiff_t offset[2][LGA_DIRECTIONS];
    struct passed sum = {0};
    for (uint32_t k = 0; k < 2; k++) {
        for (int d = 0; d < LGA_DIRECTIONS; d++) offset[k][d] = source(bits, k, d);
    }
    for (uint32_t y = y0; y < y1; y++) {
        sum.collisions += advance_ring(lga, y, y1, band, effects, ring);
        const uint64_t *from[LGA_PLANES];
        for (int d = 0; d < LGA_DIRECTIONS; d++) {
            from[d] = ring[1 - row_step[d]] + offset[y & 1][d];
        }
        from[LGA_DIRECTIONS] = ring[1] + LGA_DIRECTIONS * bits->stride;
        kernel->stream_free(plane(bits, y, 0), bits->words, from);
        lga_bits_trim(lga, y);
    }
    return sum;
}

void lga_bits_step(struct lga *lga)
{
    const struct lga_bits *bits = lga->bits;
    const unsigned effects = effects_of(lga);
    const bool walls = effects & (LGA_BITS_WALLS | LGA_BITS_SINKS | LGA_BITS_HELD);
    uint64_t collisions = 0, left = 0;
    if (lga->rule.method == LGA_GMLG) {
        lga_bits_gmlg_step(lga, kernels[lga->simd]);
        return;
    }
    if (lga->rule.method == LGA_SANDPILE) {
        collisions += lga_bits_sand_stop(lga, kernels[lga->simd]);
    }
    #pragma omp parallel for schedule(static, 1) reduction(+ : collisions) if (bits->bands > 1)
    for (uint32_t band = 0; band < bits->bands; band++) {
        const uint32_t y0 = lga_bits_band(lga, band), y1 = lga_bits_band(lga, band + 1);
        collisions += prepare(lga, y0, band, 0, effects);
        collisions += prepare(lga, y1 - 1, band, 1, effects);
    }
    #pragma omp parallel for schedule(static, 1) reduction(+ : collisions, left) \
        if (bits->bands > 1)
    for (uint32_t band = 0; band < bits->bands; band++) {
        const struct passed sum = walls ? pass_band(lga, band, effects)
                                        : pass_free(lga, band, effects);
        collisions += sum.collisions;
        left += sum.left;
    }
    if (bits->heap) lga_bits_sand_settle(lga, kernels[lga->simd]);
    lga->collisions += collisions;
    lga->grains_out += left;
}

/* --- nodes one by one --- */

void lga_bits_set_kinds(struct lga *lga, uint32_t row, const uint8_t *kind)
{
    struct lga_bits *bits = lga->bits;
    uint64_t *wall = wall_row(bits, row);
    memset(wall, 0xff, bits->words * sizeof *wall);     /* what is no node is wall */
    for (uint32_t x = 0; x < lga->lattice.columns; x++) {
        put_bit(wall, bits->words, x, kind[x] == LGA_WALL);
        if (!bits->sink) continue;
        put_bit(bits->sink + (size_t)row * bits->words, bits->words, x, kind[x] == LGA_SINK);
    }
}

void lga_bits_rasterise(struct lga *lga, double t)
{
    const struct lga_bits *bits = lga->bits;
    #pragma omp parallel for schedule(static, 1) if (bits->bands > 1)
    for (uint32_t band = 0; band < bits->bands; band++) {
        uint8_t *kind = bits->kinds + (size_t)band * lga->lattice.columns;
        for (uint32_t row = lga_bits_band(lga, band); row < lga_bits_band(lga, band + 1); row++) {
            lga_lattice_rasterise(&lga->lattice, lga->scene, t, row, kind);
            lga_bits_set_kinds(lga, row, kind);
        }
    }
    lga_bits_join_walls(lga);
}

void lga_bits_join_walls(struct lga *lga)
{
    struct lga_bits *bits = lga->bits;
    bits->effects = bits->sink ? LGA_BITS_SINKS : 0;
    for (uint32_t y = 0; y < lga->lattice.rows; y++) {
        uint64_t *row = wall_row(bits, y);
        for (uint32_t w = 0; w < bits->words; w++) {
            if (row[w]) bits->effects |= LGA_BITS_WALLS;
        }
        lga_bits_join(lga, row);
    }
}

struct lga_node lga_bits_node(const struct lga *lga, uint32_t site)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t row = site / lga->lattice.columns, x = site % lga->lattice.columns;
    struct lga_node node = {.kind = LGA_FLUID};
    for (uint32_t d = 0; d < LGA_DIRECTIONS; d++) {
        node.moving |= (uint8_t)(get_bit(plane(bits, row, d), bits->words, x) << d);
    }
    for (uint32_t p = LGA_DIRECTIONS; p < bits->depth; p++) {
        const uint64_t digit = get_bit(plane(bits, row, p), bits->words, x);
        node.rest |= (uint8_t)(digit << (p - LGA_DIRECTIONS));
    }
    if (get_bit(wall_row(bits, row), bits->words, x)) node.kind = LGA_WALL;
    if (bits->sink && get_bit(bits->sink + (size_t)row * bits->words, bits->words, x)) {
        node.kind = LGA_SINK;
    }
    return node;
}

void lga_bits_set(struct lga *lga, uint32_t site, unsigned moving, unsigned rest)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t row = site / lga->lattice.columns, x = site % lga->lattice.columns;
    const uint64_t state = moving | (uint64_t)rest << LGA_DIRECTIONS;
    assert(state >> bits->depth == 0);
    for (uint32_t p = 0; p < bits->depth; p++) {
        put_bit(plane(bits, row, p), bits->words, x, state >> p & 1);
    }
}

void lga_bits_sum(const struct lga *lga, uint32_t row, uint64_t sum[LGA_PLANES])
{
    for (int d = 0; d < LGA_PLANES; d++) sum[d] = 0;
    for (uint32_t p = 0; p < lga->bits->depth; p++) {
        const uint64_t *words = plane(lga->bits, row, p);
        uint64_t set = 0;
        for (uint32_t w = 0; w < lga->bits->words; w++) {
            set += (uint64_t)__builtin_popcountll(words[w]);
        }
        if (p < LGA_DIRECTIONS) sum[p] = set;
        else sum[LGA_DIRECTIONS] += set << (p - LGA_DIRECTIONS);
    }
}
