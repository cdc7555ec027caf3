/* ed_shear.c - see ed_shear.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_shear.h"

/* Brings `ahead` into one period along x. */
static void wrap_ahead(struct ed *ed)
{
    const double periods = floor(ed->clock.ahead * ed->unwrap_x);
    ed->clock.ahead -= periods * ed->wrap_x;
    ed->clock.ahead_cells -= (int64_t)periods * ed->cells.nx;
}

/* The image lies between ahead_cells and one more; when does it pass the next of the two? */
static void set_next(struct ed *ed)
{
    struct ed_clock *clock = &ed->clock;
    const double m = (double)clock->ahead_cells + (ed->clock.shear_speed > 0 ? 1 : 0);
    clock->slide = ed->clock.shear_speed != 0
                 ? (m * ed->cells.width_x - clock->ahead) / ed->clock.shear_speed : INFINITY;
}

void ed_shear_begin(struct ed *ed)
{
    const struct scene *scene = ed->scene;
    const bool shears = ed->effects & EFFECT_SHEAR;
    ed->clock.shear_speed = shears ? scene->shear_rate * (scene->box[3] - scene->box[1]) : 0;
    ed->sheared = shears || ed->clock.ahead != 0;
    ed->clock.slide = INFINITY;
    if (!ed->sheared) return;
    wrap_ahead(ed);
    const double ahead = ed_shear_ahead(ed, ed->clock.now);
    ed->clock.ahead_cells = (int64_t)floor(ahead / ed->cells.width_x);
    set_next(ed);
}

void ed_shear_shift(struct ed *ed, double t)
{
    if (!ed->sheared) return;
    ed->clock.ahead += ed->clock.shear_speed * t;
    wrap_ahead(ed);
    set_next(ed);
}

struct ed_path ed_shear_place(const struct ed *ed, uint32_t i, double t)
{
    const struct ed_grain *g = &ed->grains[i];
    const double *box = ed->scene->box;
    struct ed_path p = {g->x + t * (g->vx + 0.5 * ed->gx * t),
                        g->y + t * (g->vy + 0.5 * ed->gy * t),
                        g->vx + ed->gx * t, g->vy + ed->gy * t, ed->gx, ed->gy};
    if (ed->wrap_y > 0) {
        const double up = floor((p.y - box[1]) * ed->unwrap_y);
        p.y -= up * ed->wrap_y;
        if (ed->sheared) {
            p.x -= up * ed_shear_ahead(ed, t);
            p.vx -= up * ed->clock.shear_speed;
        }
    }
    if (ed->wrap_x > 0) p.x -= ed->wrap_x * floor((p.x - box[0]) * ed->unwrap_x);
    return p;
}

void ed_shear_cross(struct ed *ed, uint32_t i, uint32_t cx, uint32_t cy)
{
    struct ed_grain *g = &ed->grains[i];
    struct ed_event *e = &ed->events[i];
    const struct ed_cells *c = &ed->cells;
    ed_cells_remove(&ed->cells, ed_cells_index(c, e->cx, e->cy), i);
    if (cy == 0 || cy > c->ny) {
        const double up = cy == 0 ? -1 : 1;
        g->x -= up * ed->clock.ahead;
        g->y -= up * ed->wrap_y;
        g->vx -= up * ed->clock.shear_speed;
        cy = cy == 0 ? c->ny : 1;
        const double x = ed_walls_path(ed, i).x, low = ed->scene->box[0];
        const double shift = ed->wrap_x * floor((x - low) * ed->unwrap_x);
        uint16_t column, row;
        g->x -= shift;
        ed_cells_place(c, x - shift, ed->scene->box[1], &column, &row);
        cx = column;
    } else if (cx == 0 || cx > c->nx) {
        g->x += cx == 0 ? ed->wrap_x : -ed->wrap_x;
        cx = cx == 0 ? c->nx : 1;
    }
    e->cx = (uint16_t)cx;
    e->cy = (uint16_t)cy;
    ed_cells_put(&ed->cells, ed_cells_index(c, cx, cy), i);
}

double ed_shear_due(const struct ed *ed)
{
    return ed->sheared ? ed_scene_time(&ed->clock, ed->clock.slide) : INFINITY;
}

static void predict_row(struct ed *ed, uint32_t cy)
{
    const struct ed_cells *c = &ed->cells;
    for (uint32_t cx = 1; cx <= c->nx; cx++) {
        uint32_t block = ed_cells_index(c, cx, cy);
        do {
            const uint32_t *ids = c->cells[block].id;
            for (uint32_t k = 0; k < ED_CELL_ROOM && ids[k] != ED_CELL_EMPTY; k++) {
                ed->kernels->predict_one(ed, ids[k]);
            }
            block = c->chain[block];
        } while (block);
    }
}

void ed_shear_slide(struct ed *ed)
{
    ed->clock.ahead_cells += ed->clock.shear_speed > 0 ? 1 : -1;
    set_next(ed);
    predict_row(ed, 1);
    predict_row(ed, ed->cells.ny);
}
