/* footage.h - grains at a time, from a run's dumps or simulated on the fly: what frame, movie and
 * map draw from, without asking which.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FOOTAGE_H
#define FOOTAGE_H

#include "model/simulation.h"
#include "run/dumps.h"
#include "run/run.h"
#include "run/setup.h"

struct footage {
    const struct setup *setup;
    bool     from_dumps;
    struct dumps dumps;
    struct simulation sim;
    bool     contacts;          /* look at contacts too */
    struct grains grains;       /* as of the last footage_go */
    uint64_t steps;             /* likewise */
    uint32_t entry;             /* of the dumps, likewise */
    double   wall;              /* seconds spent on advancing so far; NAN from dumps */
    void   (*report)(void *context, const struct run_status *status);   /* may be NULL */
    void    *context;
    const volatile sig_atomic_t *signal;        /* may be NULL */
};

/* Is there a run with dumps at `path`? */
bool footage_has_dumps(const char *path);

/* `path` is what the setup was loaded from: a run directory with dumps is read, anything else
 * simulated.  Set report, context and signal afterwards. */
bool footage_open(struct footage *footage, const struct setup *setup, const char *path,
                 bool contacts, struct error *error);

/* Brings footage->grains to time t: the nearest frame of the dumps, or simulated up to it (never
 * backwards). */
bool footage_go(struct footage *footage, double t, struct error *error);

/* The end: the last frame of the dumps, or the scene's. */
double footage_end(const struct footage *footage);

void footage_close(struct footage *footage);

#endif
