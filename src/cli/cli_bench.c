/* cli_bench.c - `bench [NAME...]`: the table of timings, and ratios to an earlier one.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/jsontext.h"
#include "base/file.h"
#include "bench/bench.h"
#include "bench/effects.h"
#include "run/build.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint32_t repeats = 5;

static bool is_chosen(const struct options *options, const struct bench_case *which)
{
    for (uint32_t k = 0; k < options->operand_count; k++) {
        if (strcmp(options->operands[k], which->name) == 0) return true;
    }
    return options->operand_count == 0;
}

static bool check_names(const struct options *options, struct error *error)
{
    const char *names[64];
    size_t count = 0;
    for (const struct bench_case *c = bench_list; c->name && count < 63; c++) {
        names[count++] = c->name;
    }
    names[count] = NULL;
    for (uint32_t k = 0; k < options->operand_count; k++) {
        size_t at = 0;
        while (names[at] && strcmp(names[at], options->operands[k]) != 0) at++;
        if (names[at]) continue;
        const char *nearest = options_nearest(options->operands[k], names);
        return error_set_code(error, EXIT_USAGE, "bench: no case '%s'%s%s%s", options->operands[k],
                              nearest ? "; did you mean '" : "", nearest ? nearest : "",
                              nearest ? "'?" : "; `sandreel bench` alone runs all");
    }
    return true;
}

/* The earlier table; NULL without --against or with an error. */
static json_t *load_old(const struct options *options, struct error *error)
{
    const char *path = options->values[OPTION_against];
    json_error_t cause;
    json_t *root = json_load_file(path, 0, &cause);
    if (root && json_is_array(json_object_get(root, "cases"))) return root;
    json_decref(root);
    error_set_code(error, EXIT_USAGE, "--against %s: not a table of `sandreel bench --json`%s%s",
                   path, root ? "" : ": ", root ? "" : cause.text);
    return NULL;
}

/* What the old table says of this case; 0 if nothing. */
static double old_value(const json_t *old, const char *name)
{
    size_t index;
    json_t *entry;
    json_array_foreach(json_object_get(old, "cases"), index, entry) {
        const char *known = json_string_value(json_object_get(entry, "name"));
        if (known && strcmp(known, name) == 0) {
            return json_number_value(json_object_get(entry, "value"));
        }
    }
    return 0;
}

static void tell(const struct bench_case *which, const struct bench_result *result, double old)
{
    printf("%-14s %10.4g %-20s %8.3f cpu-s", which->name, result->value, which->unit, result->cpu);
    if (old > 0) {
        const double gain = which->larger_is_better ? result->value / old : old / result->value;
        printf("  %5.2f x", gain);
    }
    printf("  %s\n", which->doc);
    fflush(stdout);
}

static bool measure_all(const struct options *options, const json_t *old, json_t *cases,
                        struct error *error)
{
    const bool json = options_given(options, OPTION_json);
    for (const struct bench_case *c = bench_list; c->name; c++) {
        struct bench_result result;
        struct error why = {0};
        if (!is_chosen(options, c)) continue;
        if (!bench_measure(c, repeats, &result, &why)) {
            /* A case that cannot run here (no renderer) does not stop the rest. */
            fprintf(stderr, "sandreel: %s: %s\n", c->name, why.text);
            if (options->operand_count > 0) {
                *error = why;
                return false;
            }
            continue;
        }
        const double before = old ? old_value(old, c->name) : 0;
        if (!json) tell(c, &result, before);
        json_t *entry = json_pack("{s:s, s:f, s:s, s:b, s:f, s:f, s:i}", "name", c->name,
            "value", result.value, "unit", c->unit, "larger_is_better", c->larger_is_better,
            "cpu_seconds", result.cpu, "wall_seconds", result.wall, "repeats", (int)repeats);
        if (before > 0) json_object_set_new(entry, "old_value", json_real(before));
        json_array_append_new(cases, entry);
    }
    return true;
}

static bool write_json(const struct options *options, const json_t *root, struct error *error)
{
    const char *output = options->values[OPTION_output];
    char *text = jsontext_dump(root, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
    if (!text) return error_set(error, "not enough memory");
    bool done = true;
    if (options_given(options, OPTION_json)) printf("%s\n", text);
    if (output) done = file_save(output, text, strlen(text), error);
    free(text);
    return done;
}

/* A row of `bench --effects`; `context` is the list for --json, or NULL. */
static void tell_effect(void *context, const struct effects_row *row)
{
    if (context) {
        json_array_append_new(context, json_pack("{s:s, s:s, s:s, s:f, s:f, s:f}", "model",
            row->model, "effect", row->name, "work", row->work, "seconds", row->seconds, "share",
            row->share, "bytes_per_grain", row->bytes));
        return;
    }
    printf("%-6s %-20s %12.4g us of %-8s %6.2f x none %10.0f bytes a grain\n", row->model,
           row->name, 1e6 * row->seconds, row->work, row->share, row->bytes);
    fflush(stdout);
}

static int bench_effects(const struct options *options)
{
    struct error error = {0};
    if (opening_threads(options, &error) == 0) return opening_fail(&error);
    json_t *list = options_given(options, OPTION_json) ? json_array() : NULL;
    bool done = true;
    for (const struct model *const *m = model_list; done && *m; m++) {
        bool wanted = options->operand_count == 0;
        for (uint32_t k = 0; k < options->operand_count; k++) {
            wanted = wanted || strcmp(options->operands[k], (*m)->name) == 0;
        }
        if (wanted) done = effects_bench(*m, tell_effect, list, &error);
    }
    if (done && list) {
        json_dumpf(list, stdout, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
        printf("\n");
    }
    json_decref(list);
    return done ? EXIT_DONE : opening_fail(&error);
}

int cli_bench(const struct options *options)
{
    struct error error = {0};
    if (options_given(options, OPTION_effects)) return bench_effects(options);
    json_t *old = NULL;
    const uint32_t threads = opening_threads(options, &error);
    const char *output = options->values[OPTION_output];
    const bool keeps = output && !options_given(options, OPTION_force);
    if (threads == 0 || !check_names(options, &error) || (keeps && !file_absent(output, &error))) {
        return opening_fail(&error);
    }
    if (options_given(options, OPTION_against) && !(old = load_old(options, &error))) {
        return opening_fail(&error);
    }
    json_t *cases = json_array();
    json_t *root = json_pack("{s:o, s:i, s:o}", "versions", build_versions(), "threads",
                             (int)threads, "cases", cases);
    const bool done = measure_all(options, old, cases, &error) && write_json(options, root, &error);
    json_decref(root);
    json_decref(old);
    return done ? EXIT_DONE : opening_fail(&error);
}
