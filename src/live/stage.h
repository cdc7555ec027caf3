/* stage.h - pictures of a session for those who watch, drawn beside the simulation.
 *
 * The simulation only copies its grains into an empty mailbox when somebody waits for a picture;
 * a thread of the stage draws them.  A slow watcher misses frames, and when nobody waits nothing
 * is drawn.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STAGE_H
#define STAGE_H

#include "live/session.h"

/* What is told with a picture. */
struct stage_status {
    struct counters counters;
    double   until, speed, rate;        /* rate: steps a wall second, lately */
    bool     running;
    uint64_t version;           /* session->version of the picture */
};

/* A picture that several may hold; it is never changed. */
struct stage_frame {
    uint64_t number;            /* counts from 1 */
    struct image image;
    struct transform transform;
    struct stage_status status;
    int holders;                /* the stage's own */
};

struct stage;

struct stage *stage_create(struct session *session, struct error *error);
void stage_destroy(struct stage *stage);

/* ---- of the thread that owns the session ---- */

/* Does somebody wait for a picture newer than the last one?  Never more often than was asked. */
bool stage_wants(struct stage *stage, uint64_t version);

/* Hands the present over to be drawn. */
bool stage_show(struct stage *stage, const struct stage_status *status, struct error *error);

/* ---- of those who watch, in any thread ---- */

/* The newest picture with a number above `after`, waiting for at most `seconds`; NULL: none came.
 * Release it with stage_release(). `rate` is how many a second are wanted at most. */
const struct stage_frame *stage_await(struct stage *stage, uint64_t after, double seconds,
                                      double rate);
void stage_release(struct stage *stage, const struct stage_frame *frame);

/* Sends all who wait away, now and from now on. */
void stage_dismiss(struct stage *stage);

/* Called after the drawing thread stopped for an error; "" if it is well. */
const char *stage_trouble(struct stage *stage);

uint64_t stage_drawn(struct stage *stage);      /* pictures so far */

#endif
