/* hard_look.c - see hard_look.h.
 *
 * Overlaps are found on a grid of cells as wide as the largest grain; a pair may be met twice in a
 * narrow periodic box, which does not change the largest.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/hard_look.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const uint32_t nobody = UINT32_MAX;

static double total(const struct counters *c)
{
    return c->kinetic_energy + c->rotational_energy + c->potential_energy;
}

static double mass_of(const struct grains *grains)
{
    double mass = 0;
    for (uint32_t k = 0; k < grains->count; k++) mass += grains->mass[k];
    return mass;
}

bool hard_look_take(struct hard_look *look, const struct simulation *sim, struct error *error)
{
    look->scene = sim->phase_scene;
    look->counters = simulation_count(sim);
    const uint64_t count = look->counters.grains;
    if (count > UINT32_MAX / 2) return error_set(error, "more grains than a look can hold");
    if (look->grains.capacity < count + 1) {
        grains_free(&look->grains);
        if (!grains_create(&look->grains, (uint32_t)count + 1, 0, error)) return false;
    }
    look->grains.window[0] = 1;         /* the whole world */
    look->grains.window[2] = -1;
    simulation_observe(sim, &look->grains);
    const struct counters *c = &look->counters;
    const double moving = c->kinetic_energy + c->rotational_energy;
    look->motion = fmax(look->motion, moving + fmax(0, look->first.potential_energy
                                                       - c->potential_energy));
    /* Where nothing moves a fall by a diameter is what energies are compared with. */
    const double *g = look->scene->gravity, d = 2 * look->scene->radius_mean;
    look->motion = fmax(look->motion, mass_of(&look->grains) * hypot(g[0], g[1]) * d);
    return true;
}

bool hard_look_begin(struct hard_look *look, const struct simulation *sim, struct error *error)
{
    *look = (struct hard_look){.scene = sim->scene};
    look->first = simulation_count(sim);
    if (!hard_look_take(look, sim, error)) return false;
    look->energy_least = total(&look->first);
    look->momentum_scale = sqrt(2 * mass_of(&look->grains) * look->first.kinetic_energy);
    for (uint32_t k = 0; k < look->grains.count; k++) {
        if (look->grains.id[k] >= look->start_count) look->start_count = look->grains.id[k] + 1;
    }
    const size_t room = look->start_count + 1;
    look->start_x = malloc(room * sizeof *look->start_x);
    look->start_y = malloc(room * sizeof *look->start_y);
    if (!look->start_x || !look->start_y) return error_set(error, "not enough memory");
    for (uint32_t k = 0; k < look->start_count; k++) look->start_x[k] = NAN;
    for (uint32_t k = 0; k < look->grains.count; k++) {
        look->start_x[look->grains.id[k]] = look->grains.x[k];
        look->start_y[look->grains.id[k]] = look->grains.y[k];
    }
    return true;
}

void hard_look_end(struct hard_look *look)
{
    grains_free(&look->grains);
    free(look->start_x);
    free(look->start_y);
    look->start_x = look->start_y = NULL;
}

/* ---- sums ---------------------------------------------------------------------------------- */

static double share(double change, double scale)
{
    return change == 0 ? 0 : change / scale;            /* a change of nothing is infinite */
}

double hard_look_energy_rise(struct hard_look *look)
{
    const double now = total(&look->counters), rise = now - look->energy_least;
    look->energy_least = fmin(look->energy_least, now);
    return share(fmax(rise, 0), look->motion);
}

double hard_look_energy_change(const struct hard_look *look)
{
    return share(fabs(total(&look->counters) - total(&look->first)), look->motion);
}

double hard_look_momentum_change(const struct hard_look *look)
{
    const struct counters *now = &look->counters, *first = &look->first;
    return share(hypot(now->momentum_x - first->momentum_x, now->momentum_y - first->momentum_y),
                 look->momentum_scale);
}

double hard_look_loss(const struct hard_look *look)
{
    const struct counters *now = &look->counters, *first = &look->first;
    const double whole = (double)(first->grains + now->grains_in - first->grains_in);
    const double here = (double)(now->grains + now->grains_out - first->grains_out);
    const double seen = (double)look->grains.count - (double)now->grains;
    return share(fabs(here - whole) + fabs(seen), fmax(whole, 1));
}

/* The nearest image of a difference in a periodic box. */
static double nearest_image(double difference, double period)
{
    return period > 0 ? difference - period * round(difference / period) : difference;
}

static void periods(const struct scene *scene, double period[2])
{
    const double *box = scene->box;
    period[0] = scene->left == BORDER_PERIODIC ? box[2] - box[0] : 0;
    period[1] = scene->bottom == BORDER_PERIODIC ? box[3] - box[1] : 0;
}

double hard_look_travel(const struct hard_look *look)
{
    const struct grains *g = &look->grains;
    double period[2], sum = 0;
    uint32_t count = 0;
    periods(look->scene, period);
    for (uint32_t k = 0; k < g->count; k++) {
        const uint32_t id = g->id[k];
        if (id >= look->start_count || isnan(look->start_x[id])) continue;
        sum += hypot(nearest_image(g->x[k] - look->start_x[id], period[0]),
                     nearest_image(g->y[k] - look->start_y[id], period[1]));
        count++;
    }
    return count > 0 ? sum / count / (2 * look->scene->radius_mean) : 0;
}

/* ---- grains to blame ----------------------------------------------------------------------- */

static struct hard_blame blame(const struct grains *grains, uint32_t k, double value)
{
    return (struct hard_blame){.value = value, .grain = grains->id[k], .x = grains->x[k],
                                 .y = grains->y[k]};
}

struct hard_blame hard_look_broken_number(const struct hard_look *look)
{
    const struct grains *g = &look->grains;
    for (uint32_t k = 0; k < g->count; k++) {
        const double sum = g->x[k] + g->y[k] + g->vx[k] + g->vy[k] + g->spin[k] + g->angle[k];
        if (!isfinite(sum)) return blame(g, k, INFINITY);
    }
    return (struct hard_blame){0};
}

struct hard_blame hard_look_fastest(const struct hard_look *look)
{
    const struct grains *g = &look->grains;
    struct hard_blame worst = {0};
    for (uint32_t k = 0; k < g->count; k++) {
        const double speed = hypot(g->vx[k], g->vy[k]);
        if (speed > worst.value) worst = blame(g, k, speed);
    }
    return worst;
}

struct hard_blame hard_look_outside(const struct hard_look *look)
{
    const struct scene *scene = look->scene;
    const struct grains *g = &look->grains;
    const double *box = scene->box, *within = scene->hard.within, far = INFINITY;
    double limits[4] = {
        scene->left == BORDER_WALL ? box[0] : -far, scene->bottom == BORDER_WALL ? box[1] : -far,
        scene->right == BORDER_WALL ? box[2] : far, scene->top == BORDER_WALL ? box[3] : far,
    };
    for (int s = 0; s < 4 && isfinite(within[s]); s++) limits[s] = within[s];
    struct hard_blame worst = {0};
    for (uint32_t k = 0; k < g->count; k++) {
        const double out = fmax(fmax(limits[0] - g->x[k], g->x[k] - limits[2]),
                                fmax(limits[1] - g->y[k], g->y[k] - limits[3])) / g->radius[k];
        if (out > worst.value) worst = blame(g, k, out);
    }
    return worst;
}

/* ---- overlaps ------------------------------------------------------------------------------ */

struct grid {
    uint32_t nx, ny;
    double   x0, y0, per_x, per_y, period[2];
    uint32_t *head, *next;      /* the first grain of each cell, and the one after each grain */
};

static uint32_t cell_along(double x, double x0, double per, uint32_t n)
{
    const double k = floor((x - x0) * per);
    return k < 0 ? 0 : k >= n ? n - 1 : (uint32_t)k;
}

static uint32_t cell_of(const struct grid *grid, const struct grains *g, uint32_t k)
{
    return cell_along(g->y[k], grid->y0, grid->per_y, grid->ny) * grid->nx
         + cell_along(g->x[k], grid->x0, grid->per_x, grid->nx);
}

static bool grid_make(struct grid *grid, const struct scene *scene, const struct grains *g)
{
    double widest = 0;
    for (uint32_t k = 0; k < g->count; k++) widest = fmax(widest, 2 * g->radius[k]);
    const double *box = scene->box, width = box[2] - box[0], height = box[3] - box[1];
    const double most = 1000;           /* cells along a side: enough for a hundred thousand */
    periods(scene, grid->period);
    grid->x0 = box[0];
    grid->y0 = box[1];
    grid->nx = (uint32_t)fmax(1, fmin(most, floor(width / widest)));
    grid->ny = (uint32_t)fmax(1, fmin(most, floor(height / widest)));
    grid->per_x = grid->nx / width;
    grid->per_y = grid->ny / height;
    const size_t cells = (size_t)grid->nx * grid->ny;
    grid->head = malloc(cells * sizeof *grid->head);
    grid->next = malloc((g->count + 1) * sizeof *grid->next);
    if (!grid->head || !grid->next) return false;
    for (size_t c = 0; c < cells; c++) grid->head[c] = nobody;
    for (uint32_t k = 0; k < g->count; k++) {
        const uint32_t cell = cell_of(grid, g, k);
        grid->next[k] = grid->head[cell];
        grid->head[cell] = k;
    }
    return true;
}

static void compare_pair(const struct grid *grid, const struct grains *g, uint32_t a, uint32_t b,
                         struct hard_blame *worst)
{
    const double dx = nearest_image(g->x[a] - g->x[b], grid->period[0]);
    const double dy = nearest_image(g->y[a] - g->y[b], grid->period[1]);
    const double overlap = (g->radius[a] + g->radius[b] - hypot(dx, dy))
                         / fmin(g->radius[a], g->radius[b]);
    if (overlap <= worst->value) return;
    *worst = blame(g, a, overlap);
    snprintf(worst->with, sizeof worst->with, "grain %u", g->id[b]);
}

static void compare_around(const struct grid *grid, const struct grains *g, uint32_t a,
                           struct hard_blame *worst)
{
    const uint32_t cell = cell_of(grid, g, a), cx = cell % grid->nx, cy = cell / grid->nx;
    for (uint32_t row = 0; row < 3; row++) {
        for (uint32_t column = 0; column < 3; column++) {
            /* Unsigned arithmetic: the cell before the first is beyond the last. */
            uint32_t x = cx + column - 1, y = cy + row - 1;
            if (grid->period[0] > 0) x = (x + grid->nx) % grid->nx;
            if (grid->period[1] > 0) y = (y + grid->ny) % grid->ny;
            if (x >= grid->nx || y >= grid->ny) continue;
            for (uint32_t b = grid->head[y * grid->nx + x]; b != nobody; b = grid->next[b]) {
                if (b < a) compare_pair(grid, g, a, b, worst);
            }
        }
    }
}

/* Grains and the walls that are there now. */
static void compare_walls(const struct hard_look *look, struct hard_blame *worst)
{
    const struct grains *g = &look->grains;
    for (uint32_t w = 0; w < look->scene->wall_count; w++) {
        const struct wall *wall = &look->scene->walls[w];
        if (!wall_present(wall, g->time)) continue;
        const struct wall now = wall_at(wall, g->time);
        for (uint32_t k = 0; k < g->count; k++) {
            const double distance = wall_nearest(&now, g->x[k], g->y[k]).distance;
            const double overlap = 1 - distance / g->radius[k];
            if (overlap <= worst->value) continue;
            *worst = blame(g, k, overlap);
            snprintf(worst->with, sizeof worst->with, "wall %u", w);
        }
    }
}

struct hard_blame hard_look_overlap(const struct hard_look *look)
{
    struct hard_blame worst = {0};
    struct grid grid = {0};
    const struct grains *g = &look->grains;
    if (g->count > 0 && grid_make(&grid, look->scene, g)) {
        for (uint32_t k = 0; k < g->count; k++) compare_around(&grid, g, k, &worst);
    }
    const bool blind = g->count > 0 && !grid.next;
    free(grid.head);
    free(grid.next);
    compare_walls(look, &worst);
    if (blind) worst = (struct hard_blame){.value = INFINITY, .with = "(not enough memory)"};
    return worst;
}
