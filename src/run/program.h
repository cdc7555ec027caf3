/* program.h - another program fed through a pipe: ffmpeg with frames, gnuplot with a script.
 *
 * No shell is involved, and the program runs in a process group of its own, so Ctrl-C reaches
 * sandreel alone, which then decides.  What it complains about is kept for our own messages.  The
 * caller must ignore SIGPIPE.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PROGRAM_H
#define PROGRAM_H

#include "base/error.h"

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

struct program {
    pid_t process;              /* 0: none */
    int   pipe;                 /* we write, it reads; -1: closed */
    FILE *complaints;           /* what it says goes into this unnamed file */
    bool  hangs;                /* a signal came and it did not read: given up, drops the rest */
};

/* Is there a program of this name on the PATH? */
bool program_is_there(const char *name);

/* Starts arguments[0] (the list ends with NULL) in `directory` (NULL: where we are). */
bool program_start(struct program *program, const char *const *arguments, const char *directory,
                   struct error *error);

bool program_send(struct program *program, const void *bytes, size_t size);

/* Ends its input and waits; true if it was content. */
bool program_finish(struct program *program);

/* Has it ended?  Then *status is what waitpid() gave, and there is nothing left to finish. */
bool program_poll(struct program *program, int *status);

/* Stops it. */
void program_stop(struct program *program);

/* The beginning of what it complained about, on one line. */
void program_words(struct program *program, char *words, size_t size);

/* Frees, after finish or stop. */
void program_close(struct program *program);

#endif
