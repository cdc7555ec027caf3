/* heap.c - see heap.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/heap.h"

#include "measure/stats.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

bool heap_create(const struct grains *grains, double x0, double x1, uint32_t bins, double base,
                 double speed_max, struct heap *heap, struct error *error)
{
    assert(bins > 0);
    assert(x1 > x0);
    *heap = (struct heap){.x0 = x0, .width = (x1 - x0) / bins, .bins = bins, .base = base};
    heap->height = calloc(bins, sizeof *heap->height);
    if (!heap->height) return error_set(error, "not enough memory for a profile of %u bins", bins);
    for (uint32_t k = 0; k < grains->count; k++) {
        const double r = grains->radius[k];
        if (!(hypot(grains->vx[k], grains->vy[k]) <= speed_max)) continue;
        /* Bins whose middle x0 + (b + 1/2) width lies within r of the centre. */
        const double from = ceil((grains->x[k] - r - x0) / heap->width - 0.5);
        const double to = floor((grains->x[k] + r - x0) / heap->width - 0.5);
        for (double b = fmax(0, from); b <= fmin(to, bins - 1.0); b++) {
            const double dx = x0 + (b + 0.5) * heap->width - grains->x[k];
            const double top = grains->y[k] + sqrt(fmax(0, r * r - dx * dx)) - base;
            double *height = &heap->height[(uint32_t)b];
            if (top > *height) *height = top;
        }
    }
    return true;
}

void heap_free(struct heap *heap)
{
    free(heap->height);
    *heap = (struct heap){0};
}

/* The line through the bins first .. last-1 whose height is between low and high; NANs without
 * memory or bins.  A flank ends where it leaves the range for good: grains that rolled away
 * beyond its foot are not part of it. */
static struct stats_line flank(const struct heap *heap, uint32_t top, int step, double low,
                               double high)
{
    double *x = malloc(2 * (size_t)heap->bins * sizeof *x);
    if (!x) return stats_line(NULL, NULL, 0);
    double *y = x + heap->bins;
    size_t count = 0;
    for (int64_t b = top; b >= 0 && b < heap->bins; b += step) {
        const double h = heap->height[b];
        if (h < low || h <= 0) break;
        if (h > high) continue;
        x[count] = heap->x0 + ((double)b + 0.5) * heap->width;
        y[count++] = h;
    }
    const struct stats_line line = stats_line(x, y, count);
    free(x);
    return line;
}

struct heap_slope heap_slope(const struct heap *heap, double low, double high)
{
    uint32_t top = 0;
    for (uint32_t b = 1; b < heap->bins; b++) if (heap->height[b] > heap->height[top]) top = b;
    const double full = heap->height[top];
    const struct stats_line left = flank(heap, top, -1, low * full, high * full);
    const struct stats_line right = flank(heap, top, 1, low * full, high * full);
    struct heap_slope slope = {
        .left = left.slope, .left_error = left.slope_error,
        .right = -right.slope, .right_error = right.slope_error,
        .top_x = heap->x0 + (top + 0.5) * heap->width, .top = full};
    slope.slope = 0.5 * (slope.left + slope.right);
    slope.slope_error = 0.5 * hypot(slope.left_error, slope.right_error);
    if (isnan(slope.left)) slope.slope = slope.right, slope.slope_error = slope.right_error;
    if (isnan(slope.right)) slope.slope = slope.left, slope.slope_error = slope.left_error;
    slope.angle = atan(slope.slope) * 180 / M_PI;
    slope.angle_error = slope.slope_error / (1 + slope.slope * slope.slope) * 180 / M_PI;
    return slope;
}

/* Where the lines through both flanks meet; the top if one of them is not there. */
static double middle_of(const struct heap *heap)
{
    uint32_t top = 0;
    for (uint32_t b = 1; b < heap->bins; b++) if (heap->height[b] > heap->height[top]) top = b;
    const double full = heap->height[top];
    const struct stats_line left = flank(heap, top, -1, 0.15 * full, 0.85 * full);
    const struct stats_line right = flank(heap, top, 1, 0.15 * full, 0.85 * full);
    const double x = (right.offset - left.offset) / (left.slope - right.slope);
    return isfinite(x) ? x : heap->x0 + (top + 0.5) * heap->width;
}

/* c = h/m + (l/r) ln h grows with h: the h_m that gives the c of the fit. */
static double solve_height(const struct stats_plane *fit, double guess)
{
    double h = guess;
    for (int k = 0; k < 60; k++) {
        const double f = -fit->p[1] * h - fit->p[2] * log(h) - fit->p[0];
        const double next = h - f / (-fit->p[1] - fit->p[2] / h);
        if (!(next > 0)) return NAN;
        if (fabs(next - h) < 1e-12 * h) return next;
        h = next;
    }
    return NAN;
}

/* x = c - h/m - (l/r) ln h is linear in c, 1/m and l/r, so there is nothing to guess. */
bool heap_tail_through(const double *x, const double *h, uint32_t points, struct heap_tail *tail,
                       struct error *error)
{
    double *logs = calloc(points + 1u, sizeof *logs), full = 0, rest = 0;
    if (!logs) return error_set(error, "not enough memory to fit a heap by %u points", points);
    for (uint32_t k = 0; k < points; k++) {
        logs[k] = log(h[k]);
        full = fmax(full, h[k]);
    }
    const struct stats_plane fit = stats_plane(h, logs, x, points);
    const struct stats_line line = stats_line(h, x, points);
    for (uint32_t k = 0; k < points; k++) {
        rest += pow(x[k] - line.offset - line.slope * h[k], 2);
    }
    free(logs);
    const double hm = solve_height(&fit, full), m = -1 / fit.p[1];
    *tail = (struct heap_tail){
        .slope = m, .slope_error = m * m * sqrt(fit.covariance[1][1]),
        .tail = -fit.p[2], .tail_error = sqrt(fit.covariance[2][2]), .height = hm,
        .rms = fit.rms, .rms_line = sqrt(rest / points), .points = points};
    const double gradient[3] = {1, hm, log(hm)};
    double spread2 = 0;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) spread2 += gradient[r] * fit.covariance[r][c] * gradient[c];
    }
    tail->height_error = sqrt(fmax(0, spread2)) / fabs(1 / m + tail->tail / hm);
    return true;
}

bool heap_tail(const struct heap *heap, double foot, double high, struct heap_tail *tail,
               struct error *error)
{
    const double middle = middle_of(heap);
    double *x = malloc(2 * (size_t)heap->bins * sizeof *x), full = 0;
    if (!x) return error_set(error, "not enough memory to fit a heap of %u bins", heap->bins);
    double *h = x + heap->bins;
    uint32_t points = 0;
    for (uint32_t b = 0; b < heap->bins; b++) full = fmax(full, heap->height[b]);
    for (uint32_t b = 0; b < heap->bins; b++) {
        if (!(heap->height[b] >= foot) || heap->height[b] > high * full) continue;
        h[points] = heap->height[b];
        x[points++] = fabs(heap->x0 + (b + 0.5) * heap->width - middle);
    }
    const bool done = heap_tail_through(x, h, points, tail, error);
    tail->middle = middle;
    free(x);
    return done;
}

double heap_tail_x(const struct heap_tail *tail, double h)
{
    return (tail->height - h) / tail->slope + tail->tail * log(tail->height / h);
}
