/* teller.h - commands that ask: a key or a total, a grain, whether something holds, for help.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef TELLER_H
#define TELLER_H

#include "live/command.h"
#include "live/session.h"

bool teller_get(struct session *session, const struct command_line *line, struct error *error);
bool teller_inspect(struct session *session, const struct command_line *line,
                    struct error *error);
bool teller_expect(struct session *session, const struct command_line *line, struct error *error);
bool teller_help(struct session *session, const struct command_line *line, struct error *error);

#endif
