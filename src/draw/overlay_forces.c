/* overlay_forces.c - contact forces as lines between centres, as wide as the force is large.
 *
 * The 99th percentile of the forces is about as wide as a mean radius.  Percentiles change from
 * frame to frame, so it is rounded to 1, 2 or 5 times a power of ten: in a film the widths stay
 * comparable, and the legend can name a round force.  Weak lines are drawn first and paler.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/overlay_forces.h"

#include "draw/overlay.h"
#include "draw/overlay_layout.h"
#include "draw/percentile.h"
#include "draw/shortage.h"
#include "draw/ticks.h"

#include <math.h>
#include <stdlib.h>

static const double width_min = 0.12;   /* pixels; thinner lines are too pale to see */

struct line { float x0, y0, x1, y1, width; };

static double contact_force(const struct contact *c) { return hypot((double)c->fx, (double)c->fy); }

/* The 99th percentile of the forces, 0 if there are none. */
static double force_high(const struct grains *grains)
{
    if (!grains->contacts || grains->contact_count == 0) return 0;
    float *values = shortage_check(malloc(grains->contact_count * sizeof *values));
    if (!values) return 0;
    uint32_t count = 0;
    for (uint32_t k = 0; k < grains->contact_count; k++) {
        const float force = (float)contact_force(&grains->contacts[k]);
        if (isfinite(force) && force > 0) values[count++] = force;
    }
    const double high = count ? percentile(values, count, 0.99) : 0;
    free(values);
    return high;
}

static double round_near(double value)
{
    return ticks_round_down(value * 1.5);
}

bool overlay_forces_key(const struct picture *picture, const struct transform *t, double *force,
                        double *width)
{
    const double high = picture->grains ? force_high(picture->grains) : 0;
    if (!(high > 0)) return false;
    const double chosen = picture->view->force_scale;
    *force = round_near(high);
    *width = (chosen > 0 ? chosen * *force : picture->scene->radius_mean) * t->scale;
    return *width > 0;
}

struct ink_color overlay_forces_color(enum theme theme, double share)
{
    static const uint8_t weak[2][3] = {{196, 92, 66}, {206, 98, 72}};
    static const uint8_t strong[2][3] = {{158, 16, 20}, {232, 56, 44}};
    const int dark = theme == THEME_DARK;
    const double part = fmin(fmax(share, 0), 1);
    uint8_t rgb[3];
    for (int c = 0; c < 3; c++) {
        rgb[c] = (uint8_t)(weak[dark][c] + part * (strong[dark][c] - weak[dark][c]) + 0.5);
    }
    return (struct ink_color){rgb[0], rgb[1], rgb[2], 255};
}

/* From grain i through the contact to the other centre; at a wall the round end stops short of
 * the contact, so that it does not look through.  Across a periodic border the other
 * centre is elsewhere: then each grain gets its own half of the line. */
static uint32_t contact_lines(const struct grains *grains, const struct contact *c, double width,
                              const struct transform *t, struct line lines[2])
{
    const double x = grains->x[c->i], y = grains->y[c->i];
    const double dx = (double)c->x - x, dy = (double)c->y - y, reach = hypot(dx, dy);
    double x1 = (double)c->x, y1 = (double)c->y;
    uint32_t count = 1;
    if (c->j >= grains->count && reach > 0) {
        const double share = fmax(0.3, 1 - 0.5 * width / (t->scale * reach));
        x1 = x + share * dx;
        y1 = y + share * dy;
    }
    if (c->j < grains->count && reach > 0) {
        const double rj = grains->radius[c->j], xj = grains->x[c->j], yj = grains->y[c->j];
        x1 = x + dx * (reach + rj) / reach;
        y1 = y + dy * (reach + rj) / reach;
        if (hypot(x1 - xj, y1 - yj) > 0.5 * rj) {
            lines[count++] = (struct line){
                (float)transform_x(t, xj), (float)transform_y(t, yj),
                (float)transform_x(t, xj - dx * rj / reach),
                (float)transform_y(t, yj - dy * rj / reach), (float)width};
            x1 = (double)c->x;
            y1 = (double)c->y;
        } else {
            x1 = xj;
            y1 = yj;
        }
    }
    lines[0] = (struct line){(float)transform_x(t, x), (float)transform_y(t, y),
                             (float)transform_x(t, x1), (float)transform_y(t, y1), (float)width};
    return count;
}

static bool outside(const struct line *line, const struct layout *layout)
{
    const float width = (float)layout->width, height = (float)layout->height, w = line->width;
    return fmaxf(line->x0, line->x1) < -w || fminf(line->x0, line->x1) > width + w
        || fmaxf(line->y0, line->y1) < -w || fminf(line->y0, line->y1) > height + w;
}

static int thinner_first(const void *a, const void *b)
{
    const struct line *p = a, *q = b;
    if (p->width != q->width) return p->width < q->width ? -1 : 1;
    if (p->x0 != q->x0) return p->x0 < q->x0 ? -1 : 1;
    return (p->y0 > q->y0) - (p->y0 < q->y0);
}

void overlay_forces(struct ink *ink, const struct picture *picture, const struct transform *t)
{
    double key_force, key_width;
    if (!overlay_forces_key(picture, t, &key_force, &key_width)) return;
    const struct grains *grains = picture->grains;
    struct line *lines = shortage_check(malloc(grains->contact_count * 2 * sizeof *lines));
    if (!lines) return;
    struct layout layout;
    overlay_layout_make(picture, &layout);
    uint32_t count = 0;
    for (uint32_t k = 0; k < grains->contact_count; k++) {
        const struct contact *c = &grains->contacts[k];
        const double width = fmin(key_width * contact_force(c) / key_force, 3 * key_width);
        if (!(width > width_min) || c->i >= grains->count) continue;
        struct line two[2];
        const uint32_t found = contact_lines(grains, c, width, t, two);
        for (uint32_t n = 0; n < found; n++) {
            if (!outside(&two[n], &layout)) lines[count++] = two[n];
        }
    }
    qsort(lines, count, sizeof *lines, thinner_first);
    const enum theme theme = (enum theme)picture->view->theme;
    for (uint32_t k = 0; k < count; k++) {
        const struct line *line = &lines[k];
        ink_line(ink, (double)line->x0, (double)line->y0, (double)line->x1, (double)line->y1,
                 (double)line->width, overlay_forces_color(theme, (double)line->width / key_width));
    }
    free(lines);
}
