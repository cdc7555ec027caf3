/* tally.c - see tally.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/tally.h"

#include "model/field.h"

#include <math.h>
#include <stdio.h>

static bool stress_create(struct tally_stress *stress, const struct scene *scene,
                          struct arena *arena)
{
    double nx, ny;
    const double cell = field_cells(scene, &scene->measure, &nx, &ny);
    if (!(nx * ny <= FIELD_CELLS_MAX)) return true;     /* a map of such a grid is refused, too */
    *stress = (struct tally_stress){
        .nx = (uint32_t)nx, .ny = (uint32_t)ny, .x0 = scene->box[0], .y0 = scene->box[1],
        .cell = cell, .per_cell = 1 / cell,
        .lx = scene->left == BORDER_PERIODIC ? scene->box[2] - scene->box[0] : 0,
        .ly = scene->bottom == BORDER_PERIODIC ? scene->box[3] - scene->box[1] : 0};
    return arena_array(arena, &stress->cells, 4 * (size_t)stress->nx * stress->ny);
}

bool tally_create(struct tally *tally, const struct scene *scene, struct arena *arena)
{
    *tally = (struct tally){.body_count = scene->obstacle_count,
                            .screen_count = scene->screen_count};
    bool done = arena_array(arena, &tally->bodies, tally->body_count)
             && arena_array(arena, &tally->screens, tally->screen_count);
    for (uint32_t k = 0; done && k < tally->screen_count; k++) {
        struct tally_screen *screen = &tally->screens[k];
        screen->bins = scene->screens[k].bins;
        done = arena_array(arena, &screen->count, screen->bins)
            && arena_array(arena, &screen->mass, screen->bins)
            && arena_array(arena, &screen->momentum, screen->bins)
            && arena_array(arena, &screen->spin, screen->bins)
            && arena_array(arena, &screen->energy, screen->bins);
    }
    if (done && scene->effects & EFFECT_IMPACT) {
        tally->impact.bins = scene->measure.impact_bins > 0 ? scene->measure.impact_bins : 1;
        done = arena_array(arena, &tally->impact.count, tally->impact.bins);
    }
    return done && (!(scene->effects & EFFECT_STRESS)
                    || stress_create(&tally->stress, scene, arena));
}

static bool is_behind(const struct screen *screen, double x, double y)
{
    if (screen->kind == SCREEN_LINE) return x > screen->x;
    return hypot(x - screen->center[0], y - screen->center[1]) > screen->radius;
}

bool tally_cross(struct tally *tally, const struct scene *scene, double t, double x, double y,
                 double vx, double vy, double spin, double mass, double inertia)
{
    for (uint32_t k = 0; k < tally->screen_count; k++) {
        const struct screen *screen = &scene->screens[k];
        if (!is_behind(screen, x, y)) continue;
        if (t < screen->from) return true;
        struct tally_screen *sums = &tally->screens[k];
        const double turn = atan2(y - screen->center[1], x - screen->center[0]) / (2 * M_PI) + 0.5;
        const uint32_t bin = (uint32_t)(turn * sums->bins) % sums->bins;
        sums->count[bin] += 1;
        sums->mass[bin] += mass;
        sums->momentum[bin] += mass * hypot(vx, vy);
        sums->spin[bin] += inertia * spin;
        sums->energy[bin] += 0.5 * mass * (vx * vx + vy * vy) + 0.5 * inertia * spin * spin;
        return true;
    }
    return false;
}

/* The cell of a coordinate, brought back into a periodic box. */
static uint32_t cell_of(double x, double low, double period, double per_cell, uint32_t count)
{
    double way = x - low;
    if (period > 0) way -= period * floor(way / period);
    const double place = way * per_cell;
    if (!(place > 0)) return 0;
    return place < count ? (uint32_t)place : count - 1;
}

void tally_contact(struct tally *tally, double x, double y, double rx, double ry, double px,
                   double py)
{
    struct tally_stress *stress = &tally->stress;
    if (!stress->cells) return;
    const uint32_t cx = cell_of(x, stress->x0, stress->lx, stress->per_cell, stress->nx),
                   cy = cell_of(y, stress->y0, stress->ly, stress->per_cell, stress->ny);
    double *cell = stress->cells + 4 * ((size_t)cy * stress->nx + cx);
    const double sums[4] = {rx * px, rx * py, ry * px, ry * py};
    for (int k = 0; k < 4; k++) {
        cell[k] += sums[k];
        stress->total[k] += sums[k];
    }
}

void tally_archive(struct tally *tally, struct archive *archive)
{
    archive_array(archive, "tally.bodies", tally->bodies, tally->body_count);
    archive_value(archive, "tally.mass_in", &tally->mass_in);
    archive_value(archive, "tally.mass_out", &tally->mass_out);
    archive_array(archive, "tally.impact", tally->impact.count, tally->impact.bins);
    const size_t cells = (size_t)tally->stress.nx * tally->stress.ny;
    archive_array(archive, "tally.stress", tally->stress.cells, 4 * cells);
    archive_array(archive, "tally.stress_total", cells > 0 ? tally->stress.total : NULL,
                  4);
    for (uint32_t k = 0; k < tally->screen_count; k++) {
        struct tally_screen *screen = &tally->screens[k];
        double *const sums[] = {screen->count, screen->mass, screen->momentum, screen->spin,
                                screen->energy};
        for (size_t s = 0; s < sizeof sums / sizeof *sums; s++) {
            char name[48];
            snprintf(name, sizeof name, "tally.screen.%u.%zu", k, s);
            archive_array(archive, name, sums[s], screen->bins);
        }
    }
}
