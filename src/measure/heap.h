/* heap.h - the surface of a heap and the slopes of its flanks.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef HEAP_H
#define HEAP_H

#include "base/error.h"
#include "model/grains.h"

#include <stdbool.h>
#include <stdint.h>

struct heap {
    double   x0, width;         /* left end and width of a bin */
    uint32_t bins;
    double  *height;            /* of the surface above the base at the middle of each bin */
    double   base;
};

/* The surface between x0 and x1: the highest point of any disc above the middle of each bin, 0
 * where there is none.  Grains faster than `speed_max` are still falling and are left out
 * (INFINITY: all count).  Bins of about one diameter; the caller frees. */
bool heap_create(const struct grains *grains, double x0, double x1, uint32_t bins, double base,
                 double speed_max, struct heap *heap, struct error *error);
void heap_free(struct heap *heap);

struct heap_slope {
    double left, left_error;    /* tan of the angle, positive uphill to the top; NAN: no flank */
    double right, right_error;
    double slope, slope_error;  /* both flanks, weighted alike */
    double angle, angle_error;  /* of that slope, degrees */
    double top_x, top;          /* where the top is, and its height */
};

/* Straight lines through what lies between `low` and `high` shares of the height (0.15 and 0.85
 * leave the rounded top and the tails out).  The errors are those of the fits: neighbouring bins
 * share grains, so take bins of a diameter or more. */
struct heap_slope heap_slope(const struct heap *heap, double low, double high);

/* The shape of a heap with its tail, simplified (8):
 *
 *     x = (h_m - h) / m + (l/r) ln(h_m / h)
 *
 * x from the middle of the heap; a straight flank of slope m, and a tail that thins out over
 * l/r. */
struct heap_tail {
    double slope, slope_error;  /* m */
    double tail, tail_error;    /* l/r */
    double height, height_error;        /* h_m */
    double middle;              /* x of it */
    double rms;                 /* of x about the curve */
    double rms_line;            /* about the best straight line, for comparison */
    uint32_t points;
};

/* Both flanks together, from `foot` (a height; a diameter leaves single grains out) to the share
 * `high` of the top (0.95 leaves the crater of the source out).  Errors are those of the fit, the
 * height's included; neighbouring bins share grains, so take bins of a diameter or more.  NANs if
 * there are fewer than four points. */
bool heap_tail(const struct heap *heap, double foot, double high, struct heap_tail *tail,
               struct error *error);

/* The same through given points, x from the middle and a height h > 0. */
bool heap_tail_through(const double *x, const double *h, uint32_t points, struct heap_tail *tail,
                       struct error *error);

/* x of eq. 8 at a height. */
double heap_tail_x(const struct heap_tail *tail, double h);

#endif
