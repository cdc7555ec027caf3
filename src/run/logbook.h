/* logbook.h - log.csv: one row each output.log interval, the same first columns for every model,
 * then what the scene measures.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LOGBOOK_H
#define LOGBOOK_H

#include "base/archive.h"
#include "model/simulation.h"
#include "run/ledger.h"

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
    struct ledger ledger;
    uint32_t body_count;
    bool     masses;            /* columns mass_in, mass_out */
    bool     counts;            /* C/N: some phase counts collisions */
    bool     stress;            /* some phase sums up the stress */
    double   time_last;         /* of the last row, for means since then */
    double  *impulse_last;      /* three for each obstacle: x, y, angular */
    double   stress_last[4];    /* collisional sums */
};

/* Creates the file with its header lines, or opens it for `ledger_resume`. */
bool logbook_open(struct logbook *logbook, const char *path, const struct simulation *sim,
                  bool resume, struct error *error);

/* `grains` shows the present; it is read only where `stress` is set. */
bool logbook_row(struct logbook *logbook, const struct simulation *sim,
                 const struct grains *grains, double wall, struct error *error);

void logbook_archive(struct logbook *logbook, struct archive *archive);
void logbook_close(struct logbook *logbook);

#endif
