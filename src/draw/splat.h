/* splat.h - grains as pixels: what each grain adds to the sums of a picture, and from the sums to
 * colours.
 *
 * A grain adds coverage * colour and coverage to every pixel that it touches; the picture is the
 * ground where the coverage is 0, the mean colour of the grains where it reaches 1, and a mixture
 * between.  So the order of the grains does not matter, grains that touch leave no seam of ground
 * between them, and a million grains far below one pixel give a density picture of the right mean
 * colour.  Coverage adds up to the area of the grain: analytic edges clamp(r + 1/2 - d) for grains
 * that are seen as discs, and the exact coverage of a square of the same area for smaller ones.
 *
 * This file is the processor's path; grains_gl.h computes the same sums by OpenGL.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SPLAT_H
#define SPLAT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A grain in pixels from the lower left corner of the picture. */
struct splat {
    float   x, y, radius;
    uint8_t rgb[3], unused;
};

/* How strongly grains are rimmed and lit, 0 .. 1. */
struct splat_style { float rim, shade; };

/* A rectangle of pixels: x0 <= x < x1, y0 <= y < y1. */
struct splat_area { uint32_t x0, y0, x1, y1; };

/* How far a grain of this radius reaches from its centre. */
float splat_reach(float radius);

/* Does the grain touch the area? */
bool splat_touches(const struct splat *splat, const struct splat_area *area);

/* Adds grains to the sums of an area: red, green, blue (0..1, times coverage) and coverage for
 * each pixel, rows of `width` pixels from area->y0 on; `index` picks the grains.  Pixels outside
 * the area are left alone. */
void splat_add(float *sums, uint32_t width, const struct splat_area *area,
               const struct splat *splats, const uint32_t *index, uint32_t count,
               struct splat_style style);

/* Puts the colours that `count` pixels have by their sums over what `rgba` holds (premultiplied
 * before and after). */
void splat_resolve(const float *sums, uint8_t *rgba, size_t count);

#endif
