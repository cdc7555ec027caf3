/* tally.h - what exists only while a model runs and is summed up as it goes: impulses on
 * obstacles and grains that cross screens.  Collision rates per grain travel in struct grains.
 *
 * All sums start at zero and only grow, so two looks give the mean between them:
 * F = (impulse(t2) - impulse(t1)) / (t2 - t1).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef TALLY_H
#define TALLY_H

#include "base/arena.h"
#include "base/archive.h"
#include "scene/scene.h"

#include <stdint.h>

struct tally_body {             /* one for each entry of scene.obstacles */
    double impulse_x, impulse_y;        /* given to the obstacle by grains */
    double angular_impulse;     /* about its centre, counter-clockwise */
    uint64_t contacts;          /* contacts begun */
};

struct tally_screen {           /* one for each entry of scene.screens, sums over its bins */
    uint32_t bins;              /* bin k covers the angles (k .. k+1) * 360/bins - 180 degrees */
    double *count, *mass;
    double *momentum;           /* m |v| */
    double *spin;               /* angular momentum I omega */
    double *energy;
};

struct tally {
    uint32_t body_count, screen_count;
    struct tally_body   *bodies;
    struct tally_screen *screens;
    double mass_in;             /* that entered through sources, for dm = dm_D / m_st */
    double mass_out;
};

/* Room for what the scene asks for; all NULL if it asks for nothing. */
bool tally_create(struct tally *tally, const struct scene *scene, struct arena *arena);

/* Does (x, y) lie behind the screen?  Then records the grain if t >= screen.from. */
bool tally_cross(struct tally *tally, const struct scene *scene, double t, double x, double y,
                 double vx, double vy, double spin, double mass, double inertia);

void tally_archive(struct tally *tally, struct archive *archive);

#endif
