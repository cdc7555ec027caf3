/* overlay_legend_items.c - what a length, a force and a velocity look like in this picture.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/overlay_legend.h"

#include "draw/overlay.h"
#include "draw/overlay_arrows.h"
#include "draw/overlay_forces.h"
#include "draw/overlay_label.h"
#include "draw/ticks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double item_size = 0.92;           /* of the letters */
static const double sample_max = 5;             /* longest sample, in letters */

enum { ITEM_TEXT_MAX = 120 };

/* One place of the strip: where it begins, its middle line, how wide it may be. */
struct place { double x, y, room; };

static void draw_text(const struct legend *legend, const struct place *place, double used,
                      const char *text)
{
    const double s = legend->layout.text, left = used + 0.45 * s;
    const double size = overlay_legend_fit(legend, item_size * s, place->room - left, text);
    ink_text(legend->ink, place->x + left, place->y + 0.5 * OVERLAY_LEGEND_CAPITAL * size, size,
             INK_LEFT, legend->text, text);
}

static void draw_plate(const struct legend *legend, const struct place *place, double used,
                       const char *text)
{
    const double s = legend->layout.text;
    const double width = ink_text_width(legend->ink, item_size * s, text);
    overlay_legend_plate(legend, place->x - 0.35 * s, place->y - 0.85 * s,
                         place->x + fmin(used + 0.45 * s + width, place->room) + 0.35 * s,
                         place->y + 0.85 * s);
}

/* A length in words that keep the number handy: 0.002 m is 2 mm. */
static void length_text(const struct scene *scene, double length, char text[ITEM_TEXT_MAX])
{
    static const struct { double size; const char *unit; } meters[] = {
        {1000, "km"}, {1, "m"}, {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "\u00b5m"}, {1e-9, "nm"}};
    char number[TICKS_TEXT_MAX];
    if (scene->units == UNITS_REDUCED) {
        ticks_number(number, length, 3);
        snprintf(text, ITEM_TEXT_MAX, scene->radius_mean > 0 ? "%s d" : "%s", number);
        return;
    }
    const double in_meters = length * (scene->units == UNITS_CGS ? 0.01 : 1);
    size_t k = 0;
    while (k + 1 < sizeof meters / sizeof *meters && in_meters < meters[k].size * (1 - 1e-9)) k++;
    ticks_number(number, in_meters / meters[k].size, 3);
    snprintf(text, ITEM_TEXT_MAX, "%s %s", number, meters[k].unit);
}

/* A bar of round length; in reduced units it counts mean diameters. */
static void draw_scale(const struct legend *legend, const struct place *place)
{
    const struct scene *scene = legend->picture->scene;
    const double s = legend->layout.text;
    const double one = scene->units == UNITS_REDUCED && scene->radius_mean > 0
        ? 2 * scene->radius_mean : 1;
    const double length = ticks_round_down(sample_max * s / (legend->t->scale * one));
    const double width = length * one * legend->t->scale;
    char text[ITEM_TEXT_MAX];
    length_text(scene, length, text);
    draw_plate(legend, place, width, text);
    const double thick = fmax(1, round(3 * legend->layout.unit)), half = round(0.3 * s);
    const double y = round(place->y - 0.5 * thick), rule = legend->rule;
    const double x0 = place->x, x1 = place->x + width;
    ink_rectangle(legend->ink, x0, y, x1, y + thick, legend->text);
    ink_rectangle(legend->ink, x0, y - half, x0 + rule, y + thick + half, legend->text);
    ink_rectangle(legend->ink, x1 - rule, y - half, x1, y + thick + half, legend->text);
    draw_text(legend, place, width, text);
}

static void quantity_text(const struct legend *legend, const char *name, double value,
                          const char *dimension, char text[ITEM_TEXT_MAX])
{
    char number[TICKS_TEXT_MAX], unit[TICKS_TEXT_MAX];
    ticks_number(number, value, 3);
    overlay_label_unit(scene_unit(legend->picture->scene, dimension), unit, sizeof unit);
    snprintf(text, ITEM_TEXT_MAX, "%s %s%s%s", name, number, unit[0] ? " " : "", unit);
}

static void draw_gravity(const struct legend *legend, const struct place *place)
{
    const struct picture *picture = legend->picture;
    const struct scene *scene = picture->scene->phase_count
        ? scene_at(picture->scene, picture->time) : picture->scene;
    const double gx = scene->gravity[0], gy = scene->gravity[1], g = hypot(gx, gy);
    const double s = legend->layout.text, half = 0.75 * s;
    char text[ITEM_TEXT_MAX];
    quantity_text(legend, "g =", g, "acceleration", text);
    draw_plate(legend, place, 2 * half, text);
    const double x = place->x + half, y = place->y;
    if (g > 0) {
        const double dx = half * gx / g, dy = -half * gy / g;
        ink_arrow(legend->ink, x - dx, y - dy, x + dx, y + dy, fmax(1.2, 0.11 * s), legend->text);
    } else ink_disc(legend->ink, x, y, 0.15 * s, legend->text);
    draw_text(legend, place, 2 * half, text);
}

/* The sample is at most as wide as the strip allows; the force named is that of the sample. */
static void draw_force(const struct legend *legend, const struct place *place)
{
    const double s = legend->layout.text, length = 2.2 * s;
    double force = 0, width = 0;
    char text[ITEM_TEXT_MAX] = "contact force";
    if (overlay_forces_key(legend->picture, legend->t, &force, &width)) {
        const double limit = 0.6 * s;
        if (width > limit) {
            const double smaller = ticks_round_down(force * limit / width);
            width *= smaller / force;
            force = smaller;
        }
        quantity_text(legend, "contact force", force, "force", text);
    } else width = 0.2 * s;
    draw_plate(legend, place, length, text);
    ink_line(legend->ink, place->x + 0.5 * width, place->y, place->x + length - 0.5 * width,
             place->y, width, overlay_forces_color((enum theme)legend->picture->view->theme, 1));
    draw_text(legend, place, length, text);
}

static void draw_velocity(const struct legend *legend, const struct place *place)
{
    const double s = legend->layout.text, limit = 3.2 * s;
    double speed = 0, length = 0, width = 0;
    char text[ITEM_TEXT_MAX] = "velocity";
    if (overlay_arrows_key(legend->picture, legend->t, &speed, &length, &width)) {
        if (length > limit) {
            const double smaller = ticks_round_down(speed * limit / length);
            length *= smaller / speed;
            speed = smaller;
        }
        quantity_text(legend, "velocity", speed, "speed", text);
    } else {
        length = 2 * s;
        width = legend->rule;
    }
    draw_plate(legend, place, length, text);
    ink_arrow(legend->ink, place->x, place->y, place->x + length, place->y, width, legend->text);
    draw_text(legend, place, length, text);
}

void overlay_legend_items(const struct legend *legend)
{
    static void (*const draw[LAYOUT_ITEMS])(const struct legend *, const struct place *) = {
        [LAYOUT_SCALE] = draw_scale, [LAYOUT_GRAVITY] = draw_gravity,
        [LAYOUT_FORCE] = draw_force, [LAYOUT_VELOCITY] = draw_velocity,
    };
    const struct layout *layout = &legend->layout;
    uint32_t placed = 0;
    for (int item = 0; item < LAYOUT_ITEMS; item++) {
        if (!layout->item[item]) continue;
        const uint32_t row = placed / layout->columns, column = placed % layout->columns;
        const struct place place = {
            .x = round(layout->bottom[0] + column * layout->item_width),
            .y = round(layout->bottom[1] + (row + 0.5) * layout->row_height + 0.2 * layout->text),
            .room = layout->item_width - 0.8 * layout->text,
        };
        draw[item](legend, &place);
        placed++;
    }
}
