/* parse.h - from the tree of what was written to the structs, through the key tables.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PARSE_H
#define PARSE_H

#include "scene/scene.h"
#include "scene/tree.h"

/* Fills `target` with every default of the group. */
void parse_defaults(const struct key_group *group, void *target);

/* Fills all parts of the scene (and its settings) from scene->places, telling every unknown key,
 * wrong type and broken limit.  False only if memory is short. */
bool parse_scene(struct scene *scene, struct findings *findings);

#endif
