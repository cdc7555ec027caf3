/* scene.c - from a file, a built-in scene or a text to the resolved scene.
 *
 * Read the text into a tree, lay quick_set and the overrides over it, parse the tree through the
 * key tables, derive what follows, check, place.  A phase is the same text read once more with
 * the overrides of the phases up to it; it shares the placed grains of the whole scene.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scene/scene.h"

#include "base/asset.h"
#include "base/file.h"
#include "scene/check.h"
#include "scene/override.h"
#include "scene/parse.h"
#include "scene/place.h"
#include "scene/resolve.h"
#include "scene/scene_explain.h"
#include "scene/tree.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE_MAX = 64 << 20, PHASES_MAX = 1000 };

struct source_text {
    const char *text;
    char *owned;                /* to be freed; NULL if borrowed */
    char path[KEY_TEXT_MAX];    /* as the user named it; `file` says where it really is */
    char file[KEY_TEXT_MAX], folder[KEY_TEXT_MAX], name[KEY_TEXT_MAX];
};

/* ---- the text ------------------------------------------------------------------------------ */

/* "hourglass", "hard/cradle"; with another folder it is built in only if there is such a scene. */
static bool names_builtin(const char *path)
{
    if (strstr(path, ".cfg")) return false;
    char name[KEY_TEXT_MAX];
    snprintf(name, sizeof name, "scenes/%.200s.cfg", path);
    return !strchr(path, '/') || strncmp(path, "hard/", 5) == 0 || asset_find(name);
}

/* The built-in scene whose name is closest; NULL if none is close. */
static const char *nearest_builtin(const char *name, char nearest[64])
{
    static const char folder[] = "scenes/";
    uint32_t best = 4;
    nearest[0] = 0;
    for (const struct asset *asset = asset_list; asset->name; asset++) {
        if (strncmp(asset->name, folder, strlen(folder)) != 0) continue;
        char plain[64];
        snprintf(plain, sizeof plain, "%s", asset->name + strlen(folder));
        plain[strcspn(plain, ".")] = 0;
        const uint32_t distance = key_distance(name, plain);
        if (distance >= best) continue;
        best = distance;
        memcpy(nearest, plain, sizeof plain);
    }
    return nearest[0] ? nearest : NULL;
}

static void name_parts(struct source_text *source, const char *path)
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    snprintf(source->name, sizeof source->name, "%s", base);
    char *end = strrchr(source->name, '.');
    if (end && end != source->name) *end = 0;
    snprintf(source->folder, sizeof source->folder, "%.*s", slash ? (int)(slash - path) : 1,
             slash ? path : ".");
    snprintf(source->path, sizeof source->path, "%s", path);
    snprintf(source->file, sizeof source->file, "%s", path);
}

static bool read_text(struct source_text *source, const struct scene_request *request,
                      struct findings *findings)
{
    const char *path = request->path ? request->path : "scene";
    if (strlen(path) >= KEY_TEXT_MAX) {
        findings_tell_at(findings, FINDING_ERROR, path, 0, "this path is longer than %d bytes",
                         KEY_TEXT_MAX - 1);
        return false;
    }
    name_parts(source, path);
    source->text = request->text;
    if (source->text) return true;
    if (names_builtin(path)) {
        char name[KEY_TEXT_MAX];
        snprintf(name, sizeof name, "scenes/%.200s.cfg", path);
        const struct asset *asset = asset_find(name);
        if (asset) {
            source->text = (const char *)asset->bytes;
            memcpy(source->file, name, strlen(name) + 1);
            return true;
        }
        if (!file_exists(path)) {
            char close[64];
            const char *nearest = nearest_builtin(path, close);
            findings_tell_at(findings, FINDING_ERROR, path, 0, "there is no built-in scene of this "
                "name%s%s%s; 'sandreel scenes' lists them, and a file is named with its ending "
                ".cfg",
                nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
            return false;
        }
    }
    struct error error;
    size_t size;
    source->owned = file_load(path, TEXT_SIZE_MAX, &size, &error);
    source->text = source->owned;
    if (!source->owned) {
        const char *why = strncmp(error.text, path, strlen(path)) == 0
            ? error.text + strlen(path) + 2
                                                                       : error.text;
        findings_tell_at(findings, FINDING_ERROR, path, 0, "%s", why);
        return false;
    }
    if (strlen(source->text) == size) return true;
    findings_tell_at(findings, FINDING_ERROR, path, 0, "holds zero bytes, so it is no scene file");
    return false;
}

/* ---- the tree ------------------------------------------------------------------------------ */

static bool asks_quick(const struct tree *root)
{
    const struct tree *quick = tree_member(root, "quick");
    return quick && quick->kind == TREE_BOOL && quick->integer;
}

static void apply_texts(struct scene *scene, const struct tree *list, struct findings *findings)
{
    if (!list || (list->kind != TREE_LIST && list->kind != TREE_TEXT)) return;
    const struct tree *entry = list->kind == TREE_LIST ? list->child : list;
    for (; entry; entry = list->kind == TREE_LIST ? entry->next : NULL) {
        if (!entry->text) continue;             /* parsing tells what is wrong with it */
        override_apply(scene->places->root, &scene->arena, entry->text, entry->file, entry->line,
                       findings);
    }
}

static void apply_request(struct scene *scene, const struct scene_request *request,
                          struct findings *findings)
{
    for (uint32_t k = 0; k < request->override_count; k++) {
        override_apply(scene->places->root, &scene->arena, request->overrides[k], "-s", 0,
                       findings);
    }
}

/* Text, then quick_set, then -s, then the phases up to `phase`: each wins over those before. */
static bool build_tree(struct scene *scene, const struct scene_request *request,
                       const struct source_text *source, uint32_t phase, struct findings *findings)
{
    struct scene_places *places = arena_take(&scene->arena, 1, sizeof *places);
    char *file = arena_take(&scene->arena, 1, sizeof source->file);
    if (!places || !file) return false;
    memcpy(file, source->file, sizeof source->file);
    scene->places = places;
    places->file = file;
    places->root = tree_read(&scene->arena, source->text, file, source->folder, findings);
    if (!places->root) return false;
    struct findings quiet = {0};
    apply_request(scene, request, phase ? &quiet : findings);
    if (asks_quick(places->root) && tree_member(places->root, "quick_set")) {
        places->root = tree_read(&scene->arena, source->text, file, source->folder, &quiet);
        if (!places->root) return false;
        apply_request(scene, request, &quiet);  /* may change quick_set itself */
        apply_texts(scene, tree_member(places->root, "quick_set"), phase ? &quiet : findings);
        apply_request(scene, request, &quiet);
    }
    const struct tree *phases = tree_member(places->root, "phases");
    for (uint32_t k = 0; phases && k < phase; k++) {
        const struct tree *entry = phases->kind == TREE_LIST ? tree_entry(phases, k) : phases;
        if (entry) apply_texts(scene, tree_member(entry, "set"), k + 1 == phase ? findings
                               : &quiet);
    }
    return true;
}

/* ---- the scene ----------------------------------------------------------------------------- */

static struct scene *scene_blank(const struct scene_request *request,
                                 const struct source_text *source)
{
    struct scene *scene = calloc(1, sizeof *scene);
    if (!scene) return NULL;
    memcpy(scene->name, source->name, sizeof scene->name);
    memcpy(scene->path, source->path, sizeof scene->path);
    scene->settings_count = request->group_count;
    const struct key_group **groups;
    if (arena_array(&scene->arena, &groups, request->group_count)
        && arena_array(&scene->arena, &scene->settings, request->group_count)) {
        for (uint32_t k = 0; k < request->group_count; k++) groups[k] = request->groups[k];
        scene->settings_groups = groups;
        return scene;
    }
    scene_free(scene);
    return NULL;
}

/* Everything but phases and grains. */
static struct scene *scene_build(const struct scene_request *request,
                                 const struct source_text *source, uint32_t phase,
                                 struct findings *findings)
{
    struct scene *scene = scene_blank(request, source);
    if (!scene) return NULL;
    const uint32_t count = findings->count, errors = findings->errors,
                   warnings = findings->warnings;
    if (build_tree(scene, request, source, phase, findings) && parse_scene(scene, findings)) {
        if (scene->quick) scene->quick_set.count = 0;   /* applied: the keys hold the values */
        if (!isfinite(scene->view.window[0])) {
            for (int k = 0; k < 4; k++) scene->view.window[k] = NAN;
        }
        resolve_radii(scene);
        if (resolve_walls(scene) && !scene->arena.failed) {
            scene->effects = scene_explain_effects(scene);
            return scene;
        }
    }
    if (scene->arena.failed) {
        /* What else seemed wrong is that a part of the scene is missing. */
        findings->count = count;
        findings->errors = errors;
        findings->warnings = warnings;
        findings_tell_at(findings, FINDING_ERROR, source->file, 0,
                         "not enough memory to read this scene");
    }
    scene_free(scene);
    return NULL;
}

static bool build_phases(struct scene *scene, const struct scene_request *request,
                         const struct source_text *source, struct findings *findings)
{
    uint32_t count = 1 + (scene->phase_entry_count < PHASES_MAX ? scene->phase_entry_count
                                                                 : PHASES_MAX);
    double *times;
    if (!arena_array(&scene->arena, &scene->phases, count)) return false;
    if (!arena_array(&scene->arena, &times, count)) return false;
    scene->phases[0] = scene;
    scene->phase_times = times;
    scene->phase_count = 1;
    for (uint32_t k = 1; k < count; k++) {
        /* What the text itself does wrong has been told; only the overrides' faults are new. */
        struct findings *own = calloc(1, sizeof *own);
        if (!own) return false;
        struct scene *phase = scene_build(request, source, k, own);
        if (phase) check_scene(phase, own);
        check_phase_findings(scene, k, own, findings);
        free(own);
        if (!phase) return false;
        times[k] = scene->phase_entries[k - 1].time;
        scene->phases[scene->phase_count++] = phase;
    }
    return true;
}

/* A phase begins with the grains of the whole scene. */
static void share_with_phases(struct scene *scene)
{
    for (uint32_t k = 1; k < scene->phase_count; k++) {
        struct scene *phase = scene->phases[k];
        phase->placed = scene->placed;
        phase->radius_min = fmin(phase->radius_min, scene->radius_min);
        phase->radius_max = fmax(phase->radius_max, scene->radius_max);
        phase->radius_mean = scene->radius_mean;
        phase->effects |= scene->effects & EFFECT_POLYDISPERSE;
        phase->phase_count = 1;
        phase->phases = &scene->phases[k];
        phase->phase_times = scene->phase_times;        /* 0 */
    }
}

struct scene *scene_load(const struct scene_request *request, struct findings *findings)
{
    struct source_text source = {0};
    struct scene *scene = NULL;
    const uint32_t errors_before = findings->errors;
    if (read_text(&source, request, findings)) scene = scene_build(request, &source, 0, findings);
    if (scene) {
        check_scene(scene, findings);
        check_phases(scene, findings);
        if (!build_phases(scene, request, &source, findings) && findings->errors == errors_before) {
            findings_tell_at(findings, FINDING_ERROR, source.file, 0, "not enough memory");
        }
    }
    if (scene && findings->errors == errors_before) {
        double placed = check_placed_estimate(scene);
        if (request->place && place_grains(scene, findings)) {
            placed = scene->placed.count;
            resolve_radii(scene);
        }
        if (request->grains_of) {
            scene->placed = request->grains_of->placed;
            placed = scene->placed.count;
            resolve_radii(scene);
        }
        scene->count_max = resolve_count_max(scene, placed);
        uint32_t most = scene->count_max;
        for (uint32_t k = 1; k < scene->phase_count; k++) {     /* one may bring a source */
            const uint32_t needs = resolve_count_max(scene->phases[k], placed);
            most = needs > most ? needs : most;
            scene->phases[k]->count_max = most;
        }
        share_with_phases(scene);
    }
    free(source.owned);
    if (findings->errors == errors_before) return scene;
    scene_free(scene);
    return NULL;
}

void scene_free(struct scene *scene)
{
    if (!scene) return;
    for (uint32_t k = 1; k < scene->phase_count; k++) {
        struct arena arena = scene->phases[k]->arena;
        free(scene->phases[k]);
        arena_free(&arena);
    }
    struct arena arena = scene->arena;
    free(scene);
    arena_free(&arena);
}

/* ---- questions ----------------------------------------------------------------------------- */

void *scene_settings(const struct scene *scene, const char *name)
{
    for (uint32_t k = 0; k < scene->settings_count; k++) {
        if (strcmp(scene->settings_groups[k]->name, name) == 0) return scene->settings[k];
    }
    return NULL;
}

const struct scene *scene_at(const struct scene *scene, double t)
{
    uint32_t phase = 0;
    while (phase + 1 < scene->phase_count && scene->phase_times[phase + 1] <= t) phase++;
    return scene->phases[phase];
}

effects_t scene_effects(const struct scene *scene)
{
    effects_t effects = 0;
    for (uint32_t p = 0; p < scene->phase_count; p++) effects |= scene->phases[p]->effects;
    return effects;
}

double scene_mass(const struct species *species, double radius)
{
    return species->density * M_PI * radius * radius;
}

double scene_inertia(const struct species *species, double radius)
{
    const double q = species->inertia == INERTIA_SPHERE ? 0.4 : 0.5;
    return q * scene_mass(species, radius) * radius * radius;
}

/* dimension, SI, cgs */
static const char *const unit_words[][3] = {
    {"length", "m", "cm"},              {"time", "s", "s"},
    {"mass", "kg", "g"},                {"speed", "m/s", "cm/s"},
    {"acceleration", "m/s^2", "cm/s^2"}, {"force", "N", "dyn"},
    {"energy", "J", "erg"},             {"momentum", "kg m/s", "g cm/s"},
    {"area", "m^2", "cm^2"},            {"1/time", "1/s", "1/s"},
    {"1/area", "1/m^2", "1/cm^2"},      {"1/length", "1/m", "1/cm"},
    {"mass/area", "kg/m^2", "g/cm^2"},  {"pressure", "N/m", "dyn/cm"},
    {"stress", "N/m", "dyn/cm"},        {"speed^2", "m^2/s^2", "cm^2/s^2"},
    {"1/time^2", "1/s^2", "1/s^2"},     {"angular momentum", "kg m^2/s", "g cm^2/s"},
    {"temperature", "m^2/s^2", "cm^2/s^2"}, {"mass/time", "kg/s", "g/s"},
    {"force/length", "N/m", "dyn/cm"},  {"torque", "N m", "dyn cm"},
};

const char *scene_unit(const struct scene *scene, const char *dimension)
{
    if (scene->units == UNITS_REDUCED) return "";
    for (size_t k = 0; k < sizeof unit_words / sizeof *unit_words; k++) {
        if (strcmp(unit_words[k][0], dimension) == 0) {
            return unit_words[k][scene->units == UNITS_SI ? 1 : 2];
        }
    }
    return "";
}
