/* map.h - field maps: grains coarse-grained on a grid, as a snapshot or a time average.
 *
 * Sums of mass, momentum and energy are gathered cell by cell with a normalised kernel (box,
 * Gauss, Lucy) and turned into fields at the end, so averages over time weight every grain
 * alike.  The granular temperature of an average is taken about the mean velocity of the cell
 * over the whole time; that of a snapshot about the velocity at that instant.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MAP_H
#define MAP_H

#include "base/archive.h"
#include "model/field.h"
#include "model/grains.h"
#include "scene/scene.h"

#include <stdbool.h>

/* X(name, components, dimension, label) */
#define MAPS(X)                                                                         \
    X(density,       1, "1/area",   "number density")                                   \
    X(area_fraction, 1, "1",        "area fraction")                                    \
    X(velocity,      2, "speed",    "velocity")                                         \
    X(speed,         1, "speed",    "speed of the mean flow")                           \
    X(temperature,   1, "speed^2",  "granular temperature")                             \
    X(spin_temperature, 1, "1/time^2", "granular temperature of rotation")              \
    X(collisions,    1, "1/time",   "collisions per grain and time")

enum map_kind {
#define X(name, components, dimension, label) MAP_##name,
    MAPS(X)
#undef X
    MAP_KINDS
};

struct map;

/* A grid over the scene's box with the settings of `measure` (cell, kernel, width). */
struct map *map_create(const struct scene *scene, const struct measure *measure,
                       struct error *error);
void map_destroy(struct map *map);

void map_clear(struct map *map);
void map_add(struct map *map, const struct grains *grains);     /* one snapshot more */

/* What was added so far, for a run that is interrupted within an average. */
void map_archive(struct map *map, struct archive *archive);

/* The field of one kind from all that was added.  `field` is created here, the caller frees. */
bool map_field(const struct map *map, enum map_kind kind, struct field *field,
               struct error *error);

int map_find(const char *name);         /* enum map_kind; -1 if there is none */

#endif
