/* source.h - grains at a time, from a run's dumps or simulated on the fly: what frame, movie and map
 * draw from, without asking which. */
#ifndef SOURCE_H
#define SOURCE_H

#include "model/simulation.h"
#include "run/dumps.h"
#include "run/run.h"
#include "run/setup.h"

struct source {
    const struct setup *setup;
    bool     from_dumps;
    struct dumps dumps;
    struct simulation sim;
    bool     contacts;          /* look at contacts too */
    struct grains grains;       /* as of the last source_go */
    uint64_t steps;             /* likewise */
    uint32_t entry;             /* of the dumps, likewise */
    double   wall;              /* seconds spent on advancing so far; NAN from dumps */
    void   (*report)(void *context, const struct run_status *status);   /* may be NULL */
    void    *context;
    const volatile sig_atomic_t *signal;        /* may be NULL */
};

/* `path` is what the setup was loaded from: a run directory with dumps is read, anything else
 * simulated.  Set report, context and signal afterwards. */
bool source_open(struct source *source, const struct setup *setup, const char *path,
                 bool contacts, struct error *error);

/* Brings source->grains to time t: the nearest frame of the dumps, or simulated up to it (never
 * backwards). */
bool source_go(struct source *source, double t, struct error *error);

/* The end: the last frame of the dumps, or the scene's. */
double source_end(const struct source *source);

void source_close(struct source *source);

#endif
