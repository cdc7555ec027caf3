/* simulation.c - see simulation.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/simulation.h"

#include <assert.h>

static bool refuse_effects(const struct model *model, const struct scene *scene,
                           struct error *error)
{
    for (uint32_t p = 0; p < scene->phase_count; p++) {
        const effects_t missing = scene->phases[p]->effects & ~model->effects;
        if (!missing) continue;
        char able[200];
        model_names(scene->phases[p]->effects, able, sizeof able);
        return error_set_code(error, EXIT_SCENE, "%s: model '%s' cannot do %s (%s); "
            "models that can run this scene: %s; or take it out of the scene", scene->path,
            model->name, effect_word(missing), effect_doc(missing), able);
    }
    for (uint32_t p = 0; p < scene->phase_entry_count && !model->push; p++) {
        if (scene->phase_entries[p].push.count == 0) continue;
        return error_set_code(error, EXIT_SCENE, "%s: the grains of model '%s' cannot be "
            "pushed, as they have no velocity of their own; take the push out or change the model",
            scene->path, model->name);
    }
    return true;
}

bool simulation_create(struct simulation *sim, const struct model *model,
                       const struct scene *scene, struct error *error)
{
    *sim = (struct simulation){.model = model, .scene = scene, .phase_scene = scene};
    if (!refuse_effects(model, scene, error)) return false;
    sim->state = model->create(scene, error);
    return sim->state != NULL;
}

void simulation_destroy(struct simulation *sim)
{
    if (sim->state) sim->model->destroy(sim->state);
    *sim = (struct simulation){0};
}

static void carry_out_pushes(struct simulation *sim)
{
    if (sim->phase == 0) return;
    const struct key_reals *push = &sim->scene->phase_entries[sim->phase - 1].push;
    for (uint32_t k = 0; k + PHASE_PUSH <= push->count; k += PHASE_PUSH) {
        const double *v = &push->values[k];
        sim->model->push(sim->state, &(struct impulse){v[0], v[1], v[2], v[3], v[4]});
    }
}

bool simulation_enter(struct simulation *sim, const struct scene *scene, uint32_t phase,
                      const struct archive *before, struct error *error)
{
    if (scene != sim->scene && !refuse_effects(sim->model, scene, error)) return false;
    void *next = sim->model->create(scene->phases[phase], error);
    if (!next) return false;
    struct archive load;
    archive_begin_load(&load, before->bytes, before->size);
    if (before->failed) archive_fail(&load, before->reason);
    else sim->model->archive(next, &load);
    if (load.failed) {
        sim->model->destroy(next);
        return error_set(error, "phase %u cannot take over the state: %s", phase, load.reason);
    }
    sim->model->destroy(sim->state);
    sim->state = next;
    sim->scene = scene;
    sim->phase = phase;
    sim->phase_scene = scene->phases[phase];
    carry_out_pushes(sim);
    return true;
}

/* Replaces the state by one created for `phase`'s scene that goes on where the old one is. */
static bool enter_phase(struct simulation *sim, uint32_t phase, struct error *error)
{
    struct archive save;
    archive_begin_save(&save);
    sim->model->archive(sim->state, &save);
    const bool done = simulation_enter(sim, sim->scene, phase, &save, error);
    archive_end(&save);
    return done;
}

enum advance simulation_advance(struct simulation *sim, double t_end, uint64_t budget,
                                struct error *error)
{
    const struct scene *scene = sim->scene;
    for (;;) {
        const uint32_t next = sim->phase + 1;
        const bool changes = next < scene->phase_count && scene->phase_times[next] < t_end;
        const double t = changes ? scene->phase_times[next] : t_end;
        const uint64_t before = changes ? simulation_count(sim).steps : 0;
        const enum advance outcome = sim->model->advance(sim->state, t, budget);
        if (outcome == ADVANCE_BROKEN) {
            const struct fault *fault = sim->model->fault ? sim->model->fault(sim->state) : NULL;
            error_set(error, "%s", fault ? fault->text : "the state stopped being physical");
        }
        if (outcome != ADVANCE_REACHED || !changes) return outcome;
        const uint64_t spent = simulation_count(sim).steps - before;
        budget = budget > spent ? budget - spent : 0;
        if (!enter_phase(sim, next, error)) return ADVANCE_BROKEN;
    }
}

void simulation_observe(const struct simulation *sim, struct grains *out)
{
    sim->model->observe(sim->state, out);
}

struct counters simulation_count(const struct simulation *sim)
{
    struct counters counters = {0};
    sim->model->count(sim->state, &counters);
    return counters;
}

const struct tally *simulation_tally(const struct simulation *sim)
{
    return sim->model->tally ? sim->model->tally(sim->state) : NULL;
}

uint64_t simulation_digest(const struct simulation *sim)
{
    struct archive archive;
    archive_begin_hash(&archive);
    sim->model->archive(sim->state, &archive);
    return archive.hash;
}

bool simulation_save(const struct simulation *sim, struct archive *archive, struct error *error)
{
    assert(archive->mode == ARCHIVE_SAVE);
    uint32_t phase = sim->phase;
    archive_value(archive, "simulation.phase", &phase);
    sim->model->archive(sim->state, archive);
    return !archive->failed || error_set(error, "%s", archive->reason);
}

bool simulation_load(struct simulation *sim, struct archive *archive, struct error *error)
{
    assert(archive->mode == ARCHIVE_LOAD);
    uint32_t phase = 0;
    archive_count(archive, "simulation.phase", &phase, sim->scene->phase_count - 1);
    if (!archive->failed && phase != sim->phase && !enter_phase(sim, phase, error)) return false;
    if (!archive->failed) sim->model->archive(sim->state, archive);
    return !archive->failed || error_set(error, "%s", archive->reason);
}
