/* effect.h - the optional physics that a scene may call for, listed once.
 *
 * Effects are derived from a scene by scene/check (never written by the user), told by
 * `check --explain`, decided once in a model's create, and compared with what a model can do in
 * one place (model/simulation.c).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef EFFECT_H
#define EFFECT_H

#include <stdint.h>

/* X(NAME, "word for users", "what it adds") */
#define EFFECTS(X)                                                                              \
    X(GRAVITY,        "gravity",         "constant acceleration of every grain")                \
    X(DISSIPATION,    "dissipation",     "collisions lose energy")                              \
    X(ROTATION,       "rotation",        "grains spin; a spin and a torque for each")           \
    X(FRICTION,       "friction",        "a tangential force where grains touch")               \
    X(STATIC_FRICTION, "static friction", "a tangential spring remembered in each contact")     \
    X(POLYDISPERSE,   "polydispersity",  "a radius and a mass for every grain")                 \
    X(MIXTURE,        "mixture",         "contact parameters that depend on both species")      \
    X(PERIODIC,       "periodic borders", "what leaves on one side enters on the other")        \
    X(WALLS,          "walls",           "solid borders, segments, arcs and discs")             \
    X(MOVING_WALLS,   "moving walls",    "walls that move or turn")                             \
    X(GATES,          "gates",           "walls that open or close at a time")                  \
    X(OBSTACLE,       "obstacle",        "the force on a body is summed up")                    \
    X(INFLOW,         "inflow",          "grains enter while it runs")                          \
    X(RISING,         "rising source",   "a source keeps its height above the grains at rest")  \
    X(OUTFLOW,        "outflow",         "grains leave through open borders and sinks")         \
    X(SCREEN,         "screen",          "grains that cross a screen are recorded and removed") \
    X(COLLISION_RATE, "collision rate",  "contacts begun are counted for each grain")           \
    X(SHEAR,          "shear",           "Lees-Edwards borders")                                \
    X(COLLISION_COUNT, "collision counts", "all contacts of each grain, elastic ones apart")    \
    X(IMPACT,         "impact parameters", "how far off centre grains hit each other")          \
    X(STRESS,         "collisional stress", "the momentum that contacts carry, whole and by cell")

enum {
#define X(name, word, doc) EFFECT_BIT_##name,
    EFFECTS(X)
#undef X
    EFFECT_COUNT
};

typedef uint32_t effects_t;

/* A build in which effects do not exist: their bits are the constant 0, and the compiler drops
 * every line that asks for them.  Tests compare it with the usual build (tests/absent.c). */
#ifndef EFFECTS_ABSENT
#define EFFECTS_ABSENT 0
#endif

enum {
#define X(name, word, doc) EFFECT_##name = 1 << EFFECT_BIT_##name & ~(EFFECTS_ABSENT),
    EFFECTS(X)
#undef X
};

/* The word of the lowest effect in `set`, for messages; "none" for the empty set. */
const char *effect_word(effects_t set);

/* What the lowest effect in `set` adds. */
const char *effect_doc(effects_t set);

/* Writes the words of all effects in `set`, joined by ", "; "none" for the empty set. */
void effect_words(effects_t set, char *text, unsigned long size);

#endif
