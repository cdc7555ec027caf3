/* stripped.h - models by hand, to see what effects that are off still cost.
 *
 * Each kernel is its model's algorithm written for one kind of elastic grain in a periodic square,
 * without a trace of any effect.  Kernel and model start from the same state and go on by turns,
 * one slice of time each, so that a busy machine disturbs both alike.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STRIPPED_H
#define STRIPPED_H

#include "base/error.h"
#include "model/simulation.h"

#include <stdbool.h>

struct stripped_kernel {
    const char *model, *scene;
    double   slice;             /* scene time of one turn */
    uint32_t warm, turns;       /* turns before the measurement, and in it */
    /* A copy of the model's state, and its bytes a grain; NULL: no memory. */
    void  *(*open)(const struct simulation *sim, double *bytes);
    void   (*advance)(void *state, double t_end);
    /* How far the two are apart after the warm turns, in what unit, and what is still none. */
    double (*apart)(const void *state, const struct simulation *sim);
    const char *apart_unit;
    double apart_max;
    void   (*close)(void *state);
};

extern const struct stripped_kernel stripped_md, stripped_ed, stripped_dsmc, stripped_lga;

struct stripped_result {
    double model, by_hand;      /* processor seconds for a unit of the model's work */
    double share;               /* by hand, of the model's: the median over the turns */
    double model_bytes, by_hand_bytes;  /* of the state, for a grain */
    double apart;
};

/* The longest way between a grain of the model and its place by hand (x, y of each id), in a
 * periodic square; NAN: no memory. */
double stripped_apart(const struct simulation *sim, const double *places, double side);

/* The kernel of that model; NULL if there is none. */
const struct stripped_kernel *stripped_find(const char *model);

bool stripped_measure(const struct stripped_kernel *kernel, struct stripped_result *result,
                      struct error *error);

#endif
