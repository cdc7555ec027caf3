/* grains.h - a picture of the present: what `observe` fills and everything above a model reads.
 *
 * The caller owns the arrays and says what it wants by which pointers are set; NULL is skipped.
 * grains_create() makes one with everything.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef GRAINS_H
#define GRAINS_H

#include "base/arena.h"
#include "base/error.h"
#include "model/field.h"

#include <stdbool.h>
#include <stdint.h>

struct contact {
    uint32_t i, j;              /* entries of the arrays below (not ids); j = CONTACT_WALL + w for
                                 * wall w of the scene */
    float x, y;                 /* the point of contact */
    float fx, fy;               /* force (or impulse per time) on i */
    float overlap;
};

enum { CONTACT_WALL = 0x40000000 };

struct grains {
    double   time;              /* the time the picture belongs to */
    double   window[4];         /* in: grains outside x0 y0 x1 y1 may be left out; x0 > x1: all */
    uint32_t capacity, contact_capacity;        /* in */
    uint32_t count, contact_count;              /* out; never more than the capacities */
    uint32_t missed;            /* out: grains (or contacts) there was no room for */
    uint32_t *id;               /* the same grain keeps its id for the whole run */
    double   *x, *y, *vx, *vy;
    double   *angle, *spin;     /* counter-clockwise; zero where the model has no rotation */
    double   *radius, *mass;
    float    *collision_rate;   /* contacts begun per time, over the last whole window */
    uint32_t *collisions;       /* contacts begun since the start, with grains and walls ... */
    uint32_t *collisions_elastic;       /* ... and those that the TC rule kept elastic; both stay
                                 * zero without EFFECT_COLLISION_COUNT */
    uint16_t *species;
    struct contact *contacts;   /* NULL: not wanted */
    struct field sample;        /* instead of a list, where there are too many grains: sums on a
                                 * grid (enum field_sample); values NULL: the list is whole */
    struct arena arena;         /* owns the arrays if grains_create made them */
};

/* Room for `capacity` grains with every array, and for `contact_capacity` contacts (0: none). */
bool grains_create(struct grains *grains, uint32_t capacity, uint32_t contact_capacity,
                   struct error *error);
void grains_free(struct grains *grains);

/* How many grains there are, listed or summed up in a sample. */
double grains_number(const struct grains *grains);

/* Brings the grains into the order of their ids, as readers expect who follow a grain by its row;
 * models keep them in any order.  The contacts, which name rows, are dropped. */
bool grains_sort(struct grains *grains, struct error *error);

#endif
