/* cost_row.h - the observables by which settings are compared, as rows of numbers of one run.
 *
 * All of them come from what every model gives: counters, the grains, impulses on obstacles.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef COST_ROW_H
#define COST_ROW_H

#include "model/simulation.h"

/* How far a row is from that of the reference. */
enum cost_measure {
    COST_OF_EACH,               /* rms over the numbers of difference / reference */
    COST_OF_ALL,                /* |difference| / |reference|, the row being a vector */
    COST_OF_LENGTH              /* rms of the way in diameters */
};

/* X(name, measure, what it is) */
#define COST_OBSERVABLES(X)                                                                 \
    X(energy,     COST_OF_EACH,   "kinetic energy at 16 times")                             \
    X(collisions, COST_OF_ALL,    "collisions of a grain until 16 times")                   \
    X(discharge,  COST_OF_ALL,    "share of the grains past the gate or out, at 16 times")  \
    X(rate,       COST_OF_ALL,    "share of the grains that pass the gate in a time")       \
    X(height,     COST_OF_ALL,    "energy of height at 16 times")                           \
    X(slope,      COST_OF_ALL,    "tan of the angle of the heap at the end")                \
    X(force,      COST_OF_ALL,    "mean force on each obstacle, over the second half")      \
    X(structure,  COST_OF_ALL,    "S(k) of the 36 longest waves, over the second half")     \
    X(density,    COST_OF_ALL,    "share of the grains in 6 x 6 fields, over the second half") \
    X(path,       COST_OF_LENGTH, "where the first 18 grains are at the end, in diameters")

enum cost_observable {
#define X(name, measure, doc) COST_##name,
    COST_OBSERVABLES(X)
#undef X
    COST_COUNT
};

enum { COST_TIMES = 16, COST_SIDE = 6, COST_ROW = COST_SIDE * COST_SIDE };

struct cost_rows {
    double values[COST_COUNT][COST_ROW];        /* zero where a row is shorter */
    double wall, cpu;           /* seconds of the model alone */
};

const char *cost_row_name(enum cost_observable observable);
enum cost_measure cost_row_measure(enum cost_observable observable);

/* The observables that the scene names, or that suit it; 0 with an error for an unknown word. */
unsigned cost_row_chosen(const struct scene *scene, struct error *error);

/* One run to the end.  False if it broke, or would not end within `seconds`. */
bool cost_row_run(const struct model *model, const struct scene *scene, unsigned observables,
                  double seconds, struct cost_rows *rows, struct error *error);

#endif
