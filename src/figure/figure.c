/* figure.c - see figure.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/figure.h"

#include "base/clock.h"
#include "run/folder.h"
#include "run/plot.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const struct figure figure_list[] = {
#define X(name, function, title) {name, title, function},
    FIGURES(X)
#undef X
    {0}
};

const struct figure *figure_find(const char *name)
{
    for (const struct figure *f = figure_list; f->name; f++) {
        if (strcmp(f->name, name) == 0) return f;
    }
    return NULL;
}

const char *figure_outcome_words(enum figure_outcome outcome)
{
    static const char *const words[] = {
#define X(name, text) text,
        FIGURE_OUTCOMES(X)
#undef X
    };
    return words[outcome];
}

static void append(char text[FIGURE_WORDS], const char *before, const char *format,
                   va_list arguments)
{
    size_t used = strlen(text);
    used += (size_t)snprintf(text + used, FIGURE_WORDS - used, "%s%s", used ? "; " : "", before);
    if (used < FIGURE_WORDS) vsnprintf(text + used, FIGURE_WORDS - used, format, arguments);
}

void figure_say(struct figure_job *job, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    append(job->verdict, "", format, arguments);
    va_end(arguments);
}

void figure_choose(struct figure_job *job, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    append(job->choices, "", format, arguments);
    va_end(arguments);
}

static void worsen(struct figure_job *job, enum figure_outcome outcome)
{
    if (outcome > job->outcome) job->outcome = outcome;
}

void figure_near(struct figure_job *job, const char *what, double measured, double reference,
                 double tolerance)
{
    const bool near = fabs(measured - reference) <= tolerance;      /* false for NAN */
    if (!near) worsen(job, FIGURE_differs);
    figure_say(job, "%s%s %.4g (%.4g +- %.2g)", near ? "" : "not as expected: ", what, measured,
               reference, tolerance);
}

void figure_hold(struct figure_job *job, bool holds, const char *format, ...)
{
    if (!holds) worsen(job, FIGURE_differs);
    va_list arguments;
    va_start(arguments, format);
    append(job->verdict, holds ? "" : "not: ", format, arguments);
    va_end(arguments);
}

void figure_miss(struct figure_job *job, bool known, const char *format, ...)
{
    worsen(job, known ? FIGURE_not_reproduced : FIGURE_differs);
    va_list arguments;
    va_start(arguments, format);
    append(job->verdict, "", format, arguments);
    va_end(arguments);
}

/* "cooperative-9" or "cooperative-9-rate". */
static void make_stem(const struct figure_job *job, const char *suffix, char stem[FIGURE_NAME])
{
    snprintf(stem, FIGURE_NAME, "%s%s%s", job->figure->name, *suffix ? "-" : "", suffix);
}

static void note_file(char files[FIGURE_FILES][FIGURE_NAME], uint32_t *count, const char *stem,
                      const char *ending)
{
    assert(*count < FIGURE_FILES);
    snprintf(files[(*count)++], FIGURE_NAME, "%.70s.%s", stem, ending);
}

bool figure_chart(struct figure_job *job, bool done, struct chart *chart, const char *suffix,
                  struct error *error)
{
    char stem[FIGURE_NAME];
    bool drawn = false;
    make_stem(job, suffix, stem);
    done = done && plot_save(chart, job->directory, stem, job->formats, &drawn, error);
    if (done) note_file(job->tables, &job->table_count, stem, "csv");
    if (drawn) note_file(job->pictures, &job->picture_count, stem, "png");
    job->undrawn = job->undrawn || (done && !drawn);
    chart_free(chart);
    return done;
}

void figure_picture(struct figure_job *job, const char *suffix, char path[FILE_PATH_MAX])
{
    char stem[FIGURE_NAME];
    make_stem(job, suffix, stem);
    note_file(job->pictures, &job->picture_count, stem, "png");
    folder_path(path, job->directory, "%s", job->pictures[job->picture_count - 1]);
}

bool figure_make(struct figure_job *job, struct error *error)
{
    const double wall = clock_wall(), cpu = clock_process();
    const bool done = file_make_directory(job->directory, error) && job->figure->make(job, error);
    job->wall = clock_wall() - wall;
    job->cpu = clock_process() - cpu;
    return done;
}
