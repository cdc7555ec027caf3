/* overlay_arrows.c - velocities as arrows from the centres of the grains.
 *
 * A speed at the 99th percentile is about 1.5 mean diameters long; the percentile is rounded to 1,
 * 2 or 5 times a power of ten, so that arrows in a film stay comparable.  Among thousands of
 * grains no arrow could be told from the next, so there they are averaged over the cells of a
 * grid, one arrow a cell.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/overlay_arrows.h"

#include "draw/overlay.h"
#include "draw/overlay_layout.h"
#include "draw/percentile.h"
#include "draw/shortage.h"
#include "draw/ticks.h"

#include <math.h>
#include <stdlib.h>

static const uint32_t single_max = 2500;        /* visible grains that get an arrow each */
static const double single_diameter = 7;        /* units; smaller grains are averaged too */
static const double cell_size = 24;             /* units */
static const double length_min = 1.5;           /* pixels */
static const double length_max = 4;             /* times the arrow in the legend: a few outliers
                                                 * must not cross the picture */

struct arrow { float x, y, vx, vy; };           /* pixels; velocity y upwards */

struct arrows {
    struct arrow *list;
    uint32_t count;
    double spacing;             /* of arrows, pixels */
};

static uint32_t gather_visible(const struct picture *picture, const struct transform *t,
                               struct arrow *list)
{
    const struct grains *grains = picture->grains;
    const double width = picture->view->size[0], height = picture->view->size[1];
    uint32_t count = 0;
    for (uint32_t i = 0; i < grains->count; i++) {
        const double x = transform_x(t, grains->x[i]), y = transform_y(t, grains->y[i]);
        if (!(x >= 0 && y >= 0 && x < width && y < height)) continue;
        list[count++] = (struct arrow){(float)x, (float)y, (float)grains->vx[i],
                                       (float)grains->vy[i]};
    }
    return count;
}

/* Replaces the arrows by their means over square cells that are fixed in the scene, so that the
 * grid does not swim when the picture is zoomed or the view moves. */
static bool average_cells(struct arrows *arrows, const struct picture *picture,
                          const struct transform *t, double size)
{
    const double shift_x = fmod(-t->x0 * t->scale, size) + size;
    const double shift_y = fmod(t->y1 * t->scale, size) + size;
    const uint32_t nx = (uint32_t)(picture->view->size[0] / size) + 4;
    const uint32_t ny = (uint32_t)(picture->view->size[1] / size) + 4;
    struct sum { double x, y, vx, vy; uint32_t count; } *sums;
    sums = shortage_check(calloc((size_t)nx * ny, sizeof *sums));
    if (!sums) return false;
    for (uint32_t k = 0; k < arrows->count; k++) {
        const struct arrow *a = &arrows->list[k];
        const uint32_t column = (uint32_t)(((double)a->x - shift_x) / size + 2);
        const uint32_t row = (uint32_t)(((double)a->y - shift_y) / size + 2);
        struct sum *sum = &sums[row * nx + column];
        sum->x += (double)a->x;
        sum->y += (double)a->y;
        sum->vx += (double)a->vx;
        sum->vy += (double)a->vy;
        sum->count++;
    }
    arrows->count = 0;
    for (uint32_t k = 0; k < nx * ny; k++) {
        if (sums[k].count == 0) continue;
        const double share = 1.0 / sums[k].count;
        arrows->list[arrows->count++] = (struct arrow){
            (float)(sums[k].x * share), (float)(sums[k].y * share),
            (float)(sums[k].vx * share), (float)(sums[k].vy * share)};
    }
    arrows->spacing = size;
    free(sums);
    return true;
}

static bool gather(const struct picture *picture, const struct transform *t, struct arrows *arrows)
{
    const struct grains *grains = picture->grains;
    *arrows = (struct arrows){0};
    if (!grains || grains->count == 0 || !grains->vx || !grains->vy) return false;
    struct layout layout;
    overlay_layout_make(picture, &layout);
    arrows->list = shortage_check(malloc(grains->count * sizeof *arrows->list));
    if (!arrows->list) return false;
    arrows->count = gather_visible(picture, t, arrows->list);
    arrows->spacing = 2 * picture->scene->radius_mean * t->scale;
    if (arrows->count > single_max || arrows->spacing < single_diameter * layout.unit) {
        const double size = fmax(cell_size * layout.unit, arrows->spacing);
        average_cells(arrows, picture, t, size);
    }
    return true;
}

/* The speed that the arrows are scaled to: of the whole run where its range is known. */
static double speed_high(const struct picture *picture, const struct arrows *arrows)
{
    if (picture->view->color == COLOR_SPEED && picture->range[1] > 0) return picture->range[1];
    float *speeds = shortage_check(malloc((arrows->count + 1) * sizeof *speeds));
    if (!speeds) return 0;
    uint32_t count = 0;
    for (uint32_t k = 0; k < arrows->count; k++) {
        const float speed = hypotf(arrows->list[k].vx, arrows->list[k].vy);
        if (isfinite(speed)) speeds[count++] = speed;
    }
    const double high = count ? percentile(speeds, count, 0.99) : 0;
    free(speeds);
    return high;
}

static bool measure(const struct picture *picture, const struct transform *t,
                    const struct arrows *arrows, double *speed, double *length, double *width)
{
    const double high = speed_high(picture, arrows);
    if (!(high > 0)) return false;
    struct layout layout;
    overlay_layout_make(picture, &layout);
    const double chosen = picture->view->arrow_scale;
    *speed = ticks_round_down(high * 1.5);
    *length = chosen > 0 ? chosen * *speed * t->scale : 1.5 * arrows->spacing;
    *width = fmin(fmax(0.09 * arrows->spacing, 1.2 * layout.unit), 3 * layout.unit);
    return true;
}

bool overlay_arrows_key(const struct picture *picture, const struct transform *t, double *speed,
                        double *length, double *width)
{
    struct arrows arrows;
    const bool found = gather(picture, t, &arrows)
        && measure(picture, t, &arrows, speed, length, width);
    free(arrows.list);
    return found;
}

/* The arrow in the legend; width of all arrows. */
struct sample { double speed, pixels, width; };

/* All arrows in one colour, or the lines beneath them; those too short to point anywhere are left
 * out, and those that are mostly head need no line. */
static void draw_all(struct ink *ink, const struct arrows *arrows, const struct sample *key,
                     bool halo, struct ink_color color)
{
    const double width = key->width;
    for (uint32_t k = 0; k < arrows->count; k++) {
        const struct arrow *a = &arrows->list[k];
        const double vx = (double)a->vx, vy = (double)a->vy;
        const double scale = key->pixels * fmin(1 / key->speed, length_max / hypot(vx, vy));
        const double x = (double)a->x, dx = vx * scale, y = (double)a->y, dy = -vy * scale;
        if (!(hypot(dx, dy) > (halo ? 6 * width : length_min))) continue;
        if (halo) ink_line(ink, x, y, x + dx, y + dy, 2.2 * width, color);
        else ink_arrow(ink, x, y, x + dx, y + dy, width, color);
    }
}

/* Under every arrow lies a paler line, so that a dark one shows on dark grains too. */
void overlay_arrows(struct ink *ink, const struct picture *picture, const struct transform *t)
{
    const bool dark = picture->view->theme == THEME_DARK;
    const uint8_t arrow_grey = dark ? 250 : 12, halo_grey = dark ? 0 : 255;
    struct arrows arrows;
    struct sample key;
    if (gather(picture, t, &arrows)
        && measure(picture, t, &arrows, &key.speed, &key.pixels, &key.width)) {
        draw_all(ink, &arrows, &key, true,
                 (struct ink_color){halo_grey, halo_grey, halo_grey, 110});
        draw_all(ink, &arrows, &key, false,
                 (struct ink_color){arrow_grey, arrow_grey, arrow_grey, 255});
    }
    free(arrows.list);
}
