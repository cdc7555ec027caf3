/* cost.h - what accuracy costs: the error of a scene's observables against wall time, for every
 * model, method and setting that can run it.
 *
 * An observable is a row of numbers that every model gives (cost_row.h).  A setting is run with
 * several seeds, each from the same grains as the reference of that seed.  Its error is the mean
 * distance from the reference, seed by seed, and its statistical error follows from the scatter
 * of that distance.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef COST_H
#define COST_H

#include "bench/cost_row.h"
#include "run/setup.h"

enum { COST_SEEDS_MAX = 16, COST_KEYS = 8, COST_KEY = 120, COST_POINTS_MAX = 48 };

struct cost_point {
    char   label[COST_KEY];     /* "md md.dt=*2": a star is a factor on what the model chooses */
    uint32_t key_count;
    char   keys[COST_KEYS][COST_KEY];   /* as overrides, the model first */
    bool   ran, reference, front;       /* front: nothing is both faster and nearer */
    bool   cached;              /* all its seeds were known already */
    uint32_t seeds;             /* that were run */
    double wall, cpu;           /* seconds of the model, the least of the seeds */
    double errors[COST_COUNT], noise[COST_COUNT];       /* NAN: not compared */
    double error, error_noise;  /* the largest of them, and its statistical error */
    double step;                /* of time; NAN: the model takes none */
    char   why[200];            /* it did not run */
};

/* error ~ step^power for one kind of integrator, from the points that stand out of their noise. */
struct cost_order { char label[COST_KEY]; uint32_t points; double power, power_error; };

struct cost_request {
    const char *path;
    const char *const *overrides;
    uint32_t override_count;
    uint32_t seeds;             /* of each setting; 0: as many as a quarter of `seconds` allows */
    double   seconds;           /* a setting that takes longer is left out */
    const char *cache;          /* directory of references; NULL: none are kept */
    void   (*report)(void *context, const struct cost_point *point);
    void    *context;
};

enum { COST_ORDERS_MAX = 4 };

struct cost_table {
    char   scene[64], reference[COST_KEY];
    uint64_t hash;              /* of the scene as the request gives it (cost_cache.h) */
    unsigned observables;       /* bits of enum cost_observable */
    bool   quick;
    uint32_t count, order_count;
    uint32_t seeds;             /* of the reference: no setting has more */
    struct cost_point points[COST_POINTS_MAX];
    struct cost_order orders[COST_ORDERS_MAX];
};

/* Runs them all.  False if the scene cannot be read or no model can give a reference. */
bool cost_measure(const struct cost_request *request, struct cost_table *table,
                  struct error *error);

/* The fastest point whose error is at most `accuracy`; NULL if there is none. */
const struct cost_point *cost_fastest(const struct cost_table *table, double accuracy);

#endif
