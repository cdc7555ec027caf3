/* lga_kernel.h - the inner loops over words of nodes, written once and compiled for several sets
 * of instructions: whoever includes this defines KERNEL (the names' ending), KERNEL_TARGET (an
 * attribute) and KERNEL_WIDTH (words a vector).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Work goes in blocks of LGA_LANES words, whatever the width of a vector, so that the random words
 * of a node are the same on every machine.
 */
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define N(name) JOIN(name, KERNEL)
#define PARTS (LGA_LANES / KERNEL_WIDTH)        /* vectors a block */
#ifdef __SANITIZE_ADDRESS__     /* with every check in them they take minutes to compile */
#define INLINE KERNEL_TARGET static inline
#else
#define INLINE KERNEL_TARGET static inline __attribute__((always_inline))
#endif

typedef uint64_t N(vec) __attribute__((vector_size(8 * KERNEL_WIDTH), may_alias));
typedef uint64_t N(loose) __attribute__((vector_size(8 * KERNEL_WIDTH), may_alias, aligned(8)));
#define vec N(vec)

INLINE vec N(load)(const uint64_t *words) { return *(const N(loose) *)words; }
INLINE void N(store)(uint64_t *words, vec bits) { *(vec *)words = bits; }

/* Three operands that AVX-512 joins in one instruction, whose table of outcomes is the constant. */
#if KERNEL_WIDTH == 8
#define TERNARY(a, b, c, table) \
    (vec)_mm512_ternarylogic_epi64((__m512i)(a), (__m512i)(b), (__m512i)(c), table)
#endif

/* Where `which` is set the bit of yes, elsewhere that of no. */
INLINE vec N(either)(vec which, vec yes, vec no)
{
#ifdef TERNARY
    return TERNARY(which, yes, no, 0xca);
#else
    return no ^ (which & (yes ^ no));
#endif
}

/* The two bits of a + b + c: is it odd, is it two or more? */
INLINE vec N(odd)(vec a, vec b, vec c)
{
#ifdef TERNARY
    return TERNARY(a, b, c, 0x96);
#else
    return a ^ b ^ c;
#endif
}

INLINE vec N(most)(vec a, vec b, vec c)
{
#ifdef TERNARY
    return TERNARY(a, b, c, 0xe8);
#else
    return (a & b) | (c & (a | b));
#endif
}

/* xoshiro256++ of Blackman and Vigna (2018), a stream for each word of a block. */
struct N(stream) { vec a[PARTS], b[PARTS], c[PARTS], d[PARTS]; };

/* rng_mix of the words after the key, for many at once. */
INLINE vec N(mixed)(uint64_t key, uint32_t first)
{
    vec z;
    for (uint32_t l = 0; l < KERNEL_WIDTH; l++) z[l] = (first + l + 1) * 0x9e3779b97f4a7c15u;
    z += key;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

INLINE void N(seed_part)(struct N(stream) *s, int p, uint64_t key)
{
    const uint32_t first = (uint32_t)p * KERNEL_WIDTH;
    s->a[p] = N(mixed)(key, first);
    s->b[p] = N(mixed)(key, LGA_LANES + first);
    s->c[p] = N(mixed)(key, 2 * LGA_LANES + first);
    s->d[p] = N(mixed)(key, 3 * LGA_LANES + first);
}

INLINE void N(seed)(struct N(stream) *s, uint64_t key)
{
    for (int p = 0; p < PARTS; p++) N(seed_part)(s, p, key);
}

INLINE vec N(next)(struct N(stream) *s, int p)
{
    const vec a = s->a[p], b = s->b[p], sum = a + s->d[p];
    const vec word = ((sum << 23) | (sum >> 41)) + a;
    const vec c = s->c[p] ^ a, d = s->d[p] ^ b;
    s->b[p] = b ^ c;
    s->a[p] = a ^ d;
    s->c[p] = c ^ (b << 17);
    s->d[p] = (d << 45) | (d >> 19);
    return word;
}

/* One block of bits, each set with chance 1/2. */
INLINE void N(toss)(struct N(stream) *s, vec out[PARTS])
{
    for (int p = 0; p < PARTS; p++) out[p] = N(next)(s, p);
}

/* One block of bits, each set with the die's probability. */
INLINE void N(roll)(struct N(stream) *s, struct lga_die die, vec out[PARTS])
{
    const uint64_t certain = die.bits == 0 && die.threshold ? UINT64_MAX : 0;
    for (int p = 0; p < PARTS; p++) out[p] = (vec){0} | certain;
    for (int k = 0; k < die.bits; k++) {
        const bool digit = die.threshold >> k & 1;
        for (int p = 0; p < PARTS; p++) {
            const vec word = N(next)(s, p);
            out[p] = digit ? out[p] | word : out[p] & word;
        }
    }
}

/* The same for one vector of a block. */
INLINE vec N(draw)(struct N(stream) *s, int p, struct lga_die die)
{
    vec out = (vec){0} | (die.bits == 0 && die.threshold ? UINT64_MAX : 0);
    for (int k = 0; k < die.bits; k++) {
        const vec digit = (vec){0} | -(uint64_t)(die.threshold >> k & 1);
        out = N(most)(out, N(next)(s, p), digit);       /* "or" where it is set, else "and" */
    }
    return out;
}

/* Of a die that is known when this is compiled, 1 of 3 or 1 of 5. */
INLINE vec N(draw_known)(struct N(stream) *s, int p, uint32_t threshold)
{
    vec out = {0};
    #pragma GCC unroll 10
    for (int k = 0; k < LGA_CUT_BITS; k++) {
        const vec word = N(next)(s, p);
        out = threshold >> k & 1 ? out | word : out & word;
    }
    return out;
}

INLINE void N(skip)(struct N(stream) *s, int p, uint32_t words)
{
    for (uint32_t k = 0; k < words; k++) N(next)(s, p);
}

/* Dice that few nodes need: each vector's stream is followed no farther than to the last block that
 * asks, and not at all if none does.  `at` is where it is, in words, once it has begun. */
struct N(late) { struct N(stream) s; uint32_t at[PARTS]; bool begun[PARTS]; };

/* Brings the stream to the word numbered `to` of a row; of these the caller takes `words`. */
INLINE void N(reach)(struct N(late) *late, int p, struct lga_dice_source source, uint32_t to,
                     uint32_t words)
{
    if (!late->begun[p]) N(seed_part)(&late->s, p, lga_dice_key(source));
    late->begun[p] = true;
    N(skip)(&late->s, p, to - late->at[p]);
    late->at[p] = to + words;
}

KERNEL_TARGET static void N(roll_row)(const struct lga_dice *dice, uint64_t key, uint32_t words,
                                      uint64_t *const rows[LGA_DICE])
{
    struct N(stream) s;
    N(seed)(&s, key);
    for (uint32_t w = 0; w < words; w += LGA_LANES) {
        for (int k = 0; k < LGA_DICE; k++) {
            vec bits[PARTS];
            if (!rows[k]) continue;
            N(roll)(&s, dice->of[k], bits);
            for (int p = 0; p < PARTS; p++) N(store)(rows[k] + w + p * KERNEL_WIDTH, bits[p]);
        }
    }
}

/* --- FHP-II --- */

INLINE uint64_t N(count)(vec bits)
{
    uint64_t sum = 0;
    for (int k = 0; k < KERNEL_WIDTH; k++) sum += (uint64_t)__builtin_popcountll(bits[k]);
    return sum;
}

INLINE bool N(any)(vec bits)
{
#ifdef TERNARY
    return _mm512_test_epi64_mask((__m512i)bits, (__m512i)bits) != 0;
#else
    uint64_t sum = 0;
    for (int k = 0; k < KERNEL_WIDTH; k++) sum |= bits[k];
    return sum != 0;
#endif
}

/* Counts the collisions of a vector of nodes: adds a bit to the number of each, up to the last. */
INLINE void N(note)(uint64_t *number, uint32_t words, uint32_t w, vec hit)
{
    for (uint32_t k = 0; k < LGA_RATE_DIGITS; k++) {
        const vec digit = N(load)(number + k * words + w);
        N(store)(number + k * words + w, digit ^ hit);
        hit &= digit;
    }
    for (uint32_t k = 0; k < LGA_RATE_DIGITS && N(any)(hit); k++) {
        N(store)(number + k * words + w, N(load)(number + k * words + w) | hit);
    }
}

/* Collides the movers m of a vector of nodes without loss; the table is that of lga_table.c as
 * logic.  Rest grains are kicked up where they can, *splits, and added where there is room,
 * *merges.  Returns which nodes have changed. */
INLINE vec N(scatter)(vec m[6], vec can_split, vec can_merge, vec side, vec *splits, vec *merges)
{
    vec alone[6], none[3], both[3], turn[6];
    for (int i = 0; i < 3; i++) {
        alone[i] = m[i] & ~m[i + 3];
        alone[i + 3] = m[i + 3] & ~m[i];
        none[i] = ~(m[i] | m[i + 3]);
        both[i] = m[i] & m[i + 3];
    }
    const vec triple = (alone[0] & alone[2] & alone[4]) | (alone[1] & alone[3] & alone[5]);
    for (int i = 0; i < 3; i++) both[i] &= none[(i + 1) % 3] & none[(i + 2) % 3];
    vec changed = triple;
    *splits = *merges = (vec){0};
    for (int i = 0; i < 6; i++) {
        /* {i} with a rest grain -> {i-1, i+1} without, and its inverse */
        const vec split = alone[i] & none[(i + 1) % 3] & none[(i + 2) % 3] & can_split;
        const vec merge = alone[(i + 5) % 6] & alone[(i + 1) % 6] & none[i % 3] & can_merge;
        turn[i] = split | merge;
        *splits |= split;
        *merges |= merge;
    }
    vec flip[3];
    for (int i = 0; i < 3; i++) {
        changed |= both[i];
        flip[i] = both[i] | (side & both[(i + 2) % 3]) | (~side & both[(i + 1) % 3]) | triple;
    }
    for (int i = 0; i < 6; i++) {
        m[i] ^= flip[i % 3] | turn[(i + 5) % 6] | turn[i] | turn[(i + 1) % 6];
    }
    return changed | *splits | *merges;
}

/* The same for at most one rest grain a node. */
INLINE vec N(collide)(vec m[6], vec *rest, vec side, vec kick)
{
    vec splits, merges;
    const vec changed = N(scatter)(m, *rest & kick, ~*rest, side, &splits, &merges);
    *rest ^= splits | merges;
    return changed;
}

/* Gravity, where `falls`: movers that rise turn down and keep their momentum along x, and a rest
 * grain starts down, unless the slot is taken or a wall is in the way. */
INLINE void N(fall)(vec m[6], vec *rest, vec falls, vec left, vec wall_left, vec wall_right)
{
    const vec right_bends = m[1] & ~m[5] & falls, left_bends = m[2] & ~m[4] & falls;
    m[1] ^= right_bends;
    m[5] ^= right_bends;
    m[2] ^= left_bends;
    m[4] ^= left_bends;
    const vec starts = *rest & falls;
    const vec goes_left = starts & left & ~m[4] & ~wall_left;
    const vec goes_right = starts & ~left & ~m[5] & ~wall_right;
    m[4] |= goes_left;
    m[5] |= goes_right;
    *rest &= ~(goes_left | goes_right);
}

INLINE uint64_t N(collide_effects)(const struct lga_row_collide *given, unsigned effects)
{
    const struct lga_row_collide row = *given;  /* what is stored cannot change the copy */
    const uint32_t words = row.words;
    uint64_t collisions = 0;
    struct N(stream) s;
    N(seed)(&s, row.key);
    for (uint32_t block = 0; block < words; block += LGA_LANES) {
        vec side[PARTS], kick[PARTS], falls[PARTS], left[PARTS], mirror[PARTS];
        N(toss)(&s, side);
        if (effects & LGA_BITS_LOSS) N(roll)(&s, row.dice->of[LGA_DIE_KICK], kick);
        if (effects & LGA_BITS_GRAVITY) N(roll)(&s, row.dice->of[LGA_DIE_FALL], falls);
        if (effects & LGA_BITS_GRAVITY) N(roll)(&s, row.dice->of[LGA_DIE_FALL_SIDE], left);
        if (effects & LGA_BITS_MIRROR) N(roll)(&s, row.dice->of[LGA_DIE_MIRROR], mirror);
        for (int p = 0; p < PARTS; p++) {
            const uint32_t w = block + (uint32_t)p * KERNEL_WIDTH;
            vec m[6], r = N(load)(row.in + 6 * words + w);
            const vec all = ~(vec){0};
            for (uint32_t d = 0; d < 6; d++) m[d] = N(load)(row.in + d * words + w);
            if (effects & LGA_BITS_HELD) {
                const vec fluid = ~N(load)(row.wall + w);
                for (int d = 0; d < 6; d++) m[d] &= fluid;
                r &= fluid;
            }
            const vec hit = N(collide)(m, &r, side[p], effects & LGA_BITS_LOSS ? kick[p] : all);
            collisions += N(count)(hit);
            if (effects & LGA_BITS_RATE) N(note)(row.hits, words, w, hit);
            if (effects & LGA_BITS_GRAVITY) {
                N(fall)(m, &r, falls[p], left[p], N(load)(row.wall_left + w),
                        N(load)(row.wall_right + w));
            }
            for (uint32_t d = 0; d < 6; d++) N(store)(row.out + d * row.stride + w, m[d]);
            N(store)(row.out + 6 * row.stride + w, r);
            if (effects & LGA_BITS_MIRROR) {
                N(store)(row.out + LGA_PLANE_MIRROR * row.stride + w, mirror[p]);
            }
        }
    }
    return collisions;
}

INLINE uint64_t N(stream_effects)(const struct lga_row_stream *given, unsigned effects)
{
    const struct lga_row_stream row = *given;
    const uint32_t words = row.words;
    uint64_t left = 0;
    for (uint32_t w = 0; w < words; w += KERNEL_WIDTH) {
        vec wall = {0}, sink = {0};
        if (effects & LGA_BITS_WALLS) wall = N(load)(row.wall + w);
        if (effects & LGA_BITS_SINKS) sink = N(load)(row.sink + w);
        for (uint32_t d = 0; d < 6; d++) {
            vec m = N(load)(row.from[d] + w);
            if (effects & LGA_BITS_WALLS) {
                m |= N(load)(row.wall_from[d] + w) & N(load)(row.own[(d + 3) % 6] + w);
                m &= ~wall;
            }
            if (effects & LGA_BITS_SINKS) {
                left += N(count)(m & sink);
                m &= ~sink;
            }
            if (effects & LGA_BITS_HELD) m |= wall & N(load)(row.out + d * words + w);
            N(store)(row.out + d * words + w, m);
        }
        vec r = N(load)(row.own[6] + w);
        if (effects & LGA_BITS_HELD) r |= wall & N(load)(row.out + 6 * words + w);
        N(store)(row.out + 6 * words + w, r);
    }
    return left;
}

/* Where there are no walls: each plane from where its movers come. */
KERNEL_TARGET static void N(stream_free)(uint64_t *out, uint32_t words,
                                         const uint64_t *const from[LGA_PLANES])
{
    for (uint32_t w = 0; w < words; w += KERNEL_WIDTH) {
        for (uint32_t d = 0; d < LGA_PLANES; d++) {
            N(store)(out + d * words + w, N(load)(from[d] + w));
        }
    }
}

#include "model/lga/lga_kernel_choice.h"
#include "model/lga/lga_kernel_gmlg.h"
#include "model/lga/lga_kernel_room.h"
#include "model/lga/lga_kernel_sand.h"

#define INSTANCE(kind, e) \
    KERNEL_TARGET static uint64_t N(kind##_##e)(const struct lga_row_##kind *row) \
    { return N(kind##_effects)(row, e); }
INSTANCE(collide, 0) INSTANCE(collide, 1) INSTANCE(collide, 2) INSTANCE(collide, 3)
INSTANCE(collide, 4) INSTANCE(collide, 5) INSTANCE(collide, 6) INSTANCE(collide, 7)
INSTANCE(stream, 8)
/* What is rare (sinks, held grains, mirrors) is tested in the loop, on top of all else. */
KERNEL_TARGET static uint64_t N(collide_any)(const struct lga_row_collide *row)
{
    return N(collide_effects)(row, row->effects);
}
KERNEL_TARGET static uint64_t N(stream_any)(const struct lga_row_stream *row)
{
    return N(stream_effects)(row, row->effects);
}
KERNEL_TARGET static uint64_t N(gmlg_free)(const struct lga_row_gmlg *row)
{
    return N(gmlg_effects)(row, LGA_BITS_TIGHT);
}
KERNEL_TARGET static uint64_t N(gmlg_level)(const struct lga_row_gmlg *row)
{
    return N(gmlg_effects)(row, LGA_BITS_GRAVITY);
}
KERNEL_TARGET static uint64_t N(gmlg_vertical)(const struct lga_row_gmlg *row)
{
    return N(gmlg_effects)(row, LGA_BITS_GRAVITY | LGA_BITS_VERTICAL);
}
KERNEL_TARGET static uint64_t N(gmlg_any)(const struct lga_row_gmlg *row)
{
    return N(gmlg_effects)(row, row->effects);
}

static const struct lga_kernel N(kernel) = {
    N(roll_row),
    {N(collide_0), N(collide_1), N(collide_2), N(collide_3),
     N(collide_4), N(collide_5), N(collide_6), N(collide_7)},
    N(collide_any), N(stream_free), N(stream_8), N(stream_any),
    N(stop), N(fall_row), N(stream_heap), N(bind),
    N(survey), N(stirs), N(gmlg_free), N(gmlg_level), N(gmlg_vertical), N(gmlg_any), N(admit),
    N(arrive)
};

#undef INSTANCE
#undef TERNARY
#undef vec
#undef INLINE
#undef PARTS
#undef N
#undef JOIN
#undef JOIN_
#undef KERNEL
#undef KERNEL_TARGET
#undef KERNEL_WIDTH
