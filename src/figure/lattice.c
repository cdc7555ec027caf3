/* lattice.c - sand of the lattice gases: the hourglass of GMLG, and waves of density in a pipe of
 * the sandpile automaton (gmlg 4; simplified, section 2.1).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/strip.h"

#include "measure/heap.h"
#include "measure/stats.h"
#include "measure/waves.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Grains below the neck. */
static uint32_t fallen(const struct grains *grains, double neck)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < grains->count; i++) count += grains->y[i] < neck;
    return count;
}

enum { LOOKS = 120 };

struct glass {
    double until, placed;       /* the end; grains in all */
    double time[LOOKS], below[LOOKS];       /* grains below the neck */
    struct heap heap;           /* at the end */
};

static bool empty_glass(struct lab *lab, struct glass *glass, struct strip *strip,
                        struct error *error)
{
    /* Below the neck in the snapshots, but the last, which is the end. */
    static const double shares[] = {0, 0.25, 0.6};
    const double neck = 8.4;
    const struct grains *grains = &lab->footage.grains;
    uint32_t pictures = 0;
    for (uint32_t k = 0; k < LOOKS; k++) {
        const bool end = k + 1 == LOOKS;
        glass->time[k] = glass->until * (k + 1) / LOOKS;
        if (!lab_go(lab, glass->time[k], error)) return false;
        glass->below[k] = fallen(grains, neck);
        if (end && !heap_create(grains, -5, 5, 50, 0, INFINITY, &glass->heap, error)) return false;
        if (!end && (pictures == 3 || glass->below[k] < shares[pictures] * glass->placed)) continue;
        if (!strip_add(strip, lab, error)) return false;
        pictures++;
    }
    return true;
}

static void judge_glass(struct figure_job *job, const struct glass *glass)
{
    const double all = glass->placed, *n = glass->below;
    double x[2][LOOKS], y[2][LOOKS];
    size_t count[2] = {0};
    for (uint32_t k = 0; k < LOOKS; k++) {
        if (n[k] < 0.15 * all || n[k] > 0.75 * all) continue;
        const int part = n[k] < 0.45 * all ? 0 : 1;
        x[part][count[part]] = glass->time[k];
        y[part][count[part]++] = n[k];
    }
    const double first = stats_line(x[0], y[0], count[0]).slope;
    const double second = stats_line(x[1], y[1], count[1]).slope;
    /* Constant at k = 0.5: 1.2 % between windows of 2,000 grains with a hole of eight nodes.  The
     * upper sand here is shallow, and the last of it runs down the walls: a tenth; fewer grains in
     * each part of the quick form scatter by as much again. */
    figure_near(job, "rate from 45 to 75 % over that from 15 to 45 %", second / first, 1,
                job->quick ? 0.2 : 0.1);
    figure_hold(job, n[LOOKS - 1] > 0.99 * all, "it empties: %.0f of %.0f below", n[LOOKS - 1],
                all);
    /* 26.8(2) degrees of a heap of 20,000 grains by another program; the rows of nodes give the
     * small heap of the quick form steps of half a grain, and grains that splash away thin out its
     * foot, hence only the upper half is fitted. */
    figure_near(job, "angle of the lower heap", heap_slope(&glass->heap, 0.4, 0.9).angle, 26.8,
                job->quick ? 5 : 2);
}

bool lattice_hourglass(struct figure_job *job, struct error *error)
{
    struct lab lab = {0};
    struct lab_wish wish = {.scene = "hourglass"};
    struct strip strip;
    struct chart chart;
    struct glass glass = {.until = job->quick ? 1.2 : 1.8};
    char path[FILE_PATH_MAX];
    lab_set(&wish, "model=lga");
    lab_set(&wish, "lga.k=0.5");
    lab_set(&wish, "lga.pw=0.5");
    lab_set(&wish, "lga.s=0");
    lab_set(&wish, "until=%g", glass.until);
    lab_set(&wish, "view.size=(400,620)");
    lab_set(&wish, "view.title=\"\"");
    /* So much sand that the lower heap does not reach the walls of the glass. */
    lab_set(&wish, "placements.[0].outline=((-0.5,8.6),(0.5,8.6),(2.2,11.545),(-2.2,11.545))");
    lab_set(&wish, "grains.[0].radius=%s", job->quick ? "[0.016,0.024]" : "[0.008,0.012]");
    chart_begin(&chart, "Grains below the neck", "t [s]", "N");
    chart.key = "bottom right";
    chart_curve(&chart, CHART_LINES, "GMLG, k = 0.5");
    strip_begin(&strip);
    bool done = lab_open(&lab, job, &wish, error);
    if (done) glass.placed = lab.setup.scene->placed.count;
    done = done && empty_glass(&lab, &glass, &strip, error);
    if (done) {
        for (uint32_t k = 0; k < LOOKS; k++) chart_point(&chart, glass.time[k], glass.below[k]);
        judge_glass(job, &glass);
        figure_picture(job, "", path);
        done = strip_save(&strip, path, error);
    }
    heap_free(&glass.heap);
    strip_free(&strip);
    lab_close(&lab);
    figure_choose(job, "k = pw = 0.5, g = 0.5, s = 0, gravity along a link (V); the paper's rules "
                  "are in lost figures");
    return figure_chart(job, done, &chart, "rate", error);
}

/* --- waves in a pipe --- */

enum { PIPE_ROWS = 400, SLAB_ROWS = 20, FINE_ROWS = 4 };

/* The last looks; time to the right, the pipe upwards. */
static void draw_space_time(const struct waves *waves, uint32_t looks, struct chart *chart)
{
    const uint32_t shown = looks < waves->count ? looks : waves->count;
    const uint32_t first = waves->count - shown;
    double mean = 0;
    for (size_t k = 0; k < (size_t)waves->count * waves->slabs; k++) {
        mean += waves->density[k] / ((double)waves->count * waves->slabs);
    }
    chart_begin(chart, "Waves of density in a rough pipe", "t [ticks]", "y [nodes]");
    chart_curve(chart, CHART_CELLS, "density over its mean");
    for (uint32_t s = 0; s < waves->slabs; s++) {
        const double y = waves->low + (s + 0.5) * (waves->high - waves->low) / waves->slabs;
        for (uint32_t k = first; k < waves->count; k++) {
            chart_error(chart, (k + 1) * waves->interval, y,
                        waves->density[(size_t)k * waves->slabs + s] / mean);
        }
    }
}

static double mean_speed(const struct grains *grains)
{
    double sum = 0;
    for (uint32_t i = 0; i < grains->count; i++) sum += grains->vy[i];
    return sum / grains->count;
}

bool lattice_pipe(struct figure_job *job, struct error *error)
{
    const double until = job->quick ? 6144 : 16384, interval = 4;
    const uint32_t looks = (uint32_t)(until / interval), settling = looks / 4;
    const double height = PIPE_ROWS * sqrt(3) / 2;
    struct lab lab = {0};
    struct lab_wish wish = {.scene = "waves"};
    struct waves waves = {0}, fine = {0};
    struct chart chart, picture;
    double *power = NULL, step = 0, speed = 0;
    uint32_t bins = 0;
    lab_set(&wish, "box=[0,0,12,%.8g]", height);
    lab_set(&wish, "lga.fill=%.8g", 0.8 / 7);
    lab_set(&wish, "until=%g", until);
    chart_begin(&chart, "Spectrum of the density in a rough pipe, rho = 0.8", "frequency [1/ticks]",
                "power");
    chart.log_x = chart.log_y = true;
    bool done = lab_open(&lab, job, &wish, error)
        && waves_create(&waves, 0, height, PIPE_ROWS / SLAB_ROWS, looks, interval, error)
        && waves_create(&fine, 0, height, PIPE_ROWS / FINE_ROWS, looks, interval, error);
    for (uint32_t k = 0; done && k < looks; k++) {
        done = lab_go(&lab, (k + 1) * interval, error);
        if (!done) break;
        waves_add(&waves, &lab.footage.grains);
        waves_add(&fine, &lab.footage.grains);
        if (k >= settling) speed += mean_speed(&lab.footage.grains) / (looks - settling);
    }
    done = done && waves_spectrum(&waves, settling, &power, &bins, &step, error);
    if (done) {
        chart_curve(&chart, CHART_LINES, "mean over slabs of %d rows", SLAB_ROWS);
        for (uint32_t k = 1; k <= bins; k++) chart_point(&chart, k * step, power[k - 1]);
        const struct stats_line line = waves_exponent(power, bins, step, 2.4e-3, 5e-2);
        chart_curve(&chart, CHART_LAW, "f^-4/3");
        chart_point(&chart, 2.4e-3, exp(line.offset + line.slope * log(2.4e-3)));
        chart_point(&chart, 5e-2, exp(line.offset + line.slope * log(2.4e-3))
                                  * pow(5e-2 / 2.4e-3, -4.0 / 3));
        /* An independent program, T = 16384, mean over seeds: contrast 0.758(4), <v_y> =
         * -0.2011(9), exponent -2.53(6); uncorrelated grains 0.071.  One seed, and waves that live
         * for thousands of ticks: a tenth of either; a shorter run: a fifth. */
        figure_near(job, "contrast of the density", waves_contrast(&waves, settling), 0.758,
                    job->quick ? 0.15 : 0.08);
        figure_near(job, "<v_y>", speed, -0.2011, job->quick ? 0.04 : 0.02);
        if (fabs(line.slope + 4.0 / 3) > 0.2) {
            figure_miss(job, fabs(line.slope + 2.53) < 0.5, "the paper's spectrum f^-4/3 is not "
                        "reproduced: exponent %.2f +- %.2f from f = 2.4e-3 to 5e-2", line.slope,
                        line.slope_error);
        }
        draw_space_time(&fine, 400, &picture);
        done = figure_chart(job, done, &picture, "space-time", error);
    }
    free(power);
    waves_free(&waves);
    waves_free(&fine);
    lab_close(&lab);
    figure_choose(job, "eleven nodes wide, 400 rows, p = g = 0.5, b = 1; space-time: the last 1600 "
                  "ticks");
    return figure_chart(job, done, &chart, "spectrum", error);
}
