/* plot.c - see plot.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/plot.h"

#include "base/file.h"
#include "base/text.h"
#include "run/folder.h"
#include "run/program.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct { const char *name, *ending, *terminal; } formats_list[] = {
#define X(name, ending, terminal) {#name, ending, terminal},
    PLOT_FORMATS(X)
#undef X
};

/* Eight colours that also the colour-blind tell apart (Okabe and Ito 2008), without the yellow,
 * which is too pale for lines on white. */
static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9",
                                      "#e69f00", "#666666"};
enum { COLOURS = sizeof colours / sizeof *colours };

/* The map 'inferno' of matplotlib (CC0) at ten places. */
static const char inferno[] = "0 '#000004', 1 '#1b0c41', 2 '#4a0c6b', 3 '#781c6d', 4 '#a52c60', "
                              "5 '#cf4446', 6 '#ed6925', 7 '#fb9b06', 8 '#f7d13d', 9 '#fcffa4'";

bool plot_parse(const char *words, unsigned *formats, struct error *error)
{
    *formats = 0;
    while (*words) {
        const size_t length = strcspn(words, ",");
        int f = 0;
        while (f < PLOT_FORMAT_COUNT && (strlen(formats_list[f].name) != length
                                         || strncmp(formats_list[f].name, words, length) != 0)) f++;
        if (f == PLOT_FORMAT_COUNT) {
            return error_set_code(error, EXIT_USAGE, "unknown format '%.*s' of plots; use png, "
                                  "svg, pdf, text, joined by commas", (int)length, words);
        }
        *formats |= 1u << f;
        words += length + (words[length] == ',');
    }
    return *formats || error_set_code(error, EXIT_USAGE, "no format of plots is named");
}

const char *plot_ending(enum plot_format format) { return formats_list[format].ending; }

bool plot_available(void) { return program_is_there("gnuplot"); }

/* A text in double quotes; what the script would take as commands is taken out. */
static void quote(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\' || *text == '`') continue;
        fputc(*text, out);
    }
    fputc('"', out);
}

static void write_range(FILE *out, const char *axis, const double range[2])
{
    if (isnan(range[0]) && isnan(range[1])) return;
    fprintf(out, "set %srange [", axis);
    if (!isnan(range[0])) fprintf(out, "%.9g", range[0]);
    fputc(':', out);
    if (!isnan(range[1])) fprintf(out, "%.9g", range[1]);
    fputs("]\n", out);
}

/* A whole grid, without its header; as text, which has no colours, the cells in the upper half of
 * the range. */
static void write_cells(FILE *out, const struct chart_curve *cells, const char *stem, bool text)
{
    double least = INFINITY, most = -INFINITY;
    for (uint32_t k = 0; k < cells->count; k++) {
        least = fmin(least, cells->error[k]);
        most = fmax(most, cells->error[k]);
    }
    fprintf(out, "    '%s.csv' every ::1 using ", stem);
    if (text) fprintf(out, "2:($4 > %.9g ? $3 : NaN) with points pt '#'", 0.5 * (least + most));
    else fputs("2:3:4 with image", out);
    fputs(" notitle", out);
}

static void write_curve(FILE *out, const struct chart *chart, uint32_t c, const char *stem)
{
    const struct chart_curve *curve = &chart->curves[c];
    uint32_t nth[2] = {0, 0};           /* of the laws and of the others before this one */
    for (uint32_t k = 0; k < c; k++) nth[chart->curves[k].style == CHART_LAW]++;
    const char *colour = colours[nth[0] % COLOURS];
    const unsigned point = 5 + nth[0] % 9;
    fprintf(out, "    '%s.csv' using (stringcolumn(1) eq ", stem);
    quote(out, curve->name);
    fputs(" ? column(2) : NaN):(column(3))", out);
    switch (curve->style) {
    case CHART_LINES: fprintf(out, " with lines lc rgb '%s'", colour); break;
    case CHART_POINTS: fprintf(out, " with points pt %u ps 0.9 lc rgb '%s'", point, colour); break;
    case CHART_ERRORS:
        fprintf(out, ":(column(4)) with yerrorbars pt %u ps 0.9 lc rgb '%s'", point, colour);
        break;
    case CHART_STEPS: fprintf(out, " with histeps lc rgb '%s'", colour); break;
    case CHART_LAW:
        fprintf(out, " with lines dt %u lc rgb 'black'", 2 + nth[1] % 4);
        break;
    case CHART_CELLS: break;
    }
    fputs(" title ", out);
    quote(out, curve->name);
}

static void write_script(FILE *out, const struct chart *chart, const char *stem, unsigned formats)
{
    fprintf(out, "# Draws %s.csv: gnuplot %s.gp\nset datafile separator ','\n", stem, stem);
    fputs("set title ", out);
    quote(out, chart->title);
    fputs(" noenhanced\nset xlabel ", out);
    quote(out, chart->x_label);
    fputs(" noenhanced\nset ylabel ", out);
    quote(out, chart->y_label);
    fprintf(out, " noenhanced\nset key %s noenhanced\nset grid lc rgb '#dddddd'\n",
            chart->key ? chart->key : "top right");
    if (chart->log_x) fputs("set logscale x\nset format x '%g'\n", out);
    if (chart->log_y) fputs("set logscale y\nset format y '%g'\n", out);
    if (chart->equal) fputs("set size ratio -1\n", out);
    for (uint32_t c = 0; c < chart->count; c++) {
        if (chart->curves[c].style != CHART_CELLS) continue;
        fprintf(out, "set palette defined (%s)\nset autoscale xfix\nset autoscale yfix\n"
                "set cblabel ", inferno);
        quote(out, chart->curves[c].name);
        fputs(" noenhanced\n", out);
    }
    write_range(out, "x", chart->x_range);
    write_range(out, "y", chart->y_range);
    for (uint32_t k = 0; k < chart->label_count; k++) {
        const struct chart_label *label = &chart->labels[k];
        fputs("set label ", out);
        quote(out, label->text);
        fprintf(out, " at %.9g,%.9g offset char 0.6,0.4 font ',8' noenhanced\n", label->x,
                label->y);
    }
    for (int f = 0; f < PLOT_FORMAT_COUNT; f++) {
        if (!(formats >> f & 1)) continue;
        fprintf(out, "set terminal %s\nset output '%s.%s'\nplot \\\n", formats_list[f].terminal,
                stem, formats_list[f].ending);
        if (chart->count == 0) fputs("NaN notitle\n", out);     /* the axes, at least */
        for (uint32_t c = 0; c < chart->count; c++) {
            if (chart->curves[c].style == CHART_CELLS) {
                write_cells(out, &chart->curves[c], stem, f == PLOT_BIT_text);
            } else {
                write_curve(out, chart, c, stem);
            }
            fputs(c + 1 < chart->count ? ", \\\n" : "\n", out);
        }
        fputs("unset output\n", out);
    }
}

static bool draw(const char *directory, const char *stem, const char *script, size_t size,
                 struct error *error)
{
    static const char *const arguments[] = {"gnuplot", "-", NULL};
    struct program program;
    bool done = program_start(&program, arguments, directory, error);
    if (done) {
        done = program_send(&program, script, size);
        if (!program_finish(&program) || !done) {
            char words[400];
            program_words(&program, words, sizeof words);
            done = error_set(error, "%s/%s: gnuplot could not draw this: %s", directory, stem,
                             *words ? words : "it ended early; is the disk full?");
        }
    }
    program_close(&program);
    return done;
}

bool plot_save(const struct chart *chart, const char *directory, const char *stem,
               unsigned formats, bool *drawn, struct error *error)
{
    char path[FILE_PATH_MAX];
    size_t size;
    struct text text;
    *drawn = false;
    if (text_begin(&text)) write_script(text.stream, chart, stem, formats);
    char *script = text_end(&text, &size);
    if (!script) return error_set(error, "not enough memory for the script of a plot");
    bool done = file_make_directory(directory, error)
        && chart_save_csv(chart, folder_path(path, directory, "%s.csv", stem), error)
        && file_save(folder_path(path, directory, "%s.gp", stem), script, size, error);
    if (done && plot_available()) {
        done = draw(directory, stem, script, size, error);
        *drawn = done;
    }
    free(script);
    return done;
}
