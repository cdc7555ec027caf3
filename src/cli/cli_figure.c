/* cli_figure.c - `figure [ID...]`: the figures of the papers made again, with verdicts.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "figure/page.h"
#include "run/folder.h"
#include "run/plot.h"

#include <dirent.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIGURES_MAX = 64 };

static int list_figures(bool json)
{
    json_t *list = json_array();
    for (const struct figure *f = figure_list; f->name; f++) {
        if (!json) printf("%-22s %s\n", f->name, f->title);
        json_array_append_new(list, json_pack("{s:s, s:s}", "name", f->name, "title", f->title));
    }
    if (json) {
        json_dumpf(list, stdout, JSON_INDENT(4));
        printf("\n");
    }
    json_decref(list);
    return EXIT_DONE;
}

static bool unknown(const char *word, struct error *error)
{
    const char *names[FIGURES_MAX + 1];
    size_t count = 0;
    for (const struct figure *f = figure_list; f->name && count < FIGURES_MAX; f++) {
        names[count++] = f->name;
    }
    names[count] = NULL;
    const char *nearest = options_nearest(word, names);
    return error_set_code(error, EXIT_USAGE, "figure: no figure '%s'%s%s%s", word,
                          nearest ? "; did you mean '" : "", nearest ? nearest : "",
                          nearest ? "'?" : "; `sandreel figure` lists them");
}

/* The figures named; `all` stands for every one. */
static bool choose(const struct options *options, const struct figure *chosen[FIGURES_MAX],
                   uint32_t *count, struct error *error)
{
    *count = 0;
    for (uint32_t k = 0; k < options->operand_count; k++) {
        const char *word = options->operands[k];
        if (strcmp(word, "all") == 0) {
            *count = 0;
            for (const struct figure *f = figure_list; f->name; f++) chosen[(*count)++] = f;
            return true;
        }
        const struct figure *figure = figure_find(word);
        if (!figure) return unknown(word, error);
        if (*count < FIGURES_MAX) chosen[(*count)++] = figure;
    }
    return true;
}

static json_t *words(const char (*list)[FIGURE_NAME], uint32_t count)
{
    json_t *array = json_array();
    for (uint32_t k = 0; k < count; k++) json_array_append_new(array, json_string(list[k]));
    return array;
}

static json_t *describe(const struct figure_job *job, const struct error *failure)
{
    return json_pack("{s:s, s:s, s:b, s:s, s:s, s:s, s:o, s:o, s:s, s:f, s:f}",
        "name", job->figure->name, "title", job->figure->title, "quick", job->quick,
        "outcome", *failure->text ? "failed" : figure_outcome_words(job->outcome),
        "verdict", *failure->text ? failure->text : job->verdict, "choices", job->choices,
        "pictures", words((const char (*)[FIGURE_NAME])job->pictures, job->picture_count),
        "tables", words((const char (*)[FIGURE_NAME])job->tables, job->table_count),
        "commands", job->commands, "wall_seconds", job->wall, "cpu_seconds", job->cpu);
}

static void tell(const struct figure_job *job, const struct error *failure)
{
    printf("%s: %s: %s (%.1f s)\n", job->figure->name,
           *failure->text ? "failed" : figure_outcome_words(job->outcome),
           *failure->text ? failure->text : job->verdict, job->wall);
    fflush(stdout);
}

struct studio {
    const struct options *options;
    const struct figure *chosen[FIGURES_MAX];
    struct figure_job jobs[FIGURES_MAX];
    struct error failures[FIGURES_MAX];
    uint32_t count;
    const char *directory;
    unsigned formats;
};

/* Makes all that was chosen; one that fails does not stop the rest, a signal does. */
static bool make_all(struct studio *studio, struct progress *progress, struct error *error)
{
    const bool json = options_given(studio->options, OPTION_json);
    for (uint32_t k = 0; k < studio->count; k++) {
        struct figure_job *job = &studio->jobs[k];
        *job = (struct figure_job){
            .figure = studio->chosen[k], .quick = options_given(studio->options, OPTION_small),
            .directory = studio->directory, .formats = studio->formats,
            .report = opening_report, .context = progress, .signal = &opening_signal};
        struct error *failure = &studio->failures[k];
        if (!figure_make(job, failure) && opening_signal) {
            *error = *failure;
            return false;
        }
        progress_end(progress);
        if (!json) tell(job, failure);
        if (job->undrawn && !json) {
            fprintf(stderr, "sandreel: no gnuplot on the PATH: tables and scripts only; install it "
                    "(Debian: sudo apt install gnuplot-nox), then `gnuplot NAME.gp`\n");
        }
    }
    return true;
}

/* Is it a file of this figure?  They are called NAME.png, NAME-suffix.csv and the like. */
static bool belongs_to(const char *file, const struct figure *figure)
{
    const size_t length = strlen(figure->name);
    return strncmp(file, figure->name, length) == 0 && file[length] && strchr(".-", file[length]);
}

/* What would be overwritten is seen before hours are spent. */
static bool are_absent(const struct studio *studio, struct error *error)
{
    DIR *list = options_given(studio->options, OPTION_force) ? NULL : opendir(studio->directory);
    bool done = true;
    for (struct dirent *entry; done && list && (entry = readdir(list));) {
        bool found = studio->count > 1 && strcmp(entry->d_name, "index.html") == 0;
        for (uint32_t k = 0; k < studio->count; k++) {
            found = found || belongs_to(entry->d_name, studio->chosen[k]);
        }
        char path[FILE_PATH_MAX];
        folder_path(path, studio->directory, "%s", entry->d_name);
        if (found) done = file_absent(path, error);
    }
    if (list) closedir(list);
    return done;
}

/* Failures weigh more than verdicts. */
static int code_of(const struct studio *studio)
{
    int code = EXIT_DONE;
    for (uint32_t k = 0; k < studio->count; k++) {
        if (*studio->failures[k].text) return EXIT_FAILED;
        if (studio->jobs[k].outcome != FIGURE_agrees) code = EXIT_VERDICT;
    }
    return code;
}

static bool finish(const struct studio *studio, struct error *error)
{
    const bool json = options_given(studio->options, OPTION_json);
    bool done = true;
    if (json) {
        json_t *list = json_array();
        for (uint32_t k = 0; k < studio->count; k++) {
            json_array_append_new(list, describe(&studio->jobs[k], &studio->failures[k]));
        }
        json_dumpf(list, stdout, JSON_INDENT(4) | JSON_REAL_PRECISION(9));
        printf("\n");
        json_decref(list);
    }
    if (studio->count > 1) {
        done = page_save(studio->directory, studio->jobs, studio->failures, studio->count, error);
        if (done && !json) printf("%s/index.html\n", studio->directory);
    }
    return done;
}

int cli_figure(const struct options *options)
{
    struct error error = {0};
    struct progress progress;
    if (options->operand_count == 0) return list_figures(options_given(options, OPTION_json));
    struct studio *studio = calloc(1, sizeof *studio);
    if (!studio) {
        error_set(&error, "not enough memory");
        return opening_fail(&error);
    }
    const char *as = options->values[OPTION_plot_as], *output = options->values[OPTION_output];
    studio->options = options;
    studio->directory = output ? output : "figures";
    const bool done = opening_threads(options, &error) > 0
        && choose(options, studio->chosen, &studio->count, &error)
        && are_absent(studio, &error)
        && plot_parse(as ? as : "png,svg", &studio->formats, &error)
        && progress_begin(&progress, options->values[OPTION_progress], &error);
    int code = EXIT_DONE;
    if (done) {
        /* The page shows PNG files. */
        studio->formats |= 1u << PLOT_BIT_png;
        opening_catch_signals();
        code = make_all(studio, &progress, &error) && finish(studio, &error)
             ? code_of(studio) : opening_fail(&error);
    } else {
        code = opening_fail(&error);
    }
    free(studio);
    return code;
}
