/* dsmc_words.h - random words in bulk, one stream for each block of cells and step.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Eight xoshiro128++ generators (Blackman and Vigna 2019) run side by side, so that a compiler
 * puts them into one vector register; they are seeded by name (seed, step, block), so the words do
 * not depend on the number of threads and nothing of them need be saved.
 */
#ifndef DSMC_WORDS_H
#define DSMC_WORDS_H

#include "base/rng.h"

enum { DSMC_LANES = 8 };

struct dsmc_words { uint32_t s[4][DSMC_LANES]; };

static inline struct dsmc_words dsmc_words_begin(uint64_t seed, uint64_t step, uint64_t block)
{
    struct dsmc_words words;
    struct rng rng = rng_stream(seed ^ 0x64736d63u, step, block);       /* "dsmc" */
    for (int k = 0; k < 4; k++) {
        for (int lane = 0; lane < DSMC_LANES; lane += 2) {
            const uint64_t word = rng_u64(&rng);
            words.s[k][lane] = (uint32_t)word;
            words.s[k][lane + 1] = (uint32_t)(word >> 32);
        }
    }
    for (int lane = 0; lane < DSMC_LANES; lane++) words.s[0][lane] |= 1;        /* never all zero */
    return words;
}

/* `count` is rounded up to whole lanes; there must be room for that. */
static inline __attribute__((always_inline)) void
dsmc_words_fill(struct dsmc_words *words, uint32_t *out, uint32_t count)
{
    uint32_t a[DSMC_LANES], b[DSMC_LANES], c[DSMC_LANES], d[DSMC_LANES];
    for (int l = 0; l < DSMC_LANES; l++) {
        a[l] = words->s[0][l];
        b[l] = words->s[1][l];
        c[l] = words->s[2][l];
        d[l] = words->s[3][l];
    }
    for (uint32_t k = 0; k < count; k += DSMC_LANES) {
        for (int l = 0; l < DSMC_LANES; l++) {
            const uint32_t sum = a[l] + d[l], shifted = b[l] << 9;
            out[k + (uint32_t)l] = (sum << 7 | sum >> 25) + a[l];
            c[l] ^= a[l];
            d[l] ^= b[l];
            b[l] ^= c[l];
            a[l] ^= d[l];
            c[l] ^= shifted;
            d[l] = d[l] << 11 | d[l] >> 21;
        }
    }
    for (int l = 0; l < DSMC_LANES; l++) {
        words->s[0][l] = a[l];
        words->s[1][l] = b[l];
        words->s[2][l] = c[l];
        words->s[3][l] = d[l];
    }
}

/* Uniform in [0, 1), 24 bits. */
static inline float dsmc_words_unit(uint32_t word) { return (float)(word >> 8) * 0x1p-24f; }

#endif
