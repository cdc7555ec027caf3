/* stats.c - see stats.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/stats.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double average(const double *values, size_t count)
{
    double sum = 0;
    for (size_t k = 0; k < count; k++) sum += values[k];
    return sum / (double)count;
}

static double variance(const double *values, size_t count, double mean)
{
    double sum = 0;
    for (size_t k = 0; k < count; k++) sum += (values[k] - mean) * (values[k] - mean);
    return sum / (double)count;
}

/* Averaging neighbours again and again leaves the mean and makes blocks independent: the naive
 * error sqrt(c0 / (n - 1)) grows until blocks exceed the correlation time, then stays.  A longer
 * block has the smaller bias and the larger scatter; the best is the shortest whose length B has
 * B^3 > 2 n (error(B) / error(1))^4. */
bool stats_mean(const double *values, size_t count, struct stats_mean *out, struct error *error)
{
    *out = (struct stats_mean){NAN, NAN, NAN, NAN, NAN, 1, false};
    if (count == 0) return true;
    out->mean = average(values, count);
    out->deviation = sqrt(variance(values, count, out->mean));
    if (count < 2) return true;
    double *blocks = malloc(count * sizeof *blocks), naive = 0;
    if (!blocks) return error_set(error, "not enough memory to average %zu values", count);
    memcpy(blocks, values, count * sizeof *blocks);
    size_t n = count;
    for (size_t length = 1; n >= 2; length *= 2) {
        const double mean = average(blocks, n);
        const double estimate = sqrt(variance(blocks, n, mean) / (double)(n - 1));
        if (length == 1) naive = estimate;
        const double growth = naive > 0 ? estimate / naive : 1;
        const double b = (double)length;
        out->settled = b * b * b > 2 * (double)count * pow(growth, 4);
        if (out->settled || !(estimate <= out->error)) {        /* unsettled: keep the largest */
            out->error = estimate;
            out->error_error = estimate / sqrt(2.0 * (double)(n - 1));
            out->correlation = growth * growth;
            out->block = length;
        }
        if (out->settled) break;
        n /= 2;
        for (size_t k = 0; k < n; k++) blocks[k] = 0.5 * (blocks[2 * k] + blocks[2 * k + 1]);
    }
    free(blocks);
    return true;
}

struct stats_line stats_line(const double *x, const double *y, size_t count)
{
    struct stats_line line = {NAN, NAN, NAN, NAN, count};
    if (count < 2) return line;
    const double xm = average(x, count), ym = average(y, count);
    double xx = 0, xy = 0, rest = 0;
    for (size_t k = 0; k < count; k++) {
        xx += (x[k] - xm) * (x[k] - xm);
        xy += (x[k] - xm) * (y[k] - ym);
    }
    if (!(xx > 0)) return line;
    line.slope = xy / xx;
    line.offset = ym - line.slope * xm;
    if (count < 3) return line;
    for (size_t k = 0; k < count; k++) {
        const double d = y[k] - ym - line.slope * (x[k] - xm);
        rest += d * d;
    }
    const double s2 = rest / (double)(count - 2);
    line.slope_error = sqrt(s2 / xx);
    line.offset_error = sqrt(s2 * (1 / (double)count + xm * xm / xx));
    return line;
}

/* Inverse of a symmetric 3 x 3 matrix by cofactors; false if it is singular. */
static bool invert(double m[3][3], double inverse[3][3])
{
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            inverse[c][r] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
    }
    const double det = m[0][0] * inverse[0][0] + m[0][1] * inverse[1][0] + m[0][2] * inverse[2][0];
    if (!(fabs(det) > 1e-12 * fabs(m[0][0] * m[1][1] * m[2][2]))) return false;
    for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++) inverse[r][c] /= det;
    return true;
}

/* About the means of u and v and in units of their spread, so that the normal equations are well
 * conditioned; then back. */
struct stats_plane stats_plane(const double *u, const double *v, const double *y, size_t count)
{
    struct stats_plane fit = {.p = {NAN, NAN, NAN}, .rms = NAN, .count = count};
    for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++) fit.covariance[r][c] = NAN;
    if (count < 4) return fit;
    const double um = average(u, count), vm = average(v, count);
    const double us = sqrt(variance(u, count, um)), vs = sqrt(variance(v, count, vm));
    double m[3][3] = {{0}}, right[3] = {0}, cov[3][3], p[3] = {0}, rest = 0;
    if (!(us > 0) || !(vs > 0)) return fit;
    for (size_t k = 0; k < count; k++) {
        const double terms[3] = {1, (u[k] - um) / us, (v[k] - vm) / vs};
        for (int r = 0; r < 3; r++) {
            right[r] += terms[r] * y[k];
            for (int c = 0; c < 3; c++) m[r][c] += terms[r] * terms[c];
        }
    }
    if (!invert(m, cov)) return fit;
    for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++) p[r] += cov[r][c] * right[c];
    const double back[3][3] = {{1, -um / us, -vm / vs}, {0, 1 / us, 0}, {0, 0, 1 / vs}};
    for (int r = 0; r < 3; r++) {
        fit.p[r] = 0;
        for (int c = 0; c < 3; c++) fit.p[r] += back[r][c] * p[c];
    }
    for (size_t k = 0; k < count; k++) {
        const double d = y[k] - fit.p[0] - fit.p[1] * u[k] - fit.p[2] * v[k];
        rest += d * d;
    }
    fit.rms = sqrt(rest / (double)count);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            double sum = 0;
            for (int a = 0; a < 3; a++) {
                for (int b = 0; b < 3; b++) sum += back[r][a] * cov[a][b] * back[c][b];
            }
            fit.covariance[r][c] = sum * rest / (double)(count - 3);
        }
    }
    return fit;
}

/* Standard deviation of gradient . parameters, given their covariance. */
static double spread(double covariance[3][3], const double gradient[static 3])
{
    double sum = 0;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) sum += gradient[r] * covariance[r][c] * gradient[c];
    }
    return sqrt(fmax(0, sum));
}

/* In u = (x - middle) / scale, so that the normal equations are well conditioned. */
struct stats_parabola stats_parabola(const double *x, const double *y, const double *errors,
                                     size_t count)
{
    struct stats_parabola fit = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, count};
    if (count < 3) return fit;
    fit.middle = average(x, count);
    const double scale = sqrt(variance(x, count, fit.middle));
    double m[3][3] = {{0}}, right[3] = {0}, cov[3][3], p[3] = {0};
    if (!(scale > 0)) return fit;
    for (size_t k = 0; k < count; k++) {
        const double u = (x[k] - fit.middle) / scale, powers[3] = {1, u, u * u};
        assert(errors[k] > 0);
        const double w = 1 / (errors[k] * errors[k]);
        for (int r = 0; r < 3; r++) {
            right[r] += w * powers[r] * y[k];
            for (int c = 0; c < 3; c++) m[r][c] += w * powers[r] * powers[c];
        }
    }
    if (!invert(m, cov)) return fit;
    for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++) p[r] += cov[r][c] * right[c];
    fit.chi2 = 0;
    for (size_t k = 0; k < count; k++) {
        const double u = (x[k] - fit.middle) / scale, d = y[k] - p[0] - u * (p[1] + u * p[2]);
        fit.chi2 += d * d / (errors[k] * errors[k]);
    }
    fit.offset = p[0];
    fit.slope = p[1] / scale;
    fit.curvature = p[2] / (scale * scale);
    if (!(p[2] < 0)) return fit;
    const double u = -p[1] / (2 * p[2]);
    fit.top = fit.middle + scale * u;
    fit.top_error = scale * spread(cov, (double[3]){0, -1 / (2 * p[2]), -u / p[2]});
    fit.height = p[0] + u * (p[1] + u * p[2]);
    fit.height_error = spread(cov, (double[3]){1, u, u * u});
    return fit;
}
