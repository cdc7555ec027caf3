/* gauge.h - everything that can be plotted of a run, listed once: from its log and its tables, from
 * its frames, or by simulating again what it did not keep.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef GAUGE_H
#define GAUGE_H

#include "measure/chart.h"
#include "run/footage.h"

/* X(name, what it shows) */
#define GAUGES(X)                                                                               \
    X(energy,     "kinetic, rotational and potential energy against time (log.csv)")            \
    X(contacts,   "collisions of a grain against time, C/N (log.csv)")                          \
    X(flux,       "grains that leave per time (log.csv)")                                       \
    X(force,      "force on each obstacle, with its mean and error (log.csv)")                  \
    X(stress,     "stress carried by collisions and by flight against time (log.csv)")          \
    X(impact,     "impact parameters P(b/d) (impact.csv)")                                      \
    X(frequency,  "collision frequencies P(Nc) with fits (collisions.csv)")                     \
    X(scattering, "mass by angle on a screen (screen0.csv)")                                    \
    X(anisotropy, "(Kx - Ky)/K against time (frames)")                                          \
    X(structure,  "structure factor S(k) (at a time)")                                          \
    X(pair,       "pair correlation g(r) (at a time)")                                          \
    X(heap,       "profile of a heap and eq. 8 of the simplified models (at a time)")           \
    X(gap,        "area fraction before a round obstacle, and the gap (second half of the run)") \
    X(space_time, "density along the box against time, as a map (frames, or at the log's times)") \
    X(spectrum,   "power of the density in slabs against frequency (the same)")

struct gauge_job {
    const char *run;            /* its directory */
    const struct setup *setup;
    struct footage *footage;    /* open; from dumps, or a simulation at its start */
    double time;                /* NAN: the end */
    char   note[400];           /* out: numbers that go with the plot, for people; "": none */
};

struct gauge {
    const char *name, *doc;
    bool (*draw)(struct gauge_job *job, struct chart *chart, struct error *error);
    bool looks;                 /* needs grains: the footage must be open */
};

extern const struct gauge gauge_list[];         /* ends with a NULL name */

/* Fills the chart, which the caller frees in any case. */
bool gauge_draw(const struct gauge *gauge, struct gauge_job *job, struct chart *chart,
                struct error *error);

const struct gauge *gauge_find(const char *name);       /* '-' is '_'; NULL: none */

/* Names the axes with their units; "1": a plain number. */
void gauge_label_axes(const struct gauge_job *job, struct chart *chart, const char *x,
                      const char *x_dimension, const char *y, const char *y_dimension);

#endif
