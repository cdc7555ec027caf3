/* effects.h - what each effect costs: time for a unit of a model's work, and memory.
 *
 * Two forms are run by turns from the same state, one with the effect and one without, so that a
 * busy machine disturbs both alike; the least of several repeats counts (processor seconds).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef EFFECTS_H
#define EFFECTS_H

#include "run/setup.h"

struct effects_cost {
    bool   measured;            /* false: the scene would be another one without it; see why */
    double with, without;       /* processor seconds for a unit of work */
    double bytes;               /* that it adds to the state */
    char   why[200];
};

/* What `effect` costs on the scene of `request`, which must be on: the scene runs for a moment,
 * then its state goes on with the effect and without it. */
bool effects_measure(const struct setup_request *request, effects_t effect,
                     struct effects_cost *cost, struct error *error);

/* One row of `bench --effects`. */
struct effects_row {
    const char *model, *work;
    char     name[40];          /* an effect's word, "none" or "all" */
    effects_t effects;          /* that were really on */
    double   seconds;           /* processor time for a unit of work */
    double   share;             /* of the time with none */
    double   bytes;             /* of the state, for a grain */
};

/* Times an elastic gas in a periodic box with nothing on, with each effect that the model can do
 * alone, and with all of them; `tell` gets the rows as they come. */
bool effects_bench(const struct model *model,
                   void (*tell)(void *context, const struct effects_row *row), void *context,
                   struct error *error);

#endif
