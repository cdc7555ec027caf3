/* place_random.c - see place_random.h.
 *
 * The discs begin at random points of the region; pack.c moves them apart.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/place_random.h"

#include "scene/pack.h"
#include "scene/place.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
        if (!placer_region_holds(region, x, y, 0)) continue;
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
            const bool inside = placer_region_holds(region, x, y, 0);
            if (inside && (tries > 1000 || !placer_meets_wall(placer, x, y, 0))) break;
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
                        .seed = placer_word(placer, STREAM_POSITION, number, 1)};
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
        const uint64_t word = placer_word(placer, STREAM_RADIUS, number, count++);
        const double r = placer_radius(species, word);
        filled += M_PI * r * r;
    }
    return count;
}

bool place_random(struct placer *placer, const struct placement *placement, uint32_t number,
                         uint32_t species_index)
{
    const struct species *species = &placer->scene->species[species_index];
    const struct region region = placer_region(placer, placement);
    const double area = free_area(placer, placement, &region);
    struct heap heap = {.count = count_for(placer, placement, number, species, area)};
    double filled = 0, scale = 0;
    enum pack_outcome outcome = PACK_MEMORY;
    if (heap_take(placer, &heap)) {
        for (uint32_t k = 0; k < heap.count; k++) {
            heap.radius[k] = placer_radius(species, placer_word(placer, STREAM_RADIUS, number, k));
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
        done = placer_add(placer, heap.x[k], heap.y[k], heap.radius[k], species_index);
    }
    free(heap.x);
    free(heap.y);
    free(heap.radius);
    return done;
}
