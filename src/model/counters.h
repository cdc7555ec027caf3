/* counters.h - running totals of a model, listed once: struct, log columns and help.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef COUNTERS_H
#define COUNTERS_H

#include <stdint.h>

/* X(name, what it counts) - whole numbers since the start */
#define COUNTERS(X)                                                                     \
    X(steps,              "time steps, events or ticks")                                \
    X(grains,             "grains now")                                                 \
    X(grains_in,          "grains that entered")                                        \
    X(grains_out,         "grains that left")                                           \
    X(collisions,         "collisions (contacts begun) between two grains, each once")  \
    X(collisions_elastic, "collisions kept elastic by the TC rule")                     \
    X(rejected,           "candidates, moves or inserted grains refused")               \
    X(tangential,         "tangential forces evaluated")                                \
    X(rebuilds,           "neighbour lists or queues made anew")

/* X(name, dimension, what it is) - sums over the grains now; NAN where a model has no such thing */
#define QUANTITIES(X)                                                                   \
    X(kinetic_energy,     "energy",   "of translation")                                 \
    X(rotational_energy,  "energy",   "of rotation")                                    \
    X(potential_energy,   "energy",   "of gravity and of overlaps")                     \
    X(momentum_x,         "momentum", "along x")                                        \
    X(momentum_y,         "momentum", "along y")                                        \
    X(overlap_max,        "1",        "largest overlap as a share of the smaller radius")

struct counters {
    double time;
#define X(name, doc) uint64_t name;
    COUNTERS(X)
#undef X
#define X(name, dimension, doc) double name;
    QUANTITIES(X)
#undef X
};

#endif
