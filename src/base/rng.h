/* rng.h - random numbers that can be asked for by name.
 *
 * Two forms.  A stream is eight bytes of state and lives in a checkpoint.  A keyed word is a
 * pure function of (seed, a, b, c), for example (seed, step, site, draw): it does not depend
 * on the order of loops or on the number of threads.  Both end in the finaliser of splitmix64
 * (Steele, Lea and Flood 2014), which passes the usual batteries.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef RNG_H
#define RNG_H

#include <math.h>
#include <stdint.h>

struct rng { uint64_t state; };

static inline uint64_t rng_mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline uint64_t rng_u64(struct rng *rng)
{
    return rng_mix(rng->state += 0x9e3779b97f4a7c15u);
}

/* Uniform in [0, 1), 53 bits. */
static inline double rng_unit(uint64_t word) { return (double)(word >> 11) * 0x1p-53; }

static inline double rng_uniform(struct rng *rng) { return rng_unit(rng_u64(rng)); }

/* The word named (seed, a, b, c). */
static inline uint64_t rng_keyed(uint64_t seed, uint64_t a, uint64_t b, uint64_t c)
{
    uint64_t z = rng_mix(seed + 0x9e3779b97f4a7c15u);
    z = rng_mix(z ^ (a + 0x9e3779b97f4a7c15u));
    z = rng_mix(z ^ (b + 0xd1b54a32d192ed03u));
    return rng_mix(z ^ (c + 0x8cb92ba72f3d8dd7u));
}

/* A stream that is independent of the streams of every other (seed, a, b). */
static inline struct rng rng_stream(uint64_t seed, uint64_t a, uint64_t b)
{
    return (struct rng){rng_keyed(seed, a, b, 0)};
}

/* Normal deviate with mean 0 and deviation 1 (Box and Muller; one of the pair is thrown away so
 * that the stream stays stateless). */
static inline double rng_normal(struct rng *rng)
{
    const double u = 1.0 - rng_uniform(rng), phase = 6.283185307179586 * rng_uniform(rng);
    return sqrt(-2.0 * log(u)) * cos(phase);
}

#endif
