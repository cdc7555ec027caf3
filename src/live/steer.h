/* steer.h - commands that change what is simulated: a key, a gate, gravity, more grains, a push,
 * and the way back.  Each is a function of conduct.h's table.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STEER_H
#define STEER_H

#include "live/command.h"
#include "live/session.h"

bool steer_set(struct session *session, const struct command_line *line, struct error *error);
bool steer_push(struct session *session, const struct command_line *line, struct error *error);
bool steer_gate(struct session *session, const struct command_line *line, struct error *error);
bool steer_tilt(struct session *session, const struct command_line *line, struct error *error);
bool steer_pour(struct session *session, const struct command_line *line, struct error *error);
bool steer_back(struct session *session, const struct command_line *line, struct error *error);
bool steer_reset(struct session *session, const struct command_line *line, struct error *error);

/* "KEY=VALUE" from now on. */
bool steer_change(struct session *session, const char *text, struct error *error);

#endif
