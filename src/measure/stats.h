/* stats.h - means of series with errors that know of correlation, and fits of lines and parabolas
 * with the errors of what is fitted.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_H
#define STATS_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

struct stats_mean {
    double mean, deviation;     /* of the single values */
    double error;               /* of the mean, correlation counted in */
    double error_error;         /* statistical uncertainty of `error` */
    double correlation;         /* 2 x integrated correlation time, in values: 1 if independent */
    size_t block;               /* values in a block where the error has settled */
    bool   settled;             /* false: the series is too short, the error a lower bound */
};

/* Blocking after Flyvbjerg and Petersen (1989), the block chosen after Lee et al. (2011).  NANs
 * for an empty series. False if there is no memory. */
bool stats_mean(const double *values, size_t count, struct stats_mean *out, struct error *error);

struct stats_line {
    double slope, offset;       /* y = offset + slope x */
    double slope_error, offset_error;   /* from the scatter about the line */
    size_t count;
};

/* Least squares; NANs where undetermined (fewer than two different x; errors: than three). */
struct stats_line stats_line(const double *x, const double *y, size_t count);

struct stats_plane {
    double p[3];                /* y = p[0] + p[1] u + p[2] v */
    double covariance[3][3];    /* from the scatter about the plane */
    double rms;                 /* of the deviations */
    size_t count;
};

/* Least squares; NANs where undetermined (u, v and 1 not independent, fewer than four points). */
struct stats_plane stats_plane(const double *u, const double *v, const double *y, size_t count);

struct stats_parabola {
    double offset, slope, curvature;    /* y = offset + slope u + curvature u^2, u = x - middle */
    double middle;
    double top, top_error;      /* where y is largest; NAN if it curves upwards */
    double height, height_error;
    double chi2;                /* sum of squared deviations over their errors */
    size_t count;
};

/* Least squares weighted with 1 / errors^2; the errors must be positive. */
struct stats_parabola stats_parabola(const double *x, const double *y, const double *errors,
                                     size_t count);

#endif
