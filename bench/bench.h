/* bench.h - repeatable timings of every core, of maps, drawing and encoding: one row a case.
 *
 * A case sets up what it needs, measures the rest, and tells one number; the caller repeats it and
 * takes the median.  Times are processor seconds of all threads, so a busy machine disturbs less.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef BENCH_H
#define BENCH_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

struct bench_result {
    double value;               /* in the case's unit */
    double cpu, wall;           /* seconds that were measured */
};

struct bench_case {
    const char *name, *doc, *unit;
    bool larger_is_better;
    bool (*measure)(const struct bench_case *which, struct bench_result *result,
                    struct error *error);
    const char *scene, *text;   /* what the measuring function needs: a scene, built in or text, */
    const char *set, *model;    /* with an override (NULL: none) and a model ... */
    double amount;              /* ... simulated time, a number of grains */
    bool per_grain;             /* work is steps times grains */
};

extern const struct bench_case bench_list[];    /* ends with a NULL name */

/* The median of `repeats` measurements. */
bool bench_measure(const struct bench_case *which, uint32_t repeats, struct bench_result *median,
                   struct error *error);

#endif
