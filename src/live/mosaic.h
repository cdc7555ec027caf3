/* mosaic.h - a picture for a terminal: kitty's or sixel's pixels, or coloured characters.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MOSAIC_H
#define MOSAIC_H

#include "draw/image.h"
#include "live/tty.h"

struct mosaic;

/* For a picture of this size on all but the last `spared` rows of the terminal. */
struct mosaic *mosaic_create(const struct tty *tty, unsigned spared, const struct image *image,
                             struct error *error);
void mosaic_destroy(struct mosaic *mosaic);

/* Shows the picture at the upper left. */
void mosaic_show(struct mosaic *mosaic, const struct image *image);

const char *mosaic_kind(const struct mosaic *mosaic);   /* "kitty", "sixel", "characters" */

#endif
