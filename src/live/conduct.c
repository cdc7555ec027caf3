/* conduct.c - see conduct.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/conduct.h"

#include "live/journal.h"
#include "live/sight.h"
#include "live/steer.h"
#include "live/teller.h"
#include "run/checkpoint.h"
#include "run/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef bool (*deed)(struct session *session, const struct command_line *line,
                     struct error *error);

/* ---- commands about running --------------------------------------------------------------- */

static bool conduct_pause(struct session *session, const struct command_line *line,
                          struct error *error)
{
    (void)line, (void)error;
    session->running = false;
    session->steps_left = 0;
    return true;
}

/* The first `go` holds at the scene's end, the next goes beyond it. */
static bool conduct_go(struct session *session, const struct command_line *line,
                       struct error *error)
{
    const double now = simulation_count(&session->sim).time;
    const double until = session_scene(session)->until;
    session->go_until = now < until * (1 - 1e-9) ? until : INFINITY;
    if (line->number_count) {
        if (line->numbers[0] < now) {
            return error_set_code(error, EXIT_USAGE, "it is t = %.9g already; `back %.9g` returns",
                                  now, line->numbers[0]);
        }
        session->go_until = line->numbers[0];
    }
    session->steps_left = 0;
    session->running = true;
    return true;
}

static bool conduct_step(struct session *session, const struct command_line *line,
                         struct error *error)
{
    const double steps = line->number_count ? line->numbers[0] : 1;
    if (!(steps >= 1 && steps <= 1e15) || steps != floor(steps)) {
        return error_set_code(error, EXIT_USAGE, "step %g: a whole number of steps, 1 or more",
                              steps);
    }
    session->steps_left = (uint64_t)steps;
    session->running = true;
    return true;
}

static bool conduct_speed(struct session *session, const struct command_line *line,
                          struct error *error)
{
    const double speed = line->number_count ? line->numbers[0] : INFINITY;
    if (!(speed > 0)) {
        return error_set_code(error, EXIT_USAGE, "speed %g: simulated time per second, greater "
                              "than 0", speed);
    }
    session->speed = speed;
    return true;
}

static bool conduct_checkpoint(struct session *session, const struct command_line *line,
                               struct error *error)
{
    char path[FILE_PATH_MAX];
    struct archive archive;
    if (!session_file(session, line->word, ".checkpoint", path, error)) return false;
    archive_begin_save(&archive);
    const bool done = simulation_save(&session->sim, &archive, error)
        && checkpoint_save_as(path, 0, session->timeline.text, &archive, error);
    archive_end(&archive);
    if (done) session_say(session, "%s", path);
    return done;
}

static bool conduct_quit(struct session *session, const struct command_line *line,
                         struct error *error)
{
    session->ended = true;
    return conduct_pause(session, line, error);
}

/* ---- the table ---------------------------------------------------------------------------- */

static const deed deeds[COMMAND_COUNT] = {
    [COMMAND_pause] = conduct_pause, [COMMAND_go] = conduct_go, [COMMAND_step] = conduct_step,
    [COMMAND_speed] = conduct_speed, [COMMAND_back] = steer_back, [COMMAND_reset] = steer_reset,
    [COMMAND_set] = steer_set, [COMMAND_get] = teller_get, [COMMAND_color] = sight_color,
    [COMMAND_map] = sight_map, [COMMAND_zoom] = sight_zoom, [COMMAND_pan] = sight_pan,
    [COMMAND_fit] = sight_fit, [COMMAND_inspect] = teller_inspect,
    [COMMAND_follow] = sight_follow, [COMMAND_push] = steer_push, [COMMAND_gate] = steer_gate,
    [COMMAND_tilt] = steer_tilt, [COMMAND_pour] = steer_pour, [COMMAND_frame] = sight_frame,
    [COMMAND_movie] = sight_movie, [COMMAND_checkpoint] = conduct_checkpoint,
    [COMMAND_expect] = teller_expect, [COMMAND_help] = teller_help, [COMMAND_quit] = conduct_quit,
};

bool conduct_line(struct session *session, const char *text, struct error *error)
{
    struct command_line line;
    session->reply[0] = 0;
    if (!command_parse(text, &line, error)) return false;
    if (line.verb == COMMAND_NONE) return true;
    if (command_table[line.verb].kind == COMMAND_PASSING) {
        return deeds[line.verb](session, &line, error);
    }
    /* A broken state cannot settle, but one can go back from it. */
    const bool returns = line.verb == COMMAND_back || line.verb == COMMAND_reset;
    const uint64_t steps_left = session->steps_left;
    if (!session_settle(session, error) && !returns) return false;
    session->steps_left = steps_left;
    const uint64_t steps = simulation_count(&session->sim).steps;
    const double time = session->reached;
    return deeds[line.verb](session, &line, error)
        && journal_line(session, time, steps, text + strspn(text, " "), error);
}

/* ---- files of commands -------------------------------------------------------------------- */

/* Adds where the line is to what is wrong with it. */
static bool place_error(const struct conduct_file *file, unsigned number, struct error *error)
{
    const struct error cause = *error;
    return error_set_code(error, cause.code, "%.200s:%u: %.700s", file->path, number, cause.text);
}

static bool conduct_one(struct session *session, const struct conduct_file *file, char *text,
                        unsigned number, struct error *error)
{
    text[strcspn(text, "\r\n")] = 0;
    bool done = conduct_line(session, text, error);
    if (done) {
        if (file->tell) file->tell(file->context, text, session->reply, false);
    } else if (error->code == EXIT_VERDICT) {
        if (file->tell) file->tell(file->context, text, error->text, true);
        return true;
    }
    while (done && session->running && !(file->signal && *file->signal)) {
        done = session_piece(session, INFINITY, error);
    }
    return done || place_error(file, number, error);
}

bool conduct_file(struct session *session, const struct conduct_file *file, struct error *error)
{
    size_t size;
    char *text = file_load(file->path, 1 << 24, &size, error);
    if (!text) return false;
    bool done = true;
    unsigned number = 0;
    for (char *at = text; done && at && *at && !session->ended;) {
        char *end = strchr(at, '\n');
        if (end) *end++ = 0;
        done = conduct_one(session, file, at, ++number, error);
        if (file->signal && *file->signal) {
            done = error_set_code(error, (enum exit_code)(128 + *file->signal),
                                  "stopped by a signal");
        }
        at = end;
    }
    free(text);
    if (!done || session->disappointed == 0) return done;
    return error_set_code(error, EXIT_VERDICT, "%s: %llu of %llu expectations did not hold",
                          file->path, (unsigned long long)session->disappointed,
                          (unsigned long long)session->expected);
}
