/* overlap.c - see overlap.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/overlap.h"

#include <math.h>

/* Integral of sqrt(1 - s^2) from -1 to t: the part of the upper half disc left of t. */
static double half_disc(double t)
{
    return 0.5 * (t * sqrt(1 - t * t) + asin(t) + M_PI_2);
}

double overlap_corner(double a, double b)
{
    if (a <= -1 || b <= -1) return 0;
    if (a >= 1) return b >= 1 ? M_PI : 2 * half_disc(b);
    if (b >= 1) return 2 * half_disc(a);
    if (a * a + b * b >= 1) {           /* the corner itself lies outside: whole caps only */
        if (a < 0 && b < 0) return 0;
        if (a < 0) return 2 * half_disc(a);
        if (b < 0) return 2 * half_disc(b);
        return 2 * half_disc(a) + 2 * half_disc(b) - M_PI;
    }
    /* Strips along y: from -1 to -c the line y = b misses the disc, from -c to a it cuts it. */
    const double c = sqrt(1 - b * b), left = half_disc(-c);
    return (b > 0 ? 2 * left : 0) + b * (a + c) + half_disc(a) - left;
}
