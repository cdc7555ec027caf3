/* stream.c - the force on an obstacle in a stream of grains (stream 5, 6, 9).
 *
 * The full forms are the paper's (Table I, b = 16 cm, a mean over 500 rows); the quick ones have a
 * narrower stream, the screen nearer to the obstacle, and fewer rows.  Masses are those of discs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/flow.h"

#include "measure/stats.h"

#include <math.h>
#include <stdio.h>

/* An error of this share is left after a mean over so many rows: what differs between seeds and is
 * not in one run's block error (the random filling of the stream), and for quick forms the nearer
 * screen and the narrower stream. */
static const double systematic_quick = 0.06, systematic_full = 0.02;

static double doubt(const struct figure_job *job, double force, double error)
{
    return hypot(2 * error, (job->quick ? systematic_quick : systematic_full) * force);
}

/* A line through all points; tells it. */
static struct stats_line fit(const struct chart *chart, uint32_t curve)
{
    const struct chart_curve *c = &chart->curves[curve];
    return stats_line(c->x, c->y, c->count);
}

static double straight(double x, const void *context)
{
    const struct stats_line *line = context;
    return line->offset + line->slope * x;
}

bool stream_density(struct figure_job *job, struct error *error)
{
    static const double quick[] = {0.3, 0.6, 1}, full[] = {0.2, 0.4, 0.6, 0.8, 1};
    const double *values = job->quick ? quick : full;
    const uint32_t count = job->quick ? 3 : 5;
    struct chart chart;
    bool done = true;
    chart_begin(&chart, "Force against the density of the stream, v = 500 cm/s", "rho", "F [dyn]");
    chart.key = "top left";
    chart_curve(&chart, CHART_ERRORS, "R_ob = %g cm", job->quick ? 0.5 : 1.0);
    struct flow_force worst = {0};
    for (uint32_t k = 0; done && k < count; k++) {
        struct flow flow = flow_paper(job);
        flow.radius = job->quick ? 0.5 : 1;
        flow.density = values[k];
        struct flow_force force;
        done = flow_force(job, &flow, &force, error);
        if (done) chart_error(&chart, values[k], force.mean, force.error);
        if (done) worst = force;
    }
    if (done) {
        const struct stats_line line = fit(&chart, 0);
        const double at_one = straight(1, &line);
        chart_law(&chart, "straight line", straight, &line, 0, 1, 2);
        /* The paper's fit at R_ob = 1 cm: F = 125000 rho + 1400; at another radius in proportion
         * to 111 R_ob + 18, its eq. 16. */
        const double scale = job->quick ? (111 * 0.5 + 18) / (111 + 18.0) : 1;
        figure_near(job, "slope dF/d rho [dyn]", line.slope, 125e3 * scale,
                    doubt(job, 125e3 * scale, 1.5 * worst.error));
        /* The paper's own fit has 0.011; forces known to 2 % (4 % in the quick form) at densities
         * from 0.2 on leave the offset open by three times that. */
        figure_hold(job, fabs(line.offset) < (job->quick ? 0.15 : 0.08) * at_one,
                    "linear: F(0)/F(1) = %.3f of the fit", line.offset / at_one);
    }
    figure_choose(job, "R_ob = 1 cm, v = 500 cm/s belong to eq. 15 (measured; the paper does not "
                  "say)%s", job->quick ? "; quick: R_ob = 0.5 cm, eq. 15 scaled by eq. 16" : "");
    return figure_chart(job, done, &chart, "", error);
}

/* One curve F(R_ob). */
static bool radii(struct figure_job *job, bool flat, struct chart *chart, double *error_largest,
                  struct error *error)
{
    static const double quick[] = {0.24, 0.48, 0.8}, full[] = {0.5, 1, 1.5, 2, 2.5};
    const double *values = job->quick ? quick : full;
    const uint32_t count = job->quick ? 3 : 5;
    chart_curve(chart, CHART_ERRORS, flat ? "flat obstacle" : "spherical obstacle");
    for (uint32_t k = 0; k < count; k++) {
        struct flow flow = flow_paper(job);
        struct flow_force force;
        flow.radius = values[k];
        flow.flat = flat;
        if (!flow_force(job, &flow, &force, error)) return false;
        chart_error(chart, values[k], force.mean, force.error);
        *error_largest = fmax(*error_largest, force.error);
    }
    return true;
}

/* The paper's slope of F(R_ob).  An independent program has 104(3)e3 dyn/cm between 1 and 1.5 cm,
 * less than the paper: the layer before a large obstacle shields it. */
static void judge_slope(struct figure_job *job, const struct chart *chart, double slope,
                        double noise)
{
    static const double paper = 111e3, between = 104e3, between_error = 3e3;
    if (fabs(slope - paper) <= doubt(job, paper, 2 * noise)) {
        figure_near(job, "slope dF/dR_ob [dyn/cm]", slope, paper, doubt(job, paper, 2 * noise));
        return;
    }
    const double here = (chart_at(chart, 0, 1.5) - chart_at(chart, 0, 1)) / 0.5;
    const double here_error = hypot(between_error, M_SQRT2 * noise / 0.5);
    figure_miss(job, fabs(here - between) < 2 * here_error, "the paper's slope of 111e3 dyn/cm is "
                "not reproduced: %.3g over all sizes, %.3g +- %.1g from 1 to 1.5 cm, where an "
                "independent program has 104e3", slope, here, M_SQRT2 * noise / 0.5);
}

bool stream_radius(struct figure_job *job, struct error *error)
{
    struct chart chart;
    double noise[2] = {0};
    chart_begin(&chart, "Force against the size of the obstacle, v = 500 cm/s, rho = 1",
                "R_ob [cm]", "F [dyn]");
    chart.key = "top left";
    const bool done = radii(job, false, &chart, &noise[0], error)
        && radii(job, true, &chart, &noise[1], error);
    if (done) {
        const struct stats_line round = fit(&chart, 0), flat = fit(&chart, 1);
        const double at_one = straight(1, &round), flat_at_one = straight(1, &flat);
        chart_law(&chart, "eq. 16: (111 R_ob + 18) 10^3", straight,
                  &(struct stats_line){.slope = 111e3, .offset = 18e3}, 0,
                  job->quick ? 1 : 2.5, 2);
        chart_law(&chart, "flat: 156 R_ob 10^3", straight, &(struct stats_line){.slope = 156e3},
                  0, job->quick ? 1 : 2.5, 2);
        figure_near(job, "F at R_ob = 1 cm [dyn]", at_one, 129e3, doubt(job, 129e3, noise[0]));
        judge_slope(job, &chart, round.slope, noise[0]);
        /* The paper's line for the flat obstacle has no offset, though the round one's has; an
         * independent program: 179(2)e3 at 1 cm. */
        figure_near(job, "flat at 1 cm, corrected physics", flat_at_one, 179e3,
                    doubt(job, 179e3, noise[1]));
        if (fabs(flat_at_one - 156e3) > doubt(job, 156e3, noise[1])) {
            figure_miss(job, true, "the paper's 156e3 R_ob for flat obstacles is not reproduced: "
                        "F = %.0f + %.0f R_ob", flat.offset, flat.slope);
        }
    }
    figure_choose(job, "a flat obstacle is a row of touching discs of radius 0.08 cm, an odd or "
                  "even number of them as fits 2 R_ob best");
    return figure_chart(job, done, &chart, "", error);
}

/* Exponent of F(v) over all points of a curve between two speeds. */
static struct stats_line exponent(const struct chart_curve *c, double from, double to)
{
    double x[32], y[32];
    size_t count = 0;
    for (uint32_t k = 0; k < c->count && count < 32; k++) {
        if (c->x[k] < from || c->x[k] > to || !(c->y[k] > 0)) continue;
        x[count] = log(c->x[k]);
        y[count++] = log(c->y[k]);
    }
    return stats_line(x, y, count);
}

static double power(double v, const void *context)
{
    const double *at = context;         /* a point on the curve, and the exponent */
    return at[1] * pow(v / at[0], at[2]);
}

static bool speeds(struct figure_job *job, double radius, struct chart *chart,
                   struct error *error)
{
    static const double quick[] = {100, 300, 700, 2000};
    static const double full[] = {100, 200, 300, 500, 700, 1000, 1500, 2000};
    const double *values = job->quick ? quick : full;
    const uint32_t count = job->quick ? 4 : 8;
    chart_curve(chart, CHART_ERRORS, "R_ob = %g cm", radius);
    for (uint32_t k = 0; k < count; k++) {
        struct flow flow = flow_paper(job);
        struct flow_force force;
        flow.radius = radius;
        flow.speed = values[k];
        if (!flow_force(job, &flow, &force, error)) return false;
        chart_error(chart, values[k], force.mean, force.error);
    }
    return true;
}

bool stream_speed(struct figure_job *job, struct error *error)
{
    struct chart chart;
    chart_begin(&chart, "Force against the speed of the stream, rho = 1", "v [cm/s]", "F [dyn]");
    chart.log_x = chart.log_y = true;
    chart.key = "top left";
    bool done = speeds(job, 0.5, &chart, error);
    if (done && !job->quick) done = speeds(job, 1.5, &chart, error);
    if (done) {
        const struct chart_curve *small = &chart.curves[0];
        const double last = small->y[small->count - 1];
        chart_law(&chart, "v^2", power, (double[3]){2000, last, 2}, 100, 2000, 2);
        chart_law(&chart, "v^1.5 below 700 cm/s", power,
                  (double[3]){700, last * pow(0.35, 2), 1.5}, 100, 700, 2);
        const struct stats_line all = exponent(small, 0, INFINITY), low = exponent(small, 0, 701);
        /* An independent program: 1.97 (1.93 to 2.02); a force wrong by 3 % at one end of 1.3
         * decades shifts it by 0.02, quick forms by twice that. */
        figure_near(job, "exponent of F(v), 100 to 2000 cm/s", all.slope, 1.97,
                    job->quick ? 0.09 : 0.05);
        if (fabs(low.slope - 1.5) > 0.1) {
            figure_miss(job, fabs(low.slope - 1.97) < 0.12, "the paper's F ~ v^1.5 below 700 cm/s "
                        "is not reproduced: exponent %.2f there", low.slope);
        }
    }
    figure_choose(job, "small obstacle R_ob = 0.5 cm, large 1.5 cm (the paper does not say)");
    return figure_chart(job, done, &chart, "", error);
}
