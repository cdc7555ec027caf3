/* grains_gl.h - grains drawn by OpenGL: the same sums as splat_add(), by a shader.
 *
 * This is the reference picture.  One instanced quad a grain (a point sprite would be half as dear
 * but vanishes whole when its centre leaves the picture), added up in a framebuffer of floats.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef GRAINS_GL_H
#define GRAINS_GL_H

#include "base/error.h"
#include "draw/splat.h"

struct grains_gl;

/* Needs a current context, and rows of `width` pixels, at most `rows` of them at a time. */
struct grains_gl *grains_gl_create(uint32_t width, uint32_t rows, struct error *error);
void grains_gl_destroy(struct grains_gl *grains);

/* As splat_add(), but sets the sums of all pixels of the rows instead of adding to them.  Leaves
 * another framebuffer bound: canvas_begin() comes next. */
void grains_gl_add(struct grains_gl *grains, float *sums, const struct splat_area *area,
                   const struct splat *splats, uint32_t count, struct splat_style style);

#endif
