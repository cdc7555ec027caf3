/* prompt.h - the line that follows a ':', edited by libedit: history, and completion of commands,
 * keys of the scene and words.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PROMPT_H
#define PROMPT_H

#include "live/session.h"

struct prompt;

/* `between` is called while nothing is typed: the picture goes on.  It gives the line up by
 * returning false. */
struct prompt *prompt_create(const struct session *session, bool (*between)(void *context),
                             void *context, struct error *error);
void prompt_destroy(struct prompt *prompt);

/* One line, without its line feed; NULL if it was given up.  It belongs to the prompt. */
const char *prompt_read(struct prompt *prompt);

/* What `text` up to its end could go on with: the longest common continuation is copied to
 * `more`; returns how many words there are. */
unsigned prompt_complete(const struct prompt *prompt, const char *text, char *more, size_t size);

#endif
