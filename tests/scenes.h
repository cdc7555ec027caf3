/* scenes.h - tests write their scenes as text; this loads one and makes a simulation of it.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SCENES_H
#define SCENES_H

#include "check.h"
#include "model/simulation.h"

struct scenes_run { struct scene *scene; struct simulation sim; struct findings findings; };

static inline struct scene *scenes_load(const char *text, const char *model_name,
                                        struct findings *findings)
{
    static const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {
        .path = "test.cfg", .text = text, .groups = groups,
        .group_count = model_settings(groups), .place = true,
    };
    *findings = (struct findings){0};
    struct scene *scene = scene_load(&request, findings);
    const struct model *model = model_find(model_name);
    for (uint32_t p = 0; scene && model->resolve && p < scene->phase_count; p++) {
        model->resolve((struct scene *)(uintptr_t)scene->phases[p], findings);
    }
    return scene;
}

/* Fails the test, with the first finding, if the scene is wrong. */
static inline struct scenes_run *scenes_begin(const char *text, const char *model_name)
{
    struct scenes_run *run = calloc(1, sizeof *run);
    struct error error = {0};
    run->scene = scenes_load(text, model_name, &run->findings);
    if (run->findings.errors > 0) fail_msg("%s", run->findings.list[0].text);
    if (!simulation_create(&run->sim, model_find(model_name), run->scene, &error)) {
        fail_msg("%s", error.text);
    }
    return run;
}

static inline void scenes_end(struct scenes_run *run)
{
    simulation_destroy(&run->sim);
    scene_free(run->scene);
    free(run);
}

static inline void scenes_advance(struct scenes_run *run, double t)
{
    struct error error = {0};
    if (simulation_advance(&run->sim, t, UINT64_MAX, &error) != ADVANCE_REACHED) {
        fail_msg("%s", error.text);
    }
}

/* The grains now, sorted by id; the caller frees with grains_free. */
static inline struct grains scenes_look(const struct scenes_run *run)
{
    struct grains grains, sorted;
    const uint32_t count = (uint32_t)simulation_count(&run->sim).grains, n = count ? count : 1;
    CHECK(grains_create(&grains, n, 8 * n, NULL) && grains_create(&sorted, n, 0, NULL));
    simulation_observe(&run->sim, &grains);
    CHECK(grains.count == count);
    uint32_t *order = calloc(n, sizeof *order);
    for (uint32_t a = 0; a < count; a++) {
        uint32_t place = 0;
        for (uint32_t b = 0; b < count; b++) place += grains.id[b] < grains.id[a];
        order[place] = a;
    }
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t a = order[k];
        sorted.id[k] = grains.id[a];
        sorted.x[k] = grains.x[a];
        sorted.y[k] = grains.y[a];
        sorted.vx[k] = grains.vx[a];
        sorted.vy[k] = grains.vy[a];
        sorted.angle[k] = grains.angle[a];
        sorted.spin[k] = grains.spin[a];
        sorted.radius[k] = grains.radius[a];
        sorted.mass[k] = grains.mass[a];
        sorted.species[k] = grains.species[a];
        sorted.collision_rate[k] = grains.collision_rate[a];
    }
    sorted.count = count;
    sorted.time = grains.time;
    free(order);
    grains_free(&grains);
    return sorted;
}

#endif
