/* distribution.c - see distribution.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/distribution.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static const double smallest_share = 1e-300;    /* its logarithm is still a number */

bool distribution_create(struct distribution *distribution, const uint32_t *counts,
                         uint32_t count, uint32_t bins, struct error *error)
{
    assert(bins > 0);
    *distribution = (struct distribution){.bins = bins, .total = count};
    distribution->times = calloc(bins, sizeof *distribution->times);
    if (!distribution->times) return error_set(error, "not enough memory for a distribution");
    double sum = 0, squares = 0;
    for (uint32_t k = 0; k < count; k++) {
        distribution->times[counts[k] < bins ? counts[k] : bins - 1]++;
        sum += counts[k];
        squares += (double)counts[k] * counts[k];
    }
    distribution->mean = sum / count;
    distribution->variance = squares / count - distribution->mean * distribution->mean;
    return true;
}

void distribution_free(struct distribution *distribution)
{
    free(distribution->times);
    *distribution = (struct distribution){0};
}

double distribution_share(const struct distribution *distribution, uint32_t c, double *error)
{
    const double total = (double)distribution->total;
    const double times = c < distribution->bins ? (double)distribution->times[c] : 0;
    if (error) *error = sqrt(fmax(1, times)) / total;
    return times / total;
}

double distribution_law_share(enum distribution_law law, double parameter, uint32_t c)
{
    const double p = parameter;
    switch (law) {
    case DISTRIBUTION_poisson: return exp(c * log(p) - p - lgamma(c + 1.0));
    case DISTRIBUTION_exponential: return exp(-(double)c / p) * -expm1(-1 / p);
    case DISTRIBUTION_power: return p / ((p + c) * (p + c + 1));
    case DISTRIBUTION_LAW_COUNT: break;
    }
    return NAN;
}

/* What the last bin holds: all counts from c on. */
static double tail_share(enum distribution_law law, double p, uint32_t c)
{
    double sum = 0;
    switch (law) {
    case DISTRIBUTION_poisson:
        for (uint32_t k = 0; k < c; k++) sum += distribution_law_share(law, p, k);
        return 1 - sum;
    case DISTRIBUTION_exponential: return exp(-(double)c / p);
    case DISTRIBUTION_power: return p / (p + c);
    case DISTRIBUTION_LAW_COUNT: break;
    }
    return NAN;
}

static double likelihood(const struct distribution *d, enum distribution_law law, double p)
{
    double sum = 0;
    for (uint32_t c = 0; c < d->bins; c++) {
        if (d->times[c] == 0) continue;
        const double share = c + 1 < d->bins ? distribution_law_share(law, p, c)
                                             : tail_share(law, p, c);
        sum += (double)d->times[c] * log(fmax(smallest_share, share));
    }
    return sum / (double)d->total;
}

/* The likelihood has one maximum in the logarithm of the parameter: golden section. */
static double maximum(const struct distribution *d, enum distribution_law law)
{
    const double golden = 0.6180339887498949;
    double low = log(1e-4), high = log(10 * (double)d->bins + 10);
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double fa = likelihood(d, law, exp(a)), fb = likelihood(d, law, exp(b));
    while (high - low > 1e-9) {
        if (fa > fb) {
            high = b, b = a, fb = fa;
            a = high - golden * (high - low);
            fa = likelihood(d, law, exp(a));
        } else {
            low = a, a = b, fa = fb;
            b = low + golden * (high - low);
            fb = likelihood(d, law, exp(b));
        }
    }
    return exp(0.5 * (low + high));
}

struct distribution_fit distribution_fit(const struct distribution *distribution,
                                         enum distribution_law law)
{
    struct distribution_fit fit = {NAN, NAN, NAN};
    if (distribution->total == 0 || !(distribution->mean > 0)) return fit;
    const double p = maximum(distribution, law);
    fit.parameter = p;
    fit.likelihood = likelihood(distribution, law, p);
    /* The curvature of the whole likelihood is 1 / error^2; h is wide enough for its rounding. */
    const double h = 1e-3 * p;
    const double curvature = (likelihood(distribution, law, p + h) - 2 * fit.likelihood
                              + likelihood(distribution, law, p - h)) / (h * h);
    fit.error = 1 / sqrt(-curvature * (double)distribution->total);
    return fit;
}

enum distribution_law distribution_best(const struct distribution *distribution)
{
    enum distribution_law best = DISTRIBUTION_poisson;
    double most = -INFINITY;
    for (int law = 0; law < DISTRIBUTION_LAW_COUNT; law++) {
        const double l = distribution_fit(distribution, (enum distribution_law)law).likelihood;
        if (!(l > most)) continue;
        most = l;
        best = (enum distribution_law)law;
    }
    return best;
}

const char *distribution_law_name(enum distribution_law law)
{
    static const char *const names[] = {
#define X(name, equation) #name,
        DISTRIBUTION_LAWS(X)
#undef X
    };
    return names[law];
}
