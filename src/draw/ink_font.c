/* ink_font.c - see ink_font.h.
 *
 * Crisp text wants two things that exclude each other in one direction but not in the other:
 * vertically, outlines are hinted to the pixel grid ("light" hinting), so stems of equal height
 * look equal; horizontally, they are not, and a glyph is rendered at the quarter of a pixel
 * where the pen stands, so that letters keep their spacing.  Glyphs are kept for the life of the
 * font; they fill the atlas row by row.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/ink_font.h"
#include "draw/shortage.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ft2build.h>
#include FT_ADVANCES_H
#include FT_FREETYPE_H
#include FT_OUTLINE_H

enum {
    ATLAS_HEIGHT_MAX = 8192,
    GLYPHS_MAX = 4096,          /* a power of two; the table is kept at most half full */
    PHASES = 4
};

/* Above this size in pixels a quarter of a pixel cannot be seen. */
static const double phases_size_max = 40;

struct entry {
    uint64_t key;               /* code point, size, phase; 0: free */
    struct ink_glyph glyph;
};

struct ink_font {
    FT_Library library;
    FT_Face face;
    double size;                /* the one set in `face` */
    struct entry table[GLYPHS_MAX];
    uint32_t count, revision;
    uint8_t *pixels;
    uint32_t height;            /* rows allocated */
    uint32_t pen_x, pen_y, row_height;  /* where the next glyph goes */
};

static const char *const places[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/local/share/fonts/dejavu/DejaVuSans.ttf",
};

static bool find_font(const char **path, struct error *error)
{
    const char *chosen = getenv("SANDREEL_FONT");
    if (chosen && *chosen) {
        struct stat status;     /* FreeType would wait for a pipe */
        *path = chosen;
        if (access(chosen, R_OK) == 0 && stat(chosen, &status) == 0 && S_ISREG(status.st_mode)) {
            return true;
        }
        return error_set(error, "SANDREEL_FONT names %s, which cannot be read; name a TrueType "
                         "font file or unset it", chosen);
    }
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        *path = places[k];
        if (access(*path, R_OK) == 0) return true;
    }
    return error_set(error, "the font DejaVu Sans was not found, so legends cannot be written; "
                     "install it (Debian: apt install fonts-dejavu-core) or let SANDREEL_FONT "
                     "name a TrueType font file");
}

struct ink_font *ink_font_create(struct error *error)
{
    const char *path;
    if (!find_font(&path, error)) return NULL;
    struct ink_font *font = calloc(1, sizeof *font);
    if (!font) {
        error_set(error, "not enough memory for the glyphs of a font");
        return NULL;
    }
    if (FT_Init_FreeType(&font->library) != 0
        || FT_New_Face(font->library, path, 0, &font->face) != 0) {
        error_set(error, "%s: FreeType cannot read this font; let SANDREEL_FONT name another",
                  path);
        ink_font_destroy(font);
        return NULL;
    }
    return font;
}

void ink_font_destroy(struct ink_font *font)
{
    if (!font) return;
    if (font->face) FT_Done_Face(font->face);
    if (font->library) FT_Done_FreeType(font->library);
    free(font->pixels);
    free(font);
}

static bool set_size(struct ink_font *font, double size)
{
    if (size == font->size) return true;
    font->size = 0;
    if (FT_Set_Char_Size(font->face, 0, lround(size * 64), 72, 72) != 0) return false;
    font->size = size;
    return true;
}

static bool load(struct ink_font *font, uint32_t code, double size)
{
    return set_size(font, size)
        && FT_Load_Char(font->face, code, FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP) == 0;
}

double ink_font_advance(struct ink_font *font, uint32_t code, double size)
{
    FT_Fixed advance;
    const FT_UInt index = FT_Get_Char_Index(font->face, code);
    if (FT_Get_Advance(font->face, index, FT_LOAD_NO_SCALE, &advance) != 0) return 0;
    return size * (double)advance / font->face->units_per_EM;
}

/* Room for width x height pixels with an empty border; false if the atlas is full. */
static bool atlas_room(struct ink_font *font, uint32_t width, uint32_t height, struct ink_glyph *at)
{
    if (font->pen_x + width + 1 > INK_FONT_ATLAS_WIDTH) {
        font->pen_y += font->row_height;
        font->pen_x = font->row_height = 0;
    }
    const uint32_t needed = font->pen_y + height + 1;
    if (width + 1 > INK_FONT_ATLAS_WIDTH || needed > ATLAS_HEIGHT_MAX) return false;
    if (needed > font->height) {
        uint32_t rows = font->height ? font->height : 64;
        while (rows < needed) rows *= 2;
        const size_t size = (size_t)rows * INK_FONT_ATLAS_WIDTH;
        uint8_t *pixels = shortage_check(realloc(font->pixels, size));
        if (!pixels) return false;
        memset(pixels + (size_t)font->height * INK_FONT_ATLAS_WIDTH, 0,
               (size_t)(rows - font->height) * INK_FONT_ATLAS_WIDTH);
        font->pixels = pixels;
        font->height = rows;
    }
    at->x = (int32_t)font->pen_x;
    at->y = (int32_t)font->pen_y;
    font->pen_x += width + 1;
    if (height + 1 > font->row_height) font->row_height = height + 1;
    return true;
}

static void render(struct ink_font *font, uint32_t code, double size, uint32_t phase,
                   struct ink_glyph *glyph)
{
    *glyph = (struct ink_glyph){0};
    if (!load(font, code, size)) return;
    FT_GlyphSlot slot = font->face->glyph;
    FT_Outline_Translate(&slot->outline, (FT_Pos)phase * 64 / PHASES, 0);
    if (FT_Render_Glyph(slot, FT_RENDER_MODE_NORMAL) != 0) return;
    const FT_Bitmap *bitmap = &slot->bitmap;
    if (bitmap->width == 0 || bitmap->rows == 0) return;
    if (!atlas_room(font, bitmap->width, bitmap->rows, glyph)) return;
    for (uint32_t row = 0; row < bitmap->rows; row++) {
        memcpy(font->pixels + ((size_t)glyph->y + row) * INK_FONT_ATLAS_WIDTH + (size_t)glyph->x,
               bitmap->buffer + (ptrdiff_t)row * bitmap->pitch, bitmap->width);
    }
    glyph->width = (int32_t)bitmap->width;
    glyph->height = (int32_t)bitmap->rows;
    glyph->left = slot->bitmap_left;
    glyph->top = slot->bitmap_top;
    font->revision++;
}

bool ink_font_glyph(struct ink_font *font, uint32_t code, double size, double fraction,
                    struct ink_glyph *glyph)
{
    uint32_t phase = 0;
    if (size <= phases_size_max) {
        phase = (uint32_t)(fraction * PHASES);
        if (phase >= PHASES) phase = PHASES - 1;
    }
    const uint64_t key = (uint64_t)code << 32 | (uint64_t)lround(size * 64) << 2 | phase;
    uint32_t slot = (uint32_t)(key * 0x9e3779b97f4a7c15u >> 40) & (GLYPHS_MAX - 1);
    while (font->table[slot].key && font->table[slot].key != key) {
        slot = (slot + 1) & (GLYPHS_MAX - 1);
    }
    struct entry *entry = &font->table[slot];
    if (!entry->key) {
        if (font->count >= GLYPHS_MAX / 2) return false;
        font->count++;
        entry->key = key;
        render(font, code, size, phase, &entry->glyph);
    }
    *glyph = entry->glyph;
    return glyph->width > 0;
}

uint32_t ink_font_atlas(const struct ink_font *font, const uint8_t **pixels, uint32_t *height)
{
    *pixels = font->pixels;
    *height = font->height;
    return font->revision;
}

uint32_t ink_font_code(const char **text)
{
    const unsigned char *at = (const unsigned char *)*text;
    if (*at == 0) return 0;
    const int following = *at < 0x80 ? 0 : *at >= 0xf0 ? 3 : *at >= 0xe0 ? 2 : *at >= 0xc0 ? 1 : -1;
    uint32_t code = following <= 0 ? *at : *at & (0x3fu >> following);
    *text += 1;
    if (following < 0) return 0xfffd;
    for (int k = 1; k <= following; k++, *text += 1) {
        if ((at[k] & 0xc0) != 0x80) return 0xfffd;
        code = code << 6 | (at[k] & 0x3f);
    }
    return code;
}
