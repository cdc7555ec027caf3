/* ink_font.h - glyphs of one font at any size, in one grey atlas.  Private to ink.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef INK_FONT_H
#define INK_FONT_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

struct ink_font;

/* Where a glyph lies in the atlas, and where its upper left corner lies seen from the pen. */
struct ink_glyph { int32_t x, y, width, height, left, top; };

enum { INK_FONT_ATLAS_WIDTH = 2048 };

struct ink_font *ink_font_create(struct error *error);
void ink_font_destroy(struct ink_font *font);

/* The glyph of a Unicode code point at `size` pixels, with the pen `fraction` (0..1) of a pixel
 * right of a pixel's left edge.  False if it is blank, or if the atlas is full. */
bool ink_font_glyph(struct ink_font *font, uint32_t code, double size, double fraction,
                    struct ink_glyph *glyph);

/* How far the pen moves, in pixels. */
double ink_font_advance(struct ink_font *font, uint32_t code, double size);

/* The atlas, one byte a pixel; *height of its rows are in use.  The number returned grows with
 * every glyph that is added. */
uint32_t ink_font_atlas(const struct ink_font *font, const uint8_t **pixels, uint32_t *height);

/* Takes one code point from UTF-8 text and moves on; 0 at the end, U+FFFD for broken bytes. */
uint32_t ink_font_code(const char **text);

#endif
