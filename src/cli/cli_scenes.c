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
    for (const struct model *const *m = model_list; *m; m++) {
        if (!(scene_effects(scene) & ~(*m)->effects)) {
            json_array_append_new(able, json_string((*m)->name));
        }
    }
    return json_pack("{s:s, s:s, s:s, s:o}", "name", name, "title", scene->title,
                     "model", scene->model, "models", able);
}

static void print_row(const char *name, const struct scene *scene)
{
    printf("%-18s", name);
    for (const struct model *const *m = model_list; *m; m++) {
        const bool able = !(scene_effects(scene) & ~(*m)->effects);
        const bool own = strcmp(scene->model, (*m)->name) == 0;
        printf(" %-5s", own ? "*" : able ? "x" : "-");
    }
    printf(" %s\n", scene->title);
}

/* The scenes proper, or the hard cases: a row of each, or an entry of `list` if that is given. */
static bool tell_scenes(bool hard, json_t *list, struct error *error)
{
    const struct key_group *groups[MODEL_MAX];
    const uint32_t group_count = model_settings(groups);
    struct findings *findings = calloc(1, sizeof *findings);
    bool done = findings || error_set(error, "not enough memory to read a scene");
    for (const struct asset *asset = asset_list; done && asset->name; asset++) {
        char name[KEY_TEXT_MAX];
        if (!scene_name(asset, name, sizeof name)) continue;
        if (hard != (strncmp(name, "hard/", strlen("hard/")) == 0)) continue;
        const struct scene_request request = {.path = name, .groups = groups,
                                              .group_count = group_count, .place = false};
        *findings = (struct findings){0};
        struct scene *scene = scene_load(&request, findings);
        done = scene || error_set(error, "%s: %s", name, findings->count > 0
                                  ? findings->list[0].text : "not enough memory to read it");
        if (!done) break;
        if (list) json_array_append_new(list, describe(name, scene));
        else print_row(name, scene);
        scene_free(scene);
    }
    free(findings);
    return done;
}

static bool tell_json(struct error *error)
{
    json_t *list = json_array();
    const bool done = tell_scenes(false, list, error) && tell_scenes(true, list, error);
    if (done) json_dumpf(list, stdout, JSON_INDENT(4));
    if (done) printf("\n");
    json_decref(list);
    return done;
}

int cli_scenes(const struct options *options)
{
    struct error error = {0};
    if (options_given(options, OPTION_json)) {
        return tell_json(&error) ? EXIT_DONE : opening_fail(&error);
    }
    printf("%-18s", "scene");
    for (const struct model *const *m = model_list; *m; m++) printf(" %-5s", (*m)->name);
    printf("\n");
    bool done = tell_scenes(false, NULL, &error);
    printf("\nhard cases (`sandreel stress` runs them all):\n");
    done = done && tell_scenes(true, NULL, &error);
    if (!done) return opening_fail(&error);
    printf("\n* its own model, x can run it too, - lacks an effect (`sandreel check SCENE "
           "--model NAME` says which)\n`sandreel run SCENE --quick` runs the small form\n");
    return EXIT_DONE;
}
