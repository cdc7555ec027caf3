/* bench_ed.c - see bench_ed.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/bench_ed.h"

#include "base/clock.h"
#include "bench/heap.h"
#include "model/simulation.h"

#include <math.h>
#include <stdio.h>

static struct scene *load(const struct bench_ed_case *what, struct error *error)
{
    const double spacing = sqrt(M_PI / 4 / what->fraction), length = what->side * spacing;
    char text[1000];
    /* A hair more than the lattice needs, so that rounding never drops a row. */
    snprintf(text, sizeof text, "until = 1e9; box = [0.0, 0.0, %.15g, %.15g]; left = \"periodic\";"
        "right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
        "grains = ({ radius = 0.5; restitution = 1.0; });"
        "placements = ({ kind = \"square\"; spacing = %.15g; count = %u; temperature = 0.5; });"
        "ed = { t_c = 0.0; };"
        "phases = ({ time = 1e8; set = [\"grains.[0].restitution=%.15g\"]; });", length, length,
        spacing * (1 - 1e-9), what->side * what->side, what->restitution);
    const struct key_group *groups[MODEL_MAX];
    struct findings findings = {0};
    const struct scene_request request = {.path = "bench", .text = text, .groups = groups,
        .overrides = &what->setting, .override_count = what->setting != NULL,
        .group_count = model_settings(groups), .place = true};
    struct scene *scene = scene_load(&request, &findings);
    if (!scene) error_set(error, "%s", findings.list[0].text);
    return scene;
}

/* Runs until the grains have had so many more collisions each. */
static void run(struct simulation *sim, double per_grain)
{
    const struct counters from = simulation_count(sim);
    const uint64_t wanted = from.collisions + (uint64_t)(0.5 * per_grain * (double)from.grains);
    for (uint64_t done = from.collisions; done < wanted;) {
        simulation_advance(sim, 1e7, 2 * (wanted - done) + 1000, NULL);
        done = simulation_count(sim).collisions;
    }
}

/* Takes the state over into the lossy scene without waiting for its time. */
static bool switch_on(struct simulation *sim, struct simulation *lossy, struct error *error)
{
    struct archive save, load;
    if (!simulation_create(lossy, sim->model, sim->scene->phases[1], error)) return false;
    archive_begin_save(&save);
    sim->model->archive(sim->state, &save);
    archive_begin_load(&load, save.bytes, save.size);
    lossy->model->archive(lossy->state, &load);
    archive_end(&save);
    return !load.failed || error_set(error, "%s", load.reason);
}

bool bench_ed(const struct bench_ed_case *what, struct bench_ed_result *result,
              struct error *error)
{
    struct scene *scene = load(what, error);
    struct simulation sim = {0}, lossy = {0};
    const double before = heap_bytes();
    bool done = scene && simulation_create(&sim, model_find("ed"), scene, error);
    const double bytes = heap_bytes() - before;
    if (done) {
        run(&sim, what->settle);
        done = switch_on(&sim, &lossy, error);
    }
    if (done) {
        const struct counters a = simulation_count(&lossy);
        const double begun = clock_process();
        run(&lossy, what->collisions);
        const double seconds = clock_process() - begun;
        const struct counters b = simulation_count(&lossy);
        const double collisions = (double)(b.collisions - a.collisions);
        *result = (struct bench_ed_result){
            .ns = 1e9 * seconds / collisions, .collisions = b.collisions - a.collisions,
            .crossings = ((double)(b.steps - a.steps) - collisions) / collisions,
            .elastic = (double)(b.collisions_elastic - a.collisions_elastic) / collisions,
            .bytes = bytes / (double)b.grains,
            .energy = b.kinetic_energy / a.kinetic_energy, .time = b.time - a.time,
        };
    }
    simulation_destroy(&lossy);
    simulation_destroy(&sim);
    if (scene) scene_free(scene);
    return done;
}
