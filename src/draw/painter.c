/* painter.c - see painter.h.
 *
 * A picture is made in chunks of rows, from the bottom up: the ground and the field on it, then
 * the sums of the grains (splat.h), their colours over the ground, and so into the canvas.  What
 * ink draws comes last, over the whole picture: forces, arrows and walls clipped to the part that
 * the legend leaves, then the legend.
 *
 * Grains are sorted into bands of rows, so that the sums of a band stay in the cache and a picture
 * of any size needs little memory.  Buffers grow to what the largest frame needed.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/painter.h"

#include "draw/bands.h"
#include "draw/canvas.h"
#include "draw/colormap.h"
#include "draw/fieldlayer.h"
#include "draw/gl.h"
#include "draw/grains_gl.h"
#include "draw/overlay.h"
#include "draw/shortage.h"
#include "draw/splat.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    BAND_BYTES   = 1 << 19,     /* of sums, well within a second-level cache */
    CHUNK_PIXELS = 1 << 20,     /* a 1280 x 720 picture is one chunk */
    GL_GRAINS_MAX = 200,        /* chosen by count: see frame_by_gl() */
};

/* Share of the window's larger side that is left around the box. */
#define WINDOW_MARGIN 0.02

struct painter {
    struct canvas *canvas;
    struct ink    *ink;
    struct grains_gl *grains_gl;        /* made when first needed: its shaders take time */
    uint32_t width, height;
    uint32_t band_rows, chunk_rows;     /* a chunk is a whole number of bands */
    uint8_t *pixels;            /* of a chunk */
    float   *sums;              /* of a band, or of a chunk once OpenGL draws grains */
    size_t   sums_capacity;
    float   *values;            /* of every grain */
    uint32_t value_capacity;
    struct bands bands;         /* the grains in the picture */
};

/* What holds for one frame. */
struct frame {
    const struct picture *picture;
    const uint8_t (*colormap)[3];
    struct transform transform;
    struct splat_area area;     /* the part of the picture that shows the scene */
    double range[2];
    struct fieldlayer layer;    /* layer.field NULL: no field */
    struct splat_style style;
    bool by_gl;
};

const uint8_t *painter_species_color(uint32_t species)
{
    /* Okabe and Ito's, in an order that keeps neighbours apart. */
    static const uint8_t colors[][3] = {
        {0, 114, 178}, {230, 159, 0}, {0, 158, 115}, {213, 94, 0},
        {86, 180, 233}, {204, 121, 167}, {240, 228, 66}, {110, 110, 110},
    };
    return colors[species % (sizeof colors / sizeof *colors)];
}

/* ---- memory ---- */

static bool sums_grow(struct painter *painter, uint32_t rows, struct error *error)
{
    const size_t size = (size_t)painter->width * rows * 4 * sizeof *painter->sums;
    if (size <= painter->sums_capacity) return true;
    free(painter->sums);
    painter->sums_capacity = 0;
    painter->sums = aligned_alloc(64, (size + 63) / 64 * 64);
    if (!painter->sums) return error_set(error, "not enough memory to draw grains");
    painter->sums_capacity = size;
    return true;
}

static bool painter_allocate(struct painter *painter, struct error *error)
{
    const uint32_t width = painter->width, height = painter->height;
    const uint32_t band_rows = BAND_BYTES / (width * 16);
    painter->band_rows = band_rows < 1 ? 1 : band_rows;
    const uint32_t bands_max = (height + painter->band_rows - 1) / painter->band_rows;
    uint32_t chunk_bands = CHUNK_PIXELS / (width * painter->band_rows);
    if (chunk_bands < 1) chunk_bands = 1;
    if (chunk_bands > bands_max) chunk_bands = bands_max;
    painter->chunk_rows = chunk_bands * painter->band_rows;
    const size_t chunk_size = (size_t)width * painter->chunk_rows * 4;
    painter->pixels = malloc(chunk_size);
    if (!painter->pixels) {
        return error_set(error, "not enough memory for pictures of %u x %u pixels", width, height);
    }
    return sums_grow(painter, painter->band_rows, error);
}

struct painter *painter_create(const struct view *view, struct error *error)
{
    if (!(view->size[0] >= 1 && view->size[1] >= 1 && view->size[0] <= IMAGE_SIDE_MAX
          && view->size[1] <= IMAGE_SIDE_MAX)) {
        error_set_code(error, EXIT_USAGE, "view.size: a picture has 1 to %d pixels a side, not "
                       "%g x %g", IMAGE_SIDE_MAX, view->size[0], view->size[1]);
        return NULL;
    }
    struct painter *const painter = calloc(1, sizeof *painter);
    if (!painter) {
        error_set(error, "not enough memory for a picture");
        return NULL;
    }
    painter->width = (uint32_t)view->size[0];
    painter->height = (uint32_t)view->size[1];
    if (painter_allocate(painter, error)) {
        painter->canvas = canvas_create(painter->width, painter->height, error);
        if (painter->canvas) {
            canvas_begin(painter->canvas);
            painter->ink = ink_create(error);
        }
    }
    if (painter->ink) return painter;
    painter_destroy(painter);
    return NULL;
}

void painter_destroy(struct painter *painter)
{
    if (!painter) return;
    if (painter->canvas) {
        canvas_begin(painter->canvas);
        grains_gl_destroy(painter->grains_gl);
        if (painter->ink) ink_destroy(painter->ink);
        canvas_destroy(painter->canvas);
    }
    bands_free(&painter->bands);
    free(painter->sums);
    free(painter->pixels);
    free(painter->values);
    free(painter);
}

/* ---- what the frame shows, and where ---- */

void painter_window(const struct view *view, const struct scene *scene, double window[4])
{
    const double *const box = scene->box;
    const double margin = WINDOW_MARGIN * fmax(box[2] - box[0], box[3] - box[1]);
    const bool open = isnan(view->window[0]);
    for (int k = 0; k < 4; k++) {
        window[k] = open ? box[k] + (k < 2 ? -margin : margin) : view->window[k];
    }
}

/* Fits the window, with square pixels and in the middle, into the part that the legend leaves. */
static void place_window(const struct picture *picture, const double layout[4],
                         struct transform *transform)
{
    double window[4];
    painter_window(picture->view, picture->scene, window);
    const double scale = fmin((layout[2] - layout[0]) / (window[2] - window[0]),
                              (layout[3] - layout[1]) / (window[3] - window[1]));
    *transform = (struct transform){
        .scale = scale,
        .x0 = 0.5 * (window[0] + window[2]) - 0.5 * (layout[0] + layout[2]) / scale,
        .y1 = 0.5 * (window[1] + window[3]) + 0.5 * (layout[1] + layout[3]) / scale,
    };
}

void painter_place(const struct picture *picture, struct transform *transform)
{
    double layout[4];
    overlay_layout(picture, layout);
    place_window(picture, layout, transform);
}

static void frame_place(struct frame *frame, const struct painter *painter)
{
    double layout[4];
    overlay_layout(frame->picture, layout);
    place_window(frame->picture, layout, &frame->transform);
    const double width = painter->width, height = painter->height;
    frame->area = (struct splat_area){
        .x0 = (uint32_t)fmax(0, floor(layout[0])),
        .x1 = (uint32_t)fmin(width, fmax(0, ceil(layout[2]))),
        .y0 = (uint32_t)fmax(0, floor(height - layout[3])),
        .y1 = (uint32_t)fmin(height, fmax(0, ceil(height - layout[1]))),
    };
}

static bool range_given(const double range[2])
{
    return isfinite(range[0]) && isfinite(range[1]);
}

static void range_choose(double chosen[2], const double first[2], const double second[2])
{
    const double *const given = !second || range_given(first) ? first : second;
    chosen[0] = given[0];
    chosen[1] = given[1];
}

static void frame_field(struct frame *frame)
{
    const struct picture *const picture = frame->picture;
    if (!picture->field) return;
    frame->layer = (struct fieldlayer){
        .field = picture->field, .colormap = frame->colormap, .scale = SCALE_LINEAR,
        /* Cells of a box kernel are counts in squares, and shown so; the others are samples of a
         * smooth function. */
        .smooth = picture->scene->measure.kernel != KERNEL_BOX,
    };
    double found[2] = {0, 1};
    if (!range_given(picture->field_range)) fieldlayer_range(picture->field, found);
    range_choose(frame->layer.range, picture->field_range, found);
}

/* Few grains are OpenGL's, the reference.  On the machines without a graphics card that pictures
 * are made on, its cost (9 ms a frame of 1280 x 720 and 1.2 us a grain, against 0.1 us on
 * the processor's path) would show with more. */
static bool frame_by_gl(const struct picture *picture)
{
    switch (picture->path) {
    case PAINTER_GL: return true;
    case PAINTER_SPLATTER: return false;
    case PAINTER_AUTO: break;
    }
    return picture->grains && picture->grains->count <= GL_GRAINS_MAX;
}

/* Rims and shading fade in with the size of the grains, since they need some pixels to be seen:
 * the same for all, or the larger of a mixture would look like another kind; and from the scene's
 * mean radius where there is one, so that a film does not flicker. */
static struct splat_style frame_style(const struct frame *frame)
{
    const struct picture *const picture = frame->picture;
    const struct grains *const grains = picture->grains;
    double radius = picture->scene->radius_mean;
    if (!(radius > 0) && grains) {
        for (uint32_t i = 0; i < grains->count; i++) radius += grains->radius[i] / grains->count;
    }
    const double pixels = radius * frame->transform.scale;
    return (struct splat_style){
        .rim = picture->view->rims ? (float)fmin(1, fmax(0, (pixels - 2.5) * 0.4)) : 0,
        .shade = picture->view->shade ? (float)fmin(1, fmax(0, (pixels - 1.2) * 0.5)) : 0,
    };
}

static bool frame_prepare(struct frame *frame, const struct painter *painter,
                          const struct picture *picture, struct error *error)
{
    const struct view *const view = picture->view;
    frame->picture = picture;
    frame->colormap = colormap_find(view->colormap[0] ? view->colormap : "viridis");
    if (!frame->colormap) {
        return error_set_code(error, EXIT_SCENE, "view.colormap: unknown map '%s'; there are %s",
                              view->colormap, colormap_names());
    }
    frame->by_gl = frame_by_gl(picture);
    frame_place(frame, painter);
    frame->style = frame_style(frame);
    frame_field(frame);
    return true;
}

/* ---- grains ---- */

/* The colour of each value's place in the range, or of each species. */
static void splat_color(const struct frame *frame, double value, uint8_t rgb[3])
{
    static const uint8_t sand[3] = {201, 164, 104};
    const struct view *const view = frame->picture->view;
    const uint8_t *color = sand;
    if (view->color == COLOR_SPECIES) {
        color = painter_species_color((uint32_t)value);
    } else if (view->color != COLOR_NONE) {
        const double place = colormap_position((enum scale)view->scale, frame->range, value);
        color = frame->colormap[(int)(place * (COLORMAP_SIZE - 1) + 0.5)];
    }
    memcpy(rgb, color, 3);
}

static bool values_grow(struct painter *painter, uint32_t count, struct error *error)
{
    if (count <= painter->value_capacity) return true;
    free(painter->values);
    painter->value_capacity = 0;
    painter->values = malloc((size_t)count * sizeof *painter->values);
    if (!painter->values) return error_set(error, "not enough memory to draw %u grains", count);
    painter->value_capacity = count;
    return true;
}

/* Grains in the picture, in pixels, with their colours. */
static bool frame_grains(struct frame *frame, struct painter *painter, struct error *error)
{
    const struct picture *const picture = frame->picture;
    const struct grains *const grains = picture->grains;
    struct bands *const bands = &painter->bands;
    bands->count = 0;
    range_choose(frame->range, picture->range, picture->view->range);
    if (!grains || !picture->view->grains || grains->count == 0) {
        if (!range_given(frame->range)) range_choose(frame->range, (const double[2]){0, 1}, NULL);
        return true;
    }
    if (!values_grow(painter, grains->count, error)) return false;
    if (!bands_reserve(bands, grains->count, error)) return false;
    painter_value_all(picture->view, grains, painter->values);
    if (!range_given(frame->range)) {
        painter_value_range(picture->view, grains, painter->values, frame->range);
    }
    const struct transform t = frame->transform;
    for (uint32_t i = 0; i < grains->count; i++) {
        struct splat *const splat = &bands->splats[bands->count];
        splat->x = (float)transform_x(&t, grains->x[i]);
        splat->y = (float)(painter->height - transform_y(&t, grains->y[i]));
        splat->radius = (float)(grains->radius[i] * t.scale);
        if (!splat_touches(splat, &frame->area)) continue;
        splat_color(frame, (double)painter->values[i], splat->rgb);
        bands->count++;
    }
    return true;
}

/* Sorts them, and makes what the chosen path needs. */
static bool frame_sort(const struct frame *frame, struct painter *painter, struct error *error)
{
    const uint32_t rows = frame->by_gl ? painter->chunk_rows : painter->band_rows;
    if (!sums_grow(painter, rows, error)) return false;
    if (frame->by_gl && !painter->grains_gl) {
        painter->grains_gl = grains_gl_create(painter->width, painter->chunk_rows, error);
        if (!painter->grains_gl) return false;
    }
    return bands_sort(&painter->bands, rows, painter->height, error);
}

/* ---- rows ---- */

static struct splat_area area_rows(const struct splat_area *area, uint32_t first, uint32_t last)
{
    struct splat_area part = *area;
    if (part.y0 < first) part.y0 = first;
    if (part.y1 > last) part.y1 = last;
    return part;
}

/* The ground, and the field on it. */
static void chunk_ground(const struct frame *frame, struct painter *painter, uint32_t first,
                         uint32_t last)
{
    const struct ink_color color = overlay_ground((enum theme)frame->picture->view->theme);
    const uint8_t pixel[4] = {(uint8_t)(color.r * color.a / 255),
                              (uint8_t)(color.g * color.a / 255),
                              (uint8_t)(color.b * color.a / 255), color.a};
    const size_t row = 4 * (size_t)painter->width;
    for (size_t at = 0; at < row; at += 4) memcpy(painter->pixels + at, pixel, 4);
    for (uint32_t y = 1; y < last - first; y++) {
        memcpy(painter->pixels + y * row, painter->pixels, row);
    }
    const struct splat_area area = area_rows(&frame->area, first, last);
    if (!frame->layer.field || area.y0 >= area.y1) return;
    fieldlayer_draw(&frame->layer, &frame->transform, painter->width, painter->height, &area,
                    painter->pixels + (size_t)(area.y0 - first) * painter->width * 4);
}

/* The grains of one band, over the pixels of its chunk. */
static void band_grains(const struct frame *frame, struct painter *painter, uint32_t band,
                        uint32_t chunk_first, uint32_t chunk_last)
{
    const uint32_t rows = painter->bands.rows, first = band * rows;
    const uint32_t last = first + rows < chunk_last ? first + rows : chunk_last;
    const struct splat_area area = area_rows(&frame->area, first, last);
    uint32_t count;
    const uint32_t *const index = bands_index(&painter->bands, band, &count);
    if (count == 0 || area.y0 >= area.y1) return;
    const size_t pixels = (size_t)painter->width * (area.y1 - area.y0);
    if (frame->by_gl) {
        grains_gl_add(painter->grains_gl, painter->sums, &area, bands_pick(&painter->bands, band),
                      count, frame->style);
    } else {
        memset(painter->sums, 0, pixels * 4 * sizeof *painter->sums);
        splat_add(painter->sums, painter->width, &area, painter->bands.splats, index, count,
                  frame->style);
    }
    splat_resolve(painter->sums, painter->pixels
                  + (size_t)(area.y0 - chunk_first) * painter->width * 4, pixels);
}

static void frame_rows(const struct frame *frame, struct painter *painter)
{
    for (uint32_t first = 0; first < painter->height; first += painter->chunk_rows) {
        const uint32_t end = first + painter->chunk_rows;
        const uint32_t last = end < painter->height ? end : painter->height;
        chunk_ground(frame, painter, first, last);
        const uint32_t rows = painter->bands.rows;
        for (uint32_t band = first / rows; band * rows < last; band++) {
            band_grains(frame, painter, band, first, last);
        }
        canvas_write(painter->canvas, first, last - first, painter->pixels);
    }
}

/* ---- what lies over the grains ---- */

/* Walls come after the grains and after arrows and forces, so that nothing covers them. */
static void frame_overlays(const struct frame *frame, struct painter *painter)
{
    const struct picture *const picture = frame->picture;
    const struct view *const view = picture->view;
    struct ink *const ink = painter->ink;
    const struct splat_area area = frame->area;
    canvas_begin(painter->canvas);
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor((GLint)area.x0, (GLint)area.y0, (GLsizei)(area.x1 - area.x0),
               (GLsizei)(area.y1 - area.y0));
    if (picture->grains) {
        if (view->spokes && view->grains) overlay_spokes(ink, picture, &frame->transform);
        if (view->forces) overlay_forces(ink, picture, &frame->transform);
        if (view->arrows) overlay_arrows(ink, picture, &frame->transform);
    }
    if (view->walls) overlay_walls(ink, picture, &frame->transform);
    ink_flush(ink, painter->width, painter->height);
    gl.Disable(GL_SCISSOR_TEST);
    overlay_legend(ink, picture, &frame->transform, frame->range, frame->layer.range);
    ink_flush(ink, painter->width, painter->height);
}

bool painter_frame(struct painter *painter, const struct picture *picture, struct image *image,
                   struct error *error)
{
    assert(image->width == painter->width);
    assert(image->height == painter->height);
    struct frame frame = {0};
    shortage_ended();
    canvas_begin(painter->canvas);
    if (!frame_prepare(&frame, painter, picture, error)) return false;
    if (!frame_grains(&frame, painter, error)) return false;
    if (!frame_sort(&frame, painter, error)) return false;
    frame_rows(&frame, painter);
    frame_overlays(&frame, painter);
    canvas_read(painter->canvas, image);
    const GLenum trouble = gl.GetError();
    if (shortage_ended()) {
        return error_set(error, "not enough memory to draw all of a picture of %u x %u pixels",
                         painter->width, painter->height);
    }
    return trouble == GL_NO_ERROR
        || error_set(error, "a picture of %u x %u pixels was not drawn: OpenGL reports %s (%#x)",
                     painter->width, painter->height, trouble == GL_OUT_OF_MEMORY
                     ? "that memory ran out" : "an error", trouble);
}
