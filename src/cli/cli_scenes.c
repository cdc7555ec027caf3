/* cli_scenes.c - `scenes`: what is built in, and which model can run it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "base/asset.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The name by which a built-in scene is called: "scenes/hard/ring.cfg" is "hard/ring". */
static bool scene_name(const struct asset *asset, char *name, size_t size)
{
    const size_t head = strlen("scenes/"), length = strlen(asset->name);
    if (strncmp(asset->name, "scenes/", head) != 0 || length < head + 5) return false;
    if (strcmp(asset->name + length - 4, ".cfg") != 0) return false;
    snprintf(name, size, "%.*s", (int)(length - head - 4), asset->name + head);
    return true;
}

static json_t *describe(const char *name, const struct scene *scene)
{
    json_t *able = json_array();
    for (const struct model *const *m = model_list; scene && *m; m++) {
        if (!(scene_effects(scene) & ~(*m)->effects)) {
            json_array_append_new(able, json_string((*m)->name));
        }
    }
    return json_pack("{s:s, s:s, s:s, s:o}", "name", name, "title", scene ? scene->title : "",
                     "model", scene ? scene->model : "", "models", able);
}

static void print_row(const char *name, const struct scene *scene)
{
    printf("%-18s", name);
    for (const struct model *const *m = model_list; *m; m++) {
        const bool able = scene && !(scene_effects(scene) & ~(*m)->effects);
        const bool own = scene && strcmp(scene->model, (*m)->name) == 0;
        printf(" %-5s", own ? "*" : able ? "x" : "-");
    }
    printf(" %s\n", scene ? scene->title : "(cannot be read)");
}

int cli_scenes(const struct options *options)
{
    const bool json = options_given(options, OPTION_json);
    const struct key_group *groups[MODEL_MAX];
    const uint32_t group_count = model_settings(groups);
    struct findings *findings = calloc(1, sizeof *findings);
    json_t *list = json_array();
    if (!json) {
        printf("%-18s", "scene");
        for (const struct model *const *m = model_list; *m; m++) printf(" %-5s", (*m)->name);
        printf("\n");
    }
    for (const struct asset *asset = asset_list; findings && asset->name; asset++) {
        char name[KEY_TEXT_MAX];
        if (!scene_name(asset, name, sizeof name)) continue;
        const struct scene_request request = {.path = name, .groups = groups,
                                              .group_count = group_count, .place = false};
        *findings = (struct findings){0};
        struct scene *scene = scene_load(&request, findings);
        if (json) json_array_append_new(list, describe(name, scene));
        else print_row(name, scene);
        if (scene) scene_free(scene);
    }
    free(findings);
    if (json) {
        json_dumpf(list, stdout, JSON_INDENT(4));
        printf("\n");
    } else {
        printf("\n* its own model, x can run it too, - lacks an effect (`sandreel check SCENE "
               "--model NAME` says which)\n`sandreel run SCENE --quick` runs the small form\n");
    }
    json_decref(list);
    return EXIT_DONE;
}
