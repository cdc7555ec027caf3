/* cli_cost.c - `cost SCENE`: error against wall time as a table, CSV, JSON and a picture, and what
 * to take for how much accuracy.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli_cost.h"

#include "base/file.h"
#include "bench/cost.h"
#include "bench/cost_cache.h"
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/folder.h"
#include "run/jsontext.h"
#include "run/plot.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t seeds_default = 0;        /* as many as time allows */
static const double seconds_default = 10, seconds_quick = 4;    /* of one run */
static const double error_least = 1e-6;         /* drawn; what is smaller stands there */
static const double told_accuracies[] = {0.1, 0.03, 0.01, 0.003, 0.001};

static void tell(void *context, const struct cost_point *point)
{
    (void)context;
    if (!point->ran) {
        printf("%-46s -  %s\n", point->label, point->why);
    } else {
        printf("%-46s %10.4g s   error %9.3g %%  +- %8.2g %%%s\n", point->label, point->wall,
               100 * point->error, 100 * point->error_noise,
               point->cached ? "   (reference, kept from before)"
               : point->reference ? "   (reference)" : "");
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

static void tell_orders(const struct cost_table *table)
{
    for (uint32_t k = 0; k < table->order_count; k++) {
        const struct cost_order *order = &table->orders[k];
        printf("%s: error ~ dt^%.2f +- %.2f, from %u time steps\n", order->label, order->power,
               order->power_error, order->points);
    }
}

static bool write_csv(const struct cost_table *table, const char *path, struct error *error)
{
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    fprintf(file.stream, "setting,wall_seconds,cpu_seconds,error,error_noise,front,reference");
    for (int o = 0; o < COST_COUNT; o++) {
        if (!(table->observables >> o & 1)) continue;
        fprintf(file.stream, ",%s,%s_noise", cost_row_name((enum cost_observable)o),
                cost_row_name((enum cost_observable)o));
    }
    fprintf(file.stream, "\n");
    for (uint32_t k = 0; k < table->count; k++) {
        const struct cost_point *p = &table->points[k];
        if (!p->ran) continue;
        fprintf(file.stream, "%s,%.6g,%.6g,%.6g,%.6g,%d,%d", p->label, p->wall, p->cpu, p->error,
                p->error_noise, p->front, p->reference);
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
            json_object_set_new(errors, cost_row_name((enum cost_observable)o),
                                json_pack("[f, f]", p->errors[o], p->noise[o]));
        }
        json_array_append_new(points, json_pack(
            "{s:s, s:o, s:f, s:f, s:f, s:f, s:o, s:b, s:b, s:b, s:i}", "setting", p->label,
            "keys", keys, "wall_seconds", p->wall, "cpu_seconds", p->cpu, "error", p->error,
            "error_noise", p->error_noise, "observables", errors, "front", p->front,
            "reference", p->reference, "cached", p->cached, "seeds", (int)p->seeds));
    }
    json_t *orders = json_array();
    for (uint32_t k = 0; k < table->order_count; k++) {
        const struct cost_order *order = &table->orders[k];
        json_array_append_new(orders, json_pack("{s:s, s:f, s:f, s:i}", "setting", order->label,
            "power", order->power, "power_error", order->power_error, "points",
            (int)order->points));
    }
    char hash[20];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)table->hash);
    return json_pack("{s:s, s:s, s:b, s:s, s:i, s:o, s:o}", "scene", table->scene, "hash", hash,
                     "quick", table->quick, "reference", table->reference, "seeds",
                     (int)table->seeds, "points", points, "orders", orders);
}

/* ---- the picture ------------------------------------------------------------------------ */

/* Points of one kind are one curve; the words beside a point tell them apart. */
static const struct { const char *name, *model, *word; } kinds[] = {
    {"md: Gear's integrator", "md", "integrator=gear"},
    {"md: force law, stiffness", "md", "grains"},
    {"md: time step", "md", ""},
    {"ed: cut-off time", "ed", ""},
    {"dsmc", "dsmc", ""},
    {"lga", "lga", ""},
};

enum { KINDS = sizeof kinds / sizeof *kinds };

static int kind_of(const struct cost_point *point)
{
    const size_t length = strcspn(point->label, " ");
    int k = 0;
    while (k < KINDS && !(strlen(kinds[k].model) == length
                          && strncmp(point->label, kinds[k].model, length) == 0
                          && strstr(point->label, kinds[k].word))) k++;
    return k;
}

/* "md md.dt=*2 md.integrator=gear" is "dt*2 gear": the last word of each key and its value. */
static char *shorten(const struct cost_point *point, char text[CHART_LABEL_TEXT])
{
    char words[COST_KEY], *save = NULL;
    size_t used = 0;
    snprintf(words, sizeof words, "%s", point->label);
    text[0] = 0;
    strtok_r(words, " ", &save);
    for (char *word = strtok_r(NULL, " ", &save); word; word = strtok_r(NULL, " ", &save)) {
        char *value = strchr(word, '='), *dot = NULL;
        if (value) *value++ = 0;
        dot = strrchr(word, '.');
        const char *name = dot ? dot + 1 : word;
        const bool number = value && strspn(value, "*0123456789.") == strlen(value);
        /* The stiffness that goes with another force law says nothing new. */
        if (used + 1 >= CHART_LABEL_TEXT || (!number && strcmp(name, "stiffness") == 0)) continue;
        used += (size_t)snprintf(text + used, CHART_LABEL_TEXT - used, "%s%s%s%s",
                                 used ? " " : "", number ? name : "",
                                 number && value[0] != '*' ? "=" : "", value ? value : name);
    }
    if (!used) snprintf(text, CHART_LABEL_TEXT, "%s", point->label);
    return text;
}

/* The next point of the front to the right of `last`. */
static const struct cost_point *next_of_front(const struct cost_table *table, double last)
{
    const struct cost_point *next = NULL;
    for (uint32_t k = 0; k < table->count; k++) {
        const struct cost_point *p = &table->points[k];
        if (p->front && !p->reference && p->wall > last && (!next || p->wall < next->wall)) {
            next = p;
        }
    }
    return next;
}

static double drawn(const struct cost_point *point)
{
    return fmax(fmax(point->error, 0.02 * point->error_noise), error_least);
}

/* Where words have been put, in letters from the left and lines from below. */
struct words {
    uint32_t count;
    double   x[COST_POINTS_MAX], y[COST_POINTS_MAX], length[COST_POINTS_MAX];
};

enum { LETTERS = 130, LINES = 44 };     /* of this size across and up the picture */

static bool hides(const struct words *words, double x, double y, double length)
{
    for (uint32_t k = 0; k < words->count; k++) {
        if (fabs(words->y[k] - y) < 0.9 && x < words->x[k] + words->length[k] + 0.5
            && words->x[k] < x + length + 0.5) return true;
    }
    return false;
}

/* Words stand beside their point, or a few lines off where others are already. */
static void label(struct chart *chart, struct words *words, const double low[2],
                  const double high[2], const struct cost_point *p)
{
    char text[CHART_LABEL_TEXT];
    const double per_x = LETTERS / log(high[0] / low[0]), per_y = LINES / log(high[1] / low[1]);
    const double length = (double)strlen(shorten(p, text)), x = per_x * log(p->wall / low[0]);
    const double line = per_y * log(drawn(p) / low[1]);
    double y = line;
    for (int k = 1; k < 12 && hides(words, x, y, length); k++) {
        y = line + (k % 2 ? 1 : -1) * (k + 1) / 2;
    }
    words->x[words->count] = x;
    words->y[words->count] = y;
    words->length[words->count++] = length;
    chart_label(chart, p->wall, low[1] * exp(y / per_y), text);
}

/* The decades that the axes show. */
static void find_range(const struct cost_table *table, double low[2], double high[2])
{
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = 0;
    for (uint32_t k = 0; k < table->count; k++) {
        const struct cost_point *p = &table->points[k];
        if (!p->ran || p->reference) continue;
        low[0] = fmin(low[0], p->wall);
        high[0] = fmax(high[0], p->wall);
        low[1] = fmin(low[1], drawn(p));
        high[1] = fmax(high[1], drawn(p) + p->error_noise);
    }
    for (int axis = 0; axis < 2; axis++) {
        if (!(high[axis] > 0)) low[axis] = high[axis] = 1;              /* nothing ran */
        low[axis] = pow(10, floor(log10(low[axis])));
        high[axis] = pow(10, ceil(log10(high[axis]) + (axis == 0 ? 0.15 : 0)));
        if (!(high[axis] > low[axis])) high[axis] = 10 * low[axis];     /* one point, or alike */
    }
}

static bool draw(const struct cost_table *table, const char *directory, struct error *error)
{
    struct chart chart;
    struct words words = {0};
    char title[CHART_TEXT];
    bool done = false;
    snprintf(title, sizeof title, "%.50s: error against %.70s, up to %u seeds", table->scene,
             table->reference, table->seeds);
    chart_begin(&chart, title, "wall time of the model [s]", "error");
    chart.log_x = chart.log_y = true;
    double low[2], high[2];
    find_range(table, low, high);
    chart.x_range[0] = low[0];
    chart.x_range[1] = high[0];
    chart.y_range[0] = low[1];
    chart.y_range[1] = high[1];
    chart.key = "outside bottom center horizontal";
    const struct cost_point *front = next_of_front(table, 0);
    if (front) chart_curve(&chart, CHART_LINES, "nothing is faster and nearer");
    for (; front; front = next_of_front(table, front->wall)) {
        chart_point(&chart, front->wall, drawn(front));
    }
    for (int kind = 0; kind < KINDS; kind++) {
        bool begun = false;
        for (uint32_t k = 0; k < table->count; k++) {
            const struct cost_point *p = &table->points[k];
            if (!p->ran || p->reference || kind_of(p) != kind) continue;
            if (!begun) chart_curve(&chart, CHART_ERRORS, "%s", kinds[kind].name);
            begun = true;
            chart_error(&chart, p->wall, drawn(p), p->error_noise);
            label(&chart, &words, low, high, p);
        }
    }
    const bool saved = plot_save(&chart, directory, "picture", 1u << PLOT_BIT_png, &done, error);
    chart_free(&chart);
    return saved;
}

/* Into the directory, and the table into the cache, where `run` finds it from anywhere. */
static bool save(const struct cost_table *table, const char *directory, const char *cache,
                 struct error *error)
{
    char path[FILE_PATH_MAX];
    struct error ignored;
    json_t *root = describe(table);
    char *text = jsontext_dump(root, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
    json_decref(root);
    if (!text) return error_set(error, "not enough memory");
    const bool done = file_make_directory(directory, error)
        && write_csv(table, folder_path(path, directory, "cost.csv"), error)
        && file_save(folder_path(path, directory, "cost.json"), text, strlen(text), error)
        && draw(table, directory, error);
    if (done && cache && file_make_directory(cache, &ignored)) {
        file_save(cli_cost_choose_table(path, cache, table->hash), text, strlen(text), &ignored);
    }
    free(text);
    return done;
}

int cli_cost(const struct options *options)
{
    struct error error = {0};
    uint64_t seeds;
    double seconds;
    char directory[FILE_PATH_MAX], kept[FILE_PATH_MAX];
    if (opening_threads(options, &error) == 0
        || !options_whole(options, OPTION_seeds, seeds_default, &seeds, &error)
        || !options_real(options, OPTION_time_limit, options_given(options, OPTION_quick)
                         ? seconds_quick : seconds_default, &seconds, &error)) {
        return opening_fail(&error);
    }
    if (options_given(options, OPTION_seeds) && (seeds < 2 || seeds > COST_SEEDS_MAX)) {
        error_set_code(&error, EXIT_USAGE, "--seeds %llu: from 2 to %d, for an error of the mean",
                       (unsigned long long)seeds, COST_SEEDS_MAX);
        return opening_fail(&error);
    }
    if (options->values[OPTION_output]) {
        snprintf(directory, sizeof directory, "%s", options->values[OPTION_output]);
    } else {
        cli_cost_choose_directory(directory, options->operands[0]);
    }
    struct cost_table *table = calloc(1, sizeof *table);
    const bool json = options_given(options, OPTION_json);
    const struct cost_request request = {.path = options->operands[0],
        .overrides = options->overrides, .override_count = options->override_count,
        .seeds = (uint32_t)seeds, .seconds = seconds, .cache = cost_cache_directory(kept),
        .report = json ? NULL : tell};
    const bool done = table && cost_measure(&request, table, &error)
        && save(table, directory, request.cache, &error);
    if (done && json) {
        json_t *root = describe(table);
        json_dumpf(root, stdout, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
        json_decref(root);
        printf("\n");
    } else if (done) {
        tell_orders(table);
        recommend(table);
        printf("%s\n", directory);
    }
    free(table);
    return done ? EXIT_DONE : opening_fail(&error);
}
