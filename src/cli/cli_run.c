/* cli_run.c - `run SCENE`.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/cli_cost.h"
#include "cli/opening.h"
#include "run/folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Seconds, or a number with s, m, h or d. */
static bool read_time_limit(const struct options *options, double *seconds, struct error *error)
{
    const char *text = options->values[OPTION_time_limit];
    *seconds = 0;
    if (!text) return true;
    char *end;
    *seconds = strtod(text, &end);
    double unit = 1;
    if (end != text && *end) {
        const char *const letters = "smhd", *found = strchr(letters, *end);
        static const double units[] = {1, 60, 3600, 86400};
        unit = found && end[1] == 0 ? units[found - letters] : 0;
    }
    *seconds *= unit;
    return (end != text && *seconds > 0) || error_set_code(error, EXIT_USAGE,
        "--time-limit %s: needs a time like 600, 90m or 12h", text);
}

static double events(double interval, double until)
{
    return interval > 0 ? (double)(uint64_t)(until / interval + 1e-9) + 1 : 0;
}

static int tell_plan(const struct setup *setup, const char *directory)
{
    const struct scene *scene = setup->scene;
    char bytes[32];
    printf("scene %s, model %s, seed %llu\n", scene->name, setup->model->name,
           (unsigned long long)scene->seed);
    printf("%u grains at the start, until t = %g %s\n", scene->placed.count, scene->until,
           scene_unit(scene, "time"));
    printf("would write into %s: %.0f frames, %.0f log rows, %.0f maps, %.0f checkpoints%s\n",
           directory, events(scene->output.frames, scene->until),
           events(scene->output.log, scene->until), events(scene->output.maps, scene->until),
           events(scene->output.checkpoint, scene->until), scene->output.dump ? ", dumps" : "");
    if (setup->model->memory) {
        printf("memory of the model: %s\n",
               opening_bytes((double)setup->model->memory(scene), bytes, sizeof bytes));
    }
    return EXIT_DONE;
}

/* What of `unit` costs, by part. */
static void tell_rates(const struct run_result *result, const char *unit, double units,
                       double factor, const char *seconds)
{
    fprintf(stderr, "%s:", unit);
    for (int p = 0; p < PART_COUNT; p++) {
        fprintf(stderr, "%s %s %.3g %s", p ? "," : "", parts_name((enum part)p),
                factor * run_part_seconds(result, (enum part)p) / units, seconds);
    }
    fputc('\n', stderr);
}

/* Which effects the run had, which it left out, and where its time went. */
static void tell_costs(const struct run_result *result, const struct scene *scene)
{
    char words[600], unit[60];
    const double wall = result->wall > 0 ? result->wall : 1;
    effect_words(result->effects, words, sizeof words);
    fprintf(stderr, "effects: %s\n", words);
    effect_words((((effects_t)1 << EFFECT_COUNT) - 1) & ~result->effects, words, sizeof words);
    fprintf(stderr, "left out: %s\ncost:", words);
    for (int p = 0; p < PART_COUNT; p++) {
        fprintf(stderr, "%s %s %.1f %%", p ? "," : "", parts_name((enum part)p),
                100 * run_part_seconds(result, (enum part)p) / wall);
    }
    fprintf(stderr, " of %.3g s\n", result->wall);
    if (!(result->span > 0 && result->work > 0)) {
        fprintf(stderr, "nothing was simulated\n");
        return;
    }
    snprintf(unit, sizeof unit, "cost of 1 %s", *scene_unit(scene, "time")
             ? scene_unit(scene, "time") : "unit of time");
    tell_rates(result, unit, result->span, 1, "s");
    tell_rates(result, "cost of a step", result->work, 1e6, "us");
}

static void tell_result(const struct run_result *result, const char *directory)
{
    const struct counters *now = &result->counters;
    fprintf(stderr, "%s: t = %.6g, %llu steps, %llu grains; %llu frames, %llu log rows, %llu maps; "
            "%.1f s\n", directory, now->time, (unsigned long long)now->steps,
            (unsigned long long)now->grains, (unsigned long long)result->frames,
            (unsigned long long)result->log_rows, (unsigned long long)result->maps, result->wall);
}

static int simulate(const struct options *options, const struct setup *setup,
                    const char *directory, uint32_t threads)
{
    struct error error = {0};
    struct progress progress;
    struct run_result result;
    double time_limit;
    if (!read_time_limit(options, &time_limit, &error)
        || !progress_begin(&progress, options->values[OPTION_progress], &error)) {
        return opening_fail(&error);
    }
    const struct run_request request = {
        .scene = setup->scene, .model = setup->model, .directory = directory,
        .force = options_given(options, OPTION_force),
        .resume = options_given(options, OPTION_resume), .time_limit = time_limit,
        .threads = threads / 2, .report = opening_report, .warn = opening_warn,
        .context = &progress, .signal = &opening_signal,
    };
    opening_catch_signals();
    const bool done = run_scene(&request, &result, &error);
    progress_end(&progress);
    if (!done) return opening_fail(&error);
    if (progress.how != PROGRESS_NONE && !result.was_done) {
        tell_result(&result, directory);
        tell_costs(&result, setup->scene);
    }
    printf("%s\n", directory);
    return EXIT_DONE;
}

int cli_run(const struct options *given)
{
    struct options chosen = *given, *const options = &chosen;
    struct error error = {0};
    json_t *costs;
    struct setup setup;
    const char *path = options->operands[0];
    const bool resume = options_given(options, OPTION_resume);
    const uint32_t threads = opening_threads(options, &error);
    if (threads == 0) return opening_fail(&error);
    if (!cli_cost_choose(options, &costs, &error)) {
        json_decref(costs);
        return opening_fail(&error);
    }
    /* `run DIRECTORY --resume` takes scene and directory from there. */
    const bool is_run = resume && setup_is_run(path);
    int code;
    if (!opening_load(&setup, options, path, NULL, true, &error)) {
        code = opening_fail(&error);
    } else {
        char directory[FILE_PATH_MAX];
        const char *wanted = options->values[OPTION_output];
        if (wanted) snprintf(directory, sizeof directory, "%s", wanted);
        else if (is_run) snprintf(directory, sizeof directory, "%s", path);
        else if (resume) snprintf(directory, sizeof directory, "%s-%s", setup.scene->name,
                                  setup.model->name);
        else folder_choose(directory, setup.scene->name, setup.model->name);
        code = options_given(options, OPTION_dry_run)
             ? tell_plan(&setup, directory) : simulate(options, &setup, directory, threads);
    }
    setup_free(&setup);
    json_decref(costs);
    return code;
}
