/* sight.h - what is seen of a session: the view and its changes, pictures and films that are
 * saved.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SIGHT_H
#define SIGHT_H

#include "live/command.h"
#include "live/session.h"

bool sight_color(struct session *session, const struct command_line *line, struct error *error);
bool sight_map(struct session *session, const struct command_line *line, struct error *error);
bool sight_zoom(struct session *session, const struct command_line *line, struct error *error);
bool sight_pan(struct session *session, const struct command_line *line, struct error *error);
bool sight_fit(struct session *session, const struct command_line *line, struct error *error);
bool sight_follow(struct session *session, const struct command_line *line, struct error *error);
bool sight_frame(struct session *session, const struct command_line *line, struct error *error);
bool sight_movie(struct session *session, const struct command_line *line, struct error *error);

/* "view.KEY=VALUE". */
bool sight_change(struct session *session, const char *text, struct error *error);

/* The view of these grains: the one in force, around the grain that is followed. */
struct view sight_view(const struct session *session, const struct grains *grains);

/* The scene that `film_open` wants: with the changes of the look. */
const struct scene *sight_scene(const struct session *session);

/* When the film that is being made wants its next frame; INFINITY: no film. */
double sight_movie_due(const struct session *session);
bool sight_movie_frame(struct session *session, struct error *error);

/* The session has gone back: the film goes on from here. */
void sight_movie_again(struct session *session);

void sight_close(struct session *session);

#endif
