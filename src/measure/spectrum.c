/* spectrum.c - see spectrum.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/spectrum.h"

#include <assert.h>
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>

static const double side_max = 4096;

/* The power of 2 that is nearest to `ratio` on a logarithmic scale. */
static uint32_t power_nearest(double ratio)
{
    return (uint32_t)fmin(side_max, fmax(2, exp2(round(log2(fmax(1, ratio))))));
}

static uint32_t half(const struct spectrum *spectrum) { return spectrum->mx / 2 + 1; }

/* Counts the grains of each box. */
static void put_on_grid(const struct grains *grains, const double region[4],
                        struct spectrum *spectrum, double *grid)
{
    const uint32_t mx = spectrum->mx, my = spectrum->my;
    for (size_t k = 0; k < (size_t)mx * my; k++) grid[k] = 0;
    for (uint32_t k = 0; k < grains->count; k++) {
        const double fx = (grains->x[k] - region[0]) / spectrum->lx * mx;
        const double fy = (grains->y[k] - region[1]) / spectrum->ly * my;
        if (!(fx >= 0 && fx <= mx && fy >= 0 && fy <= my)) continue;
        const uint32_t ix = (uint32_t)fx % mx, iy = (uint32_t)fy % my;
        grid[(size_t)iy * mx + ix] += 1;
        spectrum->count++;
    }
}

/* Wave vectors of the right half, each for itself and its mirror image -k; the columns qx = 0 and
 * mx/2 hold both already. */
static void average_shells(struct spectrum *spectrum)
{
    const double longer = fmax(spectrum->lx, spectrum->ly);
    for (uint32_t iy = 0; iy < spectrum->my; iy++) {
        for (uint32_t ix = 0; ix < half(spectrum); ix++) {
            const double qy = iy <= spectrum->my / 2 ? iy : (double)iy - spectrum->my;
            const double number = longer * hypot(ix / spectrum->lx, qy / spectrum->ly);
            const uint32_t s = (uint32_t)(number + 0.5);
            const uint32_t modes = ix == 0 || ix == spectrum->mx / 2 ? 1 : 2;
            if (s >= spectrum->shells || (ix == 0 && iy == 0)) continue;
            spectrum->shell[s] += modes * spectrum->factor[(size_t)iy * half(spectrum) + ix];
            spectrum->wave_number[s] += modes * number;
            spectrum->modes[s] += modes;
        }
    }
    for (uint32_t s = 0; s < spectrum->shells; s++) {
        spectrum->shell[s] /= spectrum->modes[s];       /* 0 / 0 is the NAN that is promised */
        spectrum->wave_number[s] /= spectrum->modes[s];
    }
}

static bool allocate(struct spectrum *spectrum)
{
    const size_t modes = (size_t)half(spectrum) * spectrum->my;
    spectrum->factor = calloc(modes, sizeof *spectrum->factor);
    spectrum->wave_number = calloc(spectrum->shells, sizeof *spectrum->wave_number);
    spectrum->shell = calloc(spectrum->shells, sizeof *spectrum->shell);
    spectrum->modes = calloc(spectrum->shells, sizeof *spectrum->modes);
    return spectrum->factor && spectrum->wave_number && spectrum->shell && spectrum->modes;
}

bool spectrum_structure_factor(const struct grains *grains, const double region[4],
                               double diameter, struct spectrum *spectrum, struct error *error)
{
    const double lx = region[2] - region[0], ly = region[3] - region[1];
    assert(lx > 0);
    assert(ly > 0);
    assert(diameter > 0);
    *spectrum = (struct spectrum){.lx = lx, .ly = ly, .mx = power_nearest(lx / diameter),
                                  .my = power_nearest(ly / diameter)};
    /* Up to the shorter Nyquist wave number a shell is a whole ring. */
    const double nyquist = fmax(lx, ly) * fmin(spectrum->mx / lx, spectrum->my / ly) / 2;
    spectrum->shells = (uint32_t)nyquist + 1;
    const size_t boxes = (size_t)spectrum->mx * spectrum->my;
    const size_t modes = (size_t)half(spectrum) * spectrum->my;
    double *grid = fftw_alloc_real(boxes);
    fftw_complex *waves = fftw_alloc_complex(modes);
    fftw_plan plan = NULL;
    bool done = grid && waves && allocate(spectrum);
    if (done) {
        plan = fftw_plan_dft_r2c_2d((int)spectrum->my, (int)spectrum->mx, grid, waves,
                                    FFTW_ESTIMATE);
        done = plan != NULL;
    }
    if (done) {
        put_on_grid(grains, region, spectrum, grid);
        fftw_execute(plan);
        for (size_t k = 0; k < modes; k++) {
            const double re = waves[k][0], im = waves[k][1];
            spectrum->factor[k] = (re * re + im * im) / fmax(1, spectrum->count);
        }
        average_shells(spectrum);
    }
    if (plan) fftw_destroy_plan(plan);
    fftw_free(waves);
    fftw_free(grid);
    if (done) return true;
    const uint32_t mx = spectrum->mx, my = spectrum->my;
    spectrum_free(spectrum);
    return error_set(error, "not enough memory for a structure factor on %u x %u boxes", mx, my);
}

double spectrum_at(const struct spectrum *spectrum, int qx, int qy)
{
    if (qx < 0) qx = -qx, qy = -qy;             /* S(-k) = S(k) */
    assert((uint32_t)qx <= spectrum->mx / 2);
    assert((uint32_t)abs(qy) <= spectrum->my / 2);
    const uint32_t row = qy < 0 ? spectrum->my - (uint32_t)-qy : (uint32_t)qy;
    return spectrum->factor[(size_t)row * half(spectrum) + (uint32_t)qx];
}

void spectrum_free(struct spectrum *spectrum)
{
    free(spectrum->factor);
    free(spectrum->wave_number);
    free(spectrum->shell);
    free(spectrum->modes);
    *spectrum = (struct spectrum){0};
}
