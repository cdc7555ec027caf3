/* difference.h - where two pictures differ, as a picture: what a failing comparison shows.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef DIFFERENCE_H
#define DIFFERENCE_H

#include "draw/image.h"

/* Makes `out` from two pictures of the same size: pixels that differ by more than `tolerance` in
 * any channel are red, the darker the more they differ; all others are pale grey.  False only
 * without memory. */
bool difference_draw(const struct image *a, const struct image *b, int tolerance,
                     struct image *out, struct error *error);

#endif
