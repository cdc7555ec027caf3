/* setup.c - see setup.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/setup.h"

#include "base/file.h"
#include "run/recall.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool setup_is_run(const char *path)
{
    char name[FILE_PATH_MAX];
    snprintf(name, sizeof name, "%s/scene.cfg", path);
    if (!file_exists(name)) return false;
    snprintf(name, sizeof name, "%s/manifest.json", path);
    return file_exists(name);
}

/* What the model cannot do is a finding about the key `model`, like any other mistake. */
static void compare_effects(struct setup *setup)
{
    const struct scene *scene = setup->scene;
    for (uint32_t p = 0; p < scene->phase_count; p++) {
        const effects_t missing = scene->phases[p]->effects & ~setup->model->effects;
        if (!missing) continue;
        char words[400], able[200];
        effect_words(missing, words, sizeof words);
        model_names(scene->phases[p]->effects, able, sizeof able);
        findings_tell(setup->findings, scene, FINDING_ERROR, "model",
            "model '%s' cannot do %s; models that can run this scene: %s; choose one of them or "
            "take it out of the scene", setup->model->name, words, able);
        return;
    }
}

static void resolve(struct setup *setup)
{
    struct scene *scene = setup->scene;
    setup->model = model_find(scene->model);
    if (!setup->model) {
        char names[200];
        model_names(0, names, sizeof names);
        findings_tell(setup->findings, scene, FINDING_ERROR, "model",
                      "unknown model '%s'; models: %s", scene->model, names);
        return;
    }
    compare_effects(setup);
    if (setup->findings->errors || !setup->model->resolve) return;
    setup->model->resolve(scene, setup->findings);
    for (uint32_t p = 1; p < scene->phase_count; p++) {
        setup->model->resolve(scene->phases[p], setup->findings);
    }
}

/* A run's scene keeps the name of the scene it was made from, not that of its file scene.cfg. */
static bool keep_name(struct setup *setup, const char *run, struct error *error)
{
    json_t *manifest = recall_manifest(run, error);
    if (!manifest) return false;
    const char *name = json_string_value(json_object_get(manifest, "scene"));
    for (uint32_t p = 0; name && p < setup->scene->phase_count; p++) {
        struct scene *scene = setup->scene->phases[p];
        snprintf(scene->name, sizeof scene->name, "%s", name);
    }
    json_decref(manifest);
    return true;
}

bool setup_load(struct setup *setup, const struct setup_request *request, struct error *error)
{
    *setup = (struct setup){0};
    setup->findings = calloc(1, sizeof *setup->findings);
    if (!setup->findings) return error_set(error, "not enough memory to read a scene");
    const struct key_group *groups[MODEL_MAX];
    char inside[FILE_PATH_MAX];
    struct scene_request wanted = {
        .path = request->path, .text = request->text, .overrides = request->overrides,
        .override_count = request->override_count, .groups = groups,
        .group_count = model_settings(groups), .place = request->place,
        .grains_of = request->grains_of,
    };
    const bool is_run = setup_is_run(request->path);
    if (is_run && !request->text) {
        snprintf(inside, sizeof inside, "%s/scene.cfg", request->path);
        wanted.path = inside;
    }
    setup->scene = scene_load(&wanted, setup->findings);
    if (!setup->scene && setup->findings->errors == 0) {
        return error_set(error, "%s: not enough memory to read this scene", request->path);
    }
    if (setup->scene && is_run && !keep_name(setup, request->path, error)) return false;
    if (setup->scene) resolve(setup);
    if (setup->scene && setup->findings->errors == 0) return true;
    return error_set_code(error, EXIT_SCENE, "%s: %u error%s, %u warning%s", request->path,
        setup->findings->errors, setup->findings->errors == 1 ? "" : "s",
        setup->findings->warnings, setup->findings->warnings == 1 ? "" : "s");
}

void setup_free(struct setup *setup)
{
    if (setup->scene) scene_free(setup->scene);
    free(setup->findings);
    *setup = (struct setup){0};
}
