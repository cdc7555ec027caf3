/* lattice.c - sand of the lattice gases: the hourglass of GMLG, and waves of density in a pipe of
 * the sandpile automaton (gmlg 4; simplified, section 2.1).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/strip.h"

#include "measure/heap.h"
#include "measure/stats.h"

#include <math.h>
#include <stdio.h>

/* Grains below the neck. */
static uint32_t fallen(const struct grains *grains, double neck)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < grains->count; i++) count += grains->y[i] < neck;
    return count;
}

bool lattice_hourglass(struct figure_job *job, struct error *error)
{
    enum { SAMPLES = 120 };
    static const double shares[] = {0, 0.25, 0.6};     /* below the neck in the snapshots; the last is the end */
    struct lab lab = {0};
    struct lab_wish wish = {.scene = "hourglass"};
    struct strip strip;
    struct chart chart;
    struct heap heap = {0};
    char path[FILE_PATH_MAX];
    const double neck = 8.4, until = job->quick ? 1.2 : 1.8;
    double t[SAMPLES], n[SAMPLES];
    lab_set(&wish, "model=lga");
    lab_set(&wish, "lga.k=0.5");
    lab_set(&wish, "lga.pw=0.5");
    lab_set(&wish, "lga.s=0");
    lab_set(&wish, "until=%g", until);
    lab_set(&wish, "view.size=(400,620)");
    lab_set(&wish, "view.title=\"\"");
    /* So much sand that the lower heap does not reach the walls of the glass. */
    lab_set(&wish, "placements.[0].outline=((-0.5,8.6),(0.5,8.6),(2.2,11.545),(-2.2,11.545))");
    lab_set(&wish, "grains.[0].radius=%s", job->quick ? "[0.016,0.024]" : "[0.008,0.012]");
    chart_begin(&chart, "Grains below the neck", "t [s]", "N");
    chart.key = "bottom right";
    strip_begin(&strip);
    uint32_t picture = 0;
    bool done = lab_open(&lab, job, &wish, error);
    const double placed = done ? lab.setup.scene->placed.count : 0;
    chart_curve(&chart, CHART_LINES, "GMLG, k = 0.5");
    for (uint32_t k = 0; done && k < SAMPLES; k++) {
        t[k] = until * (k + 1) / SAMPLES;
        done = lab_go(&lab, t[k], error);
        if (!done) break;
        n[k] = fallen(&lab.footage.grains, neck);
        chart_point(&chart, t[k], n[k]);
        if (k + 1 == SAMPLES) {
            done = heap_create(&lab.footage.grains, -5, 5, 50, 0, INFINITY, &heap, error);
        }
        const bool end = k + 1 == SAMPLES;
        if (done && picture < 4 && (picture == 3 ? end : n[k] >= shares[picture] * placed)) {
            done = strip_add(&strip, &lab, error);
            picture++;
        }
    }
    if (done) {
        const double all = placed;
        double x[2][SAMPLES], y[2][SAMPLES];
        size_t count[2] = {0};
        for (uint32_t k = 0; k < SAMPLES; k++) {
            const int half = n[k] < 0.15 * all ? -1 : n[k] < 0.45 * all ? 0 : n[k] < 0.75 * all;
            if (half < 0 || n[k] > 0.75 * all) continue;
            x[half][count[half]] = t[k];
            y[half][count[half]++] = n[k];
        }
        const double first = stats_line(x[0], y[0], count[0]).slope;
        const double second = stats_line(x[1], y[1], count[1]).slope;
        /* Constant at k = 0.5: 1.2 % between windows of 2,000 grains with a hole of eight nodes.  The
         * upper sand here is shallow, and the last of it runs down the walls: a tenth; a few hundred
         * grains in each third of the quick form scatter by as much again. */
        figure_near(job, "rate of the second third over that of the first", second / first, 1,
                    job->quick ? 0.2 : 0.1);
        figure_hold(job, n[SAMPLES - 1] > 0.99 * all, "it empties: %.0f of %.0f below", n[SAMPLES - 1],
                    all);
        const struct heap_slope slope = heap_slope(&heap, 0.4, 0.9);
        /* 26.8(2) degrees of a heap of 20,000 grains by another program; the rows of nodes give the
         * small heap of the quick form steps of half a grain, and grains that splash away thin
         * out its foot, hence only the upper half is fitted. */
        figure_near(job, "angle of the lower heap", slope.angle, 26.8, job->quick ? 5 : 2);
        figure_picture(job, "", path);
        done = strip_save(&strip, path, error);
    }
    heap_free(&heap);
    strip_free(&strip);
    lab_close(&lab);
    figure_choose(job, "k = pw = 0.5, g = 0.5, s = 0, gravity along a link (V); the paper's rules are "
                  "in lost figures");
    return figure_chart(job, done, &chart, "rate", error);
}
