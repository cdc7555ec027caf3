/* tty.h - the terminal as a place for pictures and single keys, given back as it was found.
 *
 * A second process watches over it: when this one goes for whatever reason, also killed or
 * crashed, the watcher sets the terminal right.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef TTY_H
#define TTY_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>
#include <termios.h>

struct tty {
    struct termios found, raw;
    int   line;                 /* to the watcher; -1: the terminal is as it was found */
    pid_t watcher;
    unsigned columns, rows;     /* characters */
    unsigned width, height;     /* pixels; 0 if it does not tell */
    bool  kitty, sixel;         /* pictures that it said it can show */
};

/* Takes the terminal over and asks it what it can show. */
bool tty_open(struct tty *tty, struct error *error);
void tty_close(struct tty *tty);

/* Sets the mode for single keys again, after somebody else had the terminal. */
void tty_again(const struct tty *tty);

/* Looks whether its size has changed. */
bool tty_resized(struct tty *tty);

/* The next byte that was typed, waiting at most so long; -1: none. */
int tty_read(double seconds);

/* All of it, whatever the terminal's speed. */
void tty_write(const char *text, size_t size);

#endif
