/* cli_cost.c - `cost SCENE`: error against wall time as a table, CSV, JSON and a picture, and what
 * to take for how much accuracy; and how `run` chooses by it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli_cost.h"

#include "base/file.h"
#include "bench/cost.h"
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/folder.h"
#include "run/plot.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t seeds_default = 3;
static const double seconds_default = 60;       /* of one run */
static const double error_drawn = 1e-4;         /* smaller ones are drawn here */
static const double told_accuracies[] = {0.1, 0.03, 0.01, 0.003, 0.001};

static void tell(void *context, const struct cost_point *point)
{
    (void)context;
    if (!point->ran) {
        printf("%-34s -  %s\n", point->label, point->why);
    } else {
        printf("%-34s %10.4g s   error %9.3g %%  +- %8.2g %%%s\n", point->label, point->wall,
               100 * point->error, 100 * point->error_noise,
               point->reference ? "   (reference)" : "");
    }
    fflush(stdout);
}

static void recommend(const struct cost_table *table)
{
    const struct cost_point *last = NULL;
    for (size_t k = 0; k < sizeof told_accuracies / sizeof *told_accuracies; k++) {
        const struct cost_point *point = cost_fastest(table, told_accuracies[k]);
        if (!point) {
            printf("for %g %%: nothing here is known to be that near; more --seeds lower the "
                   "noise\n", 100 * told_accuracies[k]);
            return;
        }
        if (point != last) printf("for %g %% use %s, %.3g s\n", 100 * told_accuracies[k],
                                  point->label, point->wall);
        last = point;
    }
}

static bool write_csv(const struct cost_table *table, const char *path, struct error *error)
{
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    fprintf(file.stream, "setting,wall_seconds,error,error_noise,front,reference");
    for (int o = 0; o < COST_COUNT; o++) {
        if (!(table->observables >> o & 1)) continue;
        fprintf(file.stream, ",%s,%s_noise", cost_name((enum cost_observable)o),
                cost_name((enum cost_observable)o));
    }
    fprintf(file.stream, "\n");
    for (uint32_t k = 0; k < table->count; k++) {
        const struct cost_point *p = &table->points[k];
        if (!p->ran) continue;
        fprintf(file.stream, "%s,%.6g,%.6g,%.6g,%d,%d", p->label, p->wall, p->error, p->error_noise,
                p->front, p->reference);
        for (int o = 0; o < COST_COUNT; o++) {
            if (table->observables >> o & 1) {
                fprintf(file.stream, ",%.6g,%.6g", p->errors[o], p->noise[o]);
            }
        }
        fprintf(file.stream, "\n");
    }
    return file_commit(&file, error);
}

static json_t *describe(const struct cost_table *table)
{
    json_t *points = json_array();
    for (uint32_t k = 0; k < table->count; k++) {
        const struct cost_point *p = &table->points[k];
        if (!p->ran) continue;
        json_t *keys = json_array(), *errors = json_object();
        for (uint32_t i = 0; i < p->key_count; i++) {
            json_array_append_new(keys, json_string(p->keys[i]));
        }
        for (int o = 0; o < COST_COUNT; o++) {
            if (!(table->observables >> o & 1) || isnan(p->errors[o])) continue;
            json_object_set_new(errors, cost_name((enum cost_observable)o),
                                json_pack("[f, f]", p->errors[o], p->noise[o]));
        }
        json_array_append_new(points, json_pack(
            "{s:s, s:o, s:f, s:f, s:f, s:o, s:b, s:b}", "setting", p->label, "keys", keys,
            "wall_seconds", p->wall, "error", p->error, "error_noise", p->error_noise,
            "observables", errors, "front", p->front, "reference", p->reference));
    }
    return json_pack("{s:s, s:b, s:s, s:i, s:o}", "scene", table->scene, "quick", table->quick,
                     "reference", table->reference, "seeds", (int)table->seeds, "points", points);
}

/* Each setting is a curve of one point, so that the key names it; the front is a line. */
static bool draw(const struct cost_table *table, const char *directory, struct error *error)
{
    struct chart chart;
    char title[CHART_TEXT];
    bool drawn = false;
    snprintf(title, sizeof title, "%.60s: error against %.80s", table->scene,
             table->reference);
    chart_begin(&chart, title, "wall time [s]", "error");
    chart.log_x = chart.log_y = true;
    chart.key = "outside right top";
    chart_curve(&chart, CHART_LINES, "nothing is faster and nearer");
    for (double last = 0;;) {
        const struct cost_point *next = NULL;
        for (uint32_t k = 0; k < table->count; k++) {
            const struct cost_point *p = &table->points[k];
            if (p->front && !p->reference && p->wall > last && (!next || p->wall < next->wall)) {
                next = p;
            }
        }
        if (!next) break;
        last = next->wall;
        chart_point(&chart, next->wall, fmax(next->error, error_drawn));
    }
    for (uint32_t k = 0; k < table->count && chart.count < CHART_CURVES; k++) {
        const struct cost_point *p = &table->points[k];
        if (!p->ran || p->reference) continue;
        chart_curve(&chart, CHART_ERRORS, "%s", p->label);
        chart_error(&chart, p->wall, fmax(p->error, error_drawn), p->error_noise);
    }
    const bool done = plot_save(&chart, directory, "picture", 1u << PLOT_BIT_png, &drawn, error);
    chart_free(&chart);
    return done;
}

static bool save(const struct cost_table *table, const char *directory, struct error *error)
{
    char path[FILE_PATH_MAX];
    json_t *root = describe(table);
    char *text = json_dumps(root, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
    json_decref(root);
    if (!text) return error_set(error, "not enough memory");
    const bool done = file_make_directory(directory, error)
        && write_csv(table, folder_path(path, directory, "cost.csv"), error)
        && file_save(folder_path(path, directory, "cost.json"), text, strlen(text), error)
        && draw(table, directory, error);
    free(text);
    return done;
}

/* "hard/cradle", "scenes/mine.cfg" -> "cradle-cost", "mine-cost": beside where we are. */
static void choose_directory(char directory[FILE_PATH_MAX], const char *scene)
{
    const char *slash = strrchr(scene, '/'), *base = slash ? slash + 1 : scene;
    snprintf(directory, FILE_PATH_MAX, "%.*s-cost", (int)strcspn(base, "."), base);
}

int cli_cost(const struct options *options)
{
    struct error error = {0};
    uint64_t seeds;
    double seconds;
    char directory[FILE_PATH_MAX];
    if (opening_threads(options, &error) == 0
        || !options_whole(options, OPTION_seeds, seeds_default, &seeds, &error)
        || !options_real(options, OPTION_time_limit, seconds_default, &seconds, &error)) {
        return opening_fail(&error);
    }
    if (seeds < 2 || seeds > COST_SEEDS_MAX) {
        error_set_code(&error, EXIT_USAGE, "--seeds %llu: from 2 to %d, for an error of the mean",
                       (unsigned long long)seeds, COST_SEEDS_MAX);
        return opening_fail(&error);
    }
    if (options->values[OPTION_output]) {
        snprintf(directory, sizeof directory, "%s", options->values[OPTION_output]);
    } else {
        choose_directory(directory, options->operands[0]);
    }
    struct cost_table *table = calloc(1, sizeof *table);
    const bool json = options_given(options, OPTION_json);
    const struct cost_request request = {.path = options->operands[0],
        .overrides = options->overrides, .override_count = options->override_count,
        .seeds = (uint32_t)seeds, .seconds = seconds, .report = json ? NULL : tell};
    const bool done = table && cost_measure(&request, table, &error)
        && save(table, directory, &error);
    if (done && json) {
        json_t *root = describe(table);
        json_dumpf(root, stdout, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
        json_decref(root);
        printf("\n");
    } else if (done) {
        recommend(table);
        printf("%s\n", directory);
    }
    free(table);
    return done ? EXIT_DONE : opening_fail(&error);
}

/* ---- `run --accuracy`, `run --budget` ------------------------------------------------------ */

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

static const json_t *choose(const json_t *points, double accuracy, double budget)
{
    const json_t *best = NULL;
    size_t index;
    json_t *point;
    json_array_foreach(points, index, point) {
        const double wall = json_number_value(json_object_get(point, "wall_seconds"));
        const double told = fmax(json_number_value(json_object_get(point, "error")),
                                 json_number_value(json_object_get(point, "error_noise")));
        if (told > accuracy || wall > budget) continue;
        const double best_wall = json_number_value(json_object_get(best, "wall_seconds"));
        const double best_told = fmax(json_number_value(json_object_get(best, "error")),
                                      json_number_value(json_object_get(best, "error_noise")));
        const bool better = isfinite(accuracy) ? wall < best_wall : told < best_told;
        if (!best || better) best = point;
    }
    return best;
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
    char directory[FILE_PATH_MAX], path[FILE_PATH_MAX];
    choose_directory(directory, options->operands[0]);
    *table = json_load_file(folder_path(path, directory, "cost.json"), 0, NULL);
    if (!*table) {
        return error_set_code(error, EXIT_USAGE, "%s: not there; `sandreel cost %s%s` measures "
            "what accuracy costs first", path, options->operands[0],
            options_given(options, OPTION_quick) ? " --quick" : "");
    }
    if (json_is_true(json_object_get(*table, "quick")) != options_given(options, OPTION_quick)) {
        return error_set_code(error, EXIT_USAGE, "%s was measured on the %s form of the scene; "
            "measure this one by `sandreel cost`", path,
            json_is_true(json_object_get(*table, "quick")) ? "small" : "full");
    }
    const json_t *point = choose(json_object_get(*table, "points"), accuracy, budget);
    if (!point) {
        return error_set_code(error, EXIT_VERDICT, "%s holds no setting %s%s%s%s", path,
            accuracy_text ? "within " : "", accuracy_text ? accuracy_text : "",
            budget_text ? " in " : "", budget_text ? budget_text : "");
    }
    size_t index;
    json_t *key;
    json_array_foreach(json_object_get(point, "keys"), index, key) {
        if (options->override_count == OPTIONS_OVERRIDES_MAX) break;
        options->overrides[options->override_count++] = json_string_value(key);
    }
    fprintf(stderr, "%s: %s, error %.2g %%, about %.3g s\n", path,
            json_string_value(json_object_get(point, "setting")),
            100 * json_number_value(json_object_get(point, "error")),
            json_number_value(json_object_get(point, "wall_seconds")));
    return true;
}
