/* ink.h - lines, shapes and text over a picture, antialiased analytically, in one GL batch.
 *
 * Everything is given in pixels from the upper left corner, y downwards, and drawn in the order
 * given when ink_flush() is called: shapes and glyphs are quads of one vertex buffer and one
 * shader, so a legend with all its text is one draw call.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef INK_H
#define INK_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

struct ink;

struct ink_color { uint8_t r, g, b, a; };

enum ink_align { INK_LEFT, INK_CENTER, INK_RIGHT };

/* Needs a current context (canvas_begin).  The font is DejaVu Sans, found by its usual places or
 * SANDREEL_FONT; the error says what to install. */
struct ink *ink_create(struct error *error);
void ink_destroy(struct ink *ink);

/* A line with round caps; width in pixels, down to hair lines (a width below one dims it). */
void ink_line(struct ink *ink, double x0, double y0, double x1, double y1, double width,
              struct ink_color color);
void ink_arc(struct ink *ink, double cx, double cy, double radius, double angle0, double angle1,
             double width, struct ink_color color);     /* angles in radians, counter-clockwise */
void ink_disc(struct ink *ink, double cx, double cy, double radius, struct ink_color color);
void ink_rectangle(struct ink *ink, double x0, double y0, double x1, double y1,
                   struct ink_color color);
/* The same with rounded corners. */
void ink_plate(struct ink *ink, double x0, double y0, double x1, double y1, double rounding,
               struct ink_color color);
void ink_triangle(struct ink *ink, const double x[3], const double y[3], struct ink_color color);
void ink_arrow(struct ink *ink, double x0, double y0, double x1, double y1, double width,
               struct ink_color color);
/* A vertical or horizontal strip of a colour map, position 0 at (x0, y1). */
void ink_gradient(struct ink *ink, double x0, double y0, double x1, double y1,
                  const uint8_t (*colormap)[3]);

/* UTF-8 text of this height in pixels (font size); (x, y) is on the base line. */
void ink_text(struct ink *ink, double x, double y, double size, enum ink_align align,
              struct ink_color color, const char *text);
double ink_text_width(struct ink *ink, double size, const char *text);

/* Draws all that was given into the current framebuffer of this size, and forgets it. */
void ink_flush(struct ink *ink, uint32_t width, uint32_t height);

#endif
