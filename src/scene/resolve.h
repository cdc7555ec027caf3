/* resolve.h - what follows from the keys: flat walls, radii, capacity.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RESOLVE_H
#define RESOLVE_H

#include "scene/scene.h"

/* Fills scene->walls from borders, walls and obstacles.  Entries that make no wall are left out
 * (check tells them). */
bool resolve_walls(struct scene *scene);

/* The smallest, the largest and the mean radius over the species that occur. */
void resolve_radii(struct scene *scene);

/* Most grains that there will ever be, from what is placed and what the sources bring: no more
 * than the box can hold. */
uint32_t resolve_count_max(const struct scene *scene, double placed);

/* The species called `name` ("" is the first); species_count if there is none. */
uint32_t resolve_species(const struct scene *scene, const char *name);

/* The largest and the mean radius of a species, and its mean area. */
double resolve_radius_max(const struct species *species);
double resolve_radius_min(const struct species *species);
double resolve_radius_mean(const struct species *species);
double resolve_area_mean(const struct species *species);

#endif
