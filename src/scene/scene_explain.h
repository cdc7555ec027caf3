/* scene_explain.h - the effects that a scene calls for (see scene_explain in scene.h).
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SCENE_EXPLAIN_H
#define SCENE_EXPLAIN_H

#include "scene/scene.h"

effects_t scene_explain_effects(const struct scene *scene);

#endif
