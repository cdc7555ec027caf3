/* waves.c - see waves.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/waves.h"

#include <assert.h>
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>

bool waves_create(struct waves *waves, double low, double high, uint32_t slabs, uint32_t looks,
                  double interval, struct error *error)
{
    assert(high > low);
    assert(slabs > 0);
    *waves = (struct waves){.slabs = slabs, .room = looks, .low = low, .high = high,
                            .interval = interval};
    waves->density = calloc((size_t)slabs * looks + 1, sizeof *waves->density);
    return waves->density || error_set(error, "not enough memory for %u looks at %u slabs", looks,
                                       slabs);
}

void waves_free(struct waves *waves)
{
    free(waves->density);
    *waves = (struct waves){0};
}

static void add(const struct waves *waves, double place, double number, double *now)
{
    const double at = (place - waves->low) / (waves->high - waves->low) * waves->slabs;
    if (!(at >= 0 && at < waves->slabs)) return;
    if (!waves->shared) {
        now[(uint32_t)at] += number;
        return;
    }
    /* Between the middles of two slabs; before the first and behind the last they are the same. */
    const double middle = fmax(0, fmin(at - 0.5, waves->slabs - 1));
    const uint32_t lower = (uint32_t)middle;
    const uint32_t upper = lower + 1 < waves->slabs ? lower + 1 : lower;
    now[lower] += (1 - (middle - lower)) * number;
    now[upper] += (middle - lower) * number;
}

void waves_add(struct waves *waves, const struct grains *grains)
{
    if (waves->count == waves->room) return;
    double *now = waves->density + (size_t)waves->count++ * waves->slabs;
    const struct field *sample = &grains->sample;
    if (sample->values) {
        for (size_t k = 0; k < (size_t)sample->nx * sample->ny; k++) {
            const size_t cell = waves->level ? k % sample->nx : k / sample->nx;
            const double start = waves->level ? sample->x0 : sample->y0;
            add(waves, start + ((double)cell + 0.5) * sample->cell, sample->values[k], now);
        }
        return;
    }
    const double *place = waves->level ? grains->x : grains->y;
    for (uint32_t i = 0; i < grains->count; i++) add(waves, place[i], 1, now);
}

double waves_contrast(const struct waves *waves, uint32_t from)
{
    double sum = 0, squares = 0, n = 0;
    for (size_t k = (size_t)from * waves->slabs; k < (size_t)waves->count * waves->slabs; k++) {
        sum += waves->density[k];
        squares += waves->density[k] * waves->density[k];
        n++;
    }
    return sqrt(fmax(0, squares / n - sum / n * (sum / n))) / (sum / n);
}

/* The series of one slab about its mean, under the window. */
static void take_series(const struct waves *waves, uint32_t slab, uint32_t from, uint32_t count,
                        double *out)
{
    double mean = 0;
    for (uint32_t k = 0; k < count; k++) {
        mean += waves->density[(size_t)(from + k) * waves->slabs + slab] / count;
    }
    for (uint32_t k = 0; k < count; k++) {
        const double window = 1 - cos(2 * M_PI * (k + 0.5) / count);
        out[k] = window * (waves->density[(size_t)(from + k) * waves->slabs + slab] - mean);
    }
}

bool waves_spectrum(const struct waves *waves, uint32_t from, double **power, uint32_t *bins,
                    double *step, struct error *error)
{
    const uint32_t count = waves->count > from ? waves->count - from : 0;
    *bins = count / 2;
    *step = 1 / (count * waves->interval);
    *power = NULL;
    if (*bins < 2) return error_set(error, "a spectrum needs at least four looks");
    double *series = fftw_alloc_real(count);
    fftw_complex *modes = fftw_alloc_complex(count / 2 + 1);
    *power = calloc(*bins, sizeof **power);
    fftw_plan plan = series && modes ? fftw_plan_dft_r2c_1d((int)count, series, modes,
                                                            FFTW_ESTIMATE) : NULL;
    const bool done = plan && *power;
    for (uint32_t slab = 0; done && slab < waves->slabs; slab++) {
        take_series(waves, slab, from, count, series);
        fftw_execute(plan);
        for (uint32_t k = 1; k <= *bins; k++) {
            const double re = modes[k][0], im = modes[k][1];
            (*power)[k - 1] += (re * re + im * im) / (count * (double)waves->slabs);
        }
    }
    if (plan) fftw_destroy_plan(plan);
    fftw_free(modes);
    fftw_free(series);
    if (done) return true;
    free(*power);
    *power = NULL;
    return error_set(error, "not enough memory for a spectrum of %u looks", count);
}

struct stats_line waves_exponent(const double *power, uint32_t bins, double step, double from,
                                 double to)
{
    enum { POINTS = 200 };
    static const double factor = 1.1;
    double x[POINTS], y[POINTS];
    size_t count = 0;
    for (double low = from; low * factor <= to * (1 + 1e-9) && count < POINTS; low *= factor) {
        double sum = 0, n = 0;
        for (uint32_t k = (uint32_t)ceil(low / step); k < low * factor / step && k <= bins; k++) {
            if (k == 0) continue;
            sum += power[k - 1];
            n++;
        }
        if (!(n > 0) || !(sum > 0)) continue;
        x[count] = log(low * sqrt(factor));
        y[count++] = log(sum / n);
    }
    return stats_line(x, y, count);
}
