/* check.h - what no table row can tell: keys that contradict each other or the geometry.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CHECK_SCENE_H
#define CHECK_SCENE_H

#include "scene/scene.h"

/* Tells everything that is wrong with the scene before anything is placed. */
void check_scene(const struct scene *scene, struct findings *findings);

/* Tells phases that are out of order, and what their overrides do wrong. */
void check_phases(const struct scene *scene, struct findings *findings);

/* Tells of phase `phase` (1 ..) what was found in its own scene and not in the whole one. */
void check_phase_findings(const struct scene *scene, uint32_t phase, const struct findings *own,
                          struct findings *findings);

/* Grains that the placements will make, about (the exact number where `count` says it). */
double check_placed_estimate(const struct scene *scene);

#endif
