/* error.h - what went wrong, in a sentence for people, and the exit code that it leads to.
 *
 * Everything that a user can cause (a file, a scene, no memory) returns false and fills one of
 * these; nothing is printed below cli/.  What only a programmer can cause is an assert.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ERROR_H
#define ERROR_H

#include <stdbool.h>

/* The exit codes of the command line (docs/commands.md), so that a cause is classified where it
 * is known. */
enum exit_code {
    EXIT_DONE = 0,
    EXIT_FAILED = 1,            /* failed while running */
    EXIT_USAGE = 2,             /* wrong use of the command line */
    EXIT_SCENE = 3,             /* the scene is invalid */
    EXIT_VERDICT = 4,           /* a comparison or verdict failed */
    EXIT_STOPPED = 5,           /* stopped early on purpose, checkpoint kept */
    EXIT_INTERRUPT = 130,       /* SIGINT, checkpoint written first */
    EXIT_TERMINATED = 143       /* SIGTERM, checkpoint written first */
};

struct error {
    enum exit_code code;        /* EXIT_FAILED unless set otherwise */
    char text[1000];            /* place, what, why and the cure; no line feed at the end */
};

/* Fills `error` (may be NULL) with EXIT_FAILED and the sentence; always returns false, so that
 * a function can `return error_set(...)`. */
bool error_set(struct error *error, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The same with another exit code. */
bool error_set_code(struct error *error, enum exit_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
