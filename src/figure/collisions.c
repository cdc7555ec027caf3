/* collisions.c - who hits whom how often and how: impact parameters, shear and stress in a dense
 * box, collision frequencies (cooperative 3, 4, 5, 12).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/frequency.h"
#include "figure/gas.h"
#include "figure/strip.h"

#include "measure/haff.h"
#include "measure/energy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One second of the paper in our units of a gas: v = 0.2047 m/s there is sqrt(2) here, d = 1 mm. */
static const double second = 0.2047 / M_SQRT2 / 1e-3;

/* --- impact parameters --- */

enum { IMPACT_BINS = 20 };

static void copy_impact(const struct lab *lab, double out[IMPACT_BINS])
{
    const struct tally_impact *impact = &simulation_tally(&lab->footage.sim)->impact;
    for (int k = 0; k < IMPACT_BINS; k++) out[k] = impact->count[k];
}

/* P(b/d) of the collisions between two looks, as a curve; returns P of the last tenth over P of the
 * first, and its error. */
static double impact_curve(struct chart *chart, const double from[IMPACT_BINS],
                           const double to[IMPACT_BINS], double *error)
{
    double total = 0, p[IMPACT_BINS];
    for (int k = 0; k < IMPACT_BINS; k++) total += p[k] = to[k] - from[k];
    for (int k = 0; k < IMPACT_BINS; k++) {
        chart_error(chart, (k + 0.5) / IMPACT_BINS, p[k] * IMPACT_BINS / total,
                    sqrt(fmax(1, p[k])) * IMPACT_BINS / total);
    }
    const double low = p[0] + p[1], high = p[IMPACT_BINS - 2] + p[IMPACT_BINS - 1];
    *error = high / low * sqrt(1 / fmax(1, high) + 1 / fmax(1, low));
    return high / low;
}

static void ask_for_impact(struct lab_wish *wish)
{
    lab_set(wish, "measure.impact_parameters=true");
    lab_set(wish, "measure.impact_bins=%d", IMPACT_BINS);
}

static void begin_impact(struct chart *chart, const char *title)
{
    chart_begin(chart, title, "b/d", "P(b/d)");
    chart->y_range[0] = 0;
    chart->key = "bottom right";
    chart_curve(chart, CHART_LAW, "molecular chaos");
    chart_point(chart, 0, 1);
    chart_point(chart, 1, 1);
}

bool collisions_impact_times(struct figure_job *job, struct error *error)
{
    static const double quick[] = {0, 1, 10, 100, 300}, full[] = {0, 1, 10, 100, 1000};
    const double *times = job->quick ? quick : full;
    enum { TIMES = 5 };
    struct chart chart;
    struct lab lab;
    struct lab_wish wish;
    struct gas gas = gas_paper(GAS_ED, job->quick ? 64 : 316);
    double before[IMPACT_BINS], now[IMPACT_BINS], ratio[TIMES] = {0}, errors[TIMES] = {0};
    begin_impact(&chart, "Impact parameters while the gas clusters, r = 0.8");
    gas_wish(&gas, &wish);
    ask_for_impact(&wish);
    lab_set(&wish, "until=%.8g", gas.start + times[TIMES - 1] * gas.unit);
    bool done = lab_open(&lab, job, &wish, error) && lab_go(&lab, gas.start, error);
    if (done) copy_impact(&lab, before);
    for (uint32_t k = 1; done && k < TIMES; k++) {
        done = lab_go(&lab, gas.start + times[k] * gas.unit, error);
        if (!done) break;
        copy_impact(&lab, now);
        chart_curve(&chart, CHART_ERRORS, "%g to %g t0", times[k - 1], times[k]);
        ratio[k] = impact_curve(&chart, before, now, &errors[k]);
        memcpy(before, now, sizeof now);
    }
    lab_close(&lab);
    if (done) {
        /* Counting alone at first: three of its errors, and 1 % for a hard disc's r = 0.8. */
        figure_near(job, "P(grazing)/P(central) up to t0", ratio[1], 1, 3 * errors[1] + 0.01);
        figure_hold(job, ratio[TIMES - 1] - 1 > 5 * errors[TIMES - 1], "late more grazing "
                    "collisions: %.3f +- %.3f", ratio[TIMES - 1], errors[TIMES - 1]);
    }
    return figure_chart(job, done, &chart, "", error);
}

/* 240 discs at nu = 0.7495. */
static struct gas dense_gas(double r)
{
    struct gas gas = gas_paper(GAS_ED, 0);
    gas.count = 240;
    gas.fraction = 0.7495;
    gas.restitution = r;
    gas.t_c = 1e-6 * second;
    return gas;
}

bool collisions_impact_restitutions(struct figure_job *job, struct error *error)
{
    static const double values[] = {0.8, 0.9, 0.95, 0.99};
    enum { VALUES = sizeof values / sizeof *values };
    struct chart chart;
    bool done = true;
    begin_impact(&chart, "Impact parameters, N = 240, nu = 0.7495");
    for (int k = 0; done && k < VALUES; k++) {
        struct lab lab;
        struct lab_wish wish;
        struct gas gas = dense_gas(values[k]);
        double before[IMPACT_BINS], now[IMPACT_BINS], doubt;
        gas_wish(&gas, &wish);
        ask_for_impact(&wish);
        lab_set(&wish, "until=%.8g", gas.start + second);
        done = lab_open(&lab, job, &wish, error) && lab_go(&lab, gas.start + 0.5 * second, error);
        if (done) copy_impact(&lab, before);
        done = done && lab_go(&lab, gas.start + second, error);
        if (done) {
            copy_impact(&lab, now);
            chart_curve(&chart, CHART_ERRORS, "r = %g", values[k]);
            const double ratio = impact_curve(&chart, before, now, &doubt);
            /* Collisions of the same neighbours are not independent: counting errors are too
             * small, here taken three times, and a tenth is allowed for "homogeneous". */
            if (values[k] > 0.85) {
                char what[64];
                snprintf(what, sizeof what, "r = %g: P(grazing)/P(central)", values[k]);
                figure_near(job, what, ratio, 1, 0.1 + 3 * doubt);
            } else {
                figure_hold(job, ratio > 1.1, "r = %g: %.2f +- %.2f, more grazing ones",
                            values[k], ratio, doubt);
            }
        }
        lab_close(&lab);
    }
    figure_choose(job, "collisions between 0.5 and 1 s of the paper, as in its Fig. 5; K(0) as in "
                  "its section 3");
    return figure_chart(job, done, &chart, "", error);
}

/* --- velocities and stress of the dense box --- */

enum { STRESS_CELLS = 8 };

/* Crosses along the principal axes, each arm as long as its eigenvalue; the largest is as long as a
 * cell.  Returns the mean of |minor / major| over the cells. */
static double draw_axes(struct energy_stress cells[STRESS_CELLS][STRESS_CELLS], double cell,
                        struct chart *chart)
{
    double most = 0, ratio = 0;
    for (int r = 0; r < STRESS_CELLS; r++) {
        for (int c = 0; c < STRESS_CELLS; c++) most = fmax(most, fabs(cells[r][c].major));
    }
    for (int axis = 0; axis < 2; axis++) {
        chart_curve(chart, CHART_LINES, axis ? "minor axis" : "major axis");
        for (int r = 0; r < STRESS_CELLS; r++) {
            for (int c = 0; c < STRESS_CELLS; c++) {
                const struct energy_stress *s = &cells[r][c];
                const double size = 0.5 * cell * fabs(axis ? s->minor : s->major) / most;
                const double angle = s->angle + axis * M_PI / 2;
                const double x = (c + 0.5) * cell, y = (r + 0.5) * cell;
                chart_point(chart, x - size * cos(angle), y - size * sin(angle));
                chart_point(chart, x + size * cos(angle), y + size * sin(angle));
                chart_point(chart, NAN, NAN);   /* lifts the pen */
                if (axis) ratio += fabs(s->minor / s->major) / (STRESS_CELLS * STRESS_CELLS);
            }
        }
    }
    return ratio;
}

/* The stress of eq. 9 in each cell from what collisions carried between two looks. */
static void collisional(const double *from, const double *to, double volume_time,
                        struct energy_stress cells[STRESS_CELLS][STRESS_CELLS])
{
    for (int r = 0; r < STRESS_CELLS; r++) {
        for (int c = 0; c < STRESS_CELLS; c++) {
            const size_t at = 4 * ((size_t)r * STRESS_CELLS + (size_t)c);
            struct energy_stress *s = &cells[r][c];
            s->xx = (to[at] - from[at]) / volume_time;
            s->yy = (to[at + 3] - from[at + 3]) / volume_time;
            s->xy = 0.5 * (to[at + 1] - from[at + 1] + to[at + 2] - from[at + 2]) / volume_time;
            energy_principal(s);
        }
    }
}

/* One restitution: its panel in the strip, its axes in a chart. */
static bool stress_of(struct figure_job *job, double r, struct lab *lab, struct strip *strip,
                      double *isotropy, double *anisotropy, struct error *error)
{
    enum { SUMS = 4 * STRESS_CELLS * STRESS_CELLS };
    struct lab_wish wish;
    struct chart chart;
    struct gas gas = dense_gas(r);
    double before[SUMS] = {0};
    char suffix[24];
    gas_wish(&gas, &wish);
    const double cell = gas.length / STRESS_CELLS;
    lab_set(&wish, "until=%.8g", gas.start + second);
    lab_set(&wish, "measure.stress=true");
    lab_set(&wish, "measure.cell=%.12g", cell);
    lab_set(&wish, "view.size=(420,460)");
    lab_set(&wish, "view.arrows=true");
    lab_set(&wish, "view.color=none");
    lab_set(&wish, "view.title=\"r = %g\"", r);
    chart_begin(&chart, "", "x/d", "y/d");
    snprintf(chart.title, sizeof chart.title, "Principal axes of the stress, r = %g", r);
    chart.equal = true;
    chart.key = "outside right top";
    bool done = lab_open(lab, job, &wish, error)
        && lab_go(lab, gas.start + 0.5 * second, error);
    const struct tally *tally = done ? simulation_tally(&lab->footage.sim) : NULL;
    if (done && (tally->stress.nx != STRESS_CELLS || tally->stress.ny != STRESS_CELLS)) {
        done = error_set(error, "the stress came on %u x %u cells", tally->stress.nx,
                         tally->stress.ny);
    }
    if (done) memcpy(before, tally->stress.cells, sizeof before);
    done = done && lab_go(lab, gas.start + second, error);
    if (done) {
        struct energy_stress cells[STRESS_CELLS][STRESS_CELLS];
        tally = simulation_tally(&lab->footage.sim);
        collisional(before, tally->stress.cells, cell * cell * 0.5 * second, cells);
        *isotropy = draw_axes(cells, cell, &chart);
        *anisotropy = energy_of(&lab->footage.grains).anisotropy;
    }
    done = done && strip_add(strip, lab, error);
    snprintf(suffix, sizeof suffix, "stress-%g", r);
    return figure_chart(job, done, &chart, suffix, error);
}

bool collisions_stress(struct figure_job *job, struct error *error)
{
    static const double values[] = {0.8, 0.9, 0.95};
    enum { VALUES = 3 };
    struct lab labs[VALUES];
    struct strip strip;
    double isotropy[VALUES] = {0}, anisotropy[VALUES] = {0};
    char path[FILE_PATH_MAX];
    bool done = true;
    memset(labs, 0, sizeof labs);
    strip_begin(&strip);
    for (int k = 0; done && k < VALUES; k++) {
        done = stress_of(job, values[k], &labs[k], &strip, &isotropy[k], &anisotropy[k], error);
    }
    if (done) {
        figure_picture(job, "velocity", path);
        done = strip_save(&strip, path, error);
        /* The paper's statement is about the picture: "strongly different eigenvalues" where it
         * shears (r = 0.8), more alike at r = 0.95. */
        figure_hold(job, isotropy[0] < isotropy[2],
                    "|minor/major| is %.2f, %.2f, %.2f for r = 0.8, 0.9, 0.95", isotropy[0],
                    isotropy[1], isotropy[2]);
        figure_say(job, "(Kx - Kz)/K is %.2f, %.2f, %.2f", anisotropy[0], anisotropy[1],
                   anisotropy[2]);
    }
    strip_free(&strip);
    for (int k = 0; k < VALUES; k++) lab_close(&labs[k]);
    figure_choose(job, "velocities are scaled to each panel; collisional stress on 8 x 8 cells, "
                  "0.5 to 1 s");
    return done;
}

/* --- collision frequencies --- */

bool collisions_frequency(struct figure_job *job, struct error *error)
{
    /* C/N of the paper's curves: 8 (0.04 s, 0.93 t0), some tens, and beyond 183. */
    static const double quick[] = {0.93, 5, 50, 2000}, full[] = {0.93, 5, 30, 200, 2000};
    const double *times = job->quick ? quick : full;
    const uint32_t count = job->quick ? 4 : 5;
    struct chart early, late;
    struct lab lab = {0};
    struct lab_wish wish;
    struct gas gas = gas_paper(GAS_ED, job->quick ? 64 : 282);
    gas.t_c = 1e-5 * second;
    gas_wish(&gas, &wish);
    lab_set(&wish, "measure.collision_counts=true");
    lab_set(&wish, "until=%.8g", gas.start + times[count - 1] * gas.unit);
    chart_begin(&early, "Collisions of a grain, before clusters", "Nc t0", "P(Nc)/t0");
    chart_begin(&late, "Collisions of a grain, with clusters", "Nc t0", "P(Nc)/t0");
    early.log_y = late.log_y = late.log_x = true;
    uint32_t *last = calloc(2 * (size_t)gas.count, sizeof *last), *counts = last + gas.count;
    bool done = last != NULL || error_set(error, "not enough memory for counts of collisions");
    done = done && lab_open(&lab, job, &wish, error);
    for (uint32_t k = 0; done && k < count; k++) {
        struct distribution d;
        const double span = times[k] / 2;               /* the paper's Delta t = t/2, in t0 */
        done = lab_go(&lab, gas.start + span * gas.unit, error)
            && frequency_since(&lab, last, counts, gas.count)
            && lab_go(&lab, gas.start + times[k] * gas.unit, error)
            && frequency_since(&lab, last, counts, gas.count)
            && distribution_create(&d, counts, gas.count, 5000, error);
        if (!done) break;
        struct chart *chart = k < 2 ? &early : &late;
        chart_curve(chart, CHART_ERRORS, "t = %g t0", times[k]);
        frequency_curve(chart, &d, span);
        if (k == 0) frequency_tell(job, "at 0.93 t0", &d, DISTRIBUTION_poisson);
        if (k == 0) frequency_law(chart, &d, span, DISTRIBUTION_poisson);
        if (k + 1 == count) {
            frequency_tell(job, "at the end", &d, DISTRIBUTION_power);
            frequency_law(chart, &d, span, DISTRIBUTION_power);
            frequency_law(chart, &d, span, DISTRIBUTION_exponential);
        }
        if (k == 0) {
            /* Each grain meets omega(T) others, T after Haff: the integral over the window.  The
             * law is 3 % off by then. */
            const double rate = haff_frequency(gas.fraction, 1, 1) * gas.unit;
            figure_near(job, "mean count, kinetic theory", d.mean,
                        rate * log((1 + times[k]) / (1 + span)), 0.05 * d.mean);
            figure_say(job, "the paper's chi = 6.5 for this window is twice that; variance/mean "
                       "%.2f", d.variance / d.mean);
        }
        distribution_free(&d);
    }
    lab_close(&lab);
    free(last);
    figure_choose(job, "rates in 1/t0 (t0 = 0.043 s of the paper); parameters of laws are counts");
    const bool saved = figure_chart(job, done, &early, "early", error);
    return figure_chart(job, saved, &late, "late", error);
}
