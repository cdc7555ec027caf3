/* dsmc_walls.c - grains and solid walls.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A grid that stands still lists the walls near each of its cells; where the list is empty nothing
 * is asked.  Elsewhere a grain goes as far as no wall can be and half a radius more, then looks
 * again: so a disc never gets through a wall without thickness, and far from walls one look is
 * enough.  A disc that overlaps a wall and comes nearer bounces: restitution, and where there is
 * friction the rub of a rough wall.  A moving wall gives its own velocity.
 */
#include "model/dsmc/dsmc_walls.h"

#include <math.h>
#include <string.h>

enum {
    LOOKS_MAX = 200,            /* at the walls in one step of one grain; the way left is lost */
    ROUNDS_MAX = 6,             /* of one grain in a corner */
    IMAGES = 9
};

static const double carries_cosine = 0.9;       /* a plate: its normal is that much upright */

static void image_shift(const struct dsmc *dsmc, uint32_t image, double *x, double *y)
{
    static const int signs[3] = {0, 1, -1};
    const double *box = dsmc->scene->box;
    *x = dsmc->ax.periodic ? signs[image % 3] * (box[2] - box[0]) : 0;
    *y = dsmc->ay.periodic ? signs[image / 3] * (box[3] - box[1]) : 0;
}

/* An image that differs from the wall itself? */
static bool image_exists(const struct dsmc *dsmc, uint32_t image)
{
    return (image % 3 == 0 || dsmc->ax.periodic) && (image / 3 == 0 || dsmc->ay.periodic);
}

static double margin(const struct dsmc *dsmc)
{
    return dsmc->radius + (double)dsmc->walls.stride + dsmc->walls.slack;
}

/* Most cells that can list a wall, wherever it is. */
static double cells_near(const struct dsmc *dsmc, const struct wall *wall)
{
    double x0, y0, x1, y1;
    wall_bounds(wall, &x0, &y0, &x1, &y1);
    const double cell = 1 / (double)fmaxf(dsmc->walls.per_x, dsmc->walls.per_y);
    const double reach = 2 * (margin(dsmc) + 4 * dsmc->radius) / cell + 4;
    const double along = ((x1 - x0) + (y1 - y0)) / cell + reach;
    const double box = ((x1 - x0) / cell + reach) * ((y1 - y0) / cell + reach);
    return fmin(wall->shape == WALL_DISC ? box : fmin(box, 4 * along * reach),
                (double)dsmc->walls.nx * dsmc->walls.ny);
}

bool dsmc_walls_create(struct dsmc *dsmc)
{
    const struct scene *scene = dsmc->scene;
    struct dsmc_walls *walls = &dsmc->walls;
    if (scene->wall_count == 0) return true;
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    const double cell = fmax(dsmc->settings.cell, 2 * dsmc->radius);
    walls->nx = (uint32_t)fmax(1, floor(width / cell));
    walls->ny = (uint32_t)fmax(1, floor(height / cell));
    walls->per_x = (float)(walls->nx / width);
    walls->per_y = (float)(walls->ny / height);
    walls->stride = (float)(0.5 * cell);
    walls->slack = 0.25 * cell;
    walls->stale = true;
    double near = 16;
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        const struct wall *wall = &scene->walls[w];
        near += 4 * cells_near(dsmc, wall);
        walls->vary = walls->vary || wall_moves(wall) || wall_is_gate(wall);
        if (!wall_moves(wall)) continue;
        walls->speed = fmax(walls->speed, hypot(wall->vx, wall->vy)
            + 2 * M_PI * fabs(wall->frequency) * hypot(wall->amplitude_x, wall->amplitude_y));
    }
    walls->near_max = (uint32_t)fmin(near, 4e8);
    return arena_array(&dsmc->arena, &walls->first, (size_t)walls->nx * walls->ny + 1)
        && arena_array(&dsmc->arena, &walls->near, walls->near_max)
        && arena_array(&dsmc->arena, &walls->now, scene->wall_count)
        && arena_array(&dsmc->arena, &walls->here, scene->wall_count)
        && arena_array(&dsmc->arena, &walls->sums, (size_t)dsmc->blocks * scene->obstacle_count);
}

/* ---- which walls are near ------------------------------------------------------------------- */

/* Is the wall's image near the cell?  Border cells also take in what is beyond the border. */
static bool is_near(const struct dsmc *dsmc, uint32_t cx, uint32_t cy, const struct wall *wall,
                    double ix, double iy)
{
    const struct dsmc_walls *walls = &dsmc->walls;
    const double wx = 1 / (double)walls->per_x, wy = 1 / (double)walls->per_y;
    const bool border = cx == 0 || cy == 0 || cx + 1 == walls->nx || cy + 1 == walls->ny;
    const double half = 0.5 * hypot(wx, wy) + (border ? 4 * dsmc->radius : 0);
    const double x = (cx + 0.5) * wx - ix, y = (cy + 0.5) * wy - iy;
    return wall_nearest(wall, x, y).distance < half + margin(dsmc);
}

/* Cells from..to - 1 of one direction that lie within the bounds; false if none does. */
static bool cell_range(double low, double high, double per, uint32_t cells, uint32_t *from,
                       uint32_t *to)
{
    const double a = floor(low * per) - 1, b = floor(high * per) + 2;
    if (b <= 0 || a >= cells) return false;
    *from = a > 0 ? (uint32_t)a : 0;
    *to = b < cells ? (uint32_t)b : cells;
    return true;
}

/* Counts (near NULL) or lists the cells near one wall. */
static void list_wall(struct dsmc *dsmc, uint32_t w, bool counts)
{
    struct dsmc_walls *walls = &dsmc->walls;
    const struct wall *wall = &walls->now[w];
    const double reach = margin(dsmc) + 4 * dsmc->radius;
    double x0, y0, x1, y1;
    wall_bounds(wall, &x0, &y0, &x1, &y1);
    for (uint32_t image = 0; image < IMAGES; image++) {
        double ix, iy;
        if (!image_exists(dsmc, image)) continue;
        image_shift(dsmc, image, &ix, &iy);
        uint32_t fx, tx, fy, ty;
        if (!cell_range(x0 + ix - reach, x1 + ix + reach, (double)walls->per_x, walls->nx, &fx, &tx)
            || !cell_range(y0 + iy - reach, y1 + iy + reach, (double)walls->per_y, walls->ny,
                           &fy, &ty)) continue;
        for (uint32_t cy = fy; cy < ty; cy++) {
            for (uint32_t cx = fx; cx < tx; cx++) {
                if (!is_near(dsmc, cx, cy, wall, ix, iy)) continue;
                uint32_t *at = &walls->first[cy * walls->nx + cx];
                if (counts) ++*at;
                else walls->near[--*at] = w * IMAGES + image;
            }
        }
    }
}

/* Counting sort by cell; walls go in backwards, so that they come out in order. */
static void list_walls(struct dsmc *dsmc)
{
    struct dsmc_walls *walls = &dsmc->walls;
    const uint32_t cells = walls->nx * walls->ny;
    memset(walls->first, 0, ((size_t)cells + 1) * sizeof *walls->first);
    for (uint32_t w = 0; w < dsmc->scene->wall_count; w++) list_wall(dsmc, w, true);
    for (uint32_t c = 1; c <= cells; c++) walls->first[c] += walls->first[c - 1];
    if (walls->first[cells] > walls->near_max) {        /* cells_near() is an upper bound */
        memset(walls->first, 0, ((size_t)cells + 1) * sizeof *walls->first);
        return;
    }
    for (uint32_t w = dsmc->scene->wall_count; w-- > 0;) list_wall(dsmc, w, false);
}

void dsmc_walls_place(struct dsmc *dsmc)
{
    struct dsmc_walls *walls = &dsmc->walls;
    if (!walls->first || (!walls->vary && !walls->stale)) return;
    const double t = dsmc_time(dsmc) + dsmc->dt;        /* where they are at the end of the step */
    for (uint32_t w = 0; w < dsmc->scene->wall_count; w++) {
        struct wall *now = &walls->now[w];
        *now = wall_at(&dsmc->scene->walls[w], t);
        walls->here[w] = wall_present(&dsmc->scene->walls[w], t);
        const double x = dsmc->scene->box[0], y = dsmc->scene->box[1];
        now->x0 -= x; now->x1 -= x; now->cx -= x;
        now->y0 -= y; now->y1 -= y; now->cy -= y;
    }
    walls->moved += walls->speed * dsmc->dt;
    if (!walls->stale && walls->moved < walls->slack) return;
    list_walls(dsmc);
    walls->moved = 0;
    walls->stale = false;
}

/* ---- flight --------------------------------------------------------------------------------- */

struct flyer {                  /* a grain in flight, in double precision */
    struct dsmc *dsmc;
    uint32_t i, block;
    double x, y, vx, vy, rim;
    bool   carried;
};

static struct wall_nearest nearest_of(const struct dsmc *dsmc, uint32_t entry, double x, double y)
{
    double ix, iy;
    image_shift(dsmc, entry % IMAGES, &ix, &iy);
    return wall_nearest(&dsmc->walls.now[entry / IMAGES], x - ix, y - iy);
}

/* Velocity of the wall's surface where its normal is n; the grain is at x, y. */
static void surface_velocity(const struct wall *wall, const struct wall_nearest *nearest, double x,
                             double y, double *vx, double *vy)
{
    *vx = wall->vx;
    *vy = wall->vy;
    if (wall->surface_speed == 0) return;
    double tx = -nearest->ny, ty = nearest->nx;
    if (wall->shape == WALL_SEGMENT) {
        const double sx = wall->x1 - wall->x0, sy = wall->y1 - wall->y0, s = hypot(sx, sy);
        tx = sx / s;
        ty = sy / s;
    } else if (nearest->nx * (wall->cx - x) + nearest->ny * (wall->cy - y) > 0) {
        tx = -tx;                                               /* the grain is inside */
        ty = -ty;
    }
    *vx += wall->surface_speed * tx;
    *vy += wall->surface_speed * ty;
}

static void give_to_body(const struct flyer *flyer, const struct wall *wall,
                         const struct wall_nearest *nearest, double jx, double jy)
{
    const struct dsmc *dsmc = flyer->dsmc;
    const struct scene *scene = dsmc->scene;
    struct tally_body *sum = &dsmc->walls.sums[(size_t)flyer->block * scene->obstacle_count
                                               + wall->body];
    const double *center = scene->obstacles[wall->body].center;
    const double x = flyer->x - nearest->distance * nearest->nx + scene->box[0] - center[0];
    const double y = flyer->y - nearest->distance * nearest->ny + scene->box[1] - center[1];
    sum->impulse_x += jx;
    sum->impulse_y += jy;
    sum->angular_impulse += isfinite(center[0] + center[1]) ? x * jy - y * jx : 0;
    sum->contacts++;
}

/* Walton and Braun against a body of infinite mass.  n points from the wall to the grain. */
static void bounce(struct flyer *flyer, const struct wall *wall, const struct wall_nearest *nearest,
                   double restitution)
{
    const struct dsmc *dsmc = flyer->dsmc;
    const double nx = nearest->nx, ny = nearest->ny;
    double wx, wy;
    surface_velocity(wall, nearest, flyer->x, flyer->y, &wx, &wy);
    const double ux = flyer->vx - wx, uy = flyer->vy - wy, un = ux * nx + uy * ny;
    if (un >= 0) return;
    const double normal = -(1 + restitution) * un;
    double rub = 0;
    if (dsmc->spins) {
        const struct species *species = dsmc->scene->species;
        const double friction = 0.5 * (species[0].friction + species[wall->species].friction);
        const double q = (double)dsmc->q, slip = uy * nx - ux * ny - flyer->rim;
        rub = (1 + (double)dsmc->tangential) * q / (1 + q) * slip;
        if (fabs(rub) > friction * normal) rub = copysign(friction * normal, slip);
        flyer->rim += rub / q;
    }
    const double jx = normal * nx + rub * ny, jy = normal * ny - rub * nx;
    flyer->vx += jx;
    flyer->vy += jy;
    if (wall->body != WALL_NONE) {
        give_to_body(flyer, wall, nearest, -dsmc->mass * jx, -dsmc->mass * jy);
    }
    const double *g = dsmc->scene->gravity;
    flyer->carried |= nx * g[0] + ny * g[1] < -carries_cosine * hypot(g[0], g[1]);
}

struct touch { uint32_t entry; struct wall_nearest nearest; double overlap; };

/* The wall that it overlaps most; false if none.  Lessens `room` to the way to the nearest one. */
static bool deepest(const struct flyer *flyer, uint32_t cell, struct touch *touch, double *room)
{
    const struct dsmc *dsmc = flyer->dsmc;
    const struct dsmc_walls *walls = &dsmc->walls;
    touch->overlap = 0;
    for (uint32_t k = walls->first[cell]; k < walls->first[cell + 1]; k++) {
        const uint32_t entry = walls->near[k];
        if (!walls->here[entry / IMAGES]) continue;
        const struct wall_nearest nearest = nearest_of(dsmc, entry, flyer->x, flyer->y);
        const double overlap = dsmc->radius - nearest.distance;
        *room = fmin(*room, fmax(0, -overlap));
        if (overlap > touch->overlap) *touch = (struct touch){entry, nearest, overlap};
    }
    return touch->overlap > 0;
}

/* Out of every wall that it overlaps, bouncing if `bounces`: where two pieces of a flat wall meet
 * the nearer one is met, not the end of the other.  Returns how far it may go before it can touch
 * one. */
static double leave_walls(struct flyer *flyer, bool bounces)
{
    const struct dsmc *dsmc = flyer->dsmc;
    const uint32_t cell = dsmc_walls_cell(dsmc, (float)flyer->x, (float)flyer->y);
    double room = (double)dsmc->walls.stride;
    struct touch touch;
    for (int round = 0; round < ROUNDS_MAX && deepest(flyer, cell, &touch, &room); round++) {
        const struct wall_nearest *nearest = &touch.nearest;
        const struct wall *wall = &dsmc->walls.now[touch.entry / IMAGES];
        const double restitution = 0.5 * (dsmc->restitution
            + dsmc->scene->species[wall->species].restitution);
        const double vn = flyer->vx * nearest->nx + flyer->vy * nearest->ny;
        double back = touch.overlap;
        if (bounces && vn < 0) back += fmin(restitution * touch.overlap, 0.25 * dsmc->radius);
        if (bounces) bounce(flyer, wall, nearest, restitution);
        flyer->x += back * nearest->nx;
        flyer->y += back * nearest->ny;
    }
    return room;
}

bool dsmc_walls_fly(struct dsmc *dsmc, uint32_t i, float time, uint32_t block)
{
    struct dsmc_grain *grain = &dsmc->grains[i];
    const double *g = dsmc->scene->gravity, half = 0.5 * (double)time;
    struct flyer flyer = {.dsmc = dsmc, .i = i, .block = block,
        .x = (double)grain->x, .y = (double)grain->y,
        .vx = (double)grain->vx + half * g[0], .vy = (double)grain->vy + half * g[1],
        .rim = dsmc->spins ? (double)dsmc->spins[i] : 0};
    double left = (double)time;
    double room = leave_walls(&flyer, true);
    for (int look = 0; look < LOOKS_MAX && left > 0; look++) {
        const double speed = hypot(flyer.vx, flyer.vy);
        const double go = fmin(left, (room + 0.5 * dsmc->radius) / fmax(speed, 1e-300));
        flyer.x += go * flyer.vx;
        flyer.y += go * flyer.vy;
        left -= go;
        room = leave_walls(&flyer, true);
    }
    grain->x = (float)flyer.x;
    grain->y = (float)flyer.y;
    grain->vx = (float)(flyer.vx + half * g[0]);
    grain->vy = (float)(flyer.vy + half * g[1]);
    if (dsmc->spins) dsmc->spins[i] = (float)flyer.rim;
    return flyer.carried;
}

void dsmc_walls_slide(const struct dsmc *dsmc, struct dsmc_grain *grain, float dx, float dy)
{
    struct flyer flyer = {.dsmc = (struct dsmc *)(uintptr_t)dsmc, .x = (double)grain->x,
                          .y = (double)grain->y};
    const double way = hypot((double)dx, (double)dy);
    double left = way, room = leave_walls(&flyer, false);
    for (int look = 0; look < LOOKS_MAX && left > 0; look++) {
        const double go = fmin(left, room + 0.5 * dsmc->radius);
        flyer.x += go / way * (double)dx;
        flyer.y += go / way * (double)dy;
        left -= go;
        room = leave_walls(&flyer, false);
    }
    grain->x = (float)flyer.x;
    grain->y = (float)flyer.y;
}

bool dsmc_walls_carries(const struct dsmc *dsmc, const struct dsmc_grain *grain)
{
    const struct dsmc_walls *walls = &dsmc->walls;
    if (!walls->first) return false;
    const uint32_t cell = dsmc_walls_cell(dsmc, grain->x, grain->y);
    const double *g = dsmc->scene->gravity, weight = hypot(g[0], g[1]);
    for (uint32_t k = walls->first[cell]; k < walls->first[cell + 1]; k++) {
        if (!walls->here[walls->near[k] / IMAGES]) continue;
        const struct wall_nearest n = nearest_of(dsmc, walls->near[k], (double)grain->x,
                                                 (double)grain->y);
        if (n.distance < 1.3 * dsmc->radius
            && n.nx * g[0] + n.ny * g[1] < -carries_cosine * weight) return true;
    }
    return false;
}

bool dsmc_walls_clear(const struct dsmc *dsmc, const struct dsmc_grain *grain, double x, double y)
{
    const struct dsmc_walls *walls = &dsmc->walls;
    const uint32_t cell = dsmc_walls_cell(dsmc, (float)x, (float)y);
    for (uint32_t k = walls->first[cell]; k < walls->first[cell + 1]; k++) {
        if (!walls->here[walls->near[k] / IMAGES]) continue;
        const struct wall_nearest there = nearest_of(dsmc, walls->near[k], x, y);
        const struct wall_nearest here = nearest_of(dsmc, walls->near[k], (double)grain->x,
                                                    (double)grain->y);
        if (there.distance < 0.95 * dsmc->radius) return false;
        if (there.nx * here.nx + there.ny * here.ny < 0) return false;
    }
    return true;
}

void dsmc_walls_collect(struct dsmc *dsmc)
{
    const uint32_t bodies = dsmc->scene->obstacle_count;
    if (!dsmc->walls.sums) return;
    for (uint32_t k = 0; k < dsmc->blocks; k++) {
        for (uint32_t b = 0; b < bodies; b++) {
            struct tally_body *sum = &dsmc->walls.sums[(size_t)k * bodies + b];
            struct tally_body *all = &dsmc->tally.bodies[b];
            all->impulse_x += sum->impulse_x;
            all->impulse_y += sum->impulse_y;
            all->angular_impulse += sum->angular_impulse;
            all->contacts += sum->contacts;
            *sum = (struct tally_body){0};
        }
    }
}
