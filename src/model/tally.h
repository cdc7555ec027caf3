/* tally.h - what exists only while a model runs and is summed up as it goes: impulses on
 * obstacles, grains that cross screens, impact parameters, the stress that collisions carry.
 * What belongs to single grains (rates, counts of collisions) travels in struct grains.
 *
 * All sums start at zero and only grow, so two looks give the mean between them:
 * F = (impulse(t2) - impulse(t1)) / (t2 - t1).  What the scene does not ask for has no arrays.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef TALLY_H
#define TALLY_H

#include "base/arena.h"
#include "base/archive.h"
#include "scene/scene.h"

#include <math.h>
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

/* Impact parameters b of collisions between two grains (cooperative, eq. 17), as a share of the
 * distance of their centres: 0 head on, 1 grazing.  With EFFECT_IMPACT. */
struct tally_impact {
    uint32_t bins;              /* bin k covers (k .. k+1) / bins; 0: not asked for */
    double  *count;             /* collisions, each once */
};

/* The first sum of the stress of cooperative, eq. 9: r_a dP_b over contacts, r from a grain's
 * centre to the contact, P the momentum given to it there; both grains of a pair.  Divide by time
 * and area.  Pressure counts as negative.  With EFFECT_STRESS. */
struct tally_stress {
    uint32_t nx, ny;            /* cells of size `cell` from (x0, y0) on; 0: not asked for */
    double x0, y0, cell, per_cell;
    double lx, ly;              /* periods; 0: none */
    double *cells;              /* xx, xy, yx, yy of each cell, row by row from below */
    double total[4];
};

struct tally {
    uint32_t body_count, screen_count;
    struct tally_body   *bodies;
    struct tally_screen *screens;
    struct tally_impact  impact;
    struct tally_stress  stress;
    double mass_in;             /* that entered through sources, for dm = dm_D / m_st */
    double mass_out;
};

/* Room for what the scene asks for; all NULL if it asks for nothing. */
bool tally_create(struct tally *tally, const struct scene *scene, struct arena *arena);

/* Does (x, y) lie behind the screen?  Then records the grain if t >= screen.from. */
bool tally_cross(struct tally *tally, const struct scene *scene, double t, double x, double y,
                 double vx, double vy, double spin, double mass, double inertia);

/* A collision at relative velocity (u, v), (dx, dy) being the distance of the two centres. */
static inline void tally_collision(struct tally *tally, double dx, double dy, double u, double v)
{
    struct tally_impact *impact = &tally->impact;
    if (!impact->count) return;
    const double squares = (dx * dx + dy * dy) * (u * u + v * v);
    const double share = squares > 0 ? fabs(dx * v - dy * u) / sqrt(squares) : 0;
    const double place = share * impact->bins;
    impact->count[place < impact->bins ? (uint32_t)place : impact->bins - 1] += 1;
}

/* At (x, y) momentum (px, py) is given to a grain whose centre is (rx, ry) away.  For a pair once:
 * (rx, ry) is then the way from the grain's centre to its partner's. */
void tally_contact(struct tally *tally, double x, double y, double rx, double ry, double px,
                   double py);

void tally_archive(struct tally *tally, struct archive *archive);

#endif
