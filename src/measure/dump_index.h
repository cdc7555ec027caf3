/* dump_index.h - dump/index.csv: which frame belongs to which time, one line each.
 *
 * A line is appended and synced after the frame's files are whole, so every line names files that
 * are there; a last line that was torn by a crash is left out on reading.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DUMP_INDEX_H
#define DUMP_INDEX_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

struct dump_entry {
    uint32_t frame;             /* the number in the names of its files */
    double   time;
    uint64_t steps;
    uint32_t grains, contacts;
};

struct dump_index {
    uint32_t count, capacity;
    struct dump_entry *entries; /* in order of time */
};

/* Appends one line; writes the header line first into a new file. */
bool dump_index_append(const char *path, const struct dump_entry *entry, struct error *error);

/* Reads all whole lines; refuses what is not an index. */
bool dump_index_load(const char *path, struct dump_index *index, struct error *error);

/* Writes the whole index anew, as when a run resumes from before its last frames. */
bool dump_index_save(const char *path, const struct dump_index *index, struct error *error);

/* The entry nearest in time (NULL if there is none). */
const struct dump_entry *dump_index_nearest(const struct dump_index *index, double time);

void dump_index_free(struct dump_index *index);

#endif
