/* distribution.h - how often a count occurs, as of collisions per grain and time, and which law it
 * follows (cooperative, sections 4.2 and 5).
 *
 *     Poisson, eq. 20      exp(-chi) chi^C / C!          uncorrelated events
 *     exponential, eq. 21  exp(-C/A) / A
 *     power, eq. 22        B / (B + C)^2                 cooperative motion: the mean diverges
 *
 * A law that is continuous is compared with whole numbers by its integral from C to C + 1.  Fits
 * are of maximum likelihood, so that empty bins count as they should.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DISTRIBUTION_H
#define DISTRIBUTION_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* X(name, equation of the paper) */
#define DISTRIBUTION_LAWS(X) X(poisson, 20) X(exponential, 21) X(power, 22)

enum distribution_law {
#define X(name, equation) DISTRIBUTION_##name,
    DISTRIBUTION_LAWS(X)
#undef X
    DISTRIBUTION_LAW_COUNT
};

struct distribution {
    uint32_t  bins;             /* counts 0 .. bins - 1; the last holds all larger ones too */
    uint64_t *times;            /* how often each count occurred */
    uint64_t  total;
    double    mean, variance;
};

struct distribution_fit {
    double parameter, error;    /* chi, A or B, in counts, with its error from the likelihood */
    double likelihood;          /* its logarithm, per observation: the largest fits best */
};

bool distribution_create(struct distribution *distribution, const uint32_t *counts,
                         uint32_t count, uint32_t bins, struct error *error);
void distribution_free(struct distribution *distribution);

/* The share of observations with the count c, and its error of counting. */
double distribution_share(const struct distribution *distribution, uint32_t c, double *error);

/* NANs where a law cannot be fitted (no observations, or all zero). */
struct distribution_fit distribution_fit(const struct distribution *distribution,
                                         enum distribution_law law);

/* The law that fits best. */
enum distribution_law distribution_best(const struct distribution *distribution);

/* The share that the law gives to the count c. */
double distribution_law_share(enum distribution_law law, double parameter, uint32_t c);

const char *distribution_law_name(enum distribution_law law);

#endif
