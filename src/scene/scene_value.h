/* scene_value.h - the keys of a resolved scene with their values, one by one: what a live session
 * tells and offers as sliders.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SCENE_VALUE_H
#define SCENE_VALUE_H

#include "scene/scene.h"

/* Calls `visit` for every key: its path ("grains.[0].restitution", "md.dt"), its row, its value. */
void scene_value_each(const struct scene *scene,
                      void (*visit)(void *context, const char *path, const struct key *key,
                                    const void *value), void *context);

/* The row and the value of a path; "grains.restitution" for the only entry of a list will do.
 * False if there is no such key. */
bool scene_value_find(const struct scene *scene, const char *path, const struct key **key,
                      const void **value);

/* As a scene file would say it: *text, which the caller frees; NULL if it stands for "chosen when
 * absent" or "never".  False if memory is short. */
bool scene_write_value(const struct key *key, const void *value, char **text);

#endif
