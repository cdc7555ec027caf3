/* terminal.h - a session in a terminal: the picture, three lines below it, keys, and a line for
 * commands with history and completion.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef TERMINAL_H
#define TERMINAL_H

#include "live/loop.h"

struct terminal;

/* Takes the terminal over and shows the session in a thread of its own, until terminal_close(). */
struct terminal *terminal_open(struct loop *loop, struct error *error);
void terminal_close(struct terminal *terminal);

#endif
