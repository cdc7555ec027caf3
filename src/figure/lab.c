/* lab.c - see lab.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/lab.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void lab_set(struct lab_wish *wish, const char *format, ...)
{
    assert(wish->count < LAB_KEYS);
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(wish->keys[wish->count++], LAB_KEY_TEXT, format, arguments);
    va_end(arguments);
    assert(length < LAB_KEY_TEXT);
    (void)length;
}

/* Another line of the commands that a user could type; a list that is full stays as it is. */
static void note_command(struct figure_job *job, const struct lab_wish *wish)
{
    char line[FIGURE_WORDS];
    int used = snprintf(line, sizeof line, "sandreel run %s", wish->scene);
    for (uint32_t k = 0; k < wish->count && used < (int)sizeof line; k++) {
        used += snprintf(line + used, sizeof line - (size_t)used, " -s '%s'", wish->keys[k]);
    }
    const size_t before = strlen(job->commands);
    if (used >= (int)sizeof line || before + (size_t)used + 2 > sizeof job->commands) return;
    snprintf(job->commands + before, sizeof job->commands - before, "%s%s", before ? "\n" : "",
             line);
}

bool lab_open(struct lab *lab, struct figure_job *job, const struct lab_wish *wish,
              struct error *error)
{
    const char *overrides[LAB_KEYS];
    for (uint32_t k = 0; k < wish->count; k++) overrides[k] = wish->keys[k];
    const struct setup_request request = {.path = wish->scene, .overrides = overrides,
                                          .override_count = wish->count, .place = true};
    *lab = (struct lab){0};
    note_command(job, wish);
    if (!setup_load(&lab->setup, &request, error)) {
        const struct findings *findings = lab->setup.findings;
        char line[800];
        for (uint32_t k = 0; findings && k < findings->count && k < FINDINGS_MAX; k++) {
            if (findings->list[k].kind != FINDING_ERROR) continue;
            error_set(error, "%s", findings_line(&findings->list[k], line, sizeof line));
            break;
        }
        return false;
    }
    if (!footage_open(&lab->footage, &lab->setup, wish->scene, wish->contacts, error)) return false;
    lab->footage.report = job->report;
    lab->footage.context = job->context;
    lab->footage.signal = job->signal;
    return true;
}

bool lab_go(struct lab *lab, double t, struct error *error)
{
    return footage_go(&lab->footage, t, error);
}

struct counters lab_count(const struct lab *lab) { return simulation_count(&lab->footage.sim); }

void lab_close(struct lab *lab)
{
    footage_close(&lab->footage);
    setup_free(&lab->setup);
    *lab = (struct lab){0};
}
