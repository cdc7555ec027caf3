/* sweep.h - a parameter study: one run of this same program for each point, several at once.
 *
 * Every point is a process and a directory of its own, so a point that crashes takes nothing with
 * it, can be looked at, and can be resumed.  Several processes (shards, ranks) may work on one
 * study at the same time.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SWEEP_H
#define SWEEP_H

#include "run/plan.h"

#include <signal.h>

enum { SWEEP_ARGUMENTS_MAX = 700 };

struct sweep_status {
    uint32_t done, failed, running, all;        /* of this process's share; at the end: of all */
    int      rank;              /* which of several ranks this is; 0 speaks for all */
};

struct sweep_request {
    const struct plan *plan;
    const char *directory;
    const char *scene;          /* as for `run` */
    const char *const *arguments;       /* more for `run`, before those of the point */
    uint32_t argument_count;
    uint32_t parallel;          /* runs at a time; 0: as many as there are processors, 1 a rank */
    uint32_t shard, shards;     /* points whose number leaves `shard` when divided by `shards` */
    bool     resume, force;
    double   from;              /* means are over the time from here on */
    void   (*report)(void *context, const struct sweep_status *status);         /* may be NULL */
    void    *context;
    const volatile sig_atomic_t *signal;        /* may be NULL */
};

/* False if the study itself could not be done; points that failed are only counted.  After a
 * signal the runs were stopped with a checkpoint, and the code is 128 + signal. */
bool sweep_run(const struct sweep_request *request, struct sweep_status *status,
               struct error *error);

#endif
