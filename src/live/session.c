/* session.c - see session.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/session.h"

#include "base/clock.h"
#include "live/journal.h"
#include "live/sight.h"
#include "run/checkpoint.h"
#include "run/manifest.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const double piece_seconds = 0.01;       /* of wall time: commands are served in between */
static const double kept_states = 100;          /* over the scene's whole time */

/* A scene without pictures is shown in about so many seconds, unless the speed is set. */
static const double show_seconds = 30;

/* ---- opening and closing ------------------------------------------------------------------ */

static void forget_before(struct session *session)
{
    if (!isnan(session->before_time)) archive_end(&session->before);
    session->before_time = NAN;
}

static bool load_bytes(struct session *session, const void *bytes, size_t size,
                       struct error *error)
{
    struct archive archive;
    archive_begin_load(&archive, bytes, size);
    const bool done = simulation_load(&session->sim, &archive, error);
    archive_end(&archive);
    return done;
}

/* A run goes on from its newest checkpoint, if it has one. */
static bool load_start(struct session *session, const struct session_request *request,
                       struct error *error)
{
    char path[FILE_PATH_MAX];
    void *bytes;
    size_t size;
    uint64_t turn;
    if (request->start) {
        bytes = file_load(request->start, (size_t)1 << 36, &size, error);
        if (!bytes) return false;
        const bool done = load_bytes(session, bytes, size, error);
        free(bytes);
        return done;
    }
    if (!setup_is_run(request->path)) return true;
    folder_path(path, request->path, "checkpoint");
    if (!file_exists(path)) return true;
    if (!checkpoint_load(path, session->timeline.text, &bytes, &size, &turn, error)) return false;
    const bool done = load_bytes(session, bytes, size, error);
    free(bytes);
    return done;
}

/* What a replay begins with: the scene's words, and the state unless it is the scene's start. */
static bool write_start(struct session *session, struct error *error)
{
    char path[FILE_PATH_MAX];
    const char *text = session->timeline.text;
    folder_path(path, session->directory, "start.cfg");
    if (!file_save(path, text, strlen(text), error)) return false;
    folder_remove(session->directory, "start.checkpoint");      /* of an earlier session there */
    if (simulation_count(&session->sim).time == 0) return true;
    struct archive archive;
    archive_begin_save(&archive);
    const bool done = simulation_save(&session->sim, &archive, error)
        && file_save(folder_path(path, session->directory, "start.checkpoint"), archive.bytes,
                     archive.size, error);
    archive_end(&archive);
    return done;
}

static bool write_scene(struct session *session, const char *status, struct error *error)
{
    char path[FILE_PATH_MAX];
    const struct manifest manifest = {.scene = session_scene(session), .status = status,
                                      .model = session->sim.model};
    return scene_write(session_scene(session),
                       folder_path(path, session->directory, "scene.cfg"), error)
        && manifest_save(&manifest, session->directory, error);
}

static void mark_present(struct session *session)
{
    const struct counters now = simulation_count(&session->sim);
    session->reached = now.time;
    session->steps = now.steps;
}

static bool take_start(struct session *session, const struct session_request *request,
                       struct error *error)
{
    if (!load_start(session, request, error)) return false;
    mark_present(session);
    return true;
}

static double natural_speed(const struct scene *scene)
{
    const double film = scene->output.frames * scene->output.frame_rate;
    return film > 0 ? film : scene->until / show_seconds;
}

static bool open_folder(struct session *session, const struct session_request *request,
                        struct error *error)
{
    if (request->directory) {
        snprintf(session->directory, sizeof session->directory, "%s", request->directory);
    } else {
        folder_choose(session->directory, session_scene(session)->name, "live");
    }
    return folder_claim(session->directory, request->force, error)
        && write_start(session, error) && write_scene(session, "live", error)
        && journal_begin(session, error)
        && logging_open(&session->logging, session->directory, &session->sim, error);
}

bool session_open(struct session *session, const struct session_request *request,
                  struct error *error)
{
    *session = (struct session){.budget = 64, .before_time = NAN, .go_until = INFINITY};
    pthread_mutex_init(&session->scene_lock, NULL);
    if (!timeline_open(&session->timeline, request->path, request->text, request->overrides,
                       request->override_count, error)
        || !timeline_setup(&session->timeline, NULL, NULL, &session->base, error)) {
        return false;
    }
    const struct scene *scene = session->base.scene;
    session->view = scene->view;
    session->speed = natural_speed(scene);
    return timeline_adopt(&session->timeline, scene, error)
        && timeline_copy(&session->timeline, &session->origin, error)
        && simulation_create(&session->sim, session->base.model, scene, error)
        && take_start(session, request, error)
        && open_folder(session, request, error)
        && keeper_open(&session->keeper, &session->sim, &session->logging,
                       scene->until / kept_states, error);
}

bool session_close(struct session *session, struct error *error)
{
    bool done = true;
    /* A session that could not be opened to its end, which is the keeper's first state, has none
     * to tell of. */
    if (session->journal && session->keeper.count > 0) {
        done = journal_end(session, error) && write_scene(session, "done", error);
    } else if (session->journal) {
        fclose(session->journal);
    }
    sight_close(session);
    forget_before(session);
    keeper_close(&session->keeper);
    logging_close(&session->logging);
    if (session->sim.state) simulation_destroy(&session->sim);
    setup_free(&session->now);
    setup_free(&session->look_setup);
    setup_free(&session->base);
    timeline_close(&session->timeline);
    timeline_close(&session->origin);
    timeline_free_texts(&session->look);
    pthread_mutex_destroy(&session->scene_lock);
    return done;
}

/* ---- small services ----------------------------------------------------------------------- */

void session_say(struct session *session, const char *format, ...)
{
    const size_t used = strlen(session->reply), room = sizeof session->reply - used;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(session->reply + used, room, format, arguments);
    va_end(arguments);
}

bool session_file(const struct session *session, const char *name, const char *ending,
                  char path[FILE_PATH_MAX], struct error *error)
{
    bool plain = name[0] != '.' && strlen(name) + strlen(ending) < SESSION_NAME_MAX;
    for (const char *at = name; *at; at++) {
        plain = plain && (isalnum((unsigned char)*at) || strchr("._-", *at));
    }
    if (!plain) {
        return error_set_code(error, EXIT_USAGE, "'%.60s': a file of a session is a plain name of "
            "letters, digits, '.', '_' and '-'; it is written into %s", name, session->directory);
    }
    const char *has = strrchr(name, '.');
    folder_path(path, session->directory, "%s%s", name,
                has && strcmp(has, ending) == 0 ? "" : ending);
    return true;
}

/* ---- advancing ---------------------------------------------------------------------------- */

static void adapt(struct session *session, double took, uint64_t steps)
{
    session->wall += took;
    if (took < piece_seconds / 2 && steps >= session->budget
        && session->budget < UINT64_MAX / 4) {
        session->budget *= 2;
    } else if (took > 2 * piece_seconds && session->budget > 1) {
        session->budget /= 2;
    }
}

/* Rows of the log, states to keep and frames of a movie that are due at `time`, which has been
 * reached; the row first, so that a state knows it. */
static bool serve(struct session *session, double time, struct error *error)
{
    if (logging_due(&session->logging) <= time
        && !logging_row(&session->logging, &session->sim, session->wall, error)) {
        return false;
    }
    if (keeper_due(&session->keeper) <= time
        && !keeper_keep(&session->keeper, &session->sim, error)) {
        return false;
    }
    return sight_movie_due(session) > time || sight_movie_frame(session, error);
}

/* One piece towards t; *arrived says whether it is reached. */
static bool advance(struct session *session, double t, bool *arrived, struct error *error)
{
    const double kept = fmin(keeper_due(&session->keeper), logging_due(&session->logging));
    const double due = fmin(t, fmin(kept, sight_movie_due(session)));
    const uint64_t left = session->steps_left;
    const uint64_t budget = left > 0 && left < session->budget ? left : session->budget;
    const double start = clock_wall();
    const enum advance outcome = simulation_advance(&session->sim, due, budget, error);
    const struct counters now = simulation_count(&session->sim);
    const uint64_t steps = now.steps - session->steps;
    session->steps = now.steps;
    adapt(session, clock_wall() - start, steps);
    session->version++;
    if (steps > 0) forget_before(session);
    session->between = outcome != ADVANCE_REACHED;
    session->reached = session->between ? now.time : due;
    *arrived = outcome == ADVANCE_REACHED && due == t;
    if (outcome == ADVANCE_BROKEN) return false;
    if (left > 0) {
        session->steps_left = steps < left ? left - steps : 0;
        *arrived = *arrived || session->steps_left == 0;
    }
    return outcome != ADVANCE_REACHED || serve(session, due, error);
}

bool session_piece(struct session *session, double t_limit, struct error *error)
{
    /* Steps are taken without a time in mind; the limit only has to be out of their reach. */
    const double far = session->reached + 1e3 * session_scene(session)->until;
    const bool by_steps = session->steps_left > 0;
    const double end = fmin(by_steps ? INFINITY : session->go_until, far);
    bool arrived = false;
    if (!advance(session, by_steps ? far : fmin(end, t_limit), &arrived, error)) {
        session->running = false;
        session->steps_left = 0;
        return false;
    }
    if (arrived && (by_steps || t_limit >= end)) session->running = false;
    return true;
}

bool session_finish(struct session *session, struct error *error)
{
    while (session->running) {
        if (!session_piece(session, INFINITY, error)) return false;
    }
    return true;
}

bool session_reach(struct session *session, double time, struct error *error)
{
    for (bool arrived = false; !arrived;) {
        if (!advance(session, time, &arrived, error)) return false;
    }
    return true;
}

bool session_settle(struct session *session, struct error *error)
{
    double time = session->reached;
    session->steps_left = 0;
    /* The time of an event is rounded, and the event may lie a hair behind it: whoever goes to
     * that time at once must find the event done as well. */
    for (int k = 0; session->between && k < 4; k++) time = nextafter(time, INFINITY);
    return session_reach(session, time, error);
}

/* ---- another scene ------------------------------------------------------------------------ */

/* A simulation of the setup's scene in the state that was archived; NULL: at its start. */
static bool build(const struct setup *setup, const struct archive *state,
                  struct simulation *sim, struct error *error)
{
    if (!simulation_create(sim, setup->model, setup->scene, error)) return false;
    if (!state) return true;
    struct archive load;
    archive_begin_load(&load, state->bytes, state->size);
    const bool done = simulation_load(sim, &load, error);
    archive_end(&load);
    if (!done) simulation_destroy(sim);
    return done;
}

static void replace_setup(struct setup *old, struct setup *setup)
{
    setup_free(old);
    *old = *setup;
    *setup = (struct setup){0};
}

bool session_adopt(struct session *session, struct setup *setup, uint32_t phase,
                   const struct archive *state, struct error *error)
{
    struct simulation fresh;
    if (state && !build(setup, state, &fresh, error)) return false;
    pthread_mutex_lock(&session->scene_lock);
    bool done = true;
    if (state) {
        simulation_destroy(&session->sim);
        session->sim = fresh;
        mark_present(session);
        forget_before(session);
    } else {
        done = simulation_enter(&session->sim, setup->scene, phase, &session->before, error);
    }
    if (done) replace_setup(&session->now, setup);
    session->version++;
    pthread_mutex_unlock(&session->scene_lock);
    return done;
}

bool session_untouched(const struct session *session)
{
    const struct counters now = simulation_count(&session->sim);
    return now.time == 0 && now.steps == 0;
}

bool session_restart(struct session *session, const struct timeline *timeline,
                     struct error *error)
{
    struct setup setup;
    struct simulation fresh;
    struct keeper keeper = {0};
    if (!timeline_setup(timeline, NULL, NULL, &setup, error)) return false;
    if (!build(&setup, NULL, &fresh, error)) {
        setup_free(&setup);
        return false;
    }
    logging_close(&session->logging);
    if (!logging_open(&session->logging, session->directory, &fresh, error)
        || !keeper_open(&keeper, &fresh, &session->logging, setup.scene->until / kept_states,
                        error)) {
        keeper_close(&keeper);
        logging_close(&session->logging);
        simulation_destroy(&fresh);
        setup_free(&setup);
        return false;
    }
    pthread_mutex_lock(&session->scene_lock);
    simulation_destroy(&session->sim);
    session->sim = fresh;
    mark_present(session);
    keeper_close(&session->keeper);
    session->keeper = keeper;
    forget_before(session);
    setup_free(&session->now);
    replace_setup(&session->base, &setup);
    session->version++;
    pthread_mutex_unlock(&session->scene_lock);
    return true;
}
