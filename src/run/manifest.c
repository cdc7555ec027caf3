/* manifest.c - see manifest.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/manifest.h"

#include "run/build.h"
#include "run/folder.h"
#include "run/jsontext.h"

#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static json_t *hash_word(uint64_t hash)
{
    return json_sprintf("%016" PRIx64, hash);
}

json_t *manifest_text(const char *text)
{
    json_t *whole = json_string(text);
    if (whole) return whole;
    char *plain = strdup(text);
    for (char *at = plain; at && *at; at++) if ((unsigned char)*at > 126) *at = '?';
    json_t *bent = plain ? json_string(plain) : NULL;
    free(plain);
    return bent;
}

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *counts(const struct run_result *result)
{
    json_t *list = json_object();
#define X(name, doc) \
    json_object_set_new(list, #name, json_integer((json_int_t)result->counters.name));
    COUNTERS(X)
#undef X
    json_object_set_new(list, "frames", json_integer((json_int_t)result->frames));
    json_object_set_new(list, "maps", json_integer((json_int_t)result->maps));
    json_object_set_new(list, "log_rows", json_integer((json_int_t)result->log_rows));
    return list;
}

/* What a unit of simulated time, and what a step costs; nothing of a run that did nothing. */
static void add_rates(json_t *part, double seconds, const struct run_result *result)
{
    if (!(result->span > 0 && result->work > 0)) return;
    json_object_set_new(part, "per_simulated_time", json_real(seconds / result->span));
    json_object_set_new(part, "per_step", json_real(seconds / result->work));
}

static json_t *seconds(const struct run_result *result)
{
    json_t *list = json_object();
    double cpu = 0;
    for (int p = 0; p < PART_COUNT; p++) {
        const double mine = p == PART_encode ? result->cpu_encode : result->parts.cpu[p];
        cpu += mine;
        json_t *part = json_pack("{s:f, s:f}", "wall", result->parts.wall[p], "cpu", mine);
        add_rates(part, run_part_seconds(result, (enum part)p), result);
        json_object_set_new(list, parts_name((enum part)p), part);
    }
    json_t *total = json_pack("{s:f, s:f}", "wall", result->wall, "cpu", cpu);
    add_rates(total, result->wall, result);
    json_object_set_new(list, "total", total);
    return list;
}

/* The effects of `set`, each by its word. */
static json_t *effects(effects_t set)
{
    json_t *list = json_array();
    for (; set; set &= set - 1) json_array_append_new(list, json_string(effect_word(set)));
    return list;
}

static json_t *describe(const struct manifest *manifest)
{
    const struct scene *scene = manifest->scene;
    char when[32];
    const time_t now = time(NULL);
    strftime(when, sizeof when, "%Y-%m-%dT%H:%M:%SZ", gmtime(&now));
    json_t *root = json_pack("{s:s, s:o, s:o, s:s, s:I, s:s, s:o, s:o}",
        "status", manifest->status, "scene", manifest_text(scene->name),
        "title", manifest_text(scene->title),
        "model", manifest->model->name, "seed", (json_int_t)scene->seed,
        "written", when, "scene_hash", hash_word(manifest->scene_hash),
        "versions", build_versions());
    const double *range = manifest->range;
    if (root && range) {
        json_object_set_new(root, "range", json_pack("[o, o]", number(range[0]), number(range[1])));
        json_object_set_new(root, "color", json_integer(scene->view.color));
    }
    const struct run_result *result = manifest->result;
    if (!root || !result) return root;
    json_object_set_new(root, "time", number(result->counters.time));
    json_object_set_new(root, "until", number(scene->until));
    json_object_set_new(root, "state_digest", hash_word(result->digest));
    json_object_set_new(root, "counts", counts(result));
    json_object_set_new(root, "seconds", seconds(result));
    json_object_set_new(root, "effects", effects(result->effects));
    json_object_set_new(root, "effects_left_out",
                        effects((((effects_t)1 << EFFECT_COUNT) - 1) & ~result->effects));
    return root;
}

bool manifest_save(const struct manifest *manifest, const char *directory, struct error *error)
{
    char path[FILE_PATH_MAX];
    folder_path(path, directory, "manifest.json");
    json_t *root = describe(manifest);
    char *text = jsontext_dump(root, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
    json_decref(root);
    if (!text) return error_set(error, "%s: not enough memory to put it together", path);
    struct file file;
    bool done = file_begin(&file, path, error);
    if (done) {
        fprintf(file.stream, "%s\n", text);
        done = file_commit(&file, error);
    }
    free(text);
    return done;
}
