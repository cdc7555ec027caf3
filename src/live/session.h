/* session.h - a simulation that is steered while it runs.
 *
 * One thread owns the session: it carries out commands (conduct.h) and advances in pieces.  What
 * is steered goes the way of phases (timeline.h), so the session is repeated bit for bit from
 * what session.log says; looking, pausing and going on never change a run.
 *
 * Its folder holds start.cfg (the scene as it was given), session.log, log.csv, what was saved on
 * command, and in the end scene.cfg: the scene with every change as a phase, which `sandreel run`
 * and `frame` repeat.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SESSION_H
#define SESSION_H

#include "live/keeper.h"
#include "live/timeline.h"
#include "run/film.h"
#include "run/folder.h"
#include "run/movie.h"

#include <pthread.h>
#include <stdio.h>

enum { SESSION_REPLY_MAX = 8192, SESSION_NAME_MAX = 120 };

struct session_request {
    const char *path;           /* a scene, or a run: then from its newest checkpoint on */
    const char *text;           /* of the scene, instead of reading it; NULL */
    const char *const *overrides;
    uint32_t override_count;
    const char *directory;      /* NULL: one named after the scene */
    bool force;                 /* overwrite an earlier session there */
    const char *start;          /* a checkpoint of this scene to begin with; NULL: none */
};

/* A film that is being made, a frame each interval of simulated time. */
struct session_movie {
    struct movie *movie;        /* NULL: none */
    char     name[SESSION_NAME_MAX];
    double   start, interval;
    uint64_t next;
};

struct session {
    char directory[FILE_PATH_MAX];
    FILE *journal;
    struct timeline origin;     /* as it was opened */
    struct timeline timeline;   /* with what was changed since */
    struct setup base;          /* owns the placed grains; the scene before any change */
    struct setup now;           /* with the changes; empty while there are none */
    struct simulation sim;
    uint64_t budget;            /* of one piece of about piece_seconds */
    struct keeper keeper;
    struct logging logging;     /* log.csv */
    struct archive before;      /* the state before the phase that began last, at before_time */
    double before_time;         /* NAN: none */

    struct timeline_texts look; /* changes of the view */
    struct setup look_setup;    /* the scene with them; empty while there are none */
    struct view view;           /* in force; its window does not follow yet */
    bool     follows;
    uint64_t followed;          /* id */
    struct film film;           /* of frames and movies that are saved; opened when needed */
    struct grains grains;       /* of its last frame */
    struct session_movie movie;

    bool     running, ended;
    double   go_until;          /* INFINITY: no end */
    uint64_t steps_left;        /* 0: goes by time */
    double   speed;             /* simulated time per wall second; INFINITY: no brake */
    double   reached;           /* the time that the last piece was to reach, and did (a model
                                 * with coarse ticks may stand before it) ... */
    bool     between;           /* ... or the model's own: it ended by its budget, between times */
    uint64_t steps;             /* likewise: counting is a sum over all grains, so once a piece */
    double   wall;              /* seconds spent on advancing */
    uint64_t version;           /* counts whatever changes the picture */
    uint64_t expected, disappointed;    /* `expect` so far, and how many did not hold */
    char     reply[SESSION_REPLY_MAX];  /* of the last command, lines without the last line feed */
    pthread_mutex_t scene_lock; /* held while a scene is exchanged, and by whoever draws one
                                 * in another thread */
};

bool session_open(struct session *session, const struct session_request *request,
                  struct error *error);

/* Writes scene.cfg and the last line of the log, and frees; false if that could not be written. */
bool session_close(struct session *session, struct error *error);

/* A piece of the work that `go` or `step` asked for, not beyond `t_limit`; stops running at its
 * end.  False with a sentence if the state broke: the session can still go back. */
bool session_piece(struct session *session, double t_limit, struct error *error);

/* Runs on until nothing is left to do. */
bool session_finish(struct session *session, struct error *error);

/* To `time`, exactly as `go until` does. */
bool session_reach(struct session *session, double time, struct error *error);

/* Brings the model to rest at the present time: pieces end anywhere, changes are made at times. */
bool session_settle(struct session *session, struct error *error);

/* Simulates in this setup's scene from now on, which has the same grains at the start: enters
 * `phase` from session->before, or loads `state` if it is not NULL.  The session owns the setup
 * then; nothing changes if it fails. */
bool session_adopt(struct session *session, struct setup *setup, uint32_t phase,
                   const struct archive *state, struct error *error);

/* Has nothing moved yet?  Then changes may concern any key. */
bool session_untouched(const struct session *session);

/* Begins anew with the scene of this timeline. */
bool session_restart(struct session *session, const struct timeline *timeline,
                     struct error *error);

/* Adds to the reply. */
void session_say(struct session *session, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Joins the session's folder and a name that was given as FILE, which must be a plain one; with
 * this ending, added if the name has none. */
bool session_file(const struct session *session, const char *name, const char *ending,
                  char path[FILE_PATH_MAX], struct error *error);

static inline const struct scene *session_scene(const struct session *session)
{
    return session->sim.scene;
}

#endif
