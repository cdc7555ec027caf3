/* cli_map.c - `map SCENE|RUN`: field maps.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/folder.h"
#include "run/mapper.h"
#include "run/footage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const uint32_t samples_default = 100;    /* of a mean over a scene that says no interval */

/* Adds every look between the two times: all frames that a run kept, or so many of a scene. */
static bool add_mean(struct mapper *mapper, struct footage *footage, const double span[2],
                     struct error *error)
{
    const struct output *output = &footage->setup->scene->output;
    if (footage->from_dumps) {
        uint32_t added = 0;
        for (uint32_t k = 0; k < footage->dumps.index.count; k++) {
            const double t = footage->dumps.index.entries[k].time;
            if (t < span[0] || t > span[1]) continue;
            if (!footage_go(footage, t, error)) return false;
            mapper_add(mapper, &footage->grains);
            added++;
        }
        return added > 0 || error_set_code(error, EXIT_USAGE,
            "the run kept no frame between t = %g and %g", span[0], span[1]);
    }
    double interval = output->maps > 0 ? output->maps : output->frames;
    if (!(interval > 0)) interval = (span[1] - span[0]) / samples_default;
    const double count = floor((span[1] - span[0]) / interval + 1e-9);
    for (uint32_t k = 0; k <= count; k++) {
        if (!footage_go(footage, span[0] + k * interval, error)) return false;
        mapper_add(mapper, &footage->grains);
    }
    return true;
}

static bool make(const struct options *options, struct mapper *mapper, struct footage *footage,
                 const char *directory, struct error *error)
{
    char suffix[64];
    double t;
    if (options_given(options, OPTION_average)) {
        double span[2];
        if (!options_pair(options, OPTION_average, ':', span, error)) return false;
        if (!(span[1] > span[0]) || span[0] < 0) {
            return error_set_code(error, EXIT_USAGE, "--average %s: needs 0 <= T1 < T2",
                                  options->values[OPTION_average]);
        }
        snprintf(suffix, sizeof suffix, "mean_%g_%g", span[0], span[1]);
        if (!add_mean(mapper, footage, span, error)) return false;
    } else {
        if (!options_real(options, OPTION_time, footage_end(footage), &t, error)) return false;
        if (!footage_go(footage, t, error)) return false;
        mapper_add(mapper, &footage->grains);
        snprintf(suffix, sizeof suffix, "t_%.6g", footage->grains.time);
    }
    if (!file_make_directory(directory, error)) return false;
    return mapper_write(mapper, directory, suffix, error);
}

int cli_map(const struct options *options)
{
    struct error error = {0};
    struct setup setup = {0};
    struct footage footage = {0};
    struct mapper mapper = {0};
    struct progress progress;
    unsigned formats = 0;
    const char *path = options->operands[0], *as = options->values[OPTION_as];
    char directory[FILE_PATH_MAX];
    const bool redraws = footage_has_dumps(path);
    bool done = opening_threads(options, &error) > 0
        && mapper_parse(as ? as : "png,npy", &formats, &error)
        && progress_begin(&progress, options->values[OPTION_progress], &error)
        && opening_load(&setup, options, path, NULL, !redraws, &error)
        && mapper_open(&mapper, setup.scene, &setup.scene->view, &setup.scene->measure, formats,
                       &error)
        && footage_open(&footage, &setup, path, false, &error);
    if (done) {
        const char *output = options->values[OPTION_output];
        if (output) snprintf(directory, sizeof directory, "%s", output);
        else snprintf(directory, sizeof directory, "%s-maps", setup.scene->name);
        opening_catch_signals();
        footage.report = opening_report;
        footage.context = &progress;
        footage.signal = &opening_signal;
        mapper.keeps = !options_given(options, OPTION_force);
        done = make(options, &mapper, &footage, directory, &error);
        progress_end(&progress);
        if (done) printf("%s\n", directory);
    }
    footage_close(&footage);
    mapper_close(&mapper);
    setup_free(&setup);
    return done ? EXIT_DONE : opening_fail(&error);
}
