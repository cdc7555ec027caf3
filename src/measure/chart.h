/* chart.h - curves that belong together, with their axes: what a plot shows and a table holds.
 *
 * A chart remembers its first failure (no memory), so that a long list of points is checked once,
 * when it is saved.  It knows nothing of the program that draws it.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CHART_H
#define CHART_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

enum chart_style {
    CHART_LINES,                /* what a simulation gave, point after point */
    CHART_POINTS,
    CHART_ERRORS,               /* points with error bars */
    CHART_STEPS,                /* histograms */
    CHART_LAW,                  /* a law or a fit: dashed, black */
    CHART_CELLS                 /* a grid of cells, x running fastest, coloured by a value in the
                                 * place of the error; named by the curve beside a colour bar; a
                                 * chart of cells has no other curve */
};

enum { CHART_CURVES = 24, CHART_TEXT = 160, CHART_LABELS = 64, CHART_LABEL_TEXT = 48 };

struct chart_label { double x, y; char text[CHART_LABEL_TEXT]; };

struct chart_curve {
    char     name[CHART_TEXT];
    enum chart_style style;
    uint32_t count, capacity;
    double  *x, *y, *error;
};

struct chart {
    char   title[CHART_TEXT], x_label[CHART_TEXT], y_label[CHART_TEXT];
    bool   log_x, log_y;
    bool   equal;               /* both axes in the same scale, as for maps and orbits */
    double x_range[2], y_range[2];      /* NANs: from the curves */
    const char *key;            /* where the names of the curves stand; NULL: "top right" */
    uint32_t count;
    struct chart_curve curves[CHART_CURVES];
    uint32_t label_count;
    struct chart_label labels[CHART_LABELS];    /* words beside points */
    bool   failed;
};

/* "r/d" or "time [s]": labels are free text. */
void chart_begin(struct chart *chart, const char *title, const char *x_label, const char *y_label);
void chart_free(struct chart *chart);

/* A new curve; the points that follow belong to it. */
void chart_curve(struct chart *chart, enum chart_style style, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

void chart_point(struct chart *chart, double x, double y);
void chart_error(struct chart *chart, double x, double y, double error);

/* Words to the right of a place, in small letters.  Past CHART_LABELS they are dropped. */
void chart_label(struct chart *chart, double x, double y, const char *text);

/* Straight from a function: `count` points from x0 to x1, evenly or on a logarithmic scale like
 * the chart's. */
void chart_law(struct chart *chart, const char *name, double (*law)(double x, const void *context),
               const void *context, double x0, double x1, uint32_t count);

/* The y of the curve number `curve` at x, straight lines between its points; NAN outside. */
double chart_at(const struct chart *chart, uint32_t curve, double x);

/* A table "curve,x,y,error", one line a point, curves one after the other; points without an
 * error say nan. */
bool chart_save_csv(const struct chart *chart, const char *path, struct error *error);

#endif
