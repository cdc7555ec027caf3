/* cli_cost_choose.c - how `run --accuracy` and `run --budget` choose by what `cost` measured.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli_cost.h"

#include "bench/cost_cache.h"
#include "run/folder.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "hard/cradle", "scenes/mine.cfg" -> "cradle-cost", "mine-cost": beside where we are. */
void cli_cost_choose_directory(char directory[FILE_PATH_MAX], const char *scene)
{
    const char *slash = strrchr(scene, '/'), *base = slash ? slash + 1 : scene;
    snprintf(directory, FILE_PATH_MAX, "%.*s-cost", (int)strcspn(base, "."), base);
}

char *cli_cost_choose_table(char path[FILE_PATH_MAX], const char *cache, uint64_t hash)
{
    return folder_path(path, cache, "cost-%016llx.json", (unsigned long long)hash);
}

/* A number with a unit: "1%" is 0.01, "90m" is 5400. */
static bool read_value(const char *option, const char *text, double *value, struct error *error)
{
    static const struct { const char *word; double factor; } units[] = {
        {"", 1}, {"%", 0.01}, {"s", 1}, {"m", 60}, {"h", 3600}};
    char *end;
    *value = strtod(text, &end);
    for (size_t k = 0; end != text && *value > 0 && k < sizeof units / sizeof *units; k++) {
        if (strcmp(end, units[k].word) != 0) continue;
        *value *= units[k].factor;
        return true;
    }
    return error_set_code(error, EXIT_USAGE, "--%s %s: needs a value like 1%% or 60s", option,
                          text);
}

static double number_in(const json_t *point, const char *key)
{
    return json_number_value(json_object_get(point, key));
}

static const json_t *choose(const json_t *points, double accuracy, double budget)
{
    const json_t *best = NULL;
    size_t index;
    json_t *point;
    json_array_foreach(points, index, point) {
        const double wall = number_in(point, "wall_seconds");
        const double told = fmax(number_in(point, "error"), number_in(point, "error_noise"));
        if (told > accuracy || wall > budget) continue;
        const double best_wall = number_in(best, "wall_seconds");
        const double best_told = fmax(number_in(best, "error"), number_in(best, "error_noise"));
        const bool better = isfinite(accuracy) ? wall < best_wall : told < best_told;
        if (!best || better) best = point;
    }
    return best;
}

static bool is_of(const json_t *table, uint64_t hash)
{
    const char *there = json_string_value(json_object_get(table, "hash"));
    return there && strtoull(there, NULL, 16) == hash;
}

/* What was measured of this very scene: in the present folder, or anywhere before. */
static json_t *find_table(const struct options *options, char path[FILE_PATH_MAX],
                          struct error *error)
{
    const char *scene = options->operands[0];
    char directory[FILE_PATH_MAX], cache[FILE_PATH_MAX], kept[FILE_PATH_MAX];
    const uint64_t hash = cost_cache_hash(scene, options->overrides, options->override_count);
    cli_cost_choose_directory(directory, scene);
    json_t *table = json_load_file(folder_path(path, directory, "cost.json"), 0, NULL);
    if (table && is_of(table, hash)) return table;
    const bool other = table != NULL;
    json_decref(table);
    table = NULL;
    if (cost_cache_directory(cache)) {
        table = json_load_file(cli_cost_choose_table(kept, cache, hash), 0, NULL);
    }
    if (table) {
        snprintf(path, FILE_PATH_MAX, "%s", kept);
        return table;
    }
    error_set_code(error, EXIT_USAGE, "%s: %s; `sandreel cost %s%s` measures what accuracy costs "
                   "%s first", path, other ? "measured on another form of the scene" : "not there",
                   scene, options_given(options, OPTION_quick) ? " --quick" : "",
                   options->override_count > options_given(options, OPTION_quick)
                   ? "(with the same -s)" : "here");
    return NULL;
}

/* Nothing is near or fast enough: tells what comes nearest to it. */
static bool refuse(const json_t *points, const char *path, const struct options *options,
                   double budget, struct error *error)
{
    const char *accuracy_text = options->values[OPTION_accuracy];
    const char *budget_text = options->values[OPTION_budget];
    const json_t *nearest = choose(points, INFINITY, budget);
    const json_t *best = nearest ? nearest : choose(points, DBL_MAX, INFINITY);
    char other[200] = "";
    if (best) {
        snprintf(other, sizeof other, "; the %s is '%.80s', %.2g %% +- %.2g %%, %.3g s%s",
                 nearest ? "nearest" : "fastest",
                 json_string_value(json_object_get(best, "setting")),
                 100 * number_in(best, "error"),
                 100 * number_in(best, "error_noise"),
                 number_in(best, "wall_seconds"),
                 nearest ? ", and more --seeds of `sandreel cost` lower the noise" : "");
    }
    return error_set_code(error, EXIT_VERDICT, "%s holds no setting%s%s%s%s%s", path,
                          accuracy_text ? " within " : "", accuracy_text ? accuracy_text : "",
                          budget_text ? " in " : "", budget_text ? budget_text : "", other);
}

bool cli_cost_choose(struct options *options, json_t **table, struct error *error)
{
    const char *accuracy_text = options->values[OPTION_accuracy];
    const char *budget_text = options->values[OPTION_budget];
    double accuracy = INFINITY, budget = INFINITY;
    *table = NULL;
    if (!accuracy_text && !budget_text) return true;
    if (accuracy_text && !read_value("accuracy", accuracy_text, &accuracy, error)) return false;
    if (budget_text && !read_value("budget", budget_text, &budget, error)) return false;
    char path[FILE_PATH_MAX];
    *table = find_table(options, path, error);
    if (!*table) return false;
    const json_t *point = choose(json_object_get(*table, "points"), accuracy, budget);
    if (!point) return refuse(json_object_get(*table, "points"), path, options, budget, error);
    size_t index;
    json_t *key;
    json_array_foreach(json_object_get(point, "keys"), index, key) {
        if (options->override_count == OPTIONS_OVERRIDES_MAX) break;
        options->overrides[options->override_count++] = json_string_value(key);
    }
    fprintf(stderr, "%s: %s, error %.2g %% +- %.2g %%, about %.3g s\n", path,
            json_string_value(json_object_get(point, "setting")),
            100 * number_in(point, "error"),
            100 * number_in(point, "error_noise"),
            number_in(point, "wall_seconds"));
    return true;
}
