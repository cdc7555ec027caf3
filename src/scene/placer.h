/* placer.h - the grains placed so far, the walls they keep clear of, and the regions they fill.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PLACER_H
#define PLACER_H

#include "base/rng.h"
#include "scene/scene.h"

/* Streams of random numbers, so that one placement never shifts the numbers of another. */
enum { STREAM_RADIUS = 0x7261, STREAM_POSITION = 0x706f, STREAM_VELOCITY = 0x7665 };

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

/* False: not enough memory.  What was taken is freed by placer_free. */
bool placer_take(struct placer *placer);
void placer_free(struct placer *placer);

bool placer_add(struct placer *placer, double x, double y, double radius, uint32_t species);

/* Would a disc here overlap a grain that is there already?  Touching is no overlap: a lattice of
 * spacing 1 touches but for rounding. */
bool placer_is_taken(const struct placer *placer, double x, double y, double radius);

/* Or a wall? */
bool placer_meets_wall(const struct placer *placer, double x, double y, double radius);

/* Random numbers of a placement, and a radius drawn by one of them. */
uint64_t placer_word(const struct placer *placer, uint32_t stream, uint32_t placement,
                     uint64_t draw);
double placer_radius(const struct species *species, uint64_t word);

/* Where a placement may put grains. */
struct region {
    double bounds[4];
    const struct key_reals *outline;    /* NULL: the bounds are the region */
    bool free_x, free_y;                /* its left and right (low and high) sides are periodic
                                         * borders of the box: a disc may stand across them */
};

struct region placer_region(const struct placer *placer, const struct placement *placement);

/* Is a disc here wholly inside? */
bool placer_region_holds(const struct region *region, double x, double y, double radius);

#endif
