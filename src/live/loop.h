/* loop.h - the life of a session that is watched: advances it, serves commands from any thread,
 * and shows it to those who look.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LOOP_H
#define LOOP_H

#include "live/stage.h"

#include <signal.h>

struct loop;

struct loop *loop_create(struct session *session, struct error *error);
void loop_destroy(struct loop *loop);

/* Runs in the thread that owns the session, until `quit` or a signal (its number in *signal;
 * EXIT_INTERRUPT or EXIT_TERMINATED then). */
bool loop_run(struct loop *loop, const volatile sig_atomic_t *signal, struct error *error);

/* ---- in any thread ---- */

/* Has one line carried out between two pieces of the simulation, and waits for it.  Copies the
 * reply or the complaint; false if it failed. */
bool loop_ask(struct loop *loop, const char *text, char *reply, size_t size);

/* The same for a question that needs more than a command: `answer` is called with the session by
 * the thread that owns it.  False if the session is over. */
bool loop_call(struct loop *loop, void (*answer)(void *context, struct session *session),
               void *context);

/* How things stand. */
struct stage_status loop_status(struct loop *loop);

/* The last trouble that nobody has asked for: a state that broke, a picture that failed. */
void loop_trouble(struct loop *loop, char *text, size_t size);

struct stage *loop_stage(struct loop *loop);

/* The session itself: before loop_run() begins, or for its own thread. */
struct session *loop_session(struct loop *loop);

/* Ends it, as `quit` does. */
void loop_end(struct loop *loop);

#endif
