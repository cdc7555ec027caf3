/* canvas.h - an off-screen OpenGL 3.3 core context and its framebuffer, behind a few functions.
 *
 * Two backends with the same GL code: OSMesa (the reference) and EGL surfaceless, chosen by
 * SANDREEL_GL=osmesa|egl at run time; without the variable OSMesa is tried first, then EGL.  Both
 * libraries are opened with dlopen, so a machine without one of them still runs with the other
 * (and one without both still simulates).  Everything is drawn into a framebuffer object of our
 * own, RGBA8, so both backends give the same pixels.
 *
 * The framebuffer holds premultiplied colours with row 0 at the bottom, as GL has it.  Whoever
 * blends straight colours into it uses what canvas_begin() sets: SRC_ALPHA, ONE_MINUS_SRC_ALPHA
 * for the colour and ONE, ONE_MINUS_SRC_ALPHA for alpha, which keeps it premultiplied.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CANVAS_H
#define CANVAS_H

#include "base/error.h"
#include "draw/image.h"

#include <stdbool.h>
#include <stdint.h>

struct canvas;

/* Opens a context current on this thread with a framebuffer of this size.  The error tells which
 * backends were tried and what to install. */
struct canvas *canvas_create(uint32_t width, uint32_t height, struct error *error);
void canvas_destroy(struct canvas *canvas);

/* Makes the context current on this thread, binds the framebuffer, sets viewport and blending. */
void canvas_begin(struct canvas *canvas);

/* Replaces whole rows of the framebuffer, counted from the bottom, by premultiplied pixels. */
void canvas_write(struct canvas *canvas, uint32_t row, uint32_t row_count, const uint8_t *rgba);

/* Finishes and copies the framebuffer out (row 0 on top, straight alpha). */
void canvas_read(struct canvas *canvas, struct image *image);

const char *canvas_backend(const struct canvas *canvas);        /* "osmesa" or "egl" */
const char *canvas_renderer(const struct canvas *canvas);       /* GL_RENDERER and version */

#endif
