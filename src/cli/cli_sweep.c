/* cli_sweep.c - `sweep SCENE --vary KEY=...`: a parameter study.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/folder.h"
#include "run/sweep.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double log_rows = 200;     /* of a scene that keeps no log */

static bool read_plan(const struct options *options, struct plan *plan, struct error *error)
{
    uint64_t repeats, draws;
    if (!options_whole(options, OPTION_repeats, 1, &repeats, error)
        || !options_whole(options, OPTION_random, 0, &draws, error)) {
        return false;
    }
    if (repeats < 1 || repeats > 1000000 || draws > 1000000) {
        return error_set_code(error, EXIT_USAGE, "--repeats and --random: from 1 to 1000000");
    }
    plan->repeats = (uint32_t)repeats;
    plan->draws = (uint32_t)draws;
    for (uint32_t k = 0; k < options->vary_count; k++) {
        if (!plan_vary(plan, options->varies[k], error)) return false;
    }
    return plan->key_count > 0 || repeats > 1
        || error_set_code(error, EXIT_USAGE, "nothing is varied; add --vary KEY=a:b:step, "
                          "--vary KEY=v,w,... or --repeats N");
}

static bool read_shard(const struct options *options, struct sweep_request *request,
                       struct error *error)
{
    const char *text = options->values[OPTION_shard];
    unsigned index = 1, count = 1;
    char rest;
    if (text && (sscanf(text, "%u/%u%c", &index, &count, &rest) != 2 || index < 1
                 || index > count)) {
        return error_set_code(error, EXIT_USAGE, "--shard %s: needs I/N, from 1/N to N/N", text);
    }
    request->shard = index - 1;
    request->shards = count;
    return true;
}

/* The scene with the values of the first point, so that a misspelt key is told at once. */
static bool try_first(const struct options *options, const struct plan *plan, struct setup *setup,
                      struct error *error)
{
    const char *overrides[OPTIONS_OVERRIDES_MAX + PLAN_KEYS_MAX];
    char sets[PLAN_KEYS_MAX][2 * KEY_TEXT_MAX + 2];
    uint32_t count = 0;
    for (; count < options->override_count; count++) overrides[count] = options->overrides[count];
    for (uint32_t k = 0; k < plan->key_count; k++) {
        char value[KEY_TEXT_MAX];
        snprintf(sets[k], sizeof sets[k], "%s=%s", plan->keys[k].name,
                 plan_value(plan, 0, k, value));
        overrides[count++] = sets[k];
    }
    const struct setup_request request = {.path = options->operands[0], .overrides = overrides,
                                          .override_count = count};
    const bool done = setup_load(setup, &request, error);
    if (setup->findings) opening_findings(setup->findings);
    return done;
}

struct watch { bool shows; struct sweep_status last; };

static void report(void *context, const struct sweep_status *status)
{
    struct watch *watch = context;
    const struct sweep_status *last = &watch->last;
    if (!watch->shows || (status->done == last->done && status->failed == last->failed)) return;
    watch->last = *status;
    fprintf(stderr, "%u of %u done, %u failed\n", status->done, status->all, status->failed);
}

/* What `run` is told for every point.  Pictures cost more than most points and are left out unless
 * -s asks for them, because these words come first. */
static uint32_t collect(const struct options *options, const struct setup *setup, char log[64],
                        const char **arguments)
{
    static const char *const plain[] = {"-s", "output.frames=0", "-s", "output.maps=0",
                                        "-s", "output.dump=false", "-s", "output.movie="};
    uint32_t count = 0;
    for (size_t k = 0; k < sizeof plain / sizeof *plain; k++) arguments[count++] = plain[k];
    if (!(setup->scene->output.log > 0)) {
        snprintf(log, 64, "output.log=%.9g", setup->scene->until / log_rows);
        arguments[count++] = "-s";
        arguments[count++] = log;
    }
    for (uint32_t k = 0; k < options->override_count; k++) {
        arguments[count++] = "-s";
        arguments[count++] = options->overrides[k];
    }
    if (options_given(options, OPTION_method)) {
        arguments[count++] = "--method";
        arguments[count++] = options->values[OPTION_method];
    }
    if (options_given(options, OPTION_time_limit)) {
        arguments[count++] = "--time-limit";
        arguments[count++] = options->values[OPTION_time_limit];
    }
    return count;
}

static int study(const struct options *options, const struct setup *setup,
                 struct sweep_request *request)
{
    struct error error = {0};
    struct sweep_status status;
    const char *arguments[SWEEP_ARGUMENTS_MAX];
    char log[64], directory[FILE_PATH_MAX];
    const char *output = options->values[OPTION_output], *how = options->values[OPTION_progress];
    uint64_t parallel;
    struct watch watch = {.shows = !how || strcmp(how, "none") != 0};
    snprintf(directory, sizeof directory, "%s-sweep", setup->scene->name);
    if (output) snprintf(directory, sizeof directory, "%s", output);
    request->directory = directory;
    request->scene = options->operands[0];
    request->arguments = arguments;
    request->argument_count = collect(options, setup, log, arguments);
    request->resume = options_given(options, OPTION_resume);
    request->force = options_given(options, OPTION_force);
    request->report = report;
    request->context = &watch;
    request->signal = &opening_signal;
    opening_catch_signals();
    if (!options_whole(options, OPTION_threads, 0, &parallel, &error)
        || !options_real(options, OPTION_from, setup->scene->until / 2, &request->from, &error)) {
        return opening_fail(&error);
    }
    request->parallel = (uint32_t)(parallel < UINT16_MAX ? parallel : UINT16_MAX);
    if (!sweep_run(request, &status, &error)) return opening_fail(&error);
    if (status.rank > 0) return EXIT_DONE;
    if (status.failed) {
        fprintf(stderr, "sandreel: %u points failed; %s/failed.csv says why, and --resume tries "
                "them again\n", status.failed, directory);
    }
    printf("%s/results.csv\n", directory);
    return status.failed ? EXIT_FAILED : EXIT_DONE;
}

int cli_sweep(const struct options *options)
{
    struct error error = {0};
    struct setup setup = {0};
    struct plan plan = {0};
    struct sweep_request request = {.plan = &plan};
    int code;
    if (!read_plan(options, &plan, &error) || !read_shard(options, &request, &error)
        || !try_first(options, &plan, &setup, &error)) {
        code = opening_fail(&error);
    } else {
        plan.seed = setup.scene->seed;
        code = study(options, &setup, &request);
    }
    setup_free(&setup);
    plan_free(&plan);
    return code;
}
