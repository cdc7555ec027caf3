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

/* A scene that has run for a moment, so that effects can be taken out of it; NULL with an error. */
struct effects_probe;
struct effects_probe *effects_open(const struct setup_request *request, struct error *error);
void effects_close(struct effects_probe *probe);

/* What `effect`, which must be on, costs on that scene: its state goes on with it and without. */
bool effects_measure(struct effects_probe *probe, effects_t effect, struct effects_cost *cost,
                     struct error *error);

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
