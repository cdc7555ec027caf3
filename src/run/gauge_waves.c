/* gauge_waves.c - see gauge_waves.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/gauge_waves.h"

#include "measure/waves.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Of a scene that is simulated for this: as often as it writes its log, but not without end. */
enum { LOOKS_MIN = 100, LOOKS_MAX = 8192, SLABS_MAX = 400, SLABS_MIN = 4 };

static uint32_t looks_of(const struct gauge_job *job)
{
    const struct footage *footage = job->footage;
    const double interval = job->setup->scene->output.log;
    if (footage->from_dumps) return footage->dumps.index.count;
    const double looks = interval > 0 ? floor(footage_end(footage) / interval + 1e-9) : LOOKS_MIN;
    return (uint32_t)fmin(fmax(looks, LOOKS_MIN), LOOKS_MAX);
}

static double time_of(const struct footage *footage, uint32_t look, uint32_t looks)
{
    return footage->from_dumps ? footage->dumps.index.entries[look].time
                               : footage_end(footage) * (look + 1) / looks;
}

/* Looks at the whole run; slabs are `diameters` mean ones wide. */
static bool watch(struct gauge_job *job, double diameters, bool shared, struct waves *waves,
                  struct error *error)
{
    const struct scene *scene = job->setup->scene;
    const double *box = scene->box, width = box[2] - box[0], height = box[3] - box[1];
    const bool level = width > height;
    const double length = level ? width : height;
    const uint32_t looks = looks_of(job);
    const double slabs = floor(length / (diameters * 2 * scene->radius_mean));
    const double first = looks > 0 ? time_of(job->footage, 0, looks) : 0;
    const double last = looks > 0 ? time_of(job->footage, looks - 1, looks) : 0;
    if (looks < 2 || !(last > first)) {
        return error_set(error, "%s: density against time needs at least two frames", job->run);
    }
    if (!waves_create(waves, box[level ? 0 : 1], box[level ? 2 : 3],
                      (uint32_t)fmin(fmax(slabs, SLABS_MIN), SLABS_MAX), looks,
                      (last - first) / (looks - 1), error)) return false;
    waves->level = level;
    waves->shared = shared;
    for (uint32_t k = 0; k < looks; k++) {
        if (!footage_go(job->footage, time_of(job->footage, k, looks), error)) return false;
        waves_add(waves, &job->footage->grains);
    }
    return true;
}

bool gauge_waves_space_time(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct waves waves = {0};
    double mean = 0;
    if (!watch(job, 2, true, &waves, error)) {
        waves_free(&waves);
        return false;
    }
    gauge_label_axes(job, chart, "time", "time", waves.level ? "x" : "y", "length");
    chart_curve(chart, CHART_CELLS, "density over its mean");
    const size_t all = (size_t)waves.count * waves.slabs;
    for (size_t k = 0; k < all; k++) mean += waves.density[k] / (double)all;
    const double slab = (waves.high - waves.low) / waves.slabs;
    for (uint32_t s = 0; s < waves.slabs; s++) {
        for (uint32_t k = 0; k < waves.count; k++) {
            chart_error(chart, time_of(job->footage, k, waves.count), waves.low + (s + 0.5) * slab,
                        waves.density[(size_t)k * waves.slabs + s] / mean);
        }
    }
    snprintf(job->note, sizeof job->note, "contrast of the density, rms over mean: %.3f in %u "
             "slabs", waves_contrast(&waves, waves.count / 4), waves.slabs);
    waves_free(&waves);
    return true;
}

bool gauge_waves_spectrum(struct gauge_job *job, struct chart *chart, struct error *error)
{
    struct waves waves = {0};
    double *power = NULL, step = 0;
    uint32_t bins = 0;
    bool done = watch(job, 20, false, &waves, error);
    done = done && waves_spectrum(&waves, waves.count / 4, &power, &bins, &step, error);
    if (done) {
        gauge_label_axes(job, chart, "frequency", "1/time", "power of the grains in a slab", "1");
        chart->log_x = chart->log_y = true;
        chart_curve(chart, CHART_LINES, "mean over %u slabs", waves.slabs);
        for (uint32_t k = 1; k <= bins; k++) chart_point(chart, k * step, power[k - 1]);
        const double from = step * pow(bins, 0.25), to = step * pow(bins, 0.75);
        const struct stats_line line = waves_exponent(power, bins, step, from, to);
        if (isfinite(line.slope)) {
            chart_curve(chart, CHART_LAW, "f^%.2f", line.slope);
            for (int end = 0; end < 2; end++) {
                const double f = end ? to : from;
                chart_point(chart, f, exp(line.offset + line.slope * log(f)));
            }
        }
        snprintf(job->note, sizeof job->note, "exponent %.2f +- %.2f from f = %.3g to %.3g; "
                 "contrast %.3f", line.slope, line.slope_error, from, to,
                 waves_contrast(&waves, waves.count / 4));
    }
    free(power);
    waves_free(&waves);
    return done;
}
