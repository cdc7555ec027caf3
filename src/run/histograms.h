/* histograms.h - impact.csv and collisions.csv: what a model gathers while it runs, as tables.
 *
 * Each block of rows covers one interval of output.tallies, or the whole run.
 * impact.csv: P(b/d), normalised over 0 to 1 (cooperative, section 3.2).  collisions.csv: how many
 * grains had just so many contacts (with grains and walls), and so many elastic ones, between the
 * two times (cooperative, section 4.3); a contact of two grains counts for both of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef HISTOGRAMS_H
#define HISTOGRAMS_H

#include "model/simulation.h"
#include "run/ledger.h"

/* Contacts that a grain had when the last block was written. */
struct histograms_grain { uint32_t contacts, elastic; };

struct histograms {
    struct ledger impact, collisions;   /* no stream: not asked for */
    double   from;              /* end of the last block */
    uint32_t bins;
    double  *before;            /* the tally's impact parameters then */
    uint32_t known_count;       /* by id: grains that were there */
    struct histograms_grain *known;
};

/* Opens what some phase of the scene asks for. */
bool histograms_open(struct histograms *histograms, const char *directory,
                     const struct simulation *sim, bool resume, struct error *error);

/* Is anything asked for? */
bool histograms_wanted(const struct histograms *histograms);

/* Writes a block for the time since the last one. */
bool histograms_block(struct histograms *histograms, const struct simulation *sim,
                      const struct grains *grains, struct error *error);

bool histograms_resume(struct histograms *histograms, struct error *error);
bool histograms_sync(struct histograms *histograms, struct error *error);
void histograms_archive(struct histograms *histograms, struct archive *archive);
void histograms_close(struct histograms *histograms);

#endif
