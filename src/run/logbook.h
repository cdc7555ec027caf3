/* logbook.h - log.csv: one row each output.log interval, the same first columns for every model.
 *
 * A row is written whole and flushed, so the file can be watched while it grows.  After a
 * checkpoint is loaded the file is cut back to the rows that the checkpoint knew.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LOGBOOK_H
#define LOGBOOK_H

#include "base/archive.h"
#include "model/simulation.h"

#include <stdio.h>

/* X(column, dimension) - each is a member of struct counters, except the last */
#define LOG_WHOLES(X)                                                                   \
    X(steps, "1") X(grains, "1") X(grains_in, "1") X(grains_out, "1")
#define LOG_ENERGIES(X)                                                                 \
    X(kinetic_energy, "energy") X(rotational_energy, "energy") X(potential_energy, "energy")
#define LOG_COLLISIONS(X)                                                               \
    X(collisions, "1") X(collisions_elastic, "1")
#define LOG_MOMENTA(X)                                                                  \
    X(momentum_x, "momentum") X(momentum_y, "momentum")
#define LOG_EXTRAS(X)                                                                   \
    X(overlap_max, "1")

struct logbook {
    FILE    *stream;
    char     path[4096];
    uint64_t size, rows;        /* bytes and rows that are safely written */
    uint32_t body_count;
    bool     masses;            /* columns mass_in, mass_out */
    bool     failed;            /* a half row may be in the file: closing cuts it off */
    double   time_last;         /* of the last row, for means since then */
    double  *impulse_last;      /* three for each obstacle: x, y, angular */
};

/* Creates the file with its header lines, or opens it for `logbook_resume`. */
bool logbook_open(struct logbook *logbook, const char *path, const struct simulation *sim,
                  bool resume, struct error *error);

/* Cuts the file back to what the loaded archive knew. */
bool logbook_resume(struct logbook *logbook, struct error *error);

bool logbook_row(struct logbook *logbook, const struct simulation *sim, double wall,
                 struct error *error);

/* Brings the file to the disk, before a checkpoint refers to it. */
bool logbook_sync(struct logbook *logbook, struct error *error);

void logbook_archive(struct logbook *logbook, struct archive *archive);
void logbook_close(struct logbook *logbook);

#endif
