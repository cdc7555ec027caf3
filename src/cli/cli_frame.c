/* cli_frame.c - `frame SCENE|RUN`: one picture.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/film.h"
#include "run/folder.h"
#include "run/recall.h"
#include "run/footage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool draw(const struct options *options, const struct setup *setup, const char *path,
                 struct footage *footage, struct error *error)
{
    double t;
    char name[FILE_PATH_MAX];
    if (!options_real(options, OPTION_time, footage_end(footage), &t, error)) return false;
    snprintf(name, sizeof name, "%s.png", setup->scene->name);
    const char *output = options->values[OPTION_output];
    if (!output) output = name;
    struct film film = {0};
    struct view view = setup->scene->view;
    /* A single picture is coloured by itself, unless the run it belongs to has a range. */
    recall_range(path, setup->scene, &view);
    view.range_from = RANGE_FRAME;
    const bool done = film_open(&film, setup->scene, setup->model, &view, error)
        && footage_go(footage, t, error)
        && film_draw(&film, &footage->grains, footage->steps, footage->wall, error)
        && film_save(&film, footage->grains.time, output, error);
    film_close(&film);
    if (!done) return false;
    if (footage->from_dumps && fabs(footage->grains.time - t) > 1e-9 * fabs(t)) {
        fprintf(stderr, "the nearest frame that the run kept is at t = %.6g\n",
                footage->grains.time);
    }
    printf("%s\n", output);
    return true;
}

int cli_frame(const struct options *options)
{
    struct error error = {0};
    struct setup setup = {0};
    struct footage footage = {0};
    struct progress progress;
    const char *path = options->operands[0];
    const bool redraws = footage_has_dumps(path);
    bool done = opening_threads(options, &error) > 0
        && progress_begin(&progress, options->values[OPTION_progress], &error)
        && opening_load(&setup, options, path, NULL, !redraws, &error)
        && footage_open(&footage, &setup, path, film_needs_contacts(&setup.scene->view), &error);
    if (done) {
        opening_catch_signals();
        footage.report = opening_report;
        footage.context = &progress;
        footage.signal = &opening_signal;
        done = draw(options, &setup, path, &footage, &error);
        progress_end(&progress);
    }
    footage_close(&footage);
    setup_free(&setup);
    return done ? EXIT_DONE : opening_fail(&error);
}
