/* overlay.c - colours of the themes, walls, and the spokes of turning grains.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/overlay.h"

#include "draw/overlay_layout.h"

#include <math.h>

/* The transparent theme's walls are grey, to be seen on a white page and on a dark slide. */
static const struct { struct ink_color ground, text, wall, body; } themes[] = {
    [THEME_WHITE] = {{255, 255, 255, 255}, {27, 28, 38, 255},
                     {27, 28, 38, 255}, {203, 205, 213, 255}},
    [THEME_DARK] = {{22, 24, 31, 255}, {232, 233, 239, 255},
                    {206, 209, 219, 255}, {74, 78, 92, 255}},
    [THEME_TRANSPARENT] = {{255, 255, 255, 0}, {27, 28, 38, 255},
                           {116, 119, 134, 255}, {172, 175, 187, 255}},
};

struct ink_color overlay_ground(enum theme theme) { return themes[theme].ground; }
struct ink_color overlay_text_color(enum theme theme) { return themes[theme].text; }
struct ink_color overlay_wall_color(enum theme theme) { return themes[theme].wall; }

/* Keeps the part of a line inside x0 y0 x1 y1; false if none is.  A line that reaches far beyond
 * a zoomed picture would lose its place in the GPU's single precision. */
static bool clip(const double box[4], double p[2], double q[2])
{
    double from = 0, to = 1;
    const double start[2] = {p[0], p[1]}, way[2] = {q[0] - p[0], q[1] - p[1]};
    for (int axis = 0; axis < 2; axis++) {
        const double low = box[axis] - start[axis], high = box[axis + 2] - start[axis];
        if (way[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        const double a = low / way[axis], b = high / way[axis];
        from = fmax(from, fmin(a, b));
        to = fmin(to, fmax(a, b));
    }
    if (from > to) return false;
    for (int axis = 0; axis < 2; axis++) {
        p[axis] = start[axis] + from * way[axis];
        q[axis] = start[axis] + to * way[axis];
    }
    return true;
}

static void draw_segment(struct ink *ink, const struct wall *wall, const struct transform *t,
                         const struct layout *layout, double width, struct ink_color color)
{
    const double far[4] = {-100, -100, layout->width + 100, layout->height + 100};
    double p[2] = {transform_x(t, wall->x0), transform_y(t, wall->y0)};
    double q[2] = {transform_x(t, wall->x1), transform_y(t, wall->y1)};
    if (clip(far, p, q)) ink_line(ink, p[0], p[1], q[0], q[1], width, color);
}

/* A body is filled; its outline lies inside, so that the disc has its true size. */
static void draw_disc(struct ink *ink, const struct wall *wall, const struct transform *t,
                      double width, struct ink_color line, struct ink_color fill)
{
    const double x = transform_x(t, wall->cx), y = transform_y(t, wall->cy);
    const double radius = wall->radius * t->scale;
    ink_disc(ink, x, y, radius, line);
    if (radius > 1.5 * width) ink_disc(ink, x, y, radius - fmin(width, 0.25 * radius), fill);
}

void overlay_walls(struct ink *ink, const struct picture *picture, const struct transform *t)
{
    struct layout layout;
    overlay_layout_make(picture, &layout);
    const enum theme theme = (enum theme)picture->view->theme;
    const double width = 3 * layout.unit;
    for (uint32_t k = 0; k < picture->scene->wall_count; k++) {
        const struct wall *wall = &picture->scene->walls[k];
        if (!wall_present(wall, picture->time)) continue;
        const struct wall now = wall_at(wall, picture->time);
        switch (now.shape) {
        case WALL_SEGMENT:
            draw_segment(ink, &now, t, &layout, width, themes[theme].wall);
            break;
        case WALL_ARC:
            ink_arc(ink, transform_x(t, now.cx), transform_y(t, now.cy), now.radius * t->scale,
                    now.angle0, now.angle1, width, themes[theme].wall);
            break;
        case WALL_DISC:
            draw_disc(ink, &now, t, width, themes[theme].wall, themes[theme].body);
            break;
        }
    }
}

void overlay_spokes(struct ink *ink, const struct picture *picture, const struct transform *t)
{
    const struct grains *grains = picture->grains;
    if (!grains || !grains->angle) return;
    struct layout layout;
    overlay_layout_make(picture, &layout);
    for (uint32_t i = 0; i < grains->count; i++) {
        const double radius = grains->radius[i] * t->scale;
        const double x = transform_x(t, grains->x[i]), y = transform_y(t, grains->y[i]);
        if (radius < 2 || x < -radius || y < -radius || x > layout.width + radius
            || y > layout.height + radius) continue;
        const double reach = 0.85 * radius, width = fmin(fmax(0.16 * radius, 0.7), 4 * layout.unit);
        ink_line(ink, x, y, x + reach * cos(grains->angle[i]), y - reach * sin(grains->angle[i]),
                 width, (struct ink_color){16, 16, 22, 210});
    }
}
