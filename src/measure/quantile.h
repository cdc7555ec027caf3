/* quantile.h - percentiles of numbers too many to keep, as of all speeds of a run.
 *
 * A histogram whose bins are the leading bits of a double: 128 bins in each factor of two, so a
 * percentile is right to 1/256 (0.4 %) of its value whatever the range.  Counts are whole numbers:
 * neither the order of adding nor the way of merging changes the answer.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef QUANTILE_H
#define QUANTILE_H

#include "base/archive.h"
#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How far quantile_at() may be from the truth, as a share of it. */
#define QUANTILE_RESOLUTION (1.0 / 256)

struct quantile {
    uint64_t  count;            /* of numbers added; NANs are passed over */
    double    low, high;        /* the smallest and largest, exact */
    uint64_t *positive;         /* bins of values >= 0 */
    uint64_t *negative;         /* bins of |value| of values < 0 */
};

bool quantile_create(struct quantile *quantile, struct error *error);
void quantile_free(struct quantile *quantile);

void quantile_add(struct quantile *quantile, double value);

/* As if everything that `other` was given had been added here. */
void quantile_merge(struct quantile *quantile, const struct quantile *other);

/* The value that the share p (0..1) of all numbers does not exceed; NAN if there are none. */
double quantile_at(const struct quantile *quantile, double p);

/* Saves, loads and hashes the bins in use, so that a run that resumes keeps its ranges. */
void quantile_archive(struct quantile *quantile, struct archive *archive);

#endif
