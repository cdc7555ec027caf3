/* model.h - the interface that MD, ED, DSMC and the lattice gases implement, and nothing else.
 *
 * A model is one constant `struct model`; its running state is private to its own folder.
 * Everything outside talks to a `struct simulation` (simulation.h), never to a model's functions.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MODEL_H
#define MODEL_H

#include "base/archive.h"
#include "base/error.h"
#include "model/counters.h"
#include "model/field.h"
#include "model/grains.h"
#include "model/impulse.h"
#include "model/tally.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

enum advance {
    ADVANCE_REACHED,            /* the time is now t_end, within half a step for stepping models */
    ADVANCE_BUDGET,             /* `budget` units of work are spent; call again to go on */
    ADVANCE_BROKEN              /* the state stopped being physical: see fault() */
};

struct fault {
    double   time, x, y;
    uint32_t grain;             /* id */
    char     text[320];         /* what, where, why and the cure */
};

struct model {
    const char *name;           /* as in scene files */
    const char *summary;        /* one sentence for `help` */
    const char *work;           /* what a unit of budget is called: "particle-steps", "events" */
    effects_t   effects;        /* all that it can do */
    const struct key_group *settings;   /* its own keys in a scene file; NULL: none */

    /* Completes its settings where the scene left them open (time step, stiffness) and tells what
     * cannot be right about them; part of `check`.  Called for the scene and then for each of its
     * later phases.  May be NULL. */
    void (*resolve)(struct scene *scene, struct findings *findings);

    /* Bytes that create() will ask for, about.  May be NULL. */
    uint64_t (*memory)(const struct scene *scene);

    /* Allocates everything the run will ever need and sets the grains of scene->placed; NULL and
     * an error on failure.  The scene is kept by address and outlives the state. */
    void *(*create)(const struct scene *scene, struct error *error);
    void (*destroy)(void *state);

    /* Moves on to t_end doing at most `budget` steps, ticks or events.  Splitting a run into
     * several calls gives bit for bit the state of a single call. */
    enum advance (*advance)(void *state, double t_end, uint64_t budget);

    /* Fills a picture of the present; never changes the state, not even its rounding. */
    void (*observe)(const void *state, struct grains *out);

    /* Optional: gives grains around a point a velocity, at once (phases, live sessions).  NULL: the
     * model cannot, and a scene that pushes is refused. */
    void (*push)(void *state, const struct impulse *impulse);

    /* Names every byte that advance() depends on, for saving, loading and hashing alike.  A state
     * saved under a scene with other effects loads too (phases): see archive.h. */
    void (*archive)(void *state, struct archive *archive);

    void (*count)(const void *state, struct counters *out);

    /* What is summed up while running; NULL slot: nothing. */
    const struct tally *(*tally)(const void *state);

    /* After ADVANCE_BROKEN: which grain, where, when and why. */
    const struct fault *(*fault)(const void *state);

    /* Optional, for lattices too large to list: adds to the cells of a grid what stands there; the
     * components are those of enum field_sample, zero before (NULL: coarse-grain `observe`). */
    bool (*sample)(const void *state, struct field *field);

    /* Optional, for models that put the scene onto a lattice of their own: what became of a place,
     * as `check` shows it: '#' solid, 'v' a sink, ' ' free. */
    char (*ground)(const void *state, double x, double y);
};

enum { MODEL_MAX = 8 };

extern const struct model *const model_list[];          /* ends with NULL; at most MODEL_MAX */

/* The settings groups of all models, for scene_load; returns how many. */
uint32_t model_settings(const struct key_group *groups[static MODEL_MAX]);

const struct model *model_find(const char *name);       /* NULL if there is none */

/* "md, lga": the names of all models that can do `effects`; "none". */
void model_names(effects_t effects, char *text, unsigned long size);

#endif
