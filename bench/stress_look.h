/* stress_look.h - what a run under stress looks like at one time, and what is wrong with it.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STRESS_LOOK_H
#define STRESS_LOOK_H

#include "bench/stress.h"
#include "model/simulation.h"

/* A grain to blame, for the sentence that says where. */
struct stress_blame {
    double   value;             /* how bad it is; 0: nothing is */
    uint32_t grain;             /* id */
    double   x, y;
    char     with[48];          /* "grain 12", "wall 3" */
};

struct stress_look {
    const struct scene *scene;
    struct grains grains;       /* now */
    struct counters counters, first;    /* now; at the start */
    double *start_x, *start_y;  /* by id, of the grains that were there at the start */
    uint32_t start_count;
    double energy_least;        /* of the sum, so far */
    double motion;              /* largest kinetic energy so far, with all the heights used up */
    double momentum_scale;      /* sqrt(2 M K) at the start */
};

bool stress_look_begin(struct stress_look *look, const struct simulation *sim,
                       struct error *error);
bool stress_look_take(struct stress_look *look, const struct simulation *sim,
                      struct error *error);
void stress_look_end(struct stress_look *look);

/* The sum of energies as it compares with the start: shares of what has been in motion. */
double stress_look_energy_rise(struct stress_look *look);
double stress_look_energy_change(const struct stress_look *look);
double stress_look_momentum_change(const struct stress_look *look);

/* Grains missing or too many, as a share of all that ever were. */
double stress_look_loss(const struct stress_look *look);

/* The mean way from the start, in mean diameters, of the grains that are still there. */
double stress_look_travel(const struct stress_look *look);

/* The worst grain of each kind; value 0: none. */
struct stress_blame stress_look_broken_number(const struct stress_look *look);
struct stress_blame stress_look_outside(const struct stress_look *look);
struct stress_blame stress_look_overlap(const struct stress_look *look);
struct stress_blame stress_look_fastest(const struct stress_look *look);

#endif
