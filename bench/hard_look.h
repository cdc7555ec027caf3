/* hard_look.h - what a run under stress looks like at one time, and what is wrong with it.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef HARD_LOOK_H
#define HARD_LOOK_H

#include "bench/hard.h"
#include "model/simulation.h"

/* A grain to blame, for the sentence that says where. */
struct hard_blame {
    double   value;             /* how bad it is; 0: nothing is */
    uint32_t grain;             /* id */
    double   x, y;
    char     with[48];          /* "grain 12", "wall 3" */
};

struct hard_look {
    const struct scene *scene;
    struct grains grains;       /* now */
    struct counters counters, first;    /* now; at the start */
    double *start_x, *start_y;  /* by id, of the grains that were there at the start */
    uint32_t start_count;
    double energy_least;        /* of the sum, so far */
    double motion;              /* largest kinetic energy so far, with all the heights used up */
    double momentum_scale;      /* sqrt(2 M K) at the start */
};

bool hard_look_begin(struct hard_look *look, const struct simulation *sim,
                       struct error *error);
bool hard_look_take(struct hard_look *look, const struct simulation *sim,
                      struct error *error);
void hard_look_end(struct hard_look *look);

/* The sum of energies as it compares with the start: shares of what has been in motion. */
double hard_look_energy_rise(struct hard_look *look);
double hard_look_energy_change(const struct hard_look *look);
double hard_look_momentum_change(const struct hard_look *look);

/* Grains missing or too many, as a share of all that ever were. */
double hard_look_loss(const struct hard_look *look);

/* The mean way from the start, in mean diameters, of the grains that are still there. */
double hard_look_travel(const struct hard_look *look);

/* The worst grain of each kind; value 0: none. */
struct hard_blame hard_look_broken_number(const struct hard_look *look);
struct hard_blame hard_look_outside(const struct hard_look *look);
struct hard_blame hard_look_overlap(const struct hard_look *look);
struct hard_blame hard_look_fastest(const struct hard_look *look);

#endif
