/* quantile.c - see quantile.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/quantile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bits of a double below sign, exponent and the 7 leading bits of the fraction. */
enum { REST_BITS = 45, BINS = 2048 << 7 };

static uint32_t bin_of(double magnitude)
{
    uint64_t bits;
    memcpy(&bits, &magnitude, sizeof bits);
    return (uint32_t)(bits >> REST_BITS);
}

/* The middle of a bin: half its width is 1/256 of the power of two it starts from. */
static double bin_middle(uint32_t bin)
{
    if (bin == 0) return 0;
    const uint64_t bits = ((uint64_t)bin << REST_BITS) | (uint64_t)1 << (REST_BITS - 1);
    double middle;
    memcpy(&middle, &bits, sizeof middle);
    return middle;
}

bool quantile_create(struct quantile *quantile, struct error *error)
{
    *quantile = (struct quantile){.low = INFINITY, .high = -INFINITY};
    quantile->positive = calloc(2 * (size_t)BINS, sizeof *quantile->positive);
    if (!quantile->positive) return error_set(error, "not enough memory for a histogram");
    quantile->negative = quantile->positive + BINS;
    return true;
}

void quantile_free(struct quantile *quantile)
{
    free(quantile->positive);
    *quantile = (struct quantile){0};
}

void quantile_add(struct quantile *quantile, double value)
{
    if (isnan(value)) return;
    if (value < 0) quantile->negative[bin_of(-value)]++;
    else quantile->positive[bin_of(fabs(value))]++;
    quantile->count++;
    if (value < quantile->low) quantile->low = value;
    if (value > quantile->high) quantile->high = value;
}

void quantile_merge(struct quantile *quantile, const struct quantile *other)
{
    for (uint32_t k = 0; k < BINS; k++) {
        quantile->positive[k] += other->positive[k];
        quantile->negative[k] += other->negative[k];
    }
    quantile->count += other->count;
    quantile->low = fmin(quantile->low, other->low);
    quantile->high = fmax(quantile->high, other->high);
}

double quantile_at(const struct quantile *quantile, double p)
{
    if (quantile->count == 0) return NAN;
    /* p = 0.29 of 100 is the 29th, though 0.29 * 100 rounds to more than 29. */
    const double share = fmax(0, fmin(1, p)) * (1 - 1e-12);
    const uint64_t rank = (uint64_t)ceil(share * (double)quantile->count);
    if (rank <= 1) return quantile->low;
    if (rank >= quantile->count) return quantile->high;
    /* From the smallest upwards: negative values by falling magnitude, then the others.  Bins below
     * that of the smallest are empty and passed over. */
    uint64_t seen = 0;
    double value = 0;
    if (quantile->low < 0) {
        for (uint32_t k = bin_of(-quantile->low) + 1; k-- > 0 && seen < rank;) {
            seen += quantile->negative[k];
            value = -bin_middle(k);
        }
    }
    for (uint32_t k = quantile->low > 0 ? bin_of(quantile->low) : 0; k < BINS && seen < rank; k++) {
        seen += quantile->positive[k];
        value = bin_middle(k);
    }
    return fmax(quantile->low, fmin(quantile->high, value));
}

void quantile_archive(struct quantile *quantile, struct archive *archive)
{
    /* Only the bins between the first and the last in use travel. */
    uint32_t first = 0, last = 2 * BINS;
    uint64_t *bins = quantile->positive;
    while (first < last && bins[first] == 0) first++;
    while (last > first && bins[last - 1] == 0) last--;
    uint32_t used = last - first;
    archive_value(archive, "quantile.count", &quantile->count);
    archive_value(archive, "quantile.low", &quantile->low);
    archive_value(archive, "quantile.high", &quantile->high);
    archive_count(archive, "quantile.first", &first, 2 * BINS);
    archive_count(archive, "quantile.used", &used, 2 * BINS);
    if (archive->mode == ARCHIVE_LOAD) {
        memset(bins, 0, 2 * (size_t)BINS * sizeof *bins);
        if (used > 2 * BINS - first) {
            archive_fail(archive, "the histogram does not fit");
            return;
        }
    }
    archive_array(archive, "quantile.bins", bins + first, used);
}
