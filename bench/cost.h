/* cost.h - what accuracy costs: the error of a scene's observables against wall time, for every
 * model, method and setting that can run it.
 *
 * An observable is a row of numbers that every model gives: the energy at some times, grains left,
 * the height of the centre of mass, ...  A setting is run with several seeds; its error is the
 * distance of its mean row from the mean row of the reference, as a share of that, and its
 * statistical error follows from the scatter of both over their seeds.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef COST_H
#define COST_H

#include "run/setup.h"

/* X(name, what it is) */
#define COST_OBSERVABLES(X)                                                             \
    X(energy,     "kinetic energy at 16 times")                                         \
    X(collisions, "collisions for each grain until 16 times")                                          \
    X(discharge,  "share of the grains that is left at 16 times")                                            \
    X(height,     "energy of height at 16 times")                                       \
    X(force,      "momentum given to obstacles until 16 times")                         \
    X(density,    "share of the grains in 6 x 6 fields of the box, over the second half")

enum cost_observable {
#define X(name, doc) COST_##name,
    COST_OBSERVABLES(X)
#undef X
    COST_COUNT
};

enum { COST_SEEDS_MAX = 16, COST_KEYS = 16, COST_KEY = 120, COST_POINTS_MAX = 40 };

/* A model with keys over the scene; made from cost_settings. */
struct cost_setting { const char *model, *keys; };

extern const struct cost_setting cost_settings[];       /* ends with a NULL model */

struct cost_point {
    char   label[COST_KEY];     /* "md md.dt=*2": a star is a factor on what the model chooses */
    uint32_t key_count;
    char   keys[COST_KEYS][COST_KEY];   /* as overrides, the model first */
    bool   ran, reference, front;       /* front: nothing is both faster and nearer */
    double wall;                /* seconds of the model, the least of the seeds */
    double errors[COST_COUNT], noise[COST_COUNT];       /* shares; NAN: not compared */
    double error, error_noise;  /* the largest of them, and its statistical error */
    char   why[200];            /* it did not run */
};

struct cost_request {
    const char *path;
    const char *const *overrides;
    uint32_t override_count, seeds;
    double   seconds;           /* a setting that takes longer is left out */
    void   (*report)(void *context, const struct cost_point *point);
    void    *context;
};

struct cost_table {
    char   scene[64], reference[COST_KEY];
    unsigned observables;       /* bits of enum cost_observable */
    bool   quick;
    uint32_t count, seeds;
    struct cost_point points[COST_POINTS_MAX];
};

/* Runs them all.  False if the scene cannot be read or no model can give a reference. */
bool cost_measure(const struct cost_request *request, struct cost_table *table,
                  struct error *error);

/* The fastest point whose error is at most `accuracy`; NULL if there is none. */
const struct cost_point *cost_fastest(const struct cost_table *table, double accuracy);

const char *cost_name(enum cost_observable observable);

/* Keys of one setting: factors on what the model chose become numbers.  False: the model has no
 * such value here, so the setting is none. */
bool cost_keys(const struct cost_setting *setting, const struct setup *chosen,
               struct cost_point *point);

#endif
