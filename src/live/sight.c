/* sight.c - see sight.h.
 *
 * A change of the look is an override like any other, read through the scene's keys; it touches
 * the simulation only where a colour wants something counted.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/sight.h"

#include "live/steer.h"
#include "run/look.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The share of the box that is shown around a followed grain when the whole box was. */
static const double follow_share = 0.3;

static const double movie_frames = 250;         /* over a scene that wants no frames itself */

const struct scene *sight_scene(const struct session *session)
{
    return session->look_setup.scene ? session->look_setup.scene : session->base.scene;
}

/* ---- the look ----------------------------------------------------------------------------- */

static bool allowed(const struct session *session, const struct scene *scene,
                    struct error *error)
{
    const struct view *old = &session->view, *view = &scene->view;
    if (*view->map && map_find(view->map) < 0) {
        return error_set_code(error, EXIT_USAGE, "there is no map '%s'; `sandreel help view.map` "
                              "lists them", view->map);
    }
    if (session->movie.movie && memcmp(old->size, view->size, sizeof view->size) != 0) {
        return error_set_code(error, EXIT_USAGE, "the size cannot change while a film is made; "
                              "end it with: movie stop");
    }
    return true;
}

/* A colour may tell what nobody has counted so far. */
static bool count_for(struct session *session, const struct scene *scene, struct error *error)
{
    const effects_t fresh = scene->effects & ~session->sim.phase_scene->effects;
    return !(fresh & EFFECT_COLLISION_RATE)
        || steer_change(session, "measure.collisions=true", error);
}

/* The look without the key that `without` begins with (NULL: none is left out). */
static bool copy_look(const struct session *session, const char *without,
                      struct timeline_texts *copy, struct error *error)
{
    for (uint32_t k = 0; k < session->look.count; k++) {
        const char *text = session->look.texts[k];
        if (without && strncmp(text, without, strlen(without)) == 0) continue;
        if (!timeline_put(copy, text, error)) return false;
    }
    return true;
}

static void take_look(struct session *session, struct timeline_texts *look, struct setup *setup)
{
    const struct timeline_texts old = session->look;
    pthread_mutex_lock(&session->scene_lock);
    film_close(&session->film);                 /* opened again when it is needed */
    setup_free(&session->look_setup);
    session->look_setup = *setup;
    session->view = setup->scene->view;
    session->look = *look;
    session->version++;
    pthread_mutex_unlock(&session->scene_lock);
    *look = old;
    *setup = (struct setup){0};
}

static bool put_on(struct session *session, struct timeline_texts *look, struct error *error)
{
    struct setup setup;
    const bool done = timeline_setup(&session->timeline, session->base.scene, look, &setup, error)
                   && allowed(session, setup.scene, error)
                   && count_for(session, setup.scene, error);
    if (done) take_look(session, look, &setup);
    setup_free(&setup);
    return done;
}

bool sight_change(struct session *session, const char *text, struct error *error)
{
    struct timeline_texts look = {0};
    const bool done = copy_look(session, NULL, &look, error)
                   && timeline_put(&look, text, error) && put_on(session, &look, error);
    timeline_free_texts(&look);
    return done;
}

bool sight_color(struct session *session, const struct command_line *line, struct error *error)
{
    char text[COMMAND_WORD_MAX + 40];
    snprintf(text, sizeof text, "view.color=\"%s\"", line->word);
    return sight_change(session, text, error);
}

bool sight_map(struct session *session, const struct command_line *line, struct error *error)
{
    char text[COMMAND_WORD_MAX + 40];
    const bool none = strcmp(line->word, "none") == 0;
    snprintf(text, sizeof text, "view.map=\"%s\"", none ? "" : line->word);
    return sight_change(session, text, error);
}

/* ---- the window --------------------------------------------------------------------------- */

static bool show_window(struct session *session, const double window[4], struct error *error)
{
    char text[160];
    snprintf(text, sizeof text, "view.window=[%.9e, %.9e, %.9e, %.9e]", window[0], window[1],
             window[2], window[3]);
    return sight_change(session, text, error);
}

bool sight_zoom(struct session *session, const struct command_line *line, struct error *error)
{
    const double *n = line->numbers;
    if (line->number_count == 4) return show_window(session, n, error);
    if (!(n[0] > 0)) {
        return error_set_code(error, EXIT_USAGE, "zoom %g: a factor greater than 0", n[0]);
    }
    double w[4];
    painter_window(&session->view, session_scene(session), w);
    /* The point keeps its place in the picture. */
    const bool about = line->number_count == 3;
    const double x = about ? n[1] : 0.5 * (w[0] + w[2]), y = about ? n[2] : 0.5 * (w[1] + w[3]);
    for (int k = 0; k < 4; k++) {
        const double still = k % 2 ? y : x;
        w[k] = still + (w[k] - still) / n[0];
    }
    return show_window(session, w, error);
}

bool sight_pan(struct session *session, const struct command_line *line, struct error *error)
{
    double w[4];
    painter_window(&session->view, session_scene(session), w);
    const double dx = line->numbers[0] * (w[2] - w[0]), dy = line->numbers[1] * (w[3] - w[1]);
    const double moved[4] = {w[0] + dx, w[1] + dy, w[2] + dx, w[3] + dy};
    return show_window(session, moved, error);
}

/* The window that the scene itself asks for: of most scenes the whole box. */
bool sight_fit(struct session *session, const struct command_line *line, struct error *error)
{
    (void)line;
    struct timeline_texts look = {0};
    session->follows = false;
    const bool done = copy_look(session, "view.window=", &look, error)
                   && put_on(session, &look, error);
    timeline_free_texts(&look);
    return done;
}

bool sight_follow(struct session *session, const struct command_line *line, struct error *error)
{
    const bool follows = line->number_count == 1;
    const double id = line->numbers[0];
    if (follows && !(id >= 0 && id == floor(id) && id < UINT32_MAX)) {
        return error_set_code(error, EXIT_USAGE, "follow %g: a grain's id is a whole number", id);
    }
    session->follows = follows;
    session->followed = follows ? (uint64_t)id : 0;
    session->version++;
    return true;
}

struct view sight_view(const struct session *session, const struct grains *grains)
{
    struct view view = session->view;
    for (uint32_t i = 0; session->follows && i < grains->count; i++) {
        if (grains->id[i] != session->followed) continue;
        double w[4];
        painter_window(&view, session_scene(session), w);
        const double share = isnan(view.window[0]) ? follow_share : 1;
        const double half_x = 0.5 * share * (w[2] - w[0]), half_y = 0.5 * share * (w[3] - w[1]);
        const double window[4] = {grains->x[i] - half_x, grains->y[i] - half_y,
                                  grains->x[i] + half_x, grains->y[i] + half_y};
        memcpy(view.window, window, sizeof window);
        break;
    }
    return view;
}

/* ---- pictures ----------------------------------------------------------------------------- */

/* Draws the present; a single picture is coloured by itself, as `frame` does. */
static bool draw(struct session *session, struct error *error)
{
    struct film *film = &session->film;
    const bool contacts = film_needs_contacts(&session->view);
    if (!look_at(&session->sim, &session->grains, contacts, error)) return false;
    if (!film->painter) {
        struct view view = session->view;
        view.range_from = RANGE_FRAME;
        if (!film_open(film, sight_scene(session), session->sim.model, &view, error)) {
            film_close(film);
            return false;
        }
    }
    film->scene = session_scene(session);
    film->view = sight_view(session, &session->grains);
    return film_draw(film, &session->grains, simulation_count(&session->sim).steps, session->wall,
                     error);
}

bool sight_frame(struct session *session, const struct command_line *line, struct error *error)
{
    char path[FILE_PATH_MAX];
    if (!session_file(session, line->word, ".png", path, error) || !draw(session, error)
        || !film_save(&session->film, session->grains.time, path, error)) {
        return false;
    }
    session_say(session, "%s", path);
    return true;
}

/* ---- films -------------------------------------------------------------------------------- */

double sight_movie_due(const struct session *session)
{
    const struct session_movie *movie = &session->movie;
    return movie->movie ? movie->start + (double)movie->next * movie->interval : INFINITY;
}

bool sight_movie_frame(struct session *session, struct error *error)
{
    session->movie.next++;
    return draw(session, error) && movie_frame(session->movie.movie, &session->film.image, error);
}

void sight_movie_again(struct session *session)
{
    session->movie.start = simulation_count(&session->sim).time;
    session->movie.next = 0;
}

static bool begin_movie(struct session *session, const char *name, struct error *error)
{
    struct session_movie *movie = &session->movie;
    const struct output *output = &session_scene(session)->output;
    char path[FILE_PATH_MAX];
    const char *ending = strrchr(name, '.');
    if (movie->movie) {
        return error_set_code(error, EXIT_USAGE, "%s is being made; end it with: movie stop",
                              movie->name);
    }
    if (!session_file(session, name, ending ? ending : ".mp4", path, error)
        || !movie_name_ok(path, error) || !movie_available(error)) {
        return false;
    }
    movie->movie = movie_begin(path, (uint32_t)session->view.size[0],
                               (uint32_t)session->view.size[1], output->frame_rate, error);
    if (!movie->movie) return false;
    snprintf(movie->name, sizeof movie->name, "%s", name);
    movie->interval = output->frames > 0 ? output->frames
                                         : session_scene(session)->until / movie_frames;
    sight_movie_again(session);
    return true;
}

static bool end_movie(struct session *session, const char *name, struct error *error)
{
    struct session_movie *movie = &session->movie;
    if (!movie->movie) return error_set_code(error, EXIT_USAGE, "no film is being made");
    if (*name && strcmp(name, movie->name) != 0) {
        return error_set_code(error, EXIT_USAGE, "the film that is being made is %s",
                              movie->name);
    }
    /* A film that was ended at once shows at least where it began. */
    const bool drawn = movie->next > 0 || sight_movie_frame(session, error);
    if (!drawn) movie_abandon(movie->movie);
    const bool done = drawn && movie_commit(movie->movie, error);
    movie->movie = NULL;
    if (done) session_say(session, "%s/%s", session->directory, movie->name);
    return done;
}

bool sight_movie(struct session *session, const struct command_line *line, struct error *error)
{
    return strcmp(line->literal, "start") == 0 ? begin_movie(session, line->word, error)
                                               : end_movie(session, line->word, error);
}

void sight_close(struct session *session)
{
    if (session->movie.movie) end_movie(session, "", NULL);
    film_close(&session->film);
    grains_free(&session->grains);
}
