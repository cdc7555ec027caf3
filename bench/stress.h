/* stress.h - hard cases: scenes that say themselves what must hold while they run.
 *
 * A case is a scene with a group `stress` (scene.h).  Each entry of `stress.models` is one run: a
 * model's name and keys that this run sets.  Every look compares all that the scene asks for; the
 * first thing that does not hold ends the run, with the grain, the place and the time.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef BENCH_STRESS_H
#define BENCH_STRESS_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* X(name, what is compared with its bound) - the value is the worst of all looks */
#define STRESS_CHECKS(X)                                                                \
    X(mass,      "grains that are missing or too many, as a share of all")              \
    X(inside,    "centres outside of a solid border or of `within`, in radii")          \
    X(momentum,  "change of the momentum")                                              \
    X(rises,     "rise of the sum of energies")                                         \
    X(keeps,     "change of the sum of energies")                                       \
    X(overlap,   "largest overlap")                                                     \
    X(grains,    "grains at the end")                                                   \
    X(left,      "kinetic energy at the end over that at the start")                    \
    X(travel,    "mean way, in diameters")                                              \
    X(collides,  "collisions")                                                          \
    X(work,      "steps, events or ticks")                                              \
    X(positions, "difference from the second run, in diameters")                        \
    X(energies,  "difference of the kinetic energy from that of the second run")        \
    X(ends,      "the run ends as it must")

enum stress_check {
#define X(name, doc) STRESS_CHECK_##name,
    STRESS_CHECKS(X)
#undef X
    STRESS_CHECKS_COUNT
};

struct stress_value {
    bool   asked;               /* the scene asks for it */
    double worst, low, high;    /* must lie from low to high; NAN: no such limit */
};

enum { STRESS_RUN_MAX = 256 };

struct stress_result {
    char   run[STRESS_RUN_MAX]; /* "ed ed.t_c=0" */
    bool   passed;
    struct stress_value values[STRESS_CHECKS_COUNT];
    enum stress_check tightest; /* the check that came nearest to its limit, or the one that failed */
    char   why[700];            /* what does not hold, which grain, where, when; "" if passed */
    double wall, cpu;           /* seconds */
    uint64_t steps;
};

/* How many runs the case makes, and whether it is a slow one.  0 with an error: no such scene, or
 * no case. */
uint32_t stress_runs(const char *scene, bool *slow, struct error *error);

/* Makes run number `index` of the case.  False only if it could not be tried at all; whether it
 * passed is in the result. */
bool stress_try(const char *scene, uint32_t index, struct stress_result *result,
                struct error *error);

/* The names of the built-in cases; NULL past the last. */
const char *stress_name(uint32_t index, char *name, size_t size);

const char *stress_check_name(enum stress_check check);
const char *stress_check_doc(enum stress_check check);

/* How near the value is to its limit: 0 far, 1 at it, more: it does not hold. */
double stress_strain(const struct stress_value *value);

#endif
