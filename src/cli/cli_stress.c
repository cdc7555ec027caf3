/* cli_stress.c - `stress [NAME...]`: the table of hard cases.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "bench/hard.h"
#include "run/build.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct totals { uint32_t tried, failed; };

/* "mass inside overlap": all that is checked. */
static char *checks_text(const struct hard_result *result, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (int k = 0; k < HARD_CHECKS_COUNT && used < size; k++) {
        if (!result->values[k].asked) continue;
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "",
                                 hard_check_name((enum hard_check)k));
    }
    return text;
}

/* "overlap 3e-13 of 1e-09": the check that came nearest to its limit. */
static char *worst_text(const struct hard_result *result, char *text, size_t size)
{
    const struct hard_value *value = &result->values[result->tightest];
    const char *name = hard_check_name(result->tightest);
    if (!isnan(value->low) && !isnan(value->high)) {
        snprintf(text, size, "%s %.3g in %.3g..%.3g", name, value->worst, value->low, value->high);
    } else if (value->high > 0) {
        snprintf(text, size, "%s %.2g of %.2g", name, value->worst, value->high);
    } else {
        snprintf(text, size, "%s %.2g", name, value->worst);
    }
    return text;
}

static void tell(const char *scene, const struct hard_result *result)
{
    char checks[200], worst[100];
    printf("%-24s %-34.34s %-7s %-32s %8.2f s  %s\n", scene, result->run,
           result->passed ? "pass" : "FAIL", worst_text(result, worst, sizeof worst), result->wall,
           checks_text(result, checks, sizeof checks));
    if (!result->passed) printf("    %s\n", result->why);
    fflush(stdout);
}

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *describe(const char *scene, const struct hard_result *result)
{
    json_t *checks = json_object();
    for (int k = 0; k < HARD_CHECKS_COUNT; k++) {
        const struct hard_value *value = &result->values[k];
        if (!value->asked) continue;
        json_object_set_new(checks, hard_check_name((enum hard_check)k),
            json_pack("{s:o, s:o, s:o}", "worst", number(value->worst), "at_least",
                      number(value->low), "at_most", number(value->high)));
    }
    return json_pack("{s:s, s:s, s:b, s:s, s:s, s:o, s:f, s:f, s:I}", "scene", scene, "run",
        result->run, "passed", result->passed, "tightest", hard_check_name(result->tightest),
        "why", result->why, "checks", checks, "wall_seconds", result->wall, "cpu_seconds",
        result->cpu, "work", (json_int_t)result->steps);
}

/* All runs of one case; false if the case cannot be tried. */
static bool try_case(const char *scene, bool named, const struct options *options,
                     struct totals *totals, json_t *list, struct error *error)
{
    bool slow = false;
    const uint32_t runs = hard_runs(scene, &slow, error);
    if (runs == 0) return false;
    if (slow && !named && options_given(options, OPTION_quick)) return true;
    for (uint32_t k = 0; k < runs; k++) {
        struct hard_result result;
        if (!hard_try(scene, k, &result, error)) return false;
        totals->tried++;
        totals->failed += !result.passed;
        if (list) json_array_append_new(list, describe(scene, &result));
        else tell(scene, &result);
    }
    return true;
}

int cli_stress(const struct options *options)
{
    struct error error = {0};
    struct totals totals = {0};
    char name[64];
    const bool json = options_given(options, OPTION_json);
    json_t *list = json ? json_array() : NULL;
    bool done = opening_threads(options, &error) > 0;
    if (done && !json) {
        printf("%-24s %-34s %-7s %-32s %10s  %s\n", "case", "run", "result", "nearest to its limit",
               "wall time", "checked");
    }
    for (uint32_t k = 0; done && k < options->operand_count; k++) {
        done = try_case(options->operands[k], true, options, &totals, list, &error);
    }
    for (uint32_t k = 0; options->operand_count == 0 && hard_name(k, name, sizeof name); k++) {
        done = done && try_case(name, false, options, &totals, list, &error);
    }
    if (done && json) {
        json_t *root = json_pack("{s:o, s:i, s:i, s:o}", "versions", build_versions(), "tried",
                                 (int)totals.tried, "failed", (int)totals.failed, "runs", list);
        json_dumpf(root, stdout, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
        printf("\n");
        json_decref(root);
    } else if (json) {
        json_decref(list);
    }
    if (!done) return opening_fail(&error);
    if (!json) printf("%u runs, %u failed\n", totals.tried, totals.failed);
    return totals.failed > 0 ? EXIT_VERDICT : EXIT_DONE;
}
