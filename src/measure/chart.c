/* chart.c - see chart.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/chart.h"

#include "base/file.h"
#include "measure/csv.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void chart_begin(struct chart *chart, const char *title, const char *x_label, const char *y_label)
{
    *chart = (struct chart){.x_range = {NAN, NAN}, .y_range = {NAN, NAN}};
    snprintf(chart->title, sizeof chart->title, "%s", title);
    snprintf(chart->x_label, sizeof chart->x_label, "%s", x_label);
    snprintf(chart->y_label, sizeof chart->y_label, "%s", y_label);
}

void chart_free(struct chart *chart)
{
    for (uint32_t c = 0; c < chart->count; c++) {
        free(chart->curves[c].x);
        free(chart->curves[c].y);
        free(chart->curves[c].error);
    }
    *chart = (struct chart){0};
}

void chart_curve(struct chart *chart, enum chart_style style, const char *format, ...)
{
    assert(chart->count < CHART_CURVES);
    struct chart_curve *curve = &chart->curves[chart->count++];
    *curve = (struct chart_curve){.style = style};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(curve->name, sizeof curve->name, format, arguments);
    va_end(arguments);
    /* The name is a field of a CSV line and a word of a script. */
    for (char *at = curve->name; *at; at++) if (*at == ',' || *at == '"') *at = ';';
}

static bool grow(struct chart_curve *curve)
{
    const uint32_t wanted = curve->capacity ? 2 * curve->capacity : 64;
    double **const arrays[] = {&curve->x, &curve->y, &curve->error};
    for (int k = 0; k < 3; k++) {
        double *larger = realloc(*arrays[k], wanted * sizeof *larger);
        if (!larger) return false;
        *arrays[k] = larger;
    }
    curve->capacity = wanted;
    return true;
}

void chart_error(struct chart *chart, double x, double y, double error)
{
    assert(chart->count > 0);
    struct chart_curve *curve = &chart->curves[chart->count - 1];
    if (curve->count == curve->capacity && !grow(curve)) {
        chart->failed = true;
        return;
    }
    curve->x[curve->count] = x;
    curve->y[curve->count] = y;
    curve->error[curve->count++] = error;
}

void chart_point(struct chart *chart, double x, double y) { chart_error(chart, x, y, NAN); }

void chart_label(struct chart *chart, double x, double y, const char *text)
{
    if (chart->label_count == CHART_LABELS) return;
    struct chart_label *label = &chart->labels[chart->label_count++];
    label->x = x;
    label->y = y;
    snprintf(label->text, sizeof label->text, "%s", text);
}

void chart_law(struct chart *chart, const char *name, double (*law)(double x, const void *context),
               const void *context, double x0, double x1, uint32_t count)
{
    assert(count > 1);
    chart_curve(chart, CHART_LAW, "%s", name);
    for (uint32_t k = 0; k < count; k++) {
        const double share = (double)k / (count - 1);
        const double x = chart->log_x ? x0 * pow(x1 / x0, share) : x0 + (x1 - x0) * share;
        chart_point(chart, x, law(x, context));
    }
}

double chart_at(const struct chart *chart, uint32_t curve, double x)
{
    assert(curve < chart->count);
    const struct chart_curve *c = &chart->curves[curve];
    for (uint32_t k = 1; k < c->count; k++) {
        if (!(c->x[k - 1] <= x && x <= c->x[k])) continue;
        const double span = c->x[k] - c->x[k - 1];
        if (!(span > 0)) return c->y[k];
        return c->y[k - 1] + (c->y[k] - c->y[k - 1]) * (x - c->x[k - 1]) / span;
    }
    return NAN;
}

bool chart_save_csv(const struct chart *chart, const char *path, struct error *error)
{
    struct file file;
    if (chart->failed) return error_set(error, "%s: not enough memory for its curves", path);
    if (!file_begin(&file, path, error)) return false;
    fprintf(file.stream, "curve,x,y,error\n# units: ,%s,%s,\n", chart->x_label, chart->y_label);
    for (uint32_t c = 0; c < chart->count; c++) {
        const struct chart_curve *curve = &chart->curves[c];
        for (uint32_t k = 0; k < curve->count; k++) {
            const double numbers[] = {curve->x[k], curve->y[k], curve->error[k]};
            fputs(curve->name, file.stream);
            for (int n = 0; n < 3; n++) {
                fputc(',', file.stream);
                csv_number(file.stream, numbers[n]);
            }
            fputc('\n', file.stream);
        }
    }
    return file_commit(&file, error);
}
