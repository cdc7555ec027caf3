/* strip.h - snapshots in a row: several times, or several scenes, in one colour scale.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STRIP_H
#define STRIP_H

#include "figure/lab.h"
#include "run/film.h"

enum { STRIP_PANELS = 8 };

struct strip {
    uint32_t count, films;
    struct film film[STRIP_PANELS];             /* one for each lab */
    const struct lab *lab[STRIP_PANELS];        /* of each film */
    struct { uint32_t film; struct grains grains; uint64_t steps; } panels[STRIP_PANELS];
};

void strip_begin(struct strip *strip);

/* The next panel: what the lab last looked at, drawn as its scene's `view` says.  The strip takes
 * the grains away from the lab, which must stay open until the strip is saved. */
bool strip_add(struct strip *strip, struct lab *lab, struct error *error);

/* Draws all panels side by side.  Frees in any case. */
bool strip_save(struct strip *strip, const char *path, struct error *error);

void strip_free(struct strip *strip);

#endif
