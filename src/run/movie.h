/* movie.h - frames piped raw into ffmpeg; a movie file appears whole or not at all.
 *
 * The ending of the name decides: .mp4 (H.264), .webm (VP9) or .gif.  No shell is involved, and
 * ffmpeg runs in a process group of its own, so Ctrl-C reaches sandreel alone, which then decides.
 * The caller must ignore SIGPIPE.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MOVIE_H
#define MOVIE_H

#include "base/error.h"
#include "draw/image.h"

#include <stdint.h>

struct movie;

/* Is there an ffmpeg on the PATH?  The error says how to install it. */
bool movie_available(struct error *error);

/* Is it a name that ends in a format we can write? */
bool movie_name_ok(const char *path, struct error *error);

struct movie *movie_begin(const char *path, uint32_t width, uint32_t height, double frame_rate,
                          struct error *error);

/* `image` has the movie's size; transparent pixels are laid on white. */
bool movie_frame(struct movie *movie, const struct image *image, struct error *error);

/* Ends the stream, waits for ffmpeg and gives the file its name.  Frees in any case. */
bool movie_commit(struct movie *movie, struct error *error);

/* Stops ffmpeg and removes the unfinished file.  Frees. */
void movie_abandon(struct movie *movie);

#endif
