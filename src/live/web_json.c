/* web_json.c - see web_json.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/web_json.h"

#include "live/command.h"
#include "live/sight.h"
#include "run/jsontext.h"
#include "run/manifest.h"
#include "scene/scene_value.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static char *text_of(json_t *root)
{
    char *text = jsontext_dump(root, JSON_COMPACT | JSON_REAL_PRECISION(9) | JSON_ENSURE_ASCII);
    json_decref(root);
    return text;
}

char *web_json_status(const struct stage_status *status, const struct transform *transform)
{
    const struct counters *now = &status->counters;
    json_t *root = json_object();
    json_object_set_new(root, "time", number(now->time));
#define X(name, ...) json_object_set_new(root, #name, number((double)now->name));
    COUNTERS(X)
    QUANTITIES(X)
#undef X
    json_object_set_new(root, "until", number(status->until));
    json_object_set_new(root, "speed", number(status->speed));
    json_object_set_new(root, "rate", number(status->rate));
    json_object_set_new(root, "running", json_boolean(status->running));
    if (transform) {
        json_object_set_new(root, "scale", number(transform->scale));
        json_object_set_new(root, "x0", number(transform->x0));
        json_object_set_new(root, "y1", number(transform->y1));
    }
    return text_of(root);
}

char *web_json_reply(bool ok, const char *text)
{
    return text_of(json_pack("{s:b, s:o}", "ok", ok, "text", manifest_text(text)));
}

static json_t *words(const char *choices)
{
    json_t *list = json_array();
    while (choices && *choices) {
        const size_t length = strcspn(choices, "|");
        json_array_append_new(list, json_stringn(choices, length));
        choices += length + (choices[length] == '|');
    }
    return list;
}

static json_t *commands(void)
{
    json_t *list = json_array();
    for (int verb = 0; verb < COMMAND_COUNT; verb++) {
        char usage[200];
        command_usage((enum command_verb)verb, usage, sizeof usage);
        json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "name", command_table[verb].name,
                                              "usage", usage, "doc", command_table[verb].doc));
    }
    return list;
}

static json_t *keys_of_the_keyboard(void)
{
    json_t *list = json_array();
    for (const struct command_key *key = command_keys; key->name; key++) {
        json_array_append_new(list, json_pack("{s:s%, s:s, s:s, s:s, s:s}", "key", &key->key,
            (size_t)1, "name", key->name, "running", key->running, "resting", key->resting, "doc",
            key->doc));
    }
    return list;
}

static json_t *maps(void)
{
    json_t *list = json_array();
#define X(name, components, dimension, label) json_array_append_new(list, json_string(#name));
    MAPS(X)
#undef X
    return list;
}

void web_json_about(void *context, struct session *session)
{
    const struct scene *scene = session_scene(session);
    const struct key *color, *colormap;
    const void *value;
    scene_value_find(scene, "view.color", &color, &value);
    scene_value_find(scene, "view.colormap", &colormap, &value);
    json_t *root = json_pack("{s:o, s:o, s:s, s:s, s:s, s:o, s:f, s:o}", "name",
        manifest_text(scene->name), "title", manifest_text(scene->title), "model",
        session->sim.model->name, "work", session->sim.model->work, "time_unit",
        scene_unit(scene, "time"), "directory", manifest_text(session->directory), "radius",
        scene->radius_mean, "path", manifest_text(session->timeline.path));
    json_t *overrides = json_array();
    for (uint32_t k = 0; k < session->origin.overrides.count; k++) {
        json_array_append_new(overrides,
                              manifest_text(session->origin.overrides.texts[k]));
    }
    json_object_set_new(root, "overrides", overrides);
    json_object_set_new(root, "speed", number(session->speed));
    json_object_set_new(root, "commands", commands());
    json_object_set_new(root, "keyboard", keys_of_the_keyboard());
    json_object_set_new(root, "colors", words(color->choices));
    json_object_set_new(root, "colormaps", words(colormap->choices));
    json_object_set_new(root, "maps", maps());
    *(char **)context = text_of(root);
}

/* ---- keys --------------------------------------------------------------------------------- */

/* What cannot change while it runs, or does nothing in a session. */
static bool is_fixed(const char *path)
{
    static const char *const heads[] = {"placements.", "phases.", "output.", "box", "seed", "quick",
                                        "count_max", "units", "until", "model", "title"};
    for (size_t k = 0; k < sizeof heads / sizeof *heads; k++) {
        if (strncmp(path, heads[k], strlen(heads[k])) == 0) return true;
    }
    return strncmp(path, "grains.", 7) == 0 && strstr(path, ".radi");
}

struct key_list { json_t *list; bool look, failed; const char *model; };

/* A model's settings concern its own simulations. */
static bool concerns(const struct key_list *list, const char *path)
{
    for (const struct model *const *m = model_list; *m; m++) {
        const size_t length = strlen((*m)->name);
        if (strncmp(path, (*m)->name, length) != 0 || path[length] != '.') continue;
        return strcmp((*m)->name, list->model) == 0;
    }
    return (strncmp(path, "view.", 5) == 0) == list->look;
}

static void add_key(void *context, const char *path, const struct key *key, const void *value)
{
    struct key_list *list = context;
    if (is_fixed(path) || !concerns(list, path)) return;
    if (list->look && strncmp(path, "view.", 5) != 0) return;
    char *text;
    if (!scene_write_value(key, value, &text)) {
        list->failed = true;
        return;
    }
    json_t *entry = json_pack("{s:s, s:s, s:s, s:s, s:o?, s:o?}", "path", path, "doc", key->doc,
        "unit", key->unit ? key->unit : "", "type", key_type_word(key->type),
        "low", fabs(key->low) < 1e30 ? number(key->low) : NULL,
        "high", fabs(key->high) < 1e30 ? number(key->high) : NULL);
    if (text) json_object_set_new(entry, "text", manifest_text(text));
    if (key->type == KEY_REAL && text) {
        json_object_set_new(entry, "number", number(*(const double *)value));
    }
    if (key->choices) json_object_set_new(entry, "choices", words(key->choices));
    json_array_append_new(list->list, entry);
    free(text);
}

void web_json_keys(void *context, struct session *session)
{
    struct key_list list = {.list = json_array(), .model = session->sim.model->name};
    scene_value_each(session->sim.phase_scene, add_key, &list);
    list.look = true;
    scene_value_each(sight_scene(session), add_key, &list);
    char *text = text_of(list.list);
    if (list.failed) {
        free(text);
        text = NULL;
    }
    *(char **)context = text;
}
