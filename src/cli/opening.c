/* opening.c - see opening.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/opening.h"

#include "base/file.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

volatile sig_atomic_t opening_signal;

static void note_signal(int number)
{
    opening_signal = number;
}

void opening_catch_signals(void)
{
    /* SA_RESETHAND: a second Ctrl-C ends a program that takes too long to stop. */
    struct sigaction action = {.sa_handler = note_signal, .sa_flags = (int)SA_RESETHAND};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

uint32_t opening_threads(const struct options *options, struct error *error)
{
    uint64_t threads;
    if (!options_whole(options, OPTION_threads, (uint64_t)omp_get_max_threads(), &threads, error)) {
        return 0;
    }
    if (threads < 1 || threads > 1024) {
        error_set_code(error, EXIT_USAGE, "-j %s: from 1 to 1024 threads",
                       options->values[OPTION_threads]);
        return 0;
    }
    omp_set_num_threads((int)threads);
    char text[16];
    snprintf(text, sizeof text, "%u", (unsigned)threads);
    setenv("LP_NUM_THREADS", text, 0);          /* Mesa's software renderer */
    return (uint32_t)threads;
}

/* --method WORD: the setting of a model that knows this word. */
static bool method_override(const struct options *options, const char *model, char *text,
                            size_t size, struct error *error)
{
    const char *word = options->values[OPTION_method];
    if (!model) model = options->values[OPTION_model];
    char known[600] = "";
    for (const struct model *const *m = model_list; *m; m++) {
        const struct key_group *group = (*m)->settings;
        if (!group || (model && strcmp((*m)->name, model) != 0)) continue;
        for (uint32_t k = 0; k < group->count; k++) {
            const struct key *key = &group->keys[k];
            if (!key->choices) continue;
            const size_t used = strlen(known);
            snprintf(known + used, sizeof known - used, " %s.%s: %s;", group->name, key->name,
                     key->choices);
            if (key_choice(key->choices, word) < 0) continue;
            snprintf(text, size, "%s.%s=\"%s\"", group->name, key->name, word);
            return true;
        }
    }
    return error_set_code(error, EXIT_USAGE, "--method %s: no model has such a method; known:%s",
                          word, known);
}

/* A run's dumps are what was simulated: only its look may be changed afterwards. */
static bool may_change(const char *override)
{
    static const char *const heads[] = {"view.", "measure.", "output.", "title", "quick="};
    for (size_t k = 0; k < sizeof heads / sizeof *heads; k++) {
        if (strncmp(override, heads[k], strlen(heads[k])) == 0) return true;
    }
    return false;
}

static bool check_overrides(const struct options *options, const char *path, bool place,
                            struct error *error)
{
    if (place || !setup_is_run(path)) return true;
    for (uint32_t k = 0; k < options->override_count; k++) {
        if (may_change(options->overrides[k])) continue;
        return error_set_code(error, EXIT_USAGE, "%s: '%s' would change what was simulated; of a "
            "run only view, measure and output can be changed; simulate anew with `sandreel run`",
            path, options->overrides[k]);
    }
    return true;
}

bool opening_load(struct setup *setup, const struct options *options, const char *path,
                  const char *model, bool place, struct error *error)
{
    *setup = (struct setup){0};
    if (place && setup_is_run(path) && strcmp(options->command->name, "run") != 0) {
        fprintf(stderr, "%s: kept no grain states (output.dump): simulating again\n", path);
    }
    const char *overrides[OPTIONS_OVERRIDES_MAX + 2];
    uint32_t count = 0;
    char model_text[64], method_text[200];
    if (!check_overrides(options, path, place, error)) return false;
    if (model) {
        snprintf(model_text, sizeof model_text, "model=\"%.40s\"", model);
        overrides[count++] = model_text;
    }
    if (options_given(options, OPTION_method)) {
        if (!method_override(options, model, method_text, sizeof method_text, error)) return false;
        overrides[count++] = method_text;
    }
    for (uint32_t k = 0; k < options->override_count; k++) {
        overrides[count++] = options->overrides[k];
    }
    const struct setup_request request = {.path = path, .overrides = overrides,
                                          .override_count = count, .place = place};
    const bool done = setup_load(setup, &request, error);
    if (setup->findings) opening_findings(setup->findings);
    return done;
}

void opening_findings(const struct findings *findings)
{
    const uint32_t kept = findings->count < FINDINGS_MAX ? findings->count : FINDINGS_MAX;
    for (uint32_t k = 0; k < kept; k++) {
        char line[800];
        fprintf(stderr, "%s\n", findings_line(&findings->list[k], line, sizeof line));
    }
    if (findings->count > kept) fprintf(stderr, "... and %u more\n", findings->count - kept);
}

int opening_fail(const struct error *error)
{
    fprintf(stderr, "sandreel: %s\n", error->text);
    return error->code ? (int)error->code : EXIT_FAILED;
}

void opening_report(void *context, const struct run_status *status)
{
    progress_show(context, status);
}

void opening_warn(void *context, const char *text)
{
    progress_end(context);
    fprintf(stderr, "sandreel: %s\n", text);
}

const struct key_group *opening_key_group(uint32_t index)
{
    const struct key_group *group;
    uint32_t own = 0;
    while ((group = scene_key_group(own))) {
        if (own++ == index) return group;
    }
    const struct key_group *settings[MODEL_MAX];
    const uint32_t count = model_settings(settings);
    return index - own < count ? settings[index - own] : NULL;
}

char *opening_bytes(double bytes, char *text, size_t size)
{
    static const char *const units[] = {"B", "kB", "MB", "GB", "TB"};
    int k = 0;
    for (; bytes >= 1000 && k < 4; k++) bytes /= 1000;
    snprintf(text, size, "%.3g %s", bytes, units[k]);
    return text;
}
