/* lga_lattice.c - where the nodes are, who is beside whom, and which of them are solid.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A node is solid if a wall passes within half a spacing of it.  Then no grain can hop through a
 * wall, however thin: a link is one spacing long, so if a wall crosses it, one of its two ends is
 * at most half a spacing from the crossing, and hence solid.
 */
#include "model/lga/lga.h"

#include <assert.h>
#include <math.h>

#define ROW_HEIGHT 0.86602540378443864676       /* sqrt(3)/2: distance of rows, in spacings */

static const double reach = 0.5 * (1 + 1e-9);   /* of a wall, in spacings; the rest is rounding */

/* Fits one axis of the torus to a side of the box: `unit` is the distance of columns or rows.  A
 * periodic side takes a whole number of units, slightly stretched, any other side a ring of nodes
 * outside.  Returns how many there are; the first lies at *start. */
static uint32_t fit(double low, double high, bool periodic, bool even, double *unit, double *start)
{
    const double units = (high - low) / *unit;
    assert(units < 1e9);
    if (periodic) {
        const double step = even ? 2 : 1;
        const double count = fmax(2, step * round(units / step));
        *unit = (high - low) / count;
        *start = low + 0.25 * *unit;
        return (uint32_t)count;
    }
    uint32_t count = (uint32_t)units + 4;
    if (even && count % 2) count++;
    *start = 0.5 * (low + high) - *unit * (count / 2);  /* the middle of the box falls on a node */
    return count;
}

struct lga_lattice lga_lattice_of(const struct scene *scene, double spacing, bool turned)
{
    struct lga_lattice lattice = {.turned = turned, .spacing = spacing};
    for (int k = 0; k < 4; k++) lattice.box[k] = scene->box[k];
    lattice.wraps_x = scene->left == BORDER_PERIODIC;
    lattice.wraps_y = scene->bottom == BORDER_PERIODIC;
    const double *box = lattice.box;
    double column = spacing, row = ROW_HEIGHT * spacing;
    if (!turned) {
        lattice.columns = fit(box[0], box[2], lattice.wraps_x, false, &column, &lattice.x0);
        lattice.rows = fit(box[1], box[3], lattice.wraps_y, true, &row, &lattice.y0);
    } else {
        lattice.columns = fit(box[1], box[3], lattice.wraps_y, false, &column, &lattice.y0);
        lattice.rows = fit(box[0], box[2], lattice.wraps_x, true, &row, &lattice.x0);
        lattice.x0 += row * (lattice.rows - 1);         /* rows run towards -x */
    }
    lattice.along = column;
    lattice.across = row / ROW_HEIGHT;
    return lattice;
}

uint32_t lga_lattice_beside(const struct lga_lattice *lattice, uint32_t site, int direction)
{
    static const int dx[2][LGA_DIRECTIONS] = {{1, 0, -1, -1, -1, 0}, {1, 1, 0, -1, 0, 1}};
    static const int dy[LGA_DIRECTIONS] = {0, 1, 1, 0, -1, -1};
    const uint32_t columns = lattice->columns, rows = lattice->rows;
    const uint32_t x = site % columns, y = site / columns;
    const uint32_t tx = (x + columns + (uint32_t)dx[y & 1][direction]) % columns;
    const uint32_t ty = (y + rows + (uint32_t)dy[direction]) % rows;
    return ty * columns + tx;
}

void lga_lattice_join(const struct lga_lattice *lattice, uint32_t (*beside)[LGA_DIRECTIONS])
{
    assert(lattice->rows % 2 == 0);
    for (uint32_t n = 0; n < lattice->rows * lattice->columns; n++) {
        for (int d = 0; d < LGA_DIRECTIONS; d++) beside[n][d] = lga_lattice_beside(lattice, n, d);
    }
}

/* From the lattice's frame, in spacings, to a vector of the scene. */
static void to_scene(const struct lga_lattice *lattice, double u, double v, double *x, double *y)
{
    *x = lattice->turned ? -lattice->across * v : lattice->along * u;
    *y = lattice->turned ? lattice->along * u : lattice->across * v;
}

void lga_lattice_position(const struct lga_lattice *lattice, uint32_t site, double *x, double *y)
{
    const uint32_t row = site / lattice->columns, column = site % lattice->columns;
    to_scene(lattice, column + 0.5 * (row & 1), ROW_HEIGHT * row, x, y);
    *x += lattice->x0;
    *y += lattice->y0;
}

void lga_lattice_vector(const struct lga_lattice *lattice, double angle, double *x, double *y)
{
    to_scene(lattice, cos(angle), sin(angle), x, y);
}

/* The way from (x0, y0) to (x1, y1), through a periodic border if that is shorter. */
static void shortest(const struct lga_lattice *lattice, double *dx, double *dy)
{
    const double width = lattice->box[2] - lattice->box[0];
    const double height = lattice->box[3] - lattice->box[1];
    if (lattice->wraps_x) *dx -= width * round(*dx / width);
    if (lattice->wraps_y) *dy -= height * round(*dy / height);
}

double lga_lattice_distance(const struct lga_lattice *lattice, uint32_t site, double x, double y)
{
    double nx, ny;
    lga_lattice_position(lattice, site, &nx, &ny);
    nx -= x;
    ny -= y;
    shortest(lattice, &nx, &ny);
    return hypot(nx, ny);
}

/* Column (row) number -> one that exists: around the torus. */
static uint32_t wrapped(double number, uint32_t count)
{
    return (uint32_t)(number - floor(number / count) * count) % count;
}

uint32_t lga_lattice_nearest(const struct lga_lattice *lattice, double x, double y)
{
    x -= lattice->x0;
    y -= lattice->y0;
    const double u = (lattice->turned ? y : x) / lattice->along;
    const double v = (lattice->turned ? -x : y) / (lattice->across * ROW_HEIGHT);
    uint32_t best = 0;
    double least = INFINITY;
    for (int k = 0; k < 2; k++) {               /* the rows below and above */
        const uint32_t row = wrapped(floor(v) + k, lattice->rows);
        const uint32_t column = wrapped(round(u - 0.5 * (row & 1)), lattice->columns);
        const uint32_t site = row * lattice->columns + column;
        const double distance = lga_lattice_distance(lattice, site, x + lattice->x0,
                                                     y + lattice->y0);
        if (distance >= least) continue;
        least = distance;
        best = site;
    }
    return best;
}

/* Outside the box, or too near to one of its sides; a wall wins in the corners. */
static enum lga_kind border_kind(const struct lga_lattice *lattice, const struct scene *scene,
                                 double x, double y)
{
    const double depth = reach * lattice->spacing, *box = lattice->box;
    const bool beyond[4] = {x < box[0] + depth, x > box[2] - depth, y < box[1] + depth,
                            y > box[3] - depth};
    const int borders[4] = {scene->left, scene->right, scene->bottom, scene->top};
    enum lga_kind kind = LGA_FLUID;
    for (int side = 0; side < 4; side++) {
        if (!beyond[side] || borders[side] == BORDER_PERIODIC) continue;
        if (borders[side] == BORDER_WALL) return LGA_WALL;
        kind = LGA_SINK;
    }
    return kind;
}

static enum lga_kind sink_kind(const struct scene *scene, double x, double y)
{
    for (uint32_t k = 0; k < scene->sink_count; k++) {
        const double *region = scene->sinks[k].region;
        if (x >= region[0] && x <= region[2] && y >= region[1] && y <= region[3]) return LGA_SINK;
    }
    return LGA_FLUID;
}

static void draw_wall(const struct lga_lattice *lattice, const struct wall *wall, uint32_t row,
                      uint8_t *kind)
{
    const double depth = reach * lattice->spacing;
    double x0, y0, x1, y1, x, y;
    wall_bounds(wall, &x0, &y0, &x1, &y1);
    lga_lattice_position(lattice, row * lattice->columns, &x, &y);
    const bool passes = lattice->turned ? x >= x0 - depth && x <= x1 + depth
                                        : y >= y0 - depth && y <= y1 + depth;
    for (uint32_t n = 0; passes && n < lattice->columns; n++) {
        lga_lattice_position(lattice, row * lattice->columns + n, &x, &y);
        if (x < x0 - depth || x > x1 + depth || y < y0 - depth || y > y1 + depth) continue;
        if (wall_nearest(wall, x, y).distance <= depth) kind[n] = LGA_WALL;
    }
}

void lga_lattice_rasterise(const struct lga_lattice *lattice, const struct scene *scene, double t,
                           uint32_t row, uint8_t *kind)
{
    for (uint32_t n = 0; n < lattice->columns; n++) {
        double x, y;
        lga_lattice_position(lattice, row * lattice->columns + n, &x, &y);
        kind[n] = (uint8_t)border_kind(lattice, scene, x, y);
        if (kind[n] == LGA_FLUID) kind[n] = (uint8_t)sink_kind(scene, x, y);
    }
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        if (scene->walls[w].border || !wall_present(&scene->walls[w], t)) continue;
        const struct wall wall = wall_at(&scene->walls[w], t);
        draw_wall(lattice, &wall, row, kind);
    }
}

/* Is node `site` on the same side as (x, y) of every wall that is near to (x, y)?  Seen from the
 * wall's nearest point, that is the half plane into which its normal points. */
bool lga_lattice_same_side(const struct lga_lattice *lattice, const struct scene *scene, double t,
                           uint32_t site, double x, double y)
{
    double dx, dy;
    lga_lattice_position(lattice, site, &dx, &dy);
    dx -= x;
    dy -= y;
    shortest(lattice, &dx, &dy);
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        if (scene->walls[w].border || !wall_present(&scene->walls[w], t)) continue;
        const struct wall wall = wall_at(&scene->walls[w], t);
        const struct wall_nearest near = wall_nearest(&wall, x, y);
        if (near.distance > 1.2 * lattice->spacing) continue;
        if (near.distance + near.nx * dx + near.ny * dy <= 0) return false;
    }
    return true;
}
