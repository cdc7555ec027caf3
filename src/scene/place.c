/* place.c - see place.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/place.h"

#include "base/rng.h"
#include "scene/pack.h"
#include "scene/resolve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Streams of random numbers, so that one placement never shifts the numbers of another. */
/* Discs that touch but for rounding do not overlap. */
#define TOUCH (1 - 1e-10)

enum { STREAM_RADIUS = 0x7261, STREAM_POSITION = 0x706f, STREAM_VELOCITY = 0x7665 };

void place_bounds(const struct scene *scene, const struct placement *placement, double bounds[4])
{
    const struct key_reals *outline = &placement->outline;
    memcpy(bounds, isnan(placement->region[0]) ? scene->box : placement->region,
           4 * sizeof *bounds);
    for (uint32_t k = 0; k + 1 < outline->count; k += 2) {
        const double x = outline->values[k], y = outline->values[k + 1];
        bounds[0] = k ? fmin(bounds[0], x) : x;
        bounds[1] = k ? fmin(bounds[1], y) : y;
        bounds[2] = k ? fmax(bounds[2], x) : x;
        bounds[3] = k ? fmax(bounds[3], y) : y;
    }
}

double place_area(const struct scene *scene, const struct placement *placement)
{
    const struct key_reals *outline = &placement->outline;
    double bounds[4], twice = 0;
    place_bounds(scene, placement, bounds);
    if (outline->count == 0) return (bounds[2] - bounds[0]) * (bounds[3] - bounds[1]);
    for (uint32_t k = 0; k + 1 < outline->count; k += 2) {
        const double *p = &outline->values[k], *q = &outline->values[(k + 2) % outline->count];
        twice += p[0] * q[1] - p[1] * q[0];
    }
    return fabs(twice) / 2;
}

/* ---- the grains so far --------------------------------------------------------------------- */

/* A growing list of grains and a grid of cells of two largest radii that finds neighbours. */
struct placer {
    struct scene    *scene;
    struct findings *findings;
    struct placed    grains;
    uint32_t  capacity;
    double    cell, x0, y0;
    uint32_t  nx, ny;
    uint32_t *first, *next;     /* of each cell; after each grain.  1 + index; 0: none */
    bool      wraps_x, wraps_y;
    uint32_t  wall_count;
    struct wall *walls;         /* as they stand at the start; gates that are shut */
};

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

static bool append(struct placer *placer, double x, double y, double radius, uint32_t species)
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

/* Would a disc here overlap a grain that is there already?  Touching is no overlap: a lattice of
 * spacing 1 touches but for rounding. */
static bool is_taken(const struct placer *placer, double x, double y, double radius)
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

static bool meets_wall(const struct placer *placer, double x, double y, double radius)
{
    for (uint32_t k = 0; k < placer->wall_count; k++) {
        if (wall_nearest(&placer->walls[k], x, y).distance < radius * TOUCH) return true;
    }
    return false;
}

/* ---- the region of a placement ------------------------------------------------------------- */

struct region {
    double bounds[4];
    const struct key_reals *outline;    /* NULL: the bounds are the region */
    bool free_x, free_y;                /* its left and right (low and high) sides are periodic
                                         * borders of the box: a disc may stand across them */
};

static struct region region_of(const struct placer *placer, const struct placement *placement)
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

static bool region_holds(const struct region *region, double x, double y, double radius)
{
    if (region->outline) return polygon_holds(region->outline, x, y, radius);
    const double *b = region->bounds, reach = radius * TOUCH;
    const double rx = region->free_x ? 0 : reach, ry = region->free_y ? 0 : reach;
    return x >= b[0] + rx && x <= b[2] - rx && y >= b[1] + ry && y <= b[3] - ry;
}

/* ---- lattices ------------------------------------------------------------------------------ */

static double draw_radius(const struct species *species, uint64_t word)
{
    const double u = rng_unit(word);
    const uint32_t count = species->radii.count;
    if (count) return species->radii.values[(uint32_t)(u * count)];
    return species->radius[0] + u * (species->radius[1] - species->radius[0]);
}

static uint64_t word_of(const struct placer *placer, uint32_t stream, uint32_t placement,
                        uint64_t draw)
{
    return rng_keyed(placer->scene->seed, stream, placement, draw);
}

struct lattice { double ax, ay, x0, y0; uint32_t columns, rows; bool shifted; };

/* Along a periodic side the lattice is stretched to fit the box a whole number of times. */
static struct lattice lattice_of(const struct region *region, const struct placement *placement,
                                 double radius_max)
{
    const double *b = region->bounds, width = b[2] - b[0], height = b[3] - b[1];
    const double a = 2 * radius_max * placement->spacing;
    struct lattice l = {.shifted = placement->kind == PLACEMENT_TRIANGULAR, .ax = a, .ay = a};
    if (l.shifted) l.ay = a * sqrt(3) / 2;
    l.x0 = b[0] + a / 2;
    l.y0 = b[1] + a / 2;
    l.columns = (uint32_t)fmin(floor((width - a) / l.ax * (1 + 1e-12) + 1e-9) + 1, 1e9);
    l.rows = (uint32_t)fmin(floor((height - a) / l.ay * (1 + 1e-12) + 1e-9) + 1, 1e9);
    if (width < a) l.columns = 0;
    if (height < a) l.rows = 0;
    if (region->free_x) {
        l.columns = (uint32_t)floor(width / a + 1e-9);
        l.ax = l.columns ? width / l.columns : a;
        l.x0 = b[0] + l.ax / 4;
    }
    if (region->free_y) {
        const double step = l.shifted ? 2 : 1;
        l.rows = (uint32_t)(step * floor(height / (step * l.ay) + 1e-9));
        l.ay = l.rows ? height / l.rows : l.ay;
        l.y0 = b[1] + l.ay / 2;
    }
    return l;
}

/* A site is used if a grain of the largest radius fits there, so that small grains are not
 * favoured along slopes. */
static bool site_is_free(const struct placer *placer, const struct region *region, double x,
                         double y,
                         double radius)
{
    return region_holds(region, x, y, radius) && !meets_wall(placer, x, y, radius)
        && !is_taken(placer, x, y, radius);
}

/* Fills from the bottom row upwards; false if memory is short. */
static bool place_lattice(struct placer *placer, const struct placement *placement, uint32_t number,
                          uint32_t species_index)
{
    const struct species *species = &placer->scene->species[species_index];
    const struct region region = region_of(placer, placement);
    const double radius_max = resolve_radius_max(species);
    const struct lattice l = lattice_of(&region, placement, radius_max);
    const double gap = 2 * radius_max * (placement->spacing - 1);
    const double limit = placement->count ? (double)placement->count : INFINITY;
    double done = 0;
    for (uint32_t row = 0; row < l.rows; row++) {
        for (uint32_t column = 0; column < l.columns && done < limit; column++) {
            double x = l.x0 + (column + (l.shifted && row % 2 ? 0.5 : 0)) * l.ax;
            double y = l.y0 + row * l.ay;
            if (!site_is_free(placer, &region, x, y, radius_max)) continue;
            const uint64_t draw = 2 * (uint64_t)done;
            const double r = placement->jitter * gap / 2
                * sqrt(rng_unit(word_of(placer, STREAM_POSITION, number, draw)));
            const double phase = 2 * M_PI * rng_unit(word_of(placer, STREAM_POSITION, number,
                                                             draw + 1));
            const double xs = x + r * cos(phase), ys = y + r * sin(phase);
            if (r > 0 && site_is_free(placer, &region, xs, ys, radius_max)) {
                x = xs;
                y = ys;
            }
            const double radius = draw_radius(species, word_of(placer, STREAM_RADIUS, number,
                                                               (uint64_t)done));
            if (!append(placer, x, y, radius, species_index)) return false;
            done++;
        }
    }
    return true;
}

/* ---- random -------------------------------------------------------------------------------- */

/* The area of a region that no solid disc covers: exact without discs, else by 500 x 500 points. */
static double free_area(const struct placer *placer, const struct placement *placement,
                        const struct region *region)
{
    enum { POINTS = 500 };
    const double area = place_area(placer->scene, placement), *b = region->bounds;
    bool discs = false;
    for (uint32_t k = 0; k < placer->wall_count; k++) discs |= placer->walls[k].shape == WALL_DISC;
    if (!discs) return area;
    uint32_t inside = 0, covered = 0;
    for (uint32_t p = 0; p < POINTS * POINTS; p++) {
        const double x = b[0] + (p % POINTS + 0.5) / POINTS * (b[2] - b[0]);
        const double y = b[1] + (p / POINTS + 0.5) / POINTS * (b[3] - b[1]);
        if (!region_holds(region, x, y, 0)) continue;
        inside++;
        for (uint32_t k = 0; k < placer->wall_count; k++) {
            const struct wall *wall = &placer->walls[k];
            if (wall->shape != WALL_DISC || wall_nearest(wall, x, y).distance >= 0) continue;
            covered++;
            break;
        }
    }
    return inside ? area * (inside - covered) / inside : area;
}

/* The sides of a region, with the inside to their left; returns how many. */
static uint32_t sides_of(const struct region *region, struct wall *sides)
{
    const double *b = region->bounds;
    const double corners[8] = {b[0], b[1], b[2], b[1], b[2], b[3], b[0], b[3]};
    const double *p = region->outline ? region->outline->values : corners;
    const uint32_t points = region->outline ? region->outline->count / 2 : 4;
    double twice = 0;
    for (uint32_t k = 0; k < points; k++) {
        const uint32_t n = (k + 1) % points;
        twice += p[2 * k] * p[2 * n + 1] - p[2 * k + 1] * p[2 * n];
    }
    uint32_t count = 0;
    for (uint32_t k = 0; k < points; k++) {
        const uint32_t n = (k + 1) % points, from = twice > 0 ? k : n, to = twice > 0 ? n : k;
        if (!region->outline && (k % 2 ? region->free_x : region->free_y)) continue;
        sides[count++] = (struct wall){.shape = WALL_SEGMENT, .x0 = p[2 * from],
                                       .y0 = p[2 * from + 1],
                                       .x1 = p[2 * to], .y1 = p[2 * to + 1]};
    }
    return count;
}

/* What a random placement works on: the new discs, then those that are there already. */
struct heap { uint32_t count, all; double *x, *y, *radius; double fraction; };

static bool heap_take(const struct placer *placer, struct heap *heap)
{
    const struct placed *g = &placer->grains;
    heap->all = heap->count + g->count;
    heap->x = calloc(heap->all, sizeof *heap->x);
    heap->y = calloc(heap->all, sizeof *heap->y);
    heap->radius = calloc(heap->all, sizeof *heap->radius);
    if (!heap->x || !heap->y || !heap->radius) return false;
    for (uint32_t k = 0; k < g->count; k++) {
        heap->x[heap->count + k] = g->x[k];
        heap->y[heap->count + k] = g->y[k];
        heap->radius[heap->count + k] = g->radius[k];
    }
    return true;
}

struct guess { double x, y, band; };

/* By bands of two diameters, from left to right: neighbours in space are near in memory. */
static int guess_compare(const void *a, const void *b)
{
    const struct guess *p = a, *q = b;
    if (p->band != q->band) return p->band < q->band ? -1 : 1;
    return (p->x > q->x) - (p->x < q->x);
}

/* A random point of the region from which a disc is easily moved to where it fits: inside, and
 * outside of solid discs.  Bounded tries; the last point may lie in a disc. */
static bool first_guess(const struct placer *placer, const struct region *region, uint32_t number,
                        struct heap *heap)
{
    struct rng rng = rng_stream(placer->scene->seed, STREAM_POSITION, number);
    const double *b = region->bounds;
    struct guess *guesses = calloc(heap->count, sizeof *guesses);
    if (!guesses) return false;
    for (uint32_t k = 0; k < heap->count; k++) {
        double x = 0, y = 0;
        for (uint32_t tries = 0; tries < 2000; tries++) {
            x = b[0] + rng_uniform(&rng) * (b[2] - b[0]);
            y = b[1] + rng_uniform(&rng) * (b[3] - b[1]);
            const bool inside = region_holds(region, x, y, 0);
            if (inside && (tries > 1000 || !meets_wall(placer, x, y, 0))) break;
        }
        guesses[k] = (struct guess){x, y, floor((y - b[1]) / (4 * heap->radius[0]))};
    }
    qsort(guesses, heap->count, sizeof *guesses, guess_compare);
    for (uint32_t k = 0; k < heap->count; k++) {
        heap->x[k] = guesses[k].x;
        heap->y[k] = guesses[k].y;
    }
    free(guesses);
    return true;
}

static enum pack_outcome heap_pack(const struct placer *placer, const struct region *region,
                                   uint32_t number, struct heap *heap, double *scale)
{
    const uint32_t corners = region->outline ? region->outline->count / 2 : 4;
    struct wall *sides = calloc(corners, sizeof *sides);
    if (!sides) return PACK_MEMORY;
    struct pack pack = {.count = heap->count, .fixed = heap->all - heap->count, .x = heap->x,
                        .y = heap->y, .radius = heap->radius, .fraction = heap->fraction,
                        .sides = sides,
                        .wall_count = placer->wall_count, .walls = placer->walls,
                        .wraps_x = placer->wraps_x, .wraps_y = placer->wraps_y,
                        .seed = word_of(placer, STREAM_POSITION, number, 1)};
    pack.side_count = sides_of(region, sides);
    memcpy(pack.box, placer->scene->box, sizeof pack.box);
    const enum pack_outcome outcome = pack_solve(&pack, scale);
    free(sides);
    return outcome;
}

static void tell_jam(const struct placer *placer, const struct placement *placement,
                     uint32_t number,
                     double asked, double reached, uint32_t count)
{
    char key[64];
    const bool by_count = placement->count > 0;
    snprintf(key, sizeof key, "placements.[%u].%s", number, by_count ? "count" : "fraction");
    findings_tell(placer->findings, placer->scene, FINDING_ERROR, key, "placements.[%u]: %u grains "
                  "are an area fraction of %.4f, but only %.4f could be packed at random; that is "
                  "about %u grains. Ask for fewer, or enlarge the region", number, count, asked,
                  reached, (uint32_t)(count * fmin(reached / asked, 1)));
}

/* How many grains of the drawn radii make up the fraction; 0 if the count says it. */
static uint32_t count_for(const struct placer *placer, const struct placement *placement,
                          uint32_t number, const struct species *species, double area)
{
    if (placement->count) return placement->count;
    double filled = 0;
    uint32_t count = 0;
    while (filled < placement->fraction * area && count < 100000000) {
        const double r = draw_radius(species, word_of(placer, STREAM_RADIUS, number, count++));
        filled += M_PI * r * r;
    }
    return count;
}

static bool place_random(struct placer *placer, const struct placement *placement, uint32_t number,
                         uint32_t species_index)
{
    const struct species *species = &placer->scene->species[species_index];
    const struct region region = region_of(placer, placement);
    const double area = free_area(placer, placement, &region);
    struct heap heap = {.count = count_for(placer, placement, number, species, area)};
    double filled = 0, scale = 0;
    enum pack_outcome outcome = PACK_MEMORY;
    if (heap_take(placer, &heap)) {
        for (uint32_t k = 0; k < heap.count; k++) {
            heap.radius[k] = draw_radius(species, word_of(placer, STREAM_RADIUS, number, k));
            filled += M_PI * heap.radius[k] * heap.radius[k];
        }
        heap.fraction = filled / area;
        outcome = PACK_JAMMED;
        scale = sqrt(0.84 * area / filled);             /* what fits at random, in large regions */
        if (filled < 0.91 * area) {
            outcome = first_guess(placer, &region, number, &heap)
                    ? heap_pack(placer, &region, number, &heap, &scale) : PACK_MEMORY;
        }
    }
    if (outcome == PACK_JAMMED) {
        tell_jam(placer, placement, number, filled / area, filled / area * scale * scale,
                 heap.count);
    }
    bool done = outcome != PACK_MEMORY;
    for (uint32_t k = 0; k < heap.count && outcome == PACK_DONE && done; k++) {
        done = append(placer, heap.x[k], heap.y[k], heap.radius[k], species_index);
    }
    free(heap.x);
    free(heap.y);
    free(heap.radius);
    return done;
}

/* ---- velocities ---------------------------------------------------------------------------- */

/* Normal deviates, then shifted and scaled: the mean is zero and <v'^2>/2 is exact. */
static void set_velocities(const struct placer *placer, const struct placement *placement,
                           uint32_t number, uint32_t from)
{
    const struct placed *g = &placer->grains;
    const uint32_t count = g->count - from;
    struct rng rng = rng_stream(placer->scene->seed, STREAM_VELOCITY, number);
    double mx = 0, my = 0, square = 0;
    const bool warm = placement->temperature > 0 && count > 1;
    for (uint32_t i = from; warm && i < g->count; i++) {
        mx += (g->vx[i] = rng_normal(&rng)) / count;
        my += (g->vy[i] = rng_normal(&rng)) / count;
    }
    for (uint32_t i = from; warm && i < g->count; i++) {
        g->vx[i] -= mx;
        g->vy[i] -= my;
        square += g->vx[i] * g->vx[i] + g->vy[i] * g->vy[i];
    }
    const double factor = warm ? sqrt(2 * placement->temperature * count / square) : 0;
    for (uint32_t i = from; i < g->count; i++) {
        g->vx[i] = factor * g->vx[i] + placement->velocity[0];
        g->vy[i] = factor * g->vy[i] + placement->velocity[1];
        g->spin[i] = placement->spin;
    }
}

/* ---- all placements ------------------------------------------------------------------------ */

static bool placer_take(struct placer *placer)
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

/* Too few is an error if a number was asked for, and always if there is none at all. */
static void tell_missing(const struct placer *placer, const struct placement *placement,
                         uint32_t number, uint32_t placed)
{
    char key[64];
    if (placed > 0 && placed >= placement->count) return;
    snprintf(key, sizeof key, "placements.[%u]%s", number, placement->count ? ".count" : "");
    if (placed == 0) {
        findings_tell(placer->findings, placer->scene, FINDING_ERROR, key,
                      "placements.[%u]: no grain "
                      "fits: the region is too small, or walls or other grains fill it", number);
    } else {
        findings_tell(placer->findings, placer->scene, FINDING_ERROR, key,
                      "placements.[%u]: only %u "
                      "of %u grains fit clear of walls and other grains; ask for at most %u or "
                      "enlarge the region", number, placed, placement->count, placed);
    }
}

static bool keep_grains(struct placer *placer)
{
    struct placed *kept = &placer->scene->placed;
    const struct placed *g = &placer->grains;
    struct arena *arena = &placer->scene->arena;
    double **const to[] = {&kept->x, &kept->y, &kept->vx, &kept->vy, &kept->spin, &kept->radius};
    double *const from[] = {g->x, g->y, g->vx, g->vy, g->spin, g->radius};
    for (size_t k = 0; k < sizeof to / sizeof *to; k++) {
        if (!arena_array(arena, to[k], g->count)) return false;
        if (g->count) memcpy(*to[k], from[k], g->count * sizeof **to);
    }
    if (!arena_array(arena, &kept->species, g->count)) return false;
    if (g->count) memcpy(kept->species, g->species, g->count * sizeof *g->species);
    kept->count = g->count;
    return true;
}

bool place_grains(struct scene *scene, struct findings *findings)
{
    struct placer placer = {.scene = scene, .findings = findings};
    const uint32_t before = findings->errors;
    bool done = placer_take(&placer);
    for (uint32_t k = 0; done && k < scene->placement_count; k++) {
        const struct placement *placement = &scene->placements[k];
        const uint32_t from = placer.grains.count, errors = findings->errors;
        const uint32_t species = resolve_species(scene, placement->grains);
        done = placement->kind == PLACEMENT_RANDOM ? place_random(&placer, placement, k, species)
                                                   : place_lattice(&placer, placement, k, species);
        if (!done) break;
        set_velocities(&placer, placement, k, from);
        if (findings->errors == errors) tell_missing(&placer, placement, k,
                                                     placer.grains.count - from);
    }
    done = done && keep_grains(&placer);
    if (!done) findings_tell(findings, scene, FINDING_ERROR, "placements",
                             "not enough memory for the "
                             "grains");
    struct placed *g = &placer.grains;
    double *const arrays[] = {g->x, g->y, g->vx, g->vy, g->spin, g->radius};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) free(arrays[k]);
    free(g->species);
    free(placer.next);
    free(placer.first);
    free(placer.walls);
    return findings->errors == before;
}
