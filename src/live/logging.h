/* logging.h - log.csv of a session: the rows that `sandreel run` writes of the same scene.
 *
 * A session that goes back takes the rows back, too, so in the end the table is that of the run
 * that scene.cfg describes; only its wall seconds are the session's own.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LOGGING_H
#define LOGGING_H

#include "run/logbook.h"

struct logging {
    struct logbook book;        /* book.ledger.stream NULL: the scene wants no log */
    struct grains  grains;      /* of the last row, where one needs them */
    double   interval, until;   /* of the scene at its start */
    uint64_t next;              /* the next row is due at next * interval */
};

/* A new log.csv of this simulation, with the row of the present if one is due. */
bool logging_open(struct logging *logging, const char *directory, const struct simulation *sim,
                  struct error *error);
void logging_close(struct logging *logging);

/* The simulated time of the next row; INFINITY: none. */
double logging_due(const struct logging *logging);

/* The row that is due; `wall` are the seconds spent on advancing. */
bool logging_row(struct logging *logging, const struct simulation *sim, double wall,
                 struct error *error);

/* Adds to a state what the log must know to go on from there. */
void logging_archive(struct logging *logging, struct archive *archive);

/* Takes back the rows that came after that state was saved. */
bool logging_return(struct logging *logging, const struct archive *state, struct error *error);

#endif
