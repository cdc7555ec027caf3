/* cli_frame.c - `frame SCENE|RUN`: one picture. */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/film.h"
#include "run/folder.h"
#include "run/recall.h"
#include "run/source.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool save_picture(struct film *film, const struct source *source, const char *path,
                         struct error *error)
{
    struct encoder_job job = {0};
    struct image_note notes[ENCODER_NOTES];
    film_describe(film, source->grains.time, &job);
    for (uint32_t k = 0; k < job.note_count; k++) {
        notes[k] = (struct image_note){job.notes[k].key, job.notes[k].text};
    }
    return image_save(&film->image, path, film->scene->output.png_level, notes, job.note_count,
                      error);
}

static bool draw(const struct options *options, const struct setup *setup, const char *path,
                 struct source *source, struct error *error)
{
    double t;
    char name[FILE_PATH_MAX];
    if (!options_real(options, OPTION_time, source_end(source), &t, error)) return false;
    snprintf(name, sizeof name, "%s.png", setup->scene->name);
    const char *output = options->values[OPTION_output];
    if (!output) output = name;
    struct film film = {0};
    struct view view = setup->scene->view;
    /* A single picture is coloured by itself, unless the run it belongs to has a range. */
    recall_range(path, setup->scene, &view);
    view.range_from = RANGE_FRAME;
    const bool done = film_open(&film, setup->scene, setup->model, &view, error)
        && source_go(source, t, error)
        && film_draw(&film, &source->grains, source->steps, source->wall, error)
        && save_picture(&film, source, output, error);
    film_close(&film);
    if (!done) return false;
    if (source->from_dumps && fabs(source->grains.time - t) > 1e-9 * fabs(t)) {
        fprintf(stderr, "the nearest frame that the run kept is at t = %.6g\n", source->grains.time);
    }
    printf("%s\n", output);
    return true;
}

int cli_frame(const struct options *options)
{
    struct error error = {0};
    struct setup setup = {0};
    struct source source = {0};
    struct progress progress;
    const char *path = options->operands[0];
    char dump[FILE_PATH_MAX];
    const bool redraws = setup_is_run(path) && file_exists(folder_path(dump, path, "dump/index.csv"));
    bool done = opening_threads(options, &error) > 0
        && progress_begin(&progress, options->values[OPTION_progress], &error)
        && opening_load(&setup, options, path, NULL, !redraws, &error)
        && source_open(&source, &setup, path, film_needs_contacts(&setup.scene->view), &error);
    if (done) {
        opening_catch_signals();
        source.report = opening_report;
        source.context = &progress;
        source.signal = &opening_signal;
        done = draw(options, &setup, path, &source, &error);
        progress_end(&progress);
    }
    source_close(&source);
    setup_free(&setup);
    return done ? EXIT_DONE : opening_fail(&error);
}
