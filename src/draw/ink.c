/* ink.c - see ink.h.
 *
 * A shape is a quad just large enough for it and its antialiased rim; the fragment shader knows
 * the signed distance from `local`, the pixel's place seen from the shape (for a line: along and
 * across it), and from `shape`, the shape's own numbers:
 *
 *     kind        local                        shape
 *     BOX         along, across                half length, half width, rounding radius
 *     ARC         along and across its middle  radius, half width, cos and sin of half its angle
 *     ARROW       from its tail, across        length, half width; head: length, half width
 *     TRIANGLE    distances inside each side   -
 *     GLYPH       place in the atlas           gain of the edges
 *
 * Lines, discs, rectangles and plates are all rounded boxes.  Colours are blended as they are
 * (not in linear light), so that an edge has the grey that its coverage says; the framebuffer
 * then holds colours multiplied by alpha.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/ink.h"

#include "base/asset.h"
#include "draw/gl.h"
#include "draw/ink_font.h"
#include "draw/shortage.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

enum kind { KIND_BOX, KIND_ARC, KIND_ARROW, KIND_TRIANGLE, KIND_GLYPH };

/* More shapes than this in one batch are not drawn: they would cover each other anyway. */
enum { SHAPES_MAX = 1 << 20 };

struct vertex {
    float position[2], local[4], shape[4];
    uint8_t color[4];
    float kind;
};

struct ink {
    struct ink_font *font;
    struct vertex *vertices;    /* four a shape: upper left, upper right, lower left, lower right */
    uint32_t count, capacity;   /* shapes */
    uint32_t index_capacity;    /* shapes that the index buffer serves */
    uint32_t atlas_revision;    /* of the glyphs that the texture holds */
    GLuint program, array, vertex_buffer, index_buffer, atlas;
    GLint pixel;
};

/* Half a pixel of rim, and a little more against rounding in the rasteriser. */
static const double rim = 0.75;

/* ---- shapes ---- */

static struct vertex *new_shape(struct ink *ink)
{
    if (ink->count == ink->capacity) {
        const uint32_t capacity = ink->capacity ? ink->capacity * 2 : 1024;
        if (capacity > SHAPES_MAX) return NULL;
        const size_t size = capacity * 4 * sizeof *ink->vertices;
        struct vertex *vertices = shortage_check(realloc(ink->vertices, size));
        if (!vertices) return NULL;
        ink->vertices = vertices;
        ink->capacity = capacity;
    }
    return ink->vertices + 4 * (size_t)ink->count++;
}

/* A quad around (cx, cy) whose first axis is the unit vector (ux, uy), from u0 to u1 along it and
 * v0 to v1 across; `local` is the place in these axes. */
struct frame { double cx, cy, ux, uy, u0, u1, v0, v1; };

static void add(struct ink *ink, enum kind kind, const struct frame *f, struct ink_color color,
                double s0, double s1, double s2, double s3)
{
    struct vertex *vertex = new_shape(ink);
    if (!vertex) return;
    for (int corner = 0; corner < 4; corner++) {
        const double u = corner & 1 ? f->u1 : f->u0, v = corner & 2 ? f->v1 : f->v0;
        vertex[corner] = (struct vertex){
            .position = {(float)(f->cx + u * f->ux - v * f->uy),
                         (float)(f->cy + u * f->uy + v * f->ux)},
            .local = {(float)u, (float)v},
            .shape = {(float)s0, (float)s1, (float)s2, (float)s3},
            .color = {color.r, color.g, color.b, color.a},
            .kind = (float)kind,
        };
    }
}

/* What is thinner than a pixel is drawn a pixel thick with as much less ink. */
static double thin(double width, struct ink_color *color)
{
    if (width >= 1) return width;
    color->a = (uint8_t)(color->a * fmax(width, 0) + 0.5);
    return 1;
}

void ink_line(struct ink *ink, double x0, double y0, double x1, double y1, double width,
              struct ink_color color)
{
    const double dx = x1 - x0, dy = y1 - y0, length = hypot(dx, dy);
    const double half = 0.5 * thin(width, &color), reach = half + rim;
    struct frame f = {.cx = 0.5 * (x0 + x1), .cy = 0.5 * (y0 + y1), .ux = 1,
                      .u0 = -0.5 * length - reach, .u1 = 0.5 * length + reach,
                      .v0 = -reach, .v1 = reach};
    if (length > 0) {
        f.ux = dx / length;
        f.uy = dy / length;
    }
    add(ink, KIND_BOX, &f, color, 0.5 * length, 0, half, 0);
}

void ink_disc(struct ink *ink, double cx, double cy, double radius, struct ink_color color)
{
    if (radius < 0.5) {
        const double share = 2 * radius;
        radius = 0.5 * thin(share * share, &color);
    }
    const double reach = radius + rim;
    const struct frame f = {cx, cy, 1, 0, -reach, reach, -reach, reach};
    add(ink, KIND_BOX, &f, color, 0, 0, radius, 0);
}

void ink_plate(struct ink *ink, double x0, double y0, double x1, double y1, double rounding,
               struct ink_color color)
{
    const double width = thin(fabs(x1 - x0), &color), height = thin(fabs(y1 - y0), &color);
    const double r = fmin(rounding, 0.5 * fmin(width, height));
    const double u = 0.5 * width + rim, v = 0.5 * height + rim;
    const struct frame f = {0.5 * (x0 + x1), 0.5 * (y0 + y1), 1, 0, -u, u, -v, v};
    add(ink, KIND_BOX, &f, color, 0.5 * width - r, 0.5 * height - r, r, 0);
}

void ink_rectangle(struct ink *ink, double x0, double y0, double x1, double y1,
                   struct ink_color color)
{
    ink_plate(ink, x0, y0, x1, y1, 0, color);
}

/* Does the ring of this radius and half width come near the tile around (u, v)? */
static bool ring_meets(double radius, double half, double u, double v, double half_diagonal)
{
    return fabs(hypot(u, v) - radius) <= half + rim + half_diagonal;
}

/* A ring is mostly empty inside, so a large one is drawn as the tiles that it passes through. */
void ink_arc(struct ink *ink, double cx, double cy, double radius, double angle0, double angle1,
             double width, struct ink_color color)
{
    const double half = 0.5 * thin(width, &color), reach = radius + half + rim;
    const double aperture = fmin(0.5 * (angle1 - angle0), M_PI), middle = 0.5 * (angle0 + angle1);
    const int tiles = reach < 24 ? 1 : reach < 200 ? 8 : 32;
    const double side = 2 * reach / tiles;
    for (int row = 0; row < tiles; row++) {
        for (int column = 0; column < tiles; column++) {
            const double u = -reach + side * column, v = -reach + side * row;
            const double middle_u = u + 0.5 * side, middle_v = v + 0.5 * side;
            if (tiles > 1 && !ring_meets(radius, half, middle_u, middle_v, side)) continue;
            /* Angles run counter-clockwise, y downwards. */
            const struct frame f = {cx, cy, cos(middle), -sin(middle), u, u + side, v, v + side};
            add(ink, KIND_ARC, &f, color, radius, half, cos(aperture), sin(aperture));
        }
    }
}

void ink_triangle(struct ink *ink, const double x[3], const double y[3], struct ink_color color)
{
    const double area2 = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (area2 == 0) return;
    const double x0 = fmin(x[0], fmin(x[1], x[2])) - rim, x1 = fmax(x[0], fmax(x[1], x[2])) + rim;
    const double y0 = fmin(y[0], fmin(y[1], y[2])) - rim, y1 = fmax(y[0], fmax(y[1], y[2])) + rim;
    const struct frame f = {0, 0, 1, 0, x0, x1, y0, y1};
    struct vertex *vertex = new_shape(ink);
    if (!vertex) return;
    ink->count--;
    add(ink, KIND_TRIANGLE, &f, color, 0, 0, 0, 0);
    for (int corner = 0; corner < 4; corner++) {
        for (int side = 0; side < 3; side++) {
            const int a = side, b = (side + 1) % 3;
            const double ex = x[b] - x[a], ey = y[b] - y[a];
            const double px = (corner & 1 ? x1 : x0) - x[a], py = (corner & 2 ? y1 : y0) - y[a];
            vertex[corner].local[side] =
                (float)(copysign(1, area2) * (ex * py - ey * px) / hypot(ex, ey));
        }
    }
}

/* The head is as long as three widths, but never longer than the arrow. */
void ink_arrow(struct ink *ink, double x0, double y0, double x1, double y1, double width,
               struct ink_color color)
{
    const double dx = x1 - x0, dy = y1 - y0, length = hypot(dx, dy);
    if (!(length > 0)) return;
    const double half = 0.5 * thin(width, &color);
    const double head = fmin(length, 7 * half + 1), head_half = 0.38 * head + 0.2 * half;
    const double reach = fmax(half, head_half) + rim;
    const struct frame f = {x0, y0, dx / length, dy / length, -rim, length + rim, -reach, reach};
    add(ink, KIND_ARROW, &f, color, length, half, head, head_half);
}

static struct ink_color colormap_at(const uint8_t (*colormap)[3], double position)
{
    const double at = fmin(fmax(position, 0), 1) * 255;
    const int low = (int)at < 254 ? (int)at : 254;
    const double part = at - low;
    uint8_t rgb[3];
    for (int c = 0; c < 3; c++) {
        const double from = colormap[low][c], to = colormap[low + 1][c];
        rgb[c] = (uint8_t)(from + part * (to - from) + 0.5);
    }
    return (struct ink_color){rgb[0], rgb[1], rgb[2], 255};
}

/* One strip of one colour for each line of pixels, along the longer side. */
void ink_gradient(struct ink *ink, double x0, double y0, double x1, double y1,
                  const uint8_t (*colormap)[3])
{
    const bool vertical = y1 - y0 >= x1 - x0;
    const int count = (int)ceil(vertical ? y1 - y0 : x1 - x0);
    for (int k = 0; k < count; k++) {
        if (vertical) {
            const double y = y0 + k, next = fmin(y + 1, y1);
            const double position = (y1 - 0.5 * (y + next)) / (y1 - y0);
            ink_rectangle(ink, x0, y, x1, next, colormap_at(colormap, position));
        } else {
            const double x = x0 + k, next = fmin(x + 1, x1);
            const double position = (0.5 * (x + next) - x0) / (x1 - x0);
            ink_rectangle(ink, x, y0, next, y1, colormap_at(colormap, position));
        }
    }
}

/* ---- text ---- */

double ink_text_width(struct ink *ink, double size, const char *text)
{
    double width = 0;
    for (uint32_t code; (code = ink_font_code(&text)) != 0;) {
        width += ink_font_advance(ink->font, code, size);
    }
    return width;
}

/* Light letters on a dark ground look thinner than dark ones on a light ground, so the grey of
 * their edges is raised by this much of itself times what it lacks of full. */
static double edge_gain(struct ink_color color)
{
    return 0.38 * (0.299 * color.r + 0.587 * color.g + 0.114 * color.b) / 255;
}

static void add_glyph(struct ink *ink, const struct ink_glyph *glyph, double x, double y,
                      struct ink_color color)
{
    struct vertex *vertex = new_shape(ink);
    if (!vertex) return;
    for (int corner = 0; corner < 4; corner++) {
        const float u = (float)(corner & 1 ? glyph->width : 0);
        const float v = (float)(corner & 2 ? glyph->height : 0);
        vertex[corner] = (struct vertex){
            .position = {(float)x + u, (float)y + v},
            .local = {(float)glyph->x + u, (float)glyph->y + v},
            .shape = {(float)edge_gain(color)},
            .color = {color.r, color.g, color.b, color.a},
            .kind = KIND_GLYPH,
        };
    }
}

void ink_text(struct ink *ink, double x, double y, double size, enum ink_align align,
              struct ink_color color, const char *text)
{
    if (align != INK_LEFT) {
        const double width = ink_text_width(ink, size, text);
        x -= align == INK_CENTER ? 0.5 * width : width;
    }
    y = round(y);
    for (uint32_t code; (code = ink_font_code(&text)) != 0;) {
        const double pen = floor(x * 4 + 0.5) / 4, left = floor(pen);
        struct ink_glyph glyph;
        if (ink_font_glyph(ink->font, code, size, pen - left, &glyph)) {
            add_glyph(ink, &glyph, left + glyph.left, y - glyph.top, color);
        }
        x += ink_font_advance(ink->font, code, size);
    }
}

/* ---- drawing ---- */

static void describe_vertices(void)
{
    static const struct { GLint size; GLenum type; size_t offset; } attributes[] = {
        {2, GL_FLOAT, offsetof(struct vertex, position)},
        {4, GL_FLOAT, offsetof(struct vertex, local)},
        {4, GL_FLOAT, offsetof(struct vertex, shape)},
        {4, GL_UNSIGNED_BYTE, offsetof(struct vertex, color)},
        {1, GL_FLOAT, offsetof(struct vertex, kind)},
    };
    for (GLuint k = 0; k < sizeof attributes / sizeof *attributes; k++) {
        gl.EnableVertexAttribArray(k);
        gl.VertexAttribPointer(k, attributes[k].size, attributes[k].type,
                              attributes[k].type == GL_UNSIGNED_BYTE, sizeof(struct vertex),
                              (const void *)attributes[k].offset);
    }
}

struct ink *ink_create(struct error *error)
{
    struct ink *ink = calloc(1, sizeof *ink);
    if (!ink) {
        error_set(error, "not enough memory for the legend");
        return NULL;
    }
    ink->font = ink_font_create(error);
    ink->program = ink->font ? gl_program("shaders/ink.vert", "shaders/ink.frag", error) : 0;
    if (!ink->program) {
        ink_destroy(ink);
        return NULL;
    }
    ink->pixel = gl.GetUniformLocation(ink->program, "pixel");
    gl.GenVertexArrays(1, &ink->array);
    gl.GenBuffers(1, &ink->vertex_buffer);
    gl.GenBuffers(1, &ink->index_buffer);
    gl.GenTextures(1, &ink->atlas);
    gl.BindVertexArray(ink->array);
    gl.BindBuffer(GL_ARRAY_BUFFER, ink->vertex_buffer);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, ink->index_buffer);
    describe_vertices();
    gl.BindVertexArray(0);
    return ink;
}

void ink_destroy(struct ink *ink)
{
    if (!ink) return;
    if (ink->program) {
        gl.DeleteProgram(ink->program);
        gl.DeleteVertexArrays(1, &ink->array);
        gl.DeleteBuffers(1, &ink->vertex_buffer);
        gl.DeleteBuffers(1, &ink->index_buffer);
        gl.DeleteTextures(1, &ink->atlas);
    }
    ink_font_destroy(ink->font);
    free(ink->vertices);
    free(ink);
}

/* Two triangles a shape, the same for ever: uploaded anew only when there are more shapes. */
static bool upload_indices(struct ink *ink)
{
    if (ink->count <= ink->index_capacity) return true;
    uint32_t *indices = shortage_check(malloc(ink->capacity * 6 * sizeof *indices));
    if (!indices) return false;
    for (uint32_t k = 0; k < ink->capacity; k++) {
        const uint32_t corners[6] = {0, 1, 2, 2, 1, 3};
        for (uint32_t c = 0; c < 6; c++) indices[6 * k + c] = 4 * k + corners[c];
    }
    const size_t size = ink->capacity * 6 * sizeof *indices;
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)size, indices, GL_STATIC_DRAW);
    ink->index_capacity = ink->capacity;
    free(indices);
    return true;
}

static void upload_atlas(struct ink *ink)
{
    const uint8_t *pixels;
    uint32_t height;
    const uint32_t revision = ink_font_atlas(ink->font, &pixels, &height);
    if (revision == ink->atlas_revision) return;
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, INK_FONT_ATLAS_WIDTH, (GLsizei)height, 0, GL_RED,
                 GL_UNSIGNED_BYTE, pixels);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    ink->atlas_revision = revision;
}

void ink_flush(struct ink *ink, uint32_t width, uint32_t height)
{
    if (ink->count == 0) return;
    gl.BindVertexArray(ink->array);
    gl.BindBuffer(GL_ARRAY_BUFFER, ink->vertex_buffer);
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(GL_TEXTURE_2D, ink->atlas);
    upload_atlas(ink);
    if (upload_indices(ink)) {
        gl.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(ink->count * 4 * sizeof *ink->vertices),
                     ink->vertices, GL_STREAM_DRAW);
        gl.UseProgram(ink->program);
        gl.Uniform2f(ink->pixel, 2 / (float)width, 2 / (float)height);
        gl.Enable(GL_BLEND);
        gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        gl.DrawElements(GL_TRIANGLES, (GLsizei)(ink->count * 6), GL_UNSIGNED_INT, NULL);
        gl.Disable(GL_BLEND);
    }
    gl.BindVertexArray(0);
    ink->count = 0;
}
