/* cli_frame.c - `frame SCENE|RUN`: one picture.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "draw/difference.h"
#include "run/film.h"
#include "run/folder.h"
#include "run/recall.h"
#include "run/footage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* What --against asks for. */
struct comparison {
    struct image reference;
    const char *path;           /* of the reference; NULL: nothing is compared */
    int tolerance;
};

/* Loads the reference first, so that a wrong name is told before anything is simulated. */
static bool open_comparison(struct comparison *comparison, const struct options *options,
                            const char *output, struct error *error)
{
    uint64_t tolerance;
    *comparison = (struct comparison){.path = options->values[OPTION_reference]};
    if (!options_whole(options, OPTION_tolerance, 0, &tolerance, error)) return false;
    if (tolerance > 255) {
        return error_set_code(error, EXIT_USAGE, "--tolerance %s: from 0 to 255 grey levels",
                              options->values[OPTION_tolerance]);
    }
    comparison->tolerance = (int)tolerance;
    if (!comparison->path) {
        return !options_given(options, OPTION_tolerance) || error_set_code(error, EXIT_USAGE,
            "--tolerance needs --against REF.png, the picture to compare with");
    }
    if (strcmp(comparison->path, output) == 0) {
        return error_set_code(error, EXIT_USAGE, "%s: the new picture would overwrite the one it "
                              "is compared with; name another with -o", output);
    }
    return image_load(&comparison->reference, comparison->path, error);
}

/* True if the picture is the reference; else EXIT_VERDICT, with a picture of the difference. */
static bool compare(const struct comparison *comparison, const struct image *image,
                    const char *output, struct error *error)
{
    const struct image *reference = &comparison->reference;
    int largest;
    uint64_t differing;
    if (!image_compare(image, reference, comparison->tolerance, &largest, &differing)) {
        return error_set_code(error, EXIT_VERDICT, "%s: %ux%u pixels, but %s has %ux%u", output,
                              image->width, image->height, comparison->path, reference->width,
                              reference->height);
    }
    if (differing == 0) return true;
    char path[FILE_PATH_MAX];
    const char *ending = strrchr(output, '.');
    const size_t stem = ending && !strchr(ending, '/') ? (size_t)(ending - output) : strlen(output);
    snprintf(path, sizeof path, "%.*s-difference.png", (int)stem, output);
    struct image picture = {0};
    const bool done = difference_draw(reference, image, comparison->tolerance, &picture, error)
                   && image_save(&picture, path, 1, NULL, 0, error);
    image_free(&picture);
    return done && error_set_code(error, EXIT_VERDICT, "%s: %llu of %llu pixels differ from %s by "
        "more than %d grey level%s, the most by %d; see %s", output, (unsigned long long)differing,
        (unsigned long long)image->width * image->height, comparison->path,
        comparison->tolerance, comparison->tolerance == 1 ? "" : "s", largest, path);
}

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
    struct comparison comparison = {0};
    struct view view = setup->scene->view;
    /* A single picture is coloured by itself, unless the run it belongs to has a range. */
    const bool recalled = recall_range(path, setup->scene, &view, error);
    view.range_from = RANGE_FRAME;
    const bool done = recalled
        && (options_given(options, OPTION_force) || file_absent(output, error))
        && open_comparison(&comparison, options, output, error)
        && film_open(&film, setup->scene, setup->model, &view, error)
        && footage_go(footage, t, error)
        && film_draw(&film, &footage->grains, footage->steps, footage->wall, error)
        && film_save(&film, footage->grains.time, output, error)
        && (!comparison.path || compare(&comparison, &film.image, output, error));
    film_close(&film);
    image_free(&comparison.reference);
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
