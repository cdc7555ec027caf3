/* journal.h - session.log: what was changed, when, in the words of the grammar; and its replay.
 *
 *     # sandreel session 1
 *     # scene hourglass
 *     # override until=2
 *     0.25 12500 set gravity (1, -9.81)
 *     # end 0.5 25000 9f0c3a...             time, steps and the hash of the last state
 *
 * A line holds the time that had been reached when its command was given, and the steps it took.
 * Going on, pausing and asking leave no line, for they change nothing.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef JOURNAL_H
#define JOURNAL_H

#include "live/session.h"

bool journal_begin(struct session *session, struct error *error);

/* The command that was carried out at that time, flushed so that it survives a crash. */
bool journal_line(struct session *session, double time, uint64_t steps, const char *text,
                  struct error *error);

bool journal_end(struct session *session, struct error *error);

struct journal_replay {
    const char *run;            /* the session's folder */
    const char *directory;      /* where the repetition writes; NULL: beside it */
    bool force;
    void (*report)(void *context, double time);         /* after each line; may be NULL */
    void *context;
};

struct journal_result {
    char directory[FILE_PATH_MAX];
    uint64_t lines;
    bool compared;              /* the log says how the session ended (it was not killed) */
    uint64_t digest;
};

/* Repeats a session.  EXIT_VERDICT if it comes to other steps or to another state. */
bool journal_replay(const struct journal_replay *replay, struct journal_result *result,
                    struct error *error);

#endif
