/* spectrum.h - the structure factor of grain positions by FFT (cooperative, section 3.3).
 *
 *     S(k) = |sum_j exp(-i k . r_j)|^2 / N
 *
 * The grains are put on a grid of M x M boxes, M the power of 2 that makes a box about one
 * diameter.  S is 1 for an ideal gas at every k; clusters show as an increase at small k.  The
 * grid is exact for wavelengths of many boxes and loses power, at most sinc^2 of half a box along
 * each axis, towards the shortest.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SPECTRUM_H
#define SPECTRUM_H

#include "base/error.h"
#include "model/grains.h"

#include <stdbool.h>
#include <stdint.h>

struct spectrum {
    uint32_t mx, my;            /* boxes along x and y */
    double   lx, ly;            /* sides of the region */
    uint32_t count;             /* grains in it */
    double  *factor;            /* S at (qx, qy), k = 2 pi (qx / lx, qy / ly): spectrum_at() */
    uint32_t shells;
    double  *wave_number;       /* mean of l / wavelength in a shell, l the longer side */
    double  *shell;             /* S averaged over the shell round(l / wavelength) */
    uint32_t *modes;            /* in a shell; 0: none, and S and wave number are NAN */
};

/* Grains outside the region x0 y0 x1 y1 are left out; it should be periodic.  `diameter` sets the
 * grid: at most 4096 boxes along a side.  The caller frees.  Not to be called from two threads at
 * once (FFTW plans). */
bool spectrum_structure_factor(const struct grains *grains, const double region[4],
                               double diameter, struct spectrum *spectrum, struct error *error);

/* S at the wave vector 2 pi (qx / lx, qy / ly), |qx| <= mx/2, |qy| <= my/2. */
double spectrum_at(const struct spectrum *spectrum, int qx, int qy);

void spectrum_free(struct spectrum *spectrum);

#endif
