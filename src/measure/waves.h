/* waves.h - density along a pipe against time, and the spectrum of its fluctuations.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef WAVES_H
#define WAVES_H

#include "base/error.h"
#include "measure/stats.h"
#include "model/grains.h"

#include <stdbool.h>
#include <stdint.h>

struct waves {
    uint32_t slabs, room, count;        /* across the pipe; looks there is room for, and taken */
    double   low, high;         /* the range of y that is looked at ... */
    bool     level;             /* ... or of x; false from the start */
    bool     shared;            /* a grain counts in the two slabs nearest to it, by its distance
                                 * (the end ones keep all): lattices show no stripes; or false */
    double   interval;          /* between two looks */
    double  *density;           /* grains in a slab: density[look * slabs + slab] */
};

bool waves_create(struct waves *waves, double low, double high, uint32_t slabs, uint32_t looks,
                  double interval, struct error *error);
void waves_free(struct waves *waves);

/* The next look, at the list of grains or, where there is none, at the sample; more than there is
 * room for are passed over. */
void waves_add(struct waves *waves, const struct grains *grains);

/* Root mean square of the density of slabs about the mean of all, over that mean, from look `from`
 * on; without waves 1 / sqrt(grains in a slab), less where they exclude each other. */
double waves_contrast(const struct waves *waves, uint32_t from);

/* Power of the density in a slab at the frequencies k / (looks * interval), k = 1 .. count/2, mean
 * over all slabs, each series about its own mean and under a Hann window (without it what drifts
 * over the whole series leaks into all frequencies as 1/f^2).  *power is malloc'ed, the caller
 * frees; *bins is their number, *step the frequency of the first. */
bool waves_spectrum(const struct waves *waves, uint32_t from, double **power, uint32_t *bins,
                    double *step, struct error *error);

/* Slope of ln power over ln frequency between two frequencies, evenly in ln frequency: power is
 * first averaged in bins of a factor of 1.1. */
struct stats_line waves_exponent(const double *power, uint32_t bins, double step, double from,
                                 double to);

#endif
