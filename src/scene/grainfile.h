/* grainfile.h - grains that another program has written: CSV, LAMMPS dumps and LAMMPS data.
 *
 * The kind is found from the text.  CSV: a line of names, then numbers; lines with # are passed
 * over.  A dump (`ITEM: ...`): its last snapshot.  A data file: the sections Atoms (styles atomic
 * and sphere) and Velocities.  Only what lies in the plane is taken; unknown columns are passed
 * over.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GRAINFILE_H
#define GRAINFILE_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* X(id) - what is known of a grain */
#define GRAINFILE_VALUES(X) \
    X(id) X(species) X(x) X(y) X(vx) X(vy) X(spin) X(radius)

enum {
#define X(name) GRAINFILE_##name,
    GRAINFILE_VALUES(X)
#undef X
    GRAINFILE_VALUE_COUNT
};

struct grainfile {
    uint32_t count, capacity;
    double (*rows)[GRAINFILE_VALUE_COUNT];      /* in the order of their ids, where there are any */
    bool     has[GRAINFILE_VALUE_COUNT];        /* otherwise the values are 0 */
    bool     has_box;
    double   box[4];            /* x0 y0 x1 y1 */
};

/* Species count from 0, LAMMPS's types (from 1) too.  The caller frees, in both cases. */
bool grainfile_load(const char *path, struct grainfile *file, struct error *error);
void grainfile_free(struct grainfile *file);

#endif
