/* panel.c - see panel.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/panel.h"

#include "run/folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A stepping model's last frame is up to half a step early, or its frame would be missing. */
static const double frame_slack = 0.01;

static double end_of(const struct panel_request *request)
{
    double end = 0;
    for (uint32_t p = 0; p < request->count; p++) {
        end = fmax(end, footage_end(&request->panels[p].footage));
    }
    return end;
}

static bool stopped(const struct panel_request *request, struct error *error)
{
    if (!request->signal || !*request->signal) return false;
    error_set_code(error, (enum exit_code)(128 + *request->signal),
                   "stopped by a signal; no movie was written");
    return true;
}

/* Where panel number p keeps its grains until the movie is made. */
static void record_path(const struct panel_request *request, uint32_t p, char path[FILE_PATH_MAX])
{
    snprintf(path, FILE_PATH_MAX, "%s.%u.grains", request->path, p);
}

/* Goes through all frames once: dumps what is simulated, gathers the values of the colours. */
static bool record(const struct panel_request *request, uint32_t p, uint32_t frames,
                   struct error *error)
{
    struct panel *panel = &request->panels[p];
    char path[FILE_PATH_MAX];
    record_path(request, p, path);
    if (!panel->footage.from_dumps && !dumps_begin(&panel->record, path, 0, error)) return false;
    for (uint32_t k = 0; k < frames; k++) {
        const double t = fmin(k * request->interval, footage_end(&panel->footage));
        if (stopped(request, error) || !footage_go(&panel->footage, t, error)) return false;
        if (!film_gather(&panel->film, &panel->footage.grains, error)) return false;
        panel->walls[k] = panel->footage.wall;
        if (!panel->footage.from_dumps
            && !dumps_add(&panel->record, &panel->footage.grains, panel->footage.steps, error)) {
            return false;
        }
    }
    return true;
}

static bool draw_panel(const struct panel_request *request, struct panel *panel, uint32_t k,
                       bool recorded, struct error *error)
{
    const double t = fmin(k * request->interval, footage_end(&panel->footage));
    if (!recorded || panel->footage.from_dumps) {
        if (!footage_go(&panel->footage, t, error)) return false;
        return film_draw(&panel->film, &panel->footage.grains, panel->footage.steps,
                         panel->footage.wall, error);
    }
    struct grains *grains = &panel->footage.grains;
    return dumps_load(&panel->record, k, grains, error)
        && film_draw(&panel->film, grains, panel->record.index.entries[k].steps, panel->walls[k],
                     error);
}

static bool draw(const struct panel_request *request, uint32_t frames, bool recorded,
                 struct movie *movie, struct image *whole, struct error *error)
{
    for (uint32_t k = 0; k < frames; k++) {
        uint32_t x0 = 0;
        for (uint32_t p = 0; p < request->count; p++) {
            struct panel *panel = &request->panels[p];
            if (stopped(request, error) || !draw_panel(request, panel, k, recorded, error)) {
                return false;
            }
            image_place(whole, &panel->film.image, x0, 0);
            x0 += panel->film.image.width;
        }
        if (!movie_frame(movie, whole, error)) return false;
        if (!request->report) continue;
        const struct run_status status = {.doing = "filming", .share = (k + 1.0) / frames,
                                          .frames = k + 1, .wall = 2};
        request->report(request->context, &status);
    }
    return true;
}

static void clean(const struct panel_request *request)
{
    for (uint32_t p = 0; p < request->count; p++) {
        struct panel *panel = &request->panels[p];
        char path[FILE_PATH_MAX];
        record_path(request, p, path);
        if (*panel->record.directory) {
            folder_clear(path, "dump");
            rmdir(path);
        }
        dumps_close(&panel->record);
        free(panel->walls);
        panel->walls = NULL;
    }
}

static bool shape(const struct panel_request *request, uint32_t frames, struct image *whole,
                  bool *needs_record, struct error *error)
{
    uint32_t width = 0, height = 0;
    *needs_record = false;
    for (uint32_t p = 0; p < request->count; p++) {
        struct panel *panel = &request->panels[p];
        width += panel->film.image.width;
        if (p == 0) height = panel->film.image.height;
        if (panel->film.image.height != height) {
            return error_set_code(error, EXIT_USAGE, "panels of different heights; give all one "
                                  "--size");
        }
        panel->walls = calloc(frames, sizeof *panel->walls);
        if (!panel->walls) return error_set(error, "not enough memory for %u frames", frames);
        *needs_record = *needs_record || film_needs_gathering(&panel->film);
    }
    return image_create(whole, width, height, error);
}

bool panel_film(const struct panel_request *request, uint64_t *frames, struct error *error)
{
    const double count = floor(end_of(request) / request->interval + frame_slack) + 1;
    if (!(count <= 1e6)) {
        return error_set_code(error, EXIT_USAGE, "%.3g frames are too many; use --every", count);
    }
    *frames = (uint64_t)count;
    struct image whole = {0};
    bool needs_record;
    bool done = shape(request, (uint32_t)count, &whole, &needs_record, error);
    struct movie *movie = done ? movie_begin(request->path, whole.width, whole.height,
                                             request->frame_rate, error) : NULL;
    done = movie != NULL;
    if (done && needs_record) {
        for (uint32_t p = 0; done && p < request->count; p++) {
            done = record(request, p, (uint32_t)count, error);
        }
        struct film *films[PANEL_MAX];
        for (uint32_t p = 0; p < request->count; p++) films[p] = &request->panels[p].film;
        film_settle_together(films, request->count);
    }
    done = done && draw(request, (uint32_t)count, needs_record, movie, &whole, error);
    if (done) done = movie_commit(movie, error);
    else movie_abandon(movie);
    clean(request);
    image_free(&whole);
    return done;
}
