/* ed_root.c - see ed_root.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_root.h"

#include <math.h>
#include <stdbool.h>

static double value(const double *c, int degree, double s)
{
    double sum = c[degree];
    for (int k = degree - 1; k >= 0; k--) sum = sum * s + c[k];
    return sum;
}

/* The one zero between a and b, where the polynomial runs one way: bisection, sped up by a secant
 * step whenever that stays inside; 200 halvings exhaust any pair of doubles. */
static double zero_between(const double *c, int degree, double a, double b)
{
    double fa = value(c, degree, a), fb = value(c, degree, b);
    for (int turn = 0; turn < 200; turn++) {
        if (fa == 0) return a;
        if (fb == 0) return b;
        double s = turn % 3 == 2 ? 0.5 * (a + b) : a + (b - a) * (fa / (fa - fb));
        if (!(s > a && s < b)) s = 0.5 * (a + b);
        if (!(s > a && s < b)) break;                           /* neighbours: done */
        const double fs = value(c, degree, s);
        if ((fs > 0) == (fa > 0)) {
            a = s;
            fa = fs;
        } else {
            b = s;
            fb = fs;
        }
        if (b - a <= 1e-16 * b) break;
    }
    return a;
}

/* All sign changes in [0, s_max], ascending, falling or rising. */
static int changes(const double *c, int degree, double s_max, double *times)
{
    while (degree > 0 && c[degree] == 0) degree--;
    if (degree == 0) return 0;
    if (degree == 1) {
        times[0] = -c[0] / c[1];
        return (c[0] >= 0) != (c[0] + c[1] * s_max >= 0);
    }
    double slope[ED_ROOT_MAX + 1] = {0}, turns[ED_ROOT_MAX + 2] = {0};
    for (int k = 1; k <= degree; k++) slope[k - 1] = k * c[k];
    const int turn_count = changes(slope, degree - 1, s_max, turns + 1);
    turns[turn_count + 1] = s_max;
    int count = 0;
    for (int k = 0; k <= turn_count; k++) {
        const double a = turns[k], b = turns[k + 1];
        const bool before = value(c, degree, a) >= 0, after = value(c, degree, b) >= 0;
        if (before != after && count < ED_ROOT_MAX) times[count++] = zero_between(c, degree, a, b);
    }
    return count;
}

int ed_root_falls(const double *c, int degree, double s_max, double times[ED_ROOT_MAX])
{
    double all[ED_ROOT_MAX + 1], largest = 0;
    while (degree > 0 && c[degree] == 0) degree--;
    for (int k = 0; k < degree; k++) largest = fmax(largest, fabs(c[k] / c[degree]));
    /* Cauchy: no root lies beyond. */
    const int n = changes(c, degree, fmin(s_max, 1 + largest), all);
    /* Signs alternate from one change to the next; the first tells what all are.  c[0] = 0 counts
     * as positive, so a quantity that starts at zero and falls does so at s = 0. */
    int count = 0;
    bool positive = c[0] >= 0;
    for (int k = 0; k < n; k++) {
        if (positive) times[count++] = all[k];
        positive = !positive;
    }
    return count;
}
