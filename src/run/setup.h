/* setup.h - from what the user names to a scene with its model: load, resolve, compare effects.
 *
 * The scene knows no models and a model knows no files; here they meet, so that `check` tells
 * everything at once: the scene's findings, the model's, and what the model cannot do.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SETUP_H
#define SETUP_H

#include "model/model.h"
#include "scene/scene.h"

struct setup {
    struct scene       *scene;
    const struct model *model;
    struct findings    *findings;       /* kept whether it worked or not */
};

struct setup_request {
    const char *path;           /* a scene file, a built-in scene, or a run directory */
    const char *text;           /* or the scene itself (path is then only its name); NULL */
    const char *const *overrides;
    uint32_t override_count;
    bool place;                 /* place the grains: needed to simulate, not to draw dumps */
    const struct scene *grains_of;      /* or take over those of another scene; NULL */
};

/* EXIT_SCENE if the scene has errors: then setup->findings tells them, and the error only counts
 * them.  Call setup_free() in both cases. */
bool setup_load(struct setup *setup, const struct setup_request *request, struct error *error);
void setup_free(struct setup *setup);

/* Does this directory hold a run (a scene.cfg and a manifest.json)? */
bool setup_is_run(const char *path);

#endif
