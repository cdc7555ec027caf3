/* stripped.c - see stripped.h: a model and its kernel by hand, by turns.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/stripped.h"

#include "base/clock.h"
#include "bench/heap.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TURNS_MAX = 200 };

static const struct stripped_kernel *const kernels[] = {
    &stripped_md, &stripped_ed, &stripped_dsmc, &stripped_lga
};

const struct stripped_kernel *stripped_find(const char *model)
{
    for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++) {
        if (strcmp(kernels[k]->model, model) == 0) return kernels[k];
    }
    return NULL;
}

double stripped_apart(const struct simulation *sim, const double *places, double side)
{
    struct grains grains;
    double worst = 0;
    if (!grains_create(&grains, (uint32_t)simulation_count(sim).grains, 0, NULL)) return NAN;
    simulation_observe(sim, &grains);
    for (uint32_t k = 0; k < grains.count; k++) {
        const double dx = grains.x[k] - places[2 * grains.id[k]];
        const double dy = grains.y[k] - places[2 * grains.id[k] + 1];
        worst = fmax(worst, hypot(dx - side * rint(dx / side), dy - side * rint(dy / side)));
    }
    grains_free(&grains);
    return worst;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The lattice of the start must become a gas first: until then nobody touches.  The least of the
 * turns tells the time; ratios of neighbouring turns tell the share, as the machine's pace may
 * change between any two. */
static bool take_turns(const struct stripped_kernel *kernel, void *state, struct simulation *sim,
                       struct stripped_result *result, struct error *error)
{
    double shares[TURNS_MAX];
    const uint32_t turns = kernel->turns < TURNS_MAX ? kernel->turns : TURNS_MAX;
    result->model = result->by_hand = INFINITY;
    for (uint32_t k = 0; k < kernel->warm + turns; k++) {
        const double t = (k + 1) * kernel->slice;
        const uint64_t before = simulation_count(sim).steps;
        const double start = clock_process();
        kernel->advance(state, t);
        const double middle = clock_process();
        if (simulation_advance(sim, t, UINT64_MAX, error) != ADVANCE_REACHED) return false;
        const double end = clock_process();
        const double work = fmax((double)(simulation_count(sim).steps - before), 1);
        if (k + 1 == kernel->warm) result->apart = kernel->apart(state, sim);
        if (k < kernel->warm) continue;
        result->by_hand = fmin(result->by_hand, (middle - start) / work);
        result->model = fmin(result->model, (end - middle) / work);
        shares[k - kernel->warm] = (middle - start) / (end - middle);
    }
    qsort(shares, turns, sizeof *shares, compare);
    result->share = shares[turns / 2];
    return true;
}

bool stripped_measure(const struct stripped_kernel *kernel, struct stripped_result *result,
                      struct error *error)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = "gas", .text = kernel->scene, .groups = groups,
        .group_count = model_settings(groups), .place = true};
    const struct model *model = model_find(kernel->model);
    struct findings *findings = calloc(1, sizeof *findings);
    struct simulation sim = {0};
    const int threads = omp_get_max_threads();
    struct scene *scene = findings ? scene_load(&request, findings) : NULL;
    *result = (struct stripped_result){0};
    if (scene) model->resolve(scene, findings);
    omp_set_num_threads(1);             /* the kernels have no more */
    const double before = heap_bytes();
    bool done = scene && simulation_create(&sim, model, scene, error);
    if (done) {
        result->model_bytes = (heap_bytes() - before) / (double)simulation_count(&sim).grains;
    }
    void *state = done ? kernel->open(&sim, &result->by_hand_bytes) : NULL;
    done = state && take_turns(kernel, state, &sim, result, error);
    omp_set_num_threads(threads);
    if (state) kernel->close(state);
    if (sim.state) simulation_destroy(&sim);
    if (scene) scene_free(scene);
    const bool sound = findings && findings->errors == 0;
    if (!done && !sound) {
        error_set(error, "%s", findings ? findings->list[0].text : "not enough memory");
    } else if (!done && !error->text[0]) {
        error_set(error, "the kernel by hand of model %s cannot run here", kernel->model);
    }
    free(findings);
    if (!done) return false;
    return result->apart <= kernel->apart_max
        || error_set(error, "the kernel by hand of model %s is %.3g %s away from the model, more "
                     "than %.3g", kernel->model, result->apart, kernel->apart_unit,
                     kernel->apart_max);
}
