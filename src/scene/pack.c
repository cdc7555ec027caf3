/* pack.c - see pack.h.
 *
 * The discs are soft springs in a weak heat bath while their radii grow to the wanted size, so
 * that they find room as real grains do when a box is shaken; then the bath is taken away and
 * FIRE (Bitzek et al., Phys. Rev. Lett. 97, 170201 (2006)) takes out what overlaps.  All radii
 * are a little too large in this (MARGIN), so once the remaining overlaps are below it, the true
 * discs do not overlap at all.  If they jam, they are shaken again, longer; the number of tries
 * and of steps is bounded.  Unit of length: the mean diameter; mass and stiffness are 1.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scene/pack.h"

#include "base/arena.h"
#include "base/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MARGIN 2e-5             /* relative; costs 4e-5 of the area fraction */
#define STEP 0.25               /* of time; a contact of two discs lasts pi/sqrt(2) = 2.2 */
#define HEAT 1e-3               /* kT while shaking: overlaps of about 3 % of a diameter */
#define SKIN 0.3                /* of the list of neighbours */
#define LOOSE 0.6               /* below this area fraction there is no need to shake for long */
#define HOPELESS 3e-3           /* an overlap that a third of the relaxation has not removed */
#define START 0.75              /* of their final size, discs begin */

enum { LOOSE_STEPS = 400, DENSE_STEPS = 2000, RELAX_STEPS = 3000, TRIES = 5 };

struct pair { uint32_t i, j; };

struct packing {
    struct pack *pack;
    struct arena arena;
    uint32_t all;               /* count + fixed */
    double  unit, scale;        /* mean diameter; of the radii now */
    double *x, *y, *vx, *vy, *fx, *fy, *radius, *x_listed, *y_listed;
    uint32_t pair_count, pair_capacity, touch_count, touch_capacity;
    struct pair *pairs;         /* discs that may meet */
    struct pair *touches;       /* disc i and side or wall j that may meet; sides come first */
    double  width, height, overlap_max;
    bool    wraps_x, wraps_y;
};

/* ---- lists --------------------------------------------------------------------------------- */

static bool list_add(struct pair **list, uint32_t *count, uint32_t *capacity, uint32_t i,
                     uint32_t j)
{
    if (*count == *capacity) {
        const uint32_t larger = *capacity ? 2 * *capacity : 65536;
        struct pair *grown = realloc(*list, larger * sizeof *grown);
        if (!grown) return false;
        *list = grown;
        *capacity = larger;
    }
    (*list)[(*count)++] = (struct pair){i, j};
    return true;
}

/* Discs stay within a box length of where they began until they are wrapped at the end, hence two
 * comparisons instead of a division and a rounding. */
static double nearest_image(double d, double length)
{
    while (d > 0.5 * length) d -= length;
    while (d < -0.5 * length) d += length;
    return d;
}

static void apart(const struct packing *p, uint32_t i, uint32_t j, double *dx, double *dy)
{
    *dx = p->x[i] - p->x[j];
    *dy = p->y[i] - p->y[j];
    if (p->wraps_x) *dx = nearest_image(*dx, p->width);
    if (p->wraps_y) *dy = nearest_image(*dy, p->height);
}

struct cells { uint32_t nx, ny, *first, *next; double x0, y0, wx, wy; };

static uint32_t cell_index(double x, double x0, double width, uint32_t count, bool wraps)
{
    double k = floor((x - x0) / width);
    if (wraps) k -= count * floor(k / count);
    return (uint32_t)fmin(fmax(k, 0), count - 1.0);
}

static bool cells_fill(struct packing *p, struct cells *cells)
{
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY, radius_max = 0;
    for (uint32_t i = 0; i < p->all; i++) {
        x0 = fmin(x0, p->x[i]);
        x1 = fmax(x1, p->x[i]);
        y0 = fmin(y0, p->y[i]);
        y1 = fmax(y1, p->y[i]);
        radius_max = fmax(radius_max, p->radius[i]);
    }
    if (p->wraps_x) x0 = p->pack->box[0] / p->unit, x1 = x0 + p->width;
    if (p->wraps_y) y0 = p->pack->box[1] / p->unit, y1 = y0 + p->height;
    const double reach = 2 * radius_max * (1 + MARGIN) + SKIN;
    const double most = 4 * sqrt(p->all) + 16;          /* a long thin region needs no more */
    cells->x0 = x0;
    cells->y0 = y0;
    cells->nx = (uint32_t)fmin(fmax(floor((x1 - x0) / reach), 1), 16 * most);
    cells->ny = (uint32_t)fmin(fmax(floor((y1 - y0) / reach), 1), 16 * most);
    if ((double)cells->nx * cells->ny > most * most) {
        cells->nx = (uint32_t)fmin(cells->nx, most);
        cells->ny = (uint32_t)fmin(cells->ny, most);
    }
    cells->wx = fmax((x1 - x0) / cells->nx, 1e-300);
    cells->wy = fmax((y1 - y0) / cells->ny, 1e-300);
    cells->first = calloc((size_t)cells->nx * cells->ny, sizeof *cells->first);
    cells->next = calloc(p->all, sizeof *cells->next);
    if (!cells->first || !cells->next) return false;
    for (uint32_t i = p->all; i-- > 0;) {
        const uint32_t c = cell_index(p->y[i], y0, cells->wy, cells->ny, p->wraps_y) * cells->nx
                         + cell_index(p->x[i], x0, cells->wx, cells->nx, p->wraps_x);
        cells->next[i] = cells->first[c];
        cells->first[c] = i + 1;
    }
    return true;
}

/* The different cells at and around `k` along one axis: no cell twice when there are few. */
static uint32_t around(uint32_t k, uint32_t count, bool wraps, uint32_t cells[3])
{
    uint32_t n = 0;
    for (int step = -1; step <= 1; step++) {
        const int64_t c = (int64_t)k + step;
        const bool out = c < 0 || c >= count;
        if (out && (!wraps || count < 3)) continue;
        cells[n++] = (uint32_t)((c + count) % count);
    }
    return n;
}

static bool list_neighbours(struct packing *p, const struct cells *cells, uint32_t i)
{
    const bool wx = p->wraps_x, wy = p->wraps_y;
    uint32_t columns[3], rows[3];
    const uint32_t nc = around(cell_index(p->x[i], cells->x0, cells->wx, cells->nx, wx), cells->nx,
                               wx, columns);
    const uint32_t nr = around(cell_index(p->y[i], cells->y0, cells->wy, cells->ny, wy), cells->ny,
                               wy, rows);
    for (uint32_t k = 0; k < nr * nc; k++) {
        const uint32_t cell = rows[k / nc] * cells->nx + columns[k % nc];
        for (uint32_t j1 = cells->first[cell]; j1; j1 = cells->next[j1 - 1]) {
            const uint32_t j = j1 - 1;
            double dx, dy;
            if (j <= i) continue;
            apart(p, i, j, &dx, &dy);
            const double reach = (p->radius[i] + p->radius[j]) * (1 + MARGIN) + SKIN;
            if (dx * dx + dy * dy >= reach * reach) continue;
            if (!list_add(&p->pairs, &p->pair_count, &p->pair_capacity, i, j)) return false;
        }
    }
    return true;
}

static struct wall piece(const struct packing *p, uint32_t k)
{
    const struct pack *pack = p->pack;
    return k < pack->side_count ? pack->sides[k] : pack->walls[k - pack->side_count];
}

/* Where disc i is nearest to side or wall k.  Outside of a side the distance is negative and the
 * normal still points inwards. */
static struct wall_nearest nearest_piece(const struct packing *p, uint32_t i, uint32_t k)
{
    const struct wall wall = piece(p, k);
    struct wall_nearest near = wall_nearest(&wall, p->x[i] * p->unit, p->y[i] * p->unit);
    near.distance /= p->unit;
    if (k >= p->pack->side_count || near.end != 0) return near;
    const double left = (wall.x1 - wall.x0) * near.ny - (wall.y1 - wall.y0) * near.nx;
    if (left < 0) near = (struct wall_nearest){-near.nx, -near.ny, -near.distance, 0};
    return near;
}

static bool lists_build(struct packing *p)
{
    struct cells cells = {0};
    bool done = cells_fill(p, &cells);
    p->pair_count = p->touch_count = 0;
    const uint32_t pieces = p->pack->side_count + p->pack->wall_count;
    for (uint32_t i = 0; done && i < p->pack->count; i++) {
        done = list_neighbours(p, &cells, i);
        for (uint32_t k = 0; done && k < pieces; k++) {
            if (nearest_piece(p, i, k).distance > p->radius[i] * (1 + MARGIN) + SKIN) continue;
            done = list_add(&p->touches, &p->touch_count, &p->touch_capacity, i, k);
        }
    }
    memcpy(p->x_listed, p->x, p->all * sizeof *p->x);
    memcpy(p->y_listed, p->y, p->all * sizeof *p->y);
    free(cells.first);
    free(cells.next);
    return done;
}

static bool lists_renew(struct packing *p)
{
    double most = 0;
    for (uint32_t i = 0; i < p->pack->count; i++) {
        const double dx = p->x[i] - p->x_listed[i], dy = p->y[i] - p->y_listed[i];
        most = fmax(most, dx * dx + dy * dy);
    }
    return most < 0.25 * SKIN * SKIN || lists_build(p);
}

/* ---- forces -------------------------------------------------------------------------------- */

static void forces(struct packing *p)
{
    const double scale = p->scale;
    memset(p->fx, 0, p->all * sizeof *p->fx);
    memset(p->fy, 0, p->all * sizeof *p->fy);
    p->overlap_max = 0;
    for (uint32_t k = 0; k < p->pair_count; k++) {
        const uint32_t i = p->pairs[k].i, j = p->pairs[k].j;
        const double reach = scale * (p->radius[i] + p->radius[j]);
        double dx, dy;
        apart(p, i, j, &dx, &dy);
        const double d2 = dx * dx + dy * dy;
        if (d2 >= reach * reach) continue;
        const double d = sqrt(d2), overlap = reach - d;
        p->overlap_max = fmax(p->overlap_max, overlap / reach);
        const double nx = d > 0 ? dx / d : 1, ny = d > 0 ? dy / d : 0;
        p->fx[i] += overlap * nx;
        p->fy[i] += overlap * ny;
        p->fx[j] -= overlap * nx;
        p->fy[j] -= overlap * ny;
    }
    for (uint32_t k = 0; k < p->touch_count; k++) {
        const uint32_t i = p->touches[k].i;
        const struct wall_nearest near = nearest_piece(p, i, p->touches[k].j);
        const double overlap = scale * p->radius[i] - near.distance;
        if (overlap <= 0) continue;
        p->overlap_max = fmax(p->overlap_max, overlap / (scale * p->radius[i]));
        p->fx[i] += 2 * overlap * near.nx;      /* a wall yields half as much as a disc */
        p->fy[i] += 2 * overlap * near.ny;
    }
}

static void wrap(struct packing *p)
{
    const double x0 = p->pack->box[0] / p->unit, y0 = p->pack->box[1] / p->unit;
    for (uint32_t i = 0; i < p->pack->count; i++) {
        if (p->wraps_x) p->x[i] -= p->width * floor((p->x[i] - x0) / p->width);
        if (p->wraps_y) p->y[i] -= p->height * floor((p->y[i] - y0) / p->height);
    }
}

/* Velocities first, then positions; no disc moves farther than a tenth of a diameter. */
static void move(struct packing *p, double dt)
{
    for (uint32_t i = 0; i < p->pack->count; i++) {
        p->vx[i] += p->fx[i] * dt;
        p->vy[i] += p->fy[i] * dt;
        const double speed = sqrt(p->vx[i] * p->vx[i] + p->vy[i] * p->vy[i]);
        const double share = speed * dt > 0.1 ? 0.1 / (speed * dt) : 1;
        p->x[i] += share * p->vx[i] * dt;
        p->y[i] += share * p->vy[i] * dt;
    }
}

/* ---- shaking and relaxing ------------------------------------------------------------------ */

static void heat(struct packing *p, double temperature)
{
    double energy = 0;
    const uint32_t count = p->pack->count;
    for (uint32_t i = 0; i < count; i++) energy += p->vx[i] * p->vx[i] + p->vy[i] * p->vy[i];
    const double now = energy / (2.0 * count);
    const double factor = now > 0 ? sqrt(temperature / now) : 1;
    for (uint32_t i = 0; i < count; i++) {
        p->vx[i] *= factor;
        p->vy[i] *= factor;
    }
}

static void set_off(struct packing *p, uint64_t round)
{
    struct rng rng = rng_stream(p->pack->seed, 0x7061636b, round);
    for (uint32_t i = 0; i < p->pack->count; i++) {
        p->vx[i] = sqrt(HEAT) * rng_normal(&rng);
        p->vy[i] = sqrt(HEAT) * rng_normal(&rng);
    }
}

/* Radii grow from `from` to their full size; the heat goes down with what is left to grow. */
static bool shake(struct packing *p, double from, uint32_t steps, uint64_t round)
{
    set_off(p, round);
    for (uint32_t k = 0; k < steps; k++) {
        const double share = (double)k / steps, left = 1 - share;
        p->scale = (1 + MARGIN) * (from + (1 - from) * (1 - left * left));
        if (!lists_renew(p)) return false;
        forces(p);
        move(p, STEP);
        if (k % 4 == 0) heat(p, HEAT * left * left);
    }
    return true;
}

/* FIRE at full size; true once no true disc overlaps. */
static bool relax(struct packing *p, bool *memory)
{
    double dt = STEP, mix = 0.1;
    uint32_t downhill = 0;
    p->scale = 1 + MARGIN;
    memset(p->vx, 0, p->all * sizeof *p->vx);
    memset(p->vy, 0, p->all * sizeof *p->vy);
    for (uint32_t k = 0; k < RELAX_STEPS; k++) {
        if (!lists_renew(p)) {
            *memory = true;
            return false;
        }
        forces(p);
        /* With radii R (1 + m), an overlap of m R (1 + m) leaves the true discs apart. */
        if (p->overlap_max < 0.9 * MARGIN) return true;
        if (k > RELAX_STEPS / 3 && p->overlap_max > HOPELESS) return false;
        double power = 0, ff = 0, vv = 0;
        for (uint32_t i = 0; i < p->pack->count; i++) {
            power += p->fx[i] * p->vx[i] + p->fy[i] * p->vy[i];
            ff += p->fx[i] * p->fx[i] + p->fy[i] * p->fy[i];
            vv += p->vx[i] * p->vx[i] + p->vy[i] * p->vy[i];
        }
        const double turn = power > 0 && ff > 0 ? mix * sqrt(vv / ff) : 0, keep = power > 0
            ? 1 - mix : 0;
        for (uint32_t i = 0; i < p->pack->count; i++) {
            p->vx[i] = keep * p->vx[i] + turn * p->fx[i];
            p->vy[i] = keep * p->vy[i] + turn * p->fy[i];
        }
        downhill = power > 0 ? downhill + 1 : 0;
        if (power <= 0) dt = fmax(0.5 * dt, 0.05), mix = 0.1;
        else if (downhill > 5) dt = fmin(1.1 * dt, 0.8), mix *= 0.99;
        move(p, dt);
    }
    return false;
}

/* ---- the whole ----------------------------------------------------------------------------- */

static bool packing_take(struct packing *p)
{
    const struct pack *pack = p->pack;
    double **const arrays[] = {&p->x, &p->y, &p->vx, &p->vy, &p->fx, &p->fy, &p->radius,
                               &p->x_listed, &p->y_listed};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        if (!arena_array(&p->arena, arrays[k], p->all)) return false;
    }
    for (uint32_t i = 0; i < pack->count; i++) p->unit += 2 * pack->radius[i] / pack->count;
    for (uint32_t i = 0; i < p->all; i++) {
        p->x[i] = pack->x[i] / p->unit;
        p->y[i] = pack->y[i] / p->unit;
        p->radius[i] = pack->radius[i] / p->unit;
    }
    p->width = (pack->box[2] - pack->box[0]) / p->unit;
    p->height = (pack->box[3] - pack->box[1]) / p->unit;
    p->wraps_x = pack->wraps_x;
    p->wraps_y = pack->wraps_y;
    return lists_build(p);
}

enum pack_outcome pack_solve(struct pack *pack, double *scale)
{
    struct packing p = {.pack = pack, .all = pack->count + pack->fixed};
    enum pack_outcome outcome = PACK_JAMMED;
    bool memory = !packing_take(&p);
    *scale = 0;
    for (uint32_t round = 0; round < TRIES && !memory && outcome == PACK_JAMMED; round++) {
        /* Later rounds loosen the packing a little and shake twice as long. */
        const double from = round ? 0.97 : START;
        const uint32_t steps = pack->fraction < LOOSE ? LOOSE_STEPS : DENSE_STEPS;
        memory = !shake(&p, from, steps << round, round);
        if (!memory && relax(&p, &memory)) outcome = PACK_DONE;
        if (!memory) *scale = fmax(*scale, (1 - p.overlap_max) * (1 + MARGIN));
    }
    wrap(&p);
    for (uint32_t i = 0; i < pack->count && !memory; i++) {
        pack->x[i] = p.x[i] * p.unit;
        pack->y[i] = p.y[i] * p.unit;
    }
    free(p.pairs);
    free(p.touches);
    arena_free(&p.arena);
    return memory ? PACK_MEMORY : outcome;
}
