/* bench_dsmc.h - how many grains direct simulation Monte Carlo moves on by a step in a second.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef BENCH_DSMC_H
#define BENCH_DSMC_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

struct bench_dsmc_case {
    const char *name;
    const char *text;           /* the scene; its grains fill the box and do not cool */
    uint32_t steps;             /* measured at a time */
};

struct bench_dsmc_result {
    double cpu, wall;           /* of the steps measured, seconds */
    double per_core;            /* particle-steps a processor second */
    double per_wall;            /* ... and a second of the wall clock */
    double bytes;               /* a grain, as the model asks for them */
    uint64_t digest;            /* of the state at the end */
};

extern const struct bench_dsmc_case bench_dsmc_list[];  /* ends with a NULL name */

enum { BENCH_DSMC_THREADS = 2 };

/* Runs the case on one thread and, if `both`, on two by turns; results[0] and [1] are the medians
 * over `rounds` turns.  The processor time is that of the whole process. */
bool bench_dsmc(const struct bench_dsmc_case *what, uint32_t rounds, bool both,
                struct bench_dsmc_result results[BENCH_DSMC_THREADS], struct error *error);

#endif
