/* dumps.h - the frames of a run as grains: written while it runs, read to draw them again.
 *
 * They are read from RUN/dump, or where a run has none from its trajectory.h5; who reads does not
 * see which.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DUMPS_H
#define DUMPS_H

#include "measure/dump_index.h"
#include "model/grains.h"

struct h5md_read;

struct dumps {
    char directory[4096];       /* RUN/dump */
    struct dump_index index;
    struct h5md_read *trajectory;       /* read instead of the directory; NULL: not */
};

/* Did the run keep grains, one way or the other? */
bool dumps_kept(const char *run);

/* For writing: makes the directory; keeps the first `frames` entries of an index that is there. */
bool dumps_begin(struct dumps *dumps, const char *run, uint64_t frames, struct error *error);

/* Writes the next frame, with its contacts if the grains have any. */
bool dumps_add(struct dumps *dumps, const struct grains *grains, uint64_t steps,
               struct error *error);

/* For reading.  False if the run kept no grains. */
bool dumps_open(struct dumps *dumps, const char *run, struct error *error);

/* Loads entry number k into `grains` (freed first). */
bool dumps_load(const struct dumps *dumps, uint32_t k, struct grains *grains,
                struct error *error);

/* Number of the entry nearest to t. */
uint32_t dumps_nearest(const struct dumps *dumps, double t);

void dumps_close(struct dumps *dumps);

#endif
