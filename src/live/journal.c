/* journal.c - see journal.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/journal.h"

#include "live/conduct.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static bool flushed(struct session *session, struct error *error)
{
    return (fflush(session->journal) == 0 && !ferror(session->journal))
        || error_set(error, "%s/session.log: writing stopped; is the disk full?",
                     session->directory);
}

bool journal_begin(struct session *session, struct error *error)
{
    char path[FILE_PATH_MAX];
    folder_path(path, session->directory, "session.log");
    session->journal = fopen(path, "w");
    if (!session->journal) {
        return error_set(error, "%s: cannot create this file: %s", path, strerror(errno));
    }
    fprintf(session->journal, "# sandreel session 1\n# scene %s\n", session->timeline.path);
    for (uint32_t k = 0; k < session->timeline.overrides.count; k++) {
        fprintf(session->journal, "# override %s\n", session->timeline.overrides.texts[k]);
    }
    return flushed(session, error);
}

bool journal_line(struct session *session, double time, uint64_t steps, const char *text,
                  struct error *error)
{
    if (!session->journal) return true;
    fprintf(session->journal, "%.17g %" PRIu64 " %s\n", time, steps, text);
    return flushed(session, error);
}

bool journal_end(struct session *session, struct error *error)
{
    bool done = session_settle(session, NULL);          /* a broken state has no better end */
    fprintf(session->journal, "# end %.17g %" PRIu64 " %016" PRIx64 "\n", session->reached,
            simulation_count(&session->sim).steps, simulation_digest(&session->sim));
    done = flushed(session, error);
    done = fclose(session->journal) == 0 && done;
    session->journal = NULL;
    return done;
}

/* ---- replay ------------------------------------------------------------------------------- */

enum { OVERRIDES_MAX = 300 };

struct replay {
    char *log, *text;
    const char *path;           /* of the scene */
    const char *overrides[OVERRIDES_MAX];
    uint32_t override_count;
    char *at;                   /* the rest of the log */
    const char *run;
};

/* Cuts the next line off the log; NULL at its end. */
static char *next_line(struct replay *replay)
{
    char *line = replay->at, *end;
    if (!line || !*line) return NULL;
    end = strchr(line, '\n');
    if (!end) return NULL;      /* a torn last line was never carried out to its end */
    *end = 0;
    replay->at = end + 1;
    return line;
}

static const char *after(const char *line, const char *head)
{
    return strncmp(line, head, strlen(head)) == 0 ? line + strlen(head) : NULL;
}

static bool read_head(struct replay *replay, struct error *error)
{
    const char *first = next_line(replay);
    if (!first || strcmp(first, "# sandreel session 1") != 0) {
        return error_set_code(error, EXIT_USAGE, "%s/session.log: not the log of a session",
                              replay->run);
    }
    while (replay->at[0] == '#' && !after(replay->at, "# end ")) {
        const char *line = next_line(replay);
        if (!line) break;
        const char *scene = after(line, "# scene "), *override = after(line, "# override ");
        if (scene) replay->path = scene;
        if (override && replay->override_count < OVERRIDES_MAX) {
            replay->overrides[replay->override_count++] = override;
        }
    }
    return replay->path || error_set_code(error, EXIT_USAGE, "%s/session.log: names no scene",
                                          replay->run);
}

/* Goes to where the line was given; the same steps must lead there. */
static bool go_there(struct session *session, const char *line, const char **command,
                     struct error *error)
{
    char *end;
    const double time = strtod(line, &end);
    const uint64_t steps = strtoull(end, &end, 10);
    if (*end != ' ') {
        return error_set_code(error, EXIT_USAGE, "'%.60s' does not begin with a time and a number "
                              "of steps", line);
    }
    *command = end + 1;
    if (!session_reach(session, time, error)) return false;
    const struct counters now = simulation_count(&session->sim);
    return now.steps == steps
        || error_set_code(error, EXIT_VERDICT, "the repetition is not the session: t = %.9g took "
            "%" PRIu64 " steps, and not %" PRIu64, time, now.steps, steps);
}

static bool compare_end(struct session *session, const char *line, struct journal_result *result,
                        struct error *error)
{
    const char *text;
    if (!go_there(session, line, &text, error)) return false;
    result->digest = simulation_digest(&session->sim);
    result->compared = true;
    return strtoull(text, NULL, 16) == result->digest
        || error_set_code(error, EXIT_VERDICT, "the repetition ends in another state (%016" PRIx64
            ") than the session (%s)", result->digest, text);
}

static bool repeat(struct session *session, struct replay *replay,
                   const struct journal_replay *request, struct journal_result *result,
                   struct error *error)
{
    for (char *line; (line = next_line(replay));) {
        const char *end = after(line, "# end "), *command;
        if (end) return compare_end(session, end, result, error);
        if (!go_there(session, line, &command, error)
            || !conduct_line(session, command, error)) {
            return false;
        }
        result->lines++;
        if (request->report) request->report(request->context,
                                             simulation_count(&session->sim).time);
    }
    return true;
}

static bool load(struct replay *replay, const struct journal_replay *request,
                 struct error *error)
{
    char path[FILE_PATH_MAX];
    size_t size;
    *replay = (struct replay){.run = request->run};
    replay->log = file_load(folder_path(path, request->run, "session.log"), 1 << 28, &size, error);
    if (!replay->log) return false;
    replay->text = file_load(folder_path(path, request->run, "start.cfg"), 1 << 28, &size, error);
    replay->at = replay->log;
    return replay->text && read_head(replay, error);
}

bool journal_replay(const struct journal_replay *request, struct journal_result *result,
                    struct error *error)
{
    struct replay replay;
    char start[FILE_PATH_MAX];
    *result = (struct journal_result){0};
    struct session *session = calloc(1, sizeof *session);
    bool done = (session || error_set(error, "not enough memory for a session"))
             && load(&replay, request, error);
    if (done) {
        if (request->directory) {
            snprintf(result->directory, sizeof result->directory, "%s", request->directory);
        } else {
            folder_choose(result->directory, request->run, "replay");
        }
        folder_path(start, request->run, "start.checkpoint");
        const struct session_request wanted = {
            .path = replay.path, .text = replay.text, .overrides = replay.overrides,
            .override_count = replay.override_count, .directory = result->directory,
            .force = request->force, .start = file_exists(start) ? start : NULL,
        };
        done = session_open(session, &wanted, error)
            && repeat(session, &replay, request, result, error);
        struct error minor = {0};
        done = session_close(session, done ? error : &minor) && done;
    }
    if (session) {
        free(replay.log);
        free(replay.text);
    }
    free(session);
    return done;
}
