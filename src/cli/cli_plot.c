/* cli_plot.c - `plot RUN --of WHAT`: what was measured, drawn by gnuplot.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/folder.h"
#include "run/gauge.h"
#include "run/plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool choose(const char *word, const struct gauge **gauge, struct error *error)
{
    enum { NAMES_MAX = 64 };
    const char *names[NAMES_MAX];
    char all[400] = "";
    size_t count = 0;
    for (const struct gauge *g = gauge_list; g->name && count < NAMES_MAX - 1; g++) {
        const size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", used ? ", " : "", g->name);
        names[count++] = g->name;
    }
    names[count] = NULL;
    if (!word) return error_set_code(error, EXIT_USAGE, "plot: needs --of WHAT: %s", all);
    *gauge = gauge_find(word);
    if (*gauge) return true;
    const char *nearest = options_nearest(word, names);
    return error_set_code(error, EXIT_USAGE, "--of %s: nothing of this name; %s%s%s%s", word,
                          nearest ? "did you mean '" : "", nearest ? nearest : "",
                          nearest ? "'? There are " : "there are ", all);
}

/* Prints the plot for terminals, which gnuplot wrote into a file. */
static bool show_text(const char *directory, const char *stem, struct error *error)
{
    char path[FILE_PATH_MAX];
    size_t size;
    char *text = file_load(folder_path(path, directory, "%s.%s", stem,
                                       plot_ending(PLOT_BIT_text)), 1 << 20, &size, error);
    if (!text) return false;
    fwrite(text, 1, size, stdout);
    free(text);
    return true;
}

static void tell(const char *directory, const char *stem, unsigned formats, bool drawn)
{
    if (!drawn) {
        fprintf(stderr, "sandreel: no gnuplot on the PATH: the table and the script only; install "
                "it (Debian: sudo apt install gnuplot-nox), then `gnuplot %s.gp`\n", stem);
        printf("%s/%s.csv\n", directory, stem);
        return;
    }
    for (int f = 0; f < PLOT_FORMAT_COUNT; f++) {
        if (formats >> f & 1 && f != PLOT_BIT_text) {
            printf("%s/%s.%s\n", directory, stem, plot_ending((enum plot_format)f));
        }
    }
}

/* Where plot `gauge` of this run goes. */
static const char *place_of(const struct options *options, const struct gauge *gauge,
                            const char *run, char stem[80])
{
    const char *output = options->values[OPTION_output];
    snprintf(stem, 80, "plot-%s", gauge->name);
    return output ? output : setup_is_run(run) ? run : ".";
}

static bool is_absent(const struct options *options, const struct gauge *gauge, const char *run,
                      struct error *error)
{
    char stem[80], path[FILE_PATH_MAX];
    const char *directory = place_of(options, gauge, run, stem);
    return options_given(options, OPTION_force)
        || file_absent(folder_path(path, directory, "%s.csv", stem), error);
}

static bool plot(const struct options *options, const struct gauge *gauge, unsigned formats,
                 struct gauge_job *job, struct error *error)
{
    struct chart chart;
    bool drawn = false;
    char stem[80];
    const char *directory = place_of(options, gauge, job->run, stem);
    const bool done = gauge_draw(gauge, job, &chart, error)
        && plot_save(&chart, directory, stem, formats, &drawn, error);
    chart_free(&chart);
    if (!done) return false;
    if (*job->note) printf("%s\n", job->note);
    tell(directory, stem, formats, drawn);
    return !(drawn && formats >> PLOT_BIT_text & 1) || show_text(directory, stem, error);
}

int cli_plot(const struct options *options)
{
    struct error error = {0};
    struct setup setup = {0};
    struct footage footage = {0};
    struct progress progress;
    const struct gauge *gauge = NULL;
    unsigned formats = 0;
    const char *path = options->operands[0], *as = options->values[OPTION_plot_as];
    struct gauge_job job = {.run = path, .setup = &setup, .footage = &footage};
    bool done = choose(options->values[OPTION_of], &gauge, &error)
        && is_absent(options, gauge, path, &error)
        && opening_threads(options, &error) > 0
        && plot_parse(as ? as : "png", &formats, &error)
        && options_real(options, OPTION_time, NAN, &job.time, &error)
        && progress_begin(&progress, options->values[OPTION_progress], &error);
    const bool simulates = done && gauge->looks && !footage_has_dumps(path);
    done = done && opening_load(&setup, options, path, NULL, simulates, &error)
        && (!gauge->looks || footage_open(&footage, &setup, path, false, &error));
    if (done) {
        opening_catch_signals();
        footage.report = opening_report;
        footage.context = &progress;
        footage.signal = &opening_signal;
        done = plot(options, gauge, formats, &job, &error);
        progress_end(&progress);
    }
    footage_close(&footage);
    setup_free(&setup);
    return done ? EXIT_DONE : opening_fail(&error);
}
