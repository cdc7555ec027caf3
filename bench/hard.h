/* hard.h - hard cases: scenes that say themselves what must hold while they run.
 *
 * A case is a scene with a group `hard` (scene.h).  Each entry of `hard.models` is one run: a
 * model's name and keys that this run sets.  Every look compares all that the scene asks for; the
 * first thing that does not hold ends the run, with the grain, the place and the time.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef HARD_H
#define HARD_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* X(name, what is compared with its bound) - the value is the worst of all looks */
#define HARD_CHECKS(X)                                                                \
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

enum hard_check {
#define X(name, doc) HARD_CHECK_##name,
    HARD_CHECKS(X)
#undef X
    HARD_CHECKS_COUNT
};

struct hard_value {
    bool   asked;               /* the scene asks for it */
    double worst, low, high;    /* must lie from low to high; NAN: no such limit */
};

enum { HARD_RUN_MAX = 256 };

struct hard_result {
    char   run[HARD_RUN_MAX]; /* "ed ed.t_c=0" */
    bool   passed;
    struct hard_value values[HARD_CHECKS_COUNT];
    enum hard_check tightest; /* the check that came nearest to its limit, or the one that failed */
    char   why[700];            /* what does not hold, which grain, where, when; "" if passed */
    double wall, cpu;           /* seconds */
    uint64_t steps;
};

/* How many runs the case makes, and whether it is a slow one.  0 with an error: no such scene, or
 * no case. */
uint32_t hard_runs(const char *scene, bool *slow, struct error *error);

/* Makes run number `index` of the case.  False only if it could not be tried at all; whether it
 * passed is in the result. */
bool hard_try(const char *scene, uint32_t index, struct hard_result *result,
                struct error *error);

/* The names of the built-in cases; NULL past the last. */
const char *hard_name(uint32_t index, char *name, size_t size);

const char *hard_check_name(enum hard_check check);
const char *hard_check_doc(enum hard_check check);

/* How near the value is to its limit: 0 far, 1 at it, more: it does not hold. */
double hard_strain(const struct hard_value *value);

#endif
