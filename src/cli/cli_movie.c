/* cli_movie.c - `movie SCENE|RUN...`: a film, or several side by side.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/folder.h"
#include "run/panel.h"
#include "run/recall.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double frames_default = 200;       /* of a scene that says no interval */

struct cast {
    uint32_t count;
    struct setup setups[PANEL_MAX];
    const char *paths[PANEL_MAX];
    char models[PANEL_MAX][64]; /* "" = the scene's */
    struct panel panels[PANEL_MAX];
};

/* Every operand under every model named. */
static bool choose(struct cast *cast, const struct options *options, struct error *error)
{
    const char *models = options->values[OPTION_model];
    const bool several = models && strchr(models, ',');
    for (uint32_t k = 0; k < options->operand_count; k++) {
        const char *at = several ? models : "";
        do {
            if (cast->count == PANEL_MAX) {
                return error_set_code(error, EXIT_USAGE, "more than %d panels", PANEL_MAX);
            }
            const size_t length = strcspn(at, ",");
            snprintf(cast->models[cast->count], sizeof cast->models[0], "%.*s", (int)length, at);
            cast->paths[cast->count++] = options->operands[k];
            at += length + (at[length] == ',');
        } while (*at);
    }
    if (cast->count == 1 || options_given(options, OPTION_side_by_side)) return true;
    return error_set_code(error, EXIT_USAGE, "several films in one movie need --side-by-side");
}

/* A run that kept its grains also kept the seconds that its model took. */
static bool tell_run_cost(const char *run, char *text, size_t size, struct error *error)
{
    json_t *manifest = recall_manifest(run, error);
    if (!manifest) return false;
    const json_t *seconds = json_object_get(manifest, "seconds");
    const json_t *wall = json_object_get(json_object_get(seconds, "core"), "wall");
    text[0] = 0;
    if (wall) snprintf(text, size, "computed in %.3g s", json_number_value(wall));
    json_decref(manifest);
    return true;
}

static bool open_panel(struct cast *cast, uint32_t p, const struct options *options,
                       struct error *error)
{
    struct panel *panel = &cast->panels[p];
    struct setup *setup = &cast->setups[p];
    const char *path = cast->paths[p];
    const bool redraws = footage_has_dumps(path);
    const char *model = *cast->models[p] ? cast->models[p] : NULL;
    if (!opening_load(setup, options, path, model, !redraws, error)) return false;
    struct view view = setup->scene->view;
    if (cast->count > 1 && !options_given(options, OPTION_label)) {
        const size_t used = strlen(view.label);
        snprintf(view.label + used, sizeof view.label - used, "%s{model}", used ? "   " : "");
    }
    if (cast->count > 1 && !view.caption[0]) {
        snprintf(view.caption, sizeof view.caption, "computed in {wall} s");
        if (redraws && !tell_run_cost(path, view.caption, sizeof view.caption, error)) return false;
    }
    panel->setup = setup;
    return footage_open(&panel->footage, setup, path, film_needs_contacts(&view), error)
        && film_open(&panel->film, setup->scene, setup->model, &view, error);
}

/* Simulated time between frames: --every, the scene's, the run's. */
static double find_interval(const struct cast *cast)
{
    const struct panel *first = &cast->panels[0];
    const double end = footage_end(&first->footage);
    const struct dump_index *index = &first->footage.dumps.index;
    const double wanted = first->setup->scene->output.frames;
    if (first->footage.from_dumps && !(wanted > 0)) {
        return index->count > 1 ? end / (index->count - 1) : 1;
    }
    if (wanted > 0) return wanted;
    return end > 0 ? end / frames_default : 1;
}

static bool film(struct cast *cast, const struct options *options, struct error *error)
{
    struct progress progress;
    char name[FILE_PATH_MAX];
    snprintf(name, sizeof name, "%s.mp4", cast->setups[0].scene->name);
    const char *output = options->values[OPTION_output];
    if (!output) output = name;
    if (!options_given(options, OPTION_force) && !file_absent(output, error)) return false;
    if (!progress_begin(&progress, options->values[OPTION_progress], error)) return false;
    for (uint32_t p = 0; p < cast->count; p++) {
        struct footage *footage = &cast->panels[p].footage;
        footage->report = opening_report;
        footage->context = &progress;
        footage->signal = &opening_signal;
    }
    const struct panel_request request = {
        .panels = cast->panels, .count = cast->count, .path = output,
        .interval = find_interval(cast),
        .frame_rate = cast->setups[0].scene->output.frame_rate, .report = opening_report,
        .context = &progress, .signal = &opening_signal,
    };
    uint64_t frames = 0;
    opening_catch_signals();
    const bool done = panel_film(&request, &frames, error);
    progress_end(&progress);
    if (done) printf("%s\n", output);
    return done;
}

int cli_movie(const struct options *options)
{
    struct error error = {0};
    struct cast *cast = calloc(1, sizeof *cast);
    if (!cast) {
        error_set(&error, "not enough memory");
        return opening_fail(&error);
    }
    const char *output = options->values[OPTION_output];
    /* What must fail fails before anything is simulated. */
    bool done = (!output || movie_name_ok(output, &error)) && movie_available(&error)
        && opening_threads(options, &error) > 0 && choose(cast, options, &error);
    for (uint32_t p = 0; done && p < cast->count; p++) {
        done = open_panel(cast, p, options, &error);
    }
    done = done && film(cast, options, &error);
    for (uint32_t p = 0; p < cast->count; p++) {
        footage_close(&cast->panels[p].footage);
        film_close(&cast->panels[p].film);
        setup_free(&cast->setups[p]);
    }
    free(cast);
    return done ? EXIT_DONE : opening_fail(&error);
}
