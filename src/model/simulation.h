/* simulation.h - a model together with its scene and its state: what the rest of sandreel holds.
 *
 * It refuses what a model cannot do, carries the state across phases, and packs and unpacks
 * checkpoints; all of it the same for every model.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SIMULATION_H
#define SIMULATION_H

#include "model/model.h"

struct simulation {
    const struct model *model;
    const struct scene *scene;          /* the whole one, with its phases; the caller's */
    const struct scene *phase_scene;    /* in force now: phase 0 until the first change */
    uint32_t phase;
    void *state;
};

/* Refuses (EXIT_SCENE) effects that the model lacks, in any phase, naming the effect and the
 * models that can; else creates the state of phase 0. */
bool simulation_create(struct simulation *sim, const struct model *model,
                       const struct scene *scene, struct error *error);
void simulation_destroy(struct simulation *sim);

/* As model.advance, but through the phases: at each change the state is archived, the model is
 * created anew from that phase's scene, and the archive is loaded.  `error` (may be NULL) tells
 * why a change of phase or a broken state stopped it (ADVANCE_BROKEN). */
enum advance simulation_advance(struct simulation *sim, double t_end, uint64_t budget,
                                struct error *error);

void simulation_observe(const struct simulation *sim, struct grains *out);
struct counters simulation_count(const struct simulation *sim);
const struct tally *simulation_tally(const struct simulation *sim);     /* NULL: nothing */

/* Goes on in `scene`, which has the same past, as its phase `phase` that begins now; `before` is
 * what simulation_save() gave at this time, before the phase began.  On failure nothing changes. */
bool simulation_enter(struct simulation *sim, const struct scene *scene, uint32_t phase,
                      const struct archive *before, struct error *error);

/* Hash of all that the future depends on. */
uint64_t simulation_digest(const struct simulation *sim);

/* Saves phase and state into `archive` (begun by archive_begin_save), and loads them into a
 * simulation freshly created from the same scene. */
bool simulation_save(const struct simulation *sim, struct archive *archive, struct error *error);
bool simulation_load(struct simulation *sim, struct archive *archive, struct error *error);

#endif
