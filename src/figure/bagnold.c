/* bagnold.c - the force that drives two plates with a gas of grains between them (simplified 4).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/lab.h"

#include "measure/stats.h"

#include <math.h>
#include <stdlib.h>

enum { BLOCKS = 200 };

/* Mean shear force on the moving plate at speed v, after the gas has become stationary.  Times go
 * with 1/v: the plate moves by the same way.  With one seed all speeds would have the same run, for
 * nothing else sets a time. */
static bool drive(struct figure_job *job, double v, int seed, struct stats_mean *mean,
                  struct error *error)
{
    struct lab lab = {0};
    struct lab_wish wish = {.scene = "shear"};
    const double ways = job->quick ? 800 : 3200, settling = ways / 4;
    double series[BLOCKS], before = 0;
    if (job->quick) lab_set(&wish, "quick=true");
    lab_set(&wish, "seed=%d", seed);
    lab_set(&wish, "obstacles.[1].surface_speed=%g", v);
    lab_set(&wish, "placements.[0].temperature=%g", 0.1 * v * v);
    lab_set(&wish, "dsmc.speed=%g", 2 * v);
    lab_set(&wish, "until=%g", ways / v);
    bool done = lab_open(&lab, job, &wish, error) && lab_go(&lab, settling / v, error);
    for (int k = 0; done && k <= BLOCKS; k++) {
        done = lab_go(&lab, (settling + (ways - settling) * k / BLOCKS) / v, error);
        if (!done) break;
        const double now = simulation_tally(&lab.footage.sim)->bodies[1].impulse_x;
        if (k > 0) series[k - 1] = fabs(now - before) / ((ways - settling) / BLOCKS / v);
        before = now;
    }
    done = done && stats_mean(series, BLOCKS, mean, error);
    lab_close(&lab);
    return done;
}

static double square(double v, const void *factor) { return *(const double *)factor * v * v; }

bool bagnold_force(struct figure_job *job, struct error *error)
{
    static const double speeds[] = {1, 2, 4, 8};
    enum { SPEEDS = 4 };
    struct chart chart;
    bool done = true;
    double x[SPEEDS], y[SPEEDS], worst = 0, factor = 0;
    chart_begin(&chart, "Bagnold: force against the speed of the plate, DSMC", "v", "F");
    chart.log_x = chart.log_y = true;
    chart.key = "top left";
    chart_curve(&chart, CHART_ERRORS, "DSMC");
    for (int k = 0; done && k < SPEEDS; k++) {
        struct stats_mean mean = {0};
        done = drive(job, speeds[k], 1 + k, &mean, error);
        chart_error(&chart, speeds[k], mean.mean, mean.error);
        x[k] = log(speeds[k]);
        y[k] = log(mean.mean);
        worst = fmax(worst, mean.error / mean.mean);
        factor += mean.mean / (speeds[k] * speeds[k]) / SPEEDS;
    }
    if (done) {
        chart_law(&chart, "v^2", square, &factor, 1, 8, 2);
        /* Errors of the ends over ln 8, three of them. */
        figure_near(job, "exponent of F(v)", stats_line(x, y, SPEEDS).slope, 2,
                    0.02 + 3 * worst * M_SQRT2 / log(8));
        figure_say(job, "points have no collisional stress, so the force itself is about a third "
                   "low");
    }
    figure_choose(job, "nu = 0.2, r = 0.95, rough plates 39 d apart (the paper does not say)");
    return figure_chart(job, done, &chart, "", error);
}
