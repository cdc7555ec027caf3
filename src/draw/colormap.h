/* colormap.h - perceptual colour maps, and from a value to a colour.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef COLORMAP_H
#define COLORMAP_H

#include "scene/scene.h"

#include <stdint.h>

enum { COLORMAP_SIZE = 256 };

/* 256 RGB triples of "viridis", "inferno", "cividis", "turbo" (assets/colormaps); NULL if there is
 * no such map. */
const uint8_t (*colormap_find(const char *name))[3];

/* "viridis, inferno, ..." */
const char *colormap_names(void);

/* Where a value lies in the range, 0..1, clamped; NAN gives 0.  The log scale starts at the larger
 * of range[0] and range[1] / 1000; the square root of a range on both sides of zero is taken of the
 * size, both ways, so that opposite spins lie equally far from the middle. */
double colormap_position(enum scale scale, const double range[2], double value);

#endif
