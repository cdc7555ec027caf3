/* run.h - a whole run: advance, look, measure, draw, write, until the end or a good reason.
 *
 * Prints nothing: progress and warnings go to callbacks.  What it does beside the model never
 * changes the model's state: a run that is watched, interrupted and resumed, or encoded by more
 * threads ends with the same bytes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef RUN_H
#define RUN_H

#include "model/model.h"
#include "run/parts.h"

#include <signal.h>

struct run_status {
    const char *doing;          /* "simulating", "drawing" */
    const char *work;           /* what a unit of work is called: "particle-steps" */
    double   time, until;
    double   share;             /* done, 0..1 */
    double   rate;              /* units of work a wall second, lately */
    double   eta;               /* wall seconds left; NAN: unknown */
    double   wall;              /* seconds since the start */
    uint64_t steps, grains, frames;
};

struct run_request {
    const struct scene *scene;
    const struct model *model;
    const char *directory;
    bool     force, resume;
    double   time_limit;        /* wall seconds; 0: none */
    uint32_t threads;           /* encoder threads beside the simulation */
    void   (*report)(void *context, const struct run_status *status);  /* often; may be NULL */
    void   (*warn)(void *context, const char *text);                    /* may be NULL */
    void    *context;
    const volatile sig_atomic_t *signal;        /* becomes a signal's number; may be NULL */
};

struct run_result {
    bool was_done;              /* resumed, but done before: nothing below is known */
    struct counters counters;   /* at the end */
    struct parts parts;
    double   cpu_encode, wall;
    effects_t effects;          /* of all phases */
    double   span, work;        /* simulated time and steps, events, ticks of this run */
    uint64_t digest, frames, maps, log_rows;
    double   range[2];          /* of the colours */
};

/* Wall seconds of a part; of encoders, which run beside the others, processor seconds. */
double run_part_seconds(const struct run_result *result, enum part part);

/* Error codes: EXIT_FAILED, EXIT_USAGE (directory), EXIT_STOPPED (time limit), EXIT_INTERRUPT,
 * EXIT_TERMINATED; in the last three a checkpoint is kept and the error says how to go on. */
bool run_scene(const struct run_request *request, struct run_result *result,
               struct error *error);

#endif
