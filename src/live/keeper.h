/* keeper.h - states kept in memory, one each interval of simulated time, to go back to.
 *
 * Their bytes are bounded: when there are too many, every second one is dropped and the interval
 * doubles.  When they are taken depends on simulated time alone, so a session that is repeated
 * keeps the same ones.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef KEEPER_H
#define KEEPER_H

#include "live/logging.h"

struct keeper_state { double time; uint32_t phase; uint64_t turn; struct archive archive; };

struct keeper {
    uint32_t count, capacity;
    struct keeper_state *states;        /* in the order of time */
    struct logging *logging;    /* how far it was is kept with each state */
    size_t   bytes;
    double   interval, start;
    uint64_t next;              /* the next one is due at start + next * interval */
};

/* The first state kept is the present one. */
bool keeper_open(struct keeper *keeper, const struct simulation *sim, struct logging *logging,
                 double interval, struct error *error);
void keeper_close(struct keeper *keeper);

double keeper_due(const struct keeper *keeper);

/* Keeps the state, which is the one that is due. */
bool keeper_keep(struct keeper *keeper, const struct simulation *sim, struct error *error);

/* The last state before `time`, or the first if there is none. */
const struct keeper_state *keeper_before(const struct keeper *keeper, double time);

/* Forgets what comes after this state, which is now the present. */
void keeper_rewind(struct keeper *keeper, const struct keeper_state *state);

#endif
