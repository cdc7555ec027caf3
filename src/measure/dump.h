/* dump.h - the grains of one frame as a NumPy file, so that pictures, maps and plots can be made
 * again without simulating again.
 *
 * dump/000012.npy holds one record a grain (`numpy.load(f)["x"]`), dump/000012.contacts.npy one a
 * contact; times and counts of all frames are in dump/index.csv (dump_index.h).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DUMP_H
#define DUMP_H

#include "base/error.h"
#include "model/grains.h"

#include <stdbool.h>

/* X(field of struct grains, C type, NumPy type), in the order of the record; packed */
#define DUMP_FIELDS(X)                          \
    X(id,             uint32_t, "<u4")          \
    X(x,              double,   "<f8")          \
    X(y,              double,   "<f8")          \
    X(vx,             double,   "<f8")          \
    X(vy,             double,   "<f8")          \
    X(angle,          double,   "<f8")          \
    X(spin,           double,   "<f8")          \
    X(radius,         double,   "<f8")          \
    X(mass,           double,   "<f8")          \
    X(collision_rate, float,    "<f4")          \
    X(species,        uint16_t, "<u2")

/* The grains; arrays that are NULL are written as zeros. */
bool dump_save(const char *path, const struct grains *grains, struct error *error);

/* The contacts; i, j are entries of the same frame's grains file, j = 0x40000000 + w for wall w. */
bool dump_save_contacts(const char *path, const struct grains *grains, struct error *error);

/* Reads a frame into new arrays (the caller frees with grains_free).  `contacts_path` may be NULL.
 * The time is not in the files: set grains->time from the index. */
bool dump_load(const char *path, const char *contacts_path, struct grains *grains,
               struct error *error);

#endif
