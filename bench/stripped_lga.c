/* stripped_lga.c - FHP-II by hand; see stripped.h.
 *
 * The algorithm of lga for method fhp2: planes of bits, 64 nodes a word; rows are collided, in
 * order, into a ring that stays in the cache, and streamed from it.  No walls, no gravity, no loss;
 * borders are periodic.  The random words have the model's names, so that both give the same
 * motion, bit for bit.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/stripped.h"

#include "base/rng.h"
#include "model/lga/lga_bits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* X(name, attribute): the sets of instructions that the loops are compiled for, widest first. */
#if defined(__x86_64__) && defined(__GNUC__)
#define FORMS(X) X(avx512, __attribute__((target("avx512f,popcnt")))) \
                 X(avx2, __attribute__((target("avx2,popcnt")))) X(base, )
#else
#define FORMS(X) X(base, )
#endif
#define INLINE static inline __attribute__((always_inline))

static const char text[] =
    "until = 1e6; box = [0, 0, 2048, 512]; count_max = 4000000;"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
    "grains = ({ radius = 0.5; density = 1; restitution = 1; });"
    "placements = ({ kind = \"square\"; count = 1; });"
    "lga = { method = \"fhp2\"; spacing = 1; tick = 1; fill = 0.3; };";

enum { PLANES = 7, ROWS = 6 };
enum { FIRST, LAST, BETWEEN };          /* rows of the ring */

typedef uint64_t lanes __attribute__((vector_size(8 * LGA_LANES), may_alias));
typedef uint64_t loose __attribute__((vector_size(8 * LGA_LANES), may_alias, aligned(8)));

struct loops;

struct gas {
    uint32_t rows, columns, words, stride;
    uint64_t seed, ticks, collisions;
    double   tick;
    uint64_t *planes;           /* [row][plane][word] */
    uint64_t *ring;             /* [ROWS][plane][word], with margins */
    const struct loops *loops;
    struct arena arena;
};

static uint64_t *row_of(const struct gas *g, uint32_t y)
{
    return g->planes + (size_t)y * PLANES * g->words;
}

static uint64_t *ring_of(const struct gas *g, uint32_t k)
{
    return g->ring + (size_t)k * PLANES * g->stride + LGA_LANES;
}

/* ---- collide ------------------------------------------------------------------------------- */

/* xoshiro256++, a stream for each word of a block. */
struct random { lanes a, b, c, d; };

INLINE void seed(struct random *s, uint64_t key)
{
    lanes *const parts[] = {&s->a, &s->b, &s->c, &s->d};
    for (unsigned k = 0; k < 4; k++) {
        for (unsigned l = 0; l < LGA_LANES; l++) {
            (*parts[k])[l] = rng_mix(key + (k * LGA_LANES + l + 1) * 0x9e3779b97f4a7c15u);
        }
    }
}

INLINE void next(struct random *s, lanes *word)
{
    const lanes a = s->a, b = s->b, sum = a + s->d, c = s->c ^ a, d = s->d ^ b;
    *word = ((sum << 23) | (sum >> 41)) + a;
    s->b = b ^ c;
    s->a = a ^ d;
    s->c = c ^ (b << 17);
    s->d = (d << 45) | (d >> 19);
}

/* Head-on pairs turn to the side that the die says, triples turn back; a mover and a rest grain
 * become two movers, and two such movers a mover and a rest grain. */
INLINE uint64_t collide_block(lanes m[6], lanes *rest, const lanes *side)
{
    lanes alone[6], none[3], both[3], turn[6], moved = {0};
    for (int i = 0; i < 3; i++) {
        alone[i] = m[i] & ~m[i + 3];
        alone[i + 3] = m[i + 3] & ~m[i];
        none[i] = ~(m[i] | m[i + 3]);
        both[i] = m[i] & m[i + 3];
    }
    const lanes triple = (alone[0] & alone[2] & alone[4]) | (alone[1] & alone[3] & alone[5]);
    for (int i = 0; i < 3; i++) both[i] &= none[(i + 1) % 3] & none[(i + 2) % 3];
    for (int i = 0; i < 6; i++) {
        const lanes split = alone[i] & none[(i + 1) % 3] & none[(i + 2) % 3] & *rest;
        const lanes merge = alone[(i + 5) % 6] & alone[(i + 1) % 6] & none[i % 3] & ~*rest;
        turn[i] = split | merge;
        moved |= turn[i];
    }
    for (int i = 0; i < 6; i++) {
        const lanes pair = both[i % 3] | (*side & both[(i + 2) % 3]) | (~*side & both[(i + 1) % 3]);
        m[i] ^= pair | triple | turn[(i + 5) % 6] | turn[i] | turn[(i + 1) % 6];
    }
    *rest ^= moved;
    const lanes hit = triple | both[0] | both[1] | both[2] | moved;
    uint64_t sum = 0;
    for (int k = 0; k < LGA_LANES; k++) sum += (uint64_t)__builtin_popcountll(hit[k]);
    return sum;
}

INLINE uint64_t collide_words(const uint64_t *in, uint64_t *out, uint32_t words, uint32_t stride,
                              uint64_t key)
{
    uint64_t collisions = 0;
    struct random random;
    seed(&random, key);
    for (uint32_t w = 0; w < words; w += LGA_LANES) {
        lanes m[6], rest = *(const loose *)(in + 6 * words + w), side;
        next(&random, &side);
        for (uint32_t d = 0; d < 6; d++) m[d] = *(const loose *)(in + d * words + w);
        collisions += collide_block(m, &rest, &side);
        for (uint32_t d = 0; d < 6; d++) *(loose *)(out + d * stride + w) = m[d];
        *(loose *)(out + 6 * stride + w) = rest;
    }
    return collisions;
}

/* ---- stream -------------------------------------------------------------------------------- */

INLINE void stream_words(uint64_t *out, uint32_t words, const uint64_t *const from[PLANES])
{
    for (uint32_t w = 0; w < words; w += LGA_LANES) {
        for (uint32_t d = 0; d < PLANES; d++) {
            *(loose *)(out + d * words + w) = *(const loose *)(from[d] + w);
        }
    }
}

#define X(name, attribute)                                                                  \
    attribute static uint64_t collide_##name(const uint64_t *in, uint64_t *out,             \
                                             uint32_t words, uint32_t stride, uint64_t key) \
    {                                                                                       \
        return collide_words(in, out, words, stride, key);                                  \
    }                                                                                       \
    attribute static void stream_##name(uint64_t *out, uint32_t words,                      \
                                        const uint64_t *const from[PLANES])                 \
    {                                                                                       \
        stream_words(out, words, from);                                                     \
    }
FORMS(X)
#undef X

static const struct loops {
    uint64_t (*collide)(const uint64_t *, uint64_t *, uint32_t, uint32_t, uint64_t);
    void (*stream)(uint64_t *, uint32_t, const uint64_t *const [PLANES]);
} loops[] = {
#define X(name, attribute) {collide_##name, stream_##name},
    FORMS(X)
#undef X
};

/* The column behind the last one is the first, and the other way round. */
static void join_ends(uint64_t *row, uint32_t words, uint32_t columns)
{
    const uint32_t last = columns - 1;
    const bool full = columns == 64 * words;
    if (!full) {
        const uint64_t bit = 1ull << columns / words;
        uint64_t *word = &row[columns % words];
        *word = (*word & ~bit) | (row[0] & 1 ? bit : 0);
    }
    row[-1] = (row[words - 1] << 1) | (row[last % words] >> last / words & 1);
    row[words] = row[0] >> 1 | (full ? row[0] << 63 : 0);
}

static const uint64_t *collide(struct gas *g, uint32_t y, uint32_t k)
{
    uint64_t *out = ring_of(g, k);
    g->collisions += g->loops->collide(row_of(g, y), out, g->words, g->stride,
                                       rng_keyed(g->seed, g->ticks, y, 0));
    for (uint32_t d = 0; d < 6; d++) join_ends(out + d * g->stride, g->words, g->columns);
    return out;
}

/* Movers of direction d come from the row and the column behind them. */
static void stream(struct gas *g, uint32_t y, const uint64_t *const ring[3])
{
    const int odd = (int)(y & 1);
    const int row[6] = {1, 0, 0, 1, 2, 2}, shift[6] = {-1, odd - 1, odd, 1, odd, odd - 1};
    const uint64_t *from[PLANES];
    for (int d = 0; d < 6; d++) from[d] = ring[row[d]] + (uint32_t)d * g->stride + shift[d];
    from[6] = ring[1] + 6 * g->stride;
    g->loops->stream(row_of(g, y), g->words, from);
    if (g->columns == 64 * g->words) return;
    for (uint32_t p = 0; p < PLANES; p++) {
        row_of(g, y)[p * g->words + g->columns % g->words] &= ~(1ull << g->columns / g->words);
    }
}

static void gas_advance(void *state, double t_end)
{
    struct gas *g = state;
    const uint32_t rows = g->rows;
    for (; (double)g->ticks * g->tick + 0.5 * g->tick <= t_end; g->ticks++) {
        const uint64_t *first = collide(g, 0, FIRST), *last = collide(g, rows - 1, LAST);
        const uint64_t *ring[3] = {last, first, NULL};
        for (uint32_t y = 0; y < rows; y++) {
            ring[2] = y + 1 == rows ? first : y + 2 == rows ? last
                    : collide(g, y + 1, BETWEEN + y % 3);
            stream(g, y, ring);
            ring[0] = ring[1];
            ring[1] = ring[2];
        }
    }
}

/* ---- from the model's state ---------------------------------------------------------------- */

static void gas_close(void *state)
{
    struct gas *g = state;
    arena_free(&g->arena);
    free(g);
}

static void *gas_open(const struct simulation *sim, double *bytes)
{
    const struct lga *lga = sim->state;
    struct gas *g = calloc(1, sizeof *g);
    if (!g) return NULL;
    g->rows = lga->lattice.rows;
    g->columns = lga->lattice.columns;
    g->words = lga->words;
    g->stride = g->words + 2 * LGA_LANES;
    g->loops = &loops[sizeof loops / sizeof *loops - 1 - (size_t)lga->simd];
    g->seed = lga->seed;
    g->tick = lga->tick;
    const size_t size = (size_t)g->rows * PLANES * g->words;
    const size_t ring = (size_t)ROWS * PLANES * g->stride;
    if (!arena_array(&g->arena, &g->planes, size) || !arena_array(&g->arena, &g->ring, ring)) {
        gas_close(g);
        return NULL;
    }
    memcpy(g->planes, lga->bits->planes, size * sizeof *g->planes);
    *bytes = (double)(size + ring) * sizeof *g->planes / (double)simulation_count(sim).grains;
    return g;
}

/* Words of nodes that differ. */
static double gas_apart(const void *state, const struct simulation *sim)
{
    const struct gas *g = state;
    const struct lga *lga = sim->state;
    uint64_t count = g->collisions != lga->collisions;
    for (size_t k = 0; k < (size_t)g->rows * PLANES * g->words; k++) {
        count += g->planes[k] != lga->bits->planes[k];
    }
    return (double)count;
}

const struct stripped_kernel stripped_lga = {
    .model = "lga", .scene = text, .slice = 100, .warm = 2, .turns = 41,
    .open = gas_open, .advance = gas_advance, .close = gas_close,
    .apart = gas_apart, .apart_unit = "words of nodes", .apart_max = 0,
};
