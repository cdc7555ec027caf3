/* placer.c - see placer.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/placer.h"

#include "scene/place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Discs that touch but for rounding do not overlap. */
#define TOUCH (1 - 1e-10)

bool placer_take(struct placer *placer)
{
    const struct scene *scene = placer->scene;
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    const double most = 2000;                           /* cells along a side */
    placer->x0 = scene->box[0];
    placer->y0 = scene->box[1];
    placer->wraps_x = scene->left == BORDER_PERIODIC;
    placer->wraps_y = scene->bottom == BORDER_PERIODIC;
    placer->cell = fmax(2 * scene->radius_max, fmax(width, height) / most);
    /* Along a periodic side the last cell is wider, never narrower than the reach. */
    placer->nx = (uint32_t)fmax(floor(width / placer->cell), 1);
    placer->ny = (uint32_t)fmax(floor(height / placer->cell), 1);
    placer->first = calloc((size_t)placer->nx * placer->ny, sizeof *placer->first);
    placer->walls = calloc(scene->wall_count + 1, sizeof *placer->walls);
    if (!placer->first || !placer->walls) return false;
    for (uint32_t k = 0; k < scene->wall_count; k++) {
        if (!wall_present(&scene->walls[k], 0)) continue;
        placer->walls[placer->wall_count++] = wall_at(&scene->walls[k], 0);
    }
    return true;
}

void placer_free(struct placer *placer)
{
    struct placed *g = &placer->grains;
    double *const arrays[] = {g->x, g->y, g->vx, g->vy, g->spin, g->radius};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) free(arrays[k]);
    free(g->species);
    free(placer->next);
    free(placer->first);
    free(placer->walls);
}

static bool grow(struct placer *placer)
{
    if (placer->grains.count < placer->capacity) return true;
    const uint32_t capacity = placer->capacity ? 2 * placer->capacity : 4096;
    struct placed *g = &placer->grains;
    double **arrays[] = {&g->x, &g->y, &g->vx, &g->vy, &g->spin, &g->radius};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        double *larger = realloc(*arrays[k], capacity * sizeof *larger);
        if (!larger) return false;
        *arrays[k] = larger;
    }
    uint16_t *species = realloc(g->species, capacity * sizeof *species);
    if (species) g->species = species;
    uint32_t *next = realloc(placer->next, capacity * sizeof *next);
    if (next) placer->next = next;
    placer->capacity = species && next ? capacity : placer->capacity;
    return species && next;
}

static uint32_t cell_along(double x, double x0, double cell, uint32_t count)
{
    const double index = floor((x - x0) / cell);
    return index < 0 ? 0 : index >= count ? count - 1 : (uint32_t)index;
}

static uint32_t cell_of(const struct placer *placer, double x, double y)
{
    return cell_along(y, placer->y0, placer->cell, placer->ny) * placer->nx
         + cell_along(x, placer->x0, placer->cell, placer->nx);
}

bool placer_add(struct placer *placer, double x, double y, double radius, uint32_t species)
{
    if (!grow(placer)) return false;
    struct placed *g = &placer->grains;
    const uint32_t i = g->count++, cell = cell_of(placer, x, y);
    g->x[i] = x;
    g->y[i] = y;
    g->vx[i] = g->vy[i] = g->spin[i] = 0;
    g->radius[i] = radius;
    g->species[i] = (uint16_t)species;
    placer->next[i] = placer->first[cell];
    placer->first[cell] = i + 1;
    return true;
}

bool placer_is_taken(const struct placer *placer, double x, double y, double radius)
{
    const struct placed *g = &placer->grains;
    const double width = placer->scene->box[2] - placer->scene->box[0];
    const double height = placer->scene->box[3] - placer->scene->box[1];
    const int cx = (int)cell_along(x, placer->x0, placer->cell, placer->nx);
    const int cy = (int)cell_along(y, placer->y0, placer->cell, placer->ny);
    const int nx = (int)placer->nx, ny = (int)placer->ny;
    for (int k = 0; k < 9; k++) {
        int px = cx + k % 3 - 1, py = cy + k / 3 - 1;
        if (placer->wraps_x) px = (px + nx) % nx;
        if (placer->wraps_y) py = (py + ny) % ny;
        if (px < 0 || py < 0 || px >= nx || py >= ny) continue;
        for (uint32_t j = placer->first[py * nx + px]; j; j = placer->next[j - 1]) {
            double dx = x - g->x[j - 1], dy = y - g->y[j - 1];
            if (placer->wraps_x) dx -= width * rint(dx / width);
            if (placer->wraps_y) dy -= height * rint(dy / height);
            const double reach = (radius + g->radius[j - 1]) * TOUCH;
            if (dx * dx + dy * dy < reach * reach) return true;
        }
    }
    return false;
}

bool placer_meets_wall(const struct placer *placer, double x, double y, double radius)
{
    for (uint32_t k = 0; k < placer->wall_count; k++) {
        if (wall_nearest(&placer->walls[k], x, y).distance < radius * TOUCH) return true;
    }
    return false;
}

/* ---- the region of a placement ------------------------------------------------------------- */

struct region placer_region(const struct placer *placer, const struct placement *placement)
{
    const struct scene *scene = placer->scene;
    struct region region = {.outline = placement->outline.count ? &placement->outline : NULL};
    place_bounds(scene, placement, region.bounds);
    const double *b = region.bounds, *box = scene->box;
    region.free_x = placer->wraps_x && !region.outline && b[0] == box[0] && b[2] == box[2];
    region.free_y = placer->wraps_y && !region.outline && b[1] == box[1] && b[3] == box[3];
    return region;
}

static bool polygon_holds(const struct key_reals *outline, double x, double y, double radius)
{
    bool inside = false;
    for (uint32_t k = 0; k + 1 < outline->count; k += 2) {
        const double *p = &outline->values[k], *q = &outline->values[(k + 2) % outline->count];
        struct wall side = {.shape = WALL_SEGMENT, .x0 = p[0], .y0 = p[1], .x1 = q[0], .y1 = q[1]};
        if (wall_nearest(&side, x, y).distance < radius * TOUCH) return false;
        if ((p[1] > y) != (q[1] > y) && x < (q[0] - p[0]) * (y - p[1]) / (q[1] - p[1]) + p[0]) {
            inside = !inside;
        }
    }
    return inside;
}

bool placer_region_holds(const struct region *region, double x, double y, double radius)
{
    if (region->outline) return polygon_holds(region->outline, x, y, radius);
    const double *b = region->bounds, reach = radius * TOUCH;
    const double rx = region->free_x ? 0 : reach, ry = region->free_y ? 0 : reach;
    return x >= b[0] + rx && x <= b[2] - rx && y >= b[1] + ry && y <= b[3] - ry;
}

/* ---- random numbers ------------------------------------------------------------------------ */

double placer_radius(const struct species *species, uint64_t word)
{
    const double u = rng_unit(word);
    const uint32_t count = species->radii.count;
    if (count) return species->radii.values[(uint32_t)(u * count)];
    return species->radius[0] + u * (species->radius[1] - species->radius[0]);
}

uint64_t placer_word(const struct placer *placer, uint32_t stream, uint32_t placement,
                        uint64_t draw)
{
    return rng_keyed(placer->scene->seed, stream, placement, draw);
}
