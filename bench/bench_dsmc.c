/* bench_dsmc.c - see bench_dsmc.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Elastic gases in periodic boxes, so that every round does the same work.  The points have ten
 * grains a cell, a mean free path of two cells and go 0.27 of a cell a step at their mean speed:
 * the case that other DSMC codes are measured on.  The discs fill a quarter of the area.
 */
#include "bench/bench_dsmc.h"

#include "base/clock.h"
#include "model/simulation.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROUNDS_MAX = 99, WARM_STEPS = 20 };

#define PERIODIC "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; "           \
                 "top = \"periodic\"; until = 1e9; "
#define POINTS(side, count)                                                                     \
    "box = (0.0, 0.0, " side ", " side "); " PERIODIC                                           \
    "grains = ({ radius = 0.008839; restitution = 1.0; });"                                     \
    "placements = ({ kind = \"square\"; spacing = 17.88; jitter = 1.0; count = " count "; "     \
    "temperature = 1.0; }); dsmc = { method = \"plain\"; cell = 1.0; dt = 0.2154; };"
#define DISCS(method)                                                                           \
    "box = (0.0, 0.0, 560.0954, 560.0954); " PERIODIC                                           \
    "grains = ({ radius = 0.5; restitution = 1.0; });"                                          \
    "placements = ({ kind = \"square\"; spacing = 1.77245; count = 99856; temperature = 1.0; });" \
    "dsmc = { method = \"" method "\"; };"

const struct bench_dsmc_case bench_dsmc_list[] = {
    {"1e5", POINTS("100.0", "99856"), 100},
    {"1e6", POINTS("316.3", "1000000"), 20},
    {"dense", DISCS("dense"), 50},
    {"hsmc", DISCS("hsmc"), 50},
    {0}
};

struct run { struct simulation sim; double dt, reached; };

static bool begin(struct run *run, const struct scene *scene, int threads, struct error *error)
{
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    bool done = simulation_create(&run->sim, model_find("dsmc"), scene, error);
    /* The state's clock tells the step that the model chose. */
    for (double t = 1e-6; done && run->dt == 0; t *= 2) {
        done = simulation_advance(&run->sim, t, 1, error) != ADVANCE_BROKEN;
        const struct counters counters = simulation_count(&run->sim);
        if (counters.steps > 0) run->dt = counters.time / (double)counters.steps;
    }
    run->reached = WARM_STEPS * run->dt;
    done = done && simulation_advance(&run->sim, run->reached, UINT64_MAX, error)
                   == ADVANCE_REACHED;
    omp_set_num_threads(before);
    return done;
}

static bool measure(struct run *run, uint32_t steps, double *cpu, double *wall,
                    struct error *error)
{
    const double cpu_before = clock_process(), wall_before = clock_wall();
    run->reached += steps * run->dt;
    const bool done = simulation_advance(&run->sim, run->reached, UINT64_MAX, error)
                      == ADVANCE_REACHED;
    *cpu = clock_process() - cpu_before;
    *wall = clock_wall() - wall_before;
    return done;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

static bool measure_rounds(const struct bench_dsmc_case *what, const struct scene *scene,
                           uint32_t rounds, uint32_t teams,
                           struct bench_dsmc_result results[BENCH_DSMC_THREADS],
                           struct error *error)
{
    struct run runs[BENCH_DSMC_THREADS] = {0};
    double cpu[BENCH_DSMC_THREADS][ROUNDS_MAX] = {0}, wall[BENCH_DSMC_THREADS][ROUNDS_MAX] = {0};
    bool done = true;
    for (uint32_t t = 0; done && t < teams; t++) done = begin(&runs[t], scene, (int)t + 1, error);
    for (uint32_t k = 0; done && k < rounds; k++) {
        for (uint32_t t = 0; done && t < teams; t++) {
            done = measure(&runs[t], what->steps, &cpu[t][k], &wall[t][k], error);
        }
    }
    for (uint32_t t = 0; t < teams; t++) {
        if (done) {
            const double grains = (double)simulation_count(&runs[t].sim).grains;
            struct bench_dsmc_result *r = &results[t];
            *r = (struct bench_dsmc_result){.cpu = median(cpu[t], rounds),
                .wall = median(wall[t], rounds), .digest = simulation_digest(&runs[t].sim),
                .bytes = (double)model_find("dsmc")->memory(scene) / grains};
            r->per_core = grains * what->steps / fmax(r->cpu, 1e-9);
            r->per_wall = grains * what->steps / fmax(r->wall, 1e-9);
        }
        if (runs[t].sim.state) simulation_destroy(&runs[t].sim);
    }
    return done;
}

bool bench_dsmc(const struct bench_dsmc_case *what, uint32_t rounds, bool both,
                struct bench_dsmc_result results[BENCH_DSMC_THREADS], struct error *error)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = "bench.cfg", .text = what->text,
        .groups = groups, .group_count = model_settings(groups), .place = true};
    struct findings *findings = calloc(1, sizeof *findings);
    if (!findings) return error_set(error, "not enough memory");
    struct scene *scene = scene_load(&request, findings);
    if (scene) model_find("dsmc")->resolve(scene, findings);
    bool done = findings->errors == 0;
    if (!done) error_set(error, "%s", findings->list[0].text);
    free(findings);
    if (rounds < 1) rounds = 1;
    if (rounds > ROUNDS_MAX) rounds = ROUNDS_MAX;
    done = done && measure_rounds(what, scene, rounds, both ? 2 : 1, results, error);
    scene_free(scene);
    return done;
}
