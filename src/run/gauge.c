/* gauge.c - see gauge.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/gauge.h"

#include "measure/distribution.h"
#include "measure/energy.h"
#include "measure/gap.h"
#include "measure/heap.h"
#include "measure/pair.h"
#include "measure/spectrum.h"
#include "measure/stats.h"
#include "measure/table.h"
#include "run/folder.h"
#include "run/gauge_waves.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define X(name, doc)                                                                            \
    static bool draw_##name(struct gauge_job *job, struct chart *chart, struct error *error);
GAUGES(X)
#undef X

/* Those from `anisotropy` on look at grains. */
enum gauge_id {
#define X(name, doc) GAUGE_##name,
    GAUGES(X)
#undef X
    GAUGE_COUNT
};

const struct gauge gauge_list[] = {
#define X(name, doc) {#name, doc, draw_##name, GAUGE_##name >= GAUGE_anisotropy},
    GAUGES(X)
#undef X
    {0}
};

const struct gauge *gauge_find(const char *name)
{
    for (const struct gauge *g = gauge_list; g->name; g++) {
        size_t k = 0;
        while (g->name[k] && (g->name[k] == name[k] || (g->name[k] == '_' && name[k] == '-'))) k++;
        if (g->name[k] == name[k]) return g;
    }
    return NULL;
}

bool gauge_draw(const struct gauge *gauge, struct gauge_job *job, struct chart *chart,
                struct error *error)
{
    *job->note = 0;
    chart_begin(chart, job->setup->scene->title, "", "");
    if (!gauge->draw(job, chart, error)) return false;
    uint32_t points = 0;
    for (uint32_t c = 0; c < chart->count; c++) points += chart->curves[c].count;
    return points > 0 || error_set(error, "%s: there is nothing to plot of %s (no grains at rest, "
                                   "no rows, or no frames)", job->run, gauge->name);
}

/* "time [s]"; the name alone in reduced units. */
static void label(char text[CHART_TEXT], const char *name, const char *unit)
{
    if (*unit && strcmp(unit, "1") != 0) snprintf(text, CHART_TEXT, "%s [%s]", name, unit);
    else snprintf(text, CHART_TEXT, "%s", name);
}

void gauge_label_axes(const struct gauge_job *job, struct chart *chart, const char *x,
                      const char *x_dimension, const char *y, const char *y_dimension)
{
    label(chart->x_label, x, scene_unit(job->setup->scene, x_dimension));
    label(chart->y_label, y, scene_unit(job->setup->scene, y_dimension));
}

static bool load(const struct gauge_job *job, const char *name, const char *cure,
                 struct table *table, struct error *error)
{
    char path[FILE_PATH_MAX];
    if (!file_exists(folder_path(path, job->run, "%s", name))) {
        return error_set_code(error, EXIT_USAGE, "%s: the run wrote no %s; run the scene with %s",
                              job->run, name, cure);
    }
    return table_load(path, table, error);
}

static bool load_log(const struct gauge_job *job, struct table *table, struct error *error)
{
    return load(job, "log.csv", "-s output.log=INTERVAL", table, error);
}

/* A column against time, if the log has it and it is not all NAN. */
static void add_column(struct chart *chart, const struct table *log, const char *name,
                       const char *shown)
{
    const int column = table_find(log, name), time = table_find(log, "time");
    bool any = false;
    for (uint32_t r = 0; r < log->rows; r++) any = any || isfinite(table_at(log, r, column));
    if (!any) return;
    chart_curve(chart, CHART_LINES, "%s", shown);
    for (uint32_t r = 0; r < log->rows; r++) {
        chart_point(chart, table_at(log, r, time), table_at(log, r, column));
    }
}

static bool draw_energy(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct table log;
    if (!load_log(job, &log, error)) return false;
    gauge_label_axes(job, chart, "time", "time", "energy", "energy");
    add_column(chart, &log, "kinetic_energy", "kinetic");
    add_column(chart, &log, "rotational_energy", "rotational");
    add_column(chart, &log, "potential_energy", "potential");
    table_free(&log);
    return true;
}

static bool draw_contacts(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct table log;
    if (!load_log(job, &log, error)) return false;
    gauge_label_axes(job, chart, "time", "time", "C/N, a collision counted for both grains", "1");
    const int time = table_find(&log, "time"), grains = table_find(&log, "grains");
    static const char *const names[] = {"collisions", "collisions_elastic"};
    for (int k = 0; k < 2; k++) {
        const int column = table_find(&log, names[k]);
        chart_curve(chart, CHART_LINES, k ? "elastic" : "all");
        for (uint32_t r = 0; r < log.rows; r++) {
            chart_point(chart, table_at(&log, r, time),
                        2 * table_at(&log, r, column) / table_at(&log, r, grains));
        }
    }
    table_free(&log);
    return true;
}

static bool draw_flux(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct table log;
    if (!load_log(job, &log, error)) return false;
    gauge_label_axes(job, chart, "time", "time", "grains per time", "1/time");
    static const char *const names[] = {"grains_in", "grains_out"};
    const int time = table_find(&log, "time");
    for (int k = 0; k < 2; k++) {
        const int column = table_find(&log, names[k]);
        chart_curve(chart, CHART_LINES, k ? "leave" : "enter");
        for (uint32_t r = 1; r < log.rows; r++) {
            const double t0 = table_at(&log, r - 1, time), t1 = table_at(&log, r, time);
            if (!(t1 > t0)) continue;
            chart_point(chart, 0.5 * (t0 + t1),
                        (table_at(&log, r, column) - table_at(&log, r - 1, column)) / (t1 - t0));
        }
    }
    table_free(&log);
    return true;
}

/* The mean over the second half, when what is built up at first is there. */
static bool note_force(struct gauge_job *job, const struct table *log, int column,
                       struct error *error)
{
    const uint32_t from = log->rows / 2, count = log->rows - from;
    double *series = malloc(count * sizeof *series + 1);
    struct stats_mean mean;
    if (!series) return error_set(error, "not enough memory for a series of forces");
    for (uint32_t r = 0; r < count; r++) series[r] = table_at(log, from + r, column);
    const bool done = stats_mean(series, count, &mean, error);
    free(series);
    if (!done) return false;
    const size_t used = strlen(job->note);
    snprintf(job->note + used, sizeof job->note - used,
             "%s%s = %.5g +- %.2g%s over the second half", used ? "; " : "", log->names[column],
             mean.mean, mean.error, mean.settled ? "" : " (too short to tell the error)");
    return true;
}

static bool draw_force(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct table log;
    if (!load_log(job, &log, error)) return false;
    gauge_label_axes(job, chart, "time", "time", "force", "force");
    bool done = true;
    for (uint32_t k = 0; done && chart->count + 2 <= CHART_CURVES; k++) {
        char fx[TABLE_NAME], fy[TABLE_NAME];
        snprintf(fx, sizeof fx, "obstacle%u_fx", k);
        snprintf(fy, sizeof fy, "obstacle%u_fy", k);
        if (table_find(&log, fx) < 0) break;
        add_column(chart, &log, fx, fx);
        add_column(chart, &log, fy, fy);
        done = note_force(job, &log, table_find(&log, fx), error);
    }
    table_free(&log);
    return done && (chart->count > 0 || error_set_code(error, EXIT_USAGE, "%s: this scene has no "
                                                       "obstacle", job->run));
}

static bool draw_stress(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct table log;
    if (!load_log(job, &log, error)) return false;
    gauge_label_axes(job, chart, "time", "time", "stress, pressure negative", "1");
    for (uint32_t c = 0; c < log.columns && chart->count < CHART_CURVES; c++) {
        if (strncmp(log.names[c], "stress_", 7) == 0) {
            add_column(chart, &log, log.names[c], log.names[c] + 7);
        }
    }
    table_free(&log);
    return chart->count > 0 || error_set_code(error, EXIT_USAGE, "%s: the log has no stress; run "
                                              "the scene with -s measure.stress=true", job->run);
}

/* Rows of one pair (from, to) belong together; the last curves if there are too many. */
static uint32_t group_end(const struct table *table, uint32_t row)
{
    uint32_t end = row;
    while (end < table->rows && table_at(table, end, 0) == table_at(table, row, 0)
           && table_at(table, end, 1) == table_at(table, row, 1)) end++;
    return end;
}

static uint32_t first_group(const struct table *table, uint32_t groups_max)
{
    uint32_t groups = 0;
    for (uint32_t r = 0; r < table->rows; r = group_end(table, r)) groups++;
    uint32_t row = 0;
    for (; groups > groups_max; groups--) row = group_end(table, row);
    return row;
}

static bool draw_impact(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct table table;
    if (!load(job, "impact.csv", "-s measure.impact_parameters=true", &table, error)) return false;
    gauge_label_axes(job, chart, "b/d", "1", "P(b/d)", "1");
    chart->y_range[0] = 0;
    for (uint32_t r = first_group(&table, CHART_CURVES); r < table.rows;) {
        const uint32_t end = group_end(&table, r);
        chart_curve(chart, CHART_STEPS, "t = %.4g .. %.4g", table_at(&table, r, 0),
                    table_at(&table, r, 1));
        for (; r < end; r++) {
            chart_point(chart, table_at(&table, r, table_find(&table, "b")),
                        table_at(&table, r, table_find(&table, "density")));
        }
    }
    table_free(&table);
    return true;
}

/* One group of collisions.csv as counts of single grains. */
static bool distribute(const struct table *table, uint32_t from, uint32_t to,
                       struct distribution *d, struct error *error)
{
    const int contacts = table_find(table, "contacts"), grains = table_find(table, "grains");
    uint32_t count = 0, most = 0, at = 0;
    for (uint32_t r = from; r < to; r++) {
        count += (uint32_t)table_at(table, r, grains);
        most = (uint32_t)fmax(most, table_at(table, r, contacts));
    }
    uint32_t *counts = malloc((size_t)count * sizeof *counts + 1);
    if (!counts) return error_set(error, "not enough memory for counts of collisions");
    for (uint32_t r = from; r < to; r++) {
        for (uint32_t k = 0; k < (uint32_t)table_at(table, r, grains); k++) {
            counts[at++] = (uint32_t)table_at(table, r, contacts);
        }
    }
    const bool done = distribution_create(d, counts, count, most + 2, error);
    free(counts);
    return done;
}

static bool draw_frequency(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct table table;
    if (!load(job, "collisions.csv", "-s measure.collision_counts=true", &table, error)) {
        return false;
    }
    gauge_label_axes(job, chart, "contacts of a grain", "1", "share of the grains", "1");
    chart->log_x = chart->log_y = true;
    bool done = true;
    for (uint32_t r = first_group(&table, CHART_CURVES / 2); done && r < table.rows;) {
        const uint32_t end = group_end(&table, r);
        struct distribution d;
        done = distribute(&table, r, end, &d, error);
        if (!done) break;
        chart_curve(chart, CHART_ERRORS, "t = %.4g .. %.4g", table_at(&table, r, 0),
                    table_at(&table, r, 1));
        for (uint32_t c = 0; c < d.bins; c++) {
            double doubt;
            const double share = distribution_share(&d, c, &doubt);
            if (share > 0) chart_error(chart, c + 0.5, share, doubt);
        }
        const enum distribution_law best = distribution_best(&d);
        const struct distribution_fit fit = distribution_fit(&d, best);
        chart_curve(chart, CHART_LAW, "%s, %.3g +- %.2g", distribution_law_name(best),
                    fit.parameter, fit.error);
        for (uint32_t c = 0; c < d.bins; c++) {
            chart_point(chart, c + 0.5, distribution_law_share(best, fit.parameter, c));
        }
        distribution_free(&d);
        r = end;
    }
    table_free(&table);
    return done;
}

static bool draw_scattering(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct table table;
    if (!load(job, "screen0.csv", "a screen and a source", &table, error)) return false;
    gauge_label_axes(job, chart, "angle [degrees]", "1", "dm / dTheta [1/rad]", "1");
    chart_curve(chart, CHART_ERRORS, "mass");
    for (uint32_t r = 0; r < table.rows; r++) {
        chart_error(chart, table_at(&table, r, table_find(&table, "angle")),
                    table_at(&table, r, table_find(&table, "mass")),
                    table_at(&table, r, table_find(&table, "mass_error")));
    }
    table_free(&table);
    return true;
}

/* --- from grains --- */

enum { SERIES_LOOKS = 100 };    /* of a scene that is simulated for a series */

static bool draw_anisotropy(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct footage *footage = job->footage;
    const uint32_t looks = footage->from_dumps ? footage->dumps.index.count : SERIES_LOOKS + 1;
    gauge_label_axes(job, chart, "time", "time", "(Kx - Ky)/K", "1");
    chart->y_range[0] = -1;
    chart->y_range[1] = 1;
    chart_curve(chart, CHART_LINES, "all grains");
    for (uint32_t k = 0; k < looks; k++) {
        const double t = footage->from_dumps ? footage->dumps.index.entries[k].time
                                             : footage_end(footage) * k / SERIES_LOOKS;
        if (!footage_go(footage, t, error)) return false;
        const double anisotropy = energy_of(&footage->grains).anisotropy;
        if (isfinite(anisotropy)) chart_point(chart, footage->grains.time, anisotropy);
    }
    return true;
}

static bool look(struct gauge_job *job, struct chart *chart, struct error *error)
{
    const double t = isnan(job->time) ? footage_end(job->footage) : job->time;
    if (!footage_go(job->footage, t, error)) return false;
    const size_t used = strlen(chart->title);
    snprintf(chart->title + used, sizeof chart->title - used, "%st = %.6g", used ? ", " : "",
             job->footage->grains.time);
    return true;
}

static bool draw_structure(struct gauge_job *job, struct chart *chart, struct error *error)
{
    const struct scene *scene = job->setup->scene;
    struct spectrum spectrum;
    if (!look(job, chart, error)
        || !spectrum_structure_factor(&job->footage->grains, scene->box, 2 * scene->radius_mean,
                                      &spectrum, error)) {
        return false;
    }
    gauge_label_axes(job, chart, "k = l / wavelength", "1", "S(k)", "1");
    chart->log_x = chart->log_y = true;
    chart_curve(chart, CHART_LINES, "mean over shells");
    for (uint32_t s = 1; s < spectrum.shells; s++) {
        if (spectrum.modes[s] > 0 && spectrum.shell[s] > 0) {
            chart_point(chart, spectrum.wave_number[s], spectrum.shell[s]);
        }
    }
    spectrum_free(&spectrum);
    return true;
}

static bool draw_pair(struct gauge_job *job, struct chart *chart, struct error *error)
{
    const struct scene *scene = job->setup->scene;
    const double d = 2 * scene->radius_mean, *box = scene->box;
    const double reach = fmin(5 * d, 0.5 * fmin(box[2] - box[0], box[3] - box[1]));
    struct pair pair;
    if (!look(job, chart, error)
        || !pair_create(&job->footage->grains, scene, reach, 100, &pair, error)) {
        return false;
    }
    gauge_label_axes(job, chart, "r in mean diameters", "1", "g(r)", "1");
    chart_curve(chart, CHART_LINES, "%u grains", pair.grains);
    for (uint32_t b = 0; b < pair.bins; b++) {
        chart_point(chart, (b + 0.5) * pair.width / d, pair.g[b]);
    }
    pair_free(&pair);
    return true;
}

static bool draw_heap(struct gauge_job *job, struct chart *chart, struct error *error)
{
    const struct scene *scene = job->setup->scene;
    const double d = 2 * scene->radius_mean, x0 = scene->box[0], x1 = scene->box[2];
    struct heap heap = {0};
    struct heap_tail tail;
    if (!look(job, chart, error)) return false;
    const struct grains *g = &job->footage->grains;
    double base = INFINITY;
    for (uint32_t i = 0; i < g->count; i++) base = fmin(base, g->y[i] - g->radius[i]);
    const double speed_max = 0.5 * sqrt(fabs(scene->gravity[1]) * d);
    const uint32_t bins = (uint32_t)fmax(4, fmin(1e6, (x1 - x0) / d));
    if (!heap_create(g, x0, x1, bins, base, speed_max, &heap, error)) return false;
    const bool done = heap_tail(&heap, d, 0.95, &tail, error);
    const struct heap_slope slope = heap_slope(&heap, 0.15, 0.85);
    gauge_label_axes(job, chart, "x", "length", "height", "length");
    chart_curve(chart, CHART_POINTS, "surface");
    for (uint32_t b = 0; b < bins; b++) {
        if (heap.height[b] > 0) chart_point(chart, x0 + (b + 0.5) * heap.width, heap.height[b]);
    }
    for (int side = -1; done && isfinite(tail.height) && side <= 1; side += 2) {
        chart_curve(chart, CHART_LAW, side < 0 ? "eq. 8" : "eq. 8, right");
        for (int k = 0; k <= 100; k++) {
            const double h = tail.height * pow(d / tail.height, k / 100.0);
            chart_point(chart, tail.middle + side * heap_tail_x(&tail, h), h);
        }
    }
    snprintf(job->note, sizeof job->note, "slope %.3f +- %.3f (%.1f degrees); eq. 8: m = %.3f +- "
             "%.3f, l/r = %.3g +- %.2g, hm = %.4g +- %.2g, rms %.3g (straight line %.3g)",
             slope.slope, slope.slope_error, slope.angle, tail.slope, tail.slope_error, tail.tail,
             tail.tail_error, tail.height, tail.height_error, tail.rms, tail.rms_line);
    heap_free(&heap);
    return done;
}

/* The disc of the first obstacle; NULL if that has none. */
static const struct wall *round_obstacle(const struct scene *scene)
{
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        if (scene->walls[w].body == 0 && scene->walls[w].shape == WALL_DISC) {
            return &scene->walls[w];
        }
    }
    return NULL;
}

static bool draw_gap(struct gauge_job *job, struct chart *chart, struct error *error)
{
    const struct scene *scene = job->setup->scene;
    struct footage *footage = job->footage;
    const struct wall *disc = round_obstacle(scene);
    const double d = 2 * scene->radius_mean, end = footage_end(footage);
    struct gap gap;
    if (!disc) {
        return error_set_code(error, EXIT_USAGE, "%s: a gap is measured before an obstacle that is "
                              "a disc; this scene has none", job->run);
    }
    const double center[2] = {disc->cx, disc->cy};
    if (!gap_create(&gap, center, disc->radius, 30 * d, 60, error)) return false;
    /* What is built up at first is there; as many looks as frames. */
    const uint32_t looks = footage->from_dumps ? footage->dumps.index.count : SERIES_LOOKS;
    bool done = true;
    for (uint32_t k = looks / 2; done && k < looks; k++) {
        done = footage_go(footage, footage->from_dumps ? footage->dumps.index.entries[k].time
                                                       : end * (k + 1) / looks, error);
        if (done) gap_add(&gap, &footage->grains);
    }
    if (done && gap.seen > 0) {
        gauge_label_axes(job, chart, "distance from the obstacle", "length", "area fraction", "1");
        chart_curve(chart, CHART_LINES, "within 20 degrees of the stream's axis");
        for (uint32_t b = 0; b < gap.bins; b++) {
            chart_point(chart, (b + 0.5) * gap.width, gap_fraction(&gap, b));
        }
        snprintf(job->note, sizeof job->note, "gap %.4g %s, in mean diameters %.3g (to half of the "
                 "largest area fraction, less a radius)", gap_width(&gap),
                 scene_unit(scene, "length"), gap_width(&gap) / d);
    }
    gap_free(&gap);
    return done;
}

static bool draw_space_time(struct gauge_job *job, struct chart *chart, struct error *error)
{
    return gauge_waves_space_time(job, chart, error);
}

static bool draw_spectrum(struct gauge_job *job, struct chart *chart, struct error *error)
{
    return gauge_waves_spectrum(job, chart, error);
}
