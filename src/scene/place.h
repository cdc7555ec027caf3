/* place.h - the grains that are there at the start.  SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PLACE_H
#define PLACE_H

#include "scene/scene.h"

/* Fills scene->placed from the placements; tells those that do not fit.  False after an error. */
bool place_grains(struct scene *scene, struct findings *findings);

/* The area that a placement may fill, and the box around it. */
double place_area(const struct scene *scene, const struct placement *placement);
void place_bounds(const struct scene *scene, const struct placement *placement, double bounds[4]);

#endif
