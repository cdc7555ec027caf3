/* conduct.h - carries commands out, whoever gave them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CONDUCT_H
#define CONDUCT_H

#include "live/session.h"

/* Carries out one line at the present time; session->reply then holds what there is to tell.
 * `go` and `step` only set the session running.  Commands that leave a trace are written to the
 * log. */
bool conduct_line(struct session *session, const char *text, struct error *error);

/* Carries out a file of commands, each after all that the one before set running is done.  `tell`
 * is called with every line and its reply or, if `failed`, its complaint.  An expectation that
 * does not hold is told and passed over (EXIT_VERDICT in the end); any other error stops. */
struct conduct_file {
    const char *path;
    void (*tell)(void *context, const char *line, const char *reply, bool failed);
    void *context;
    const volatile int *signal;         /* stops when it is not zero; may be NULL */
};
bool conduct_file(struct session *session, const struct conduct_file *file, struct error *error);

#endif
