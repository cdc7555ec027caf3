/* stripped.c - soft discs by hand, with nothing but elastic springs in a periodic box, beside the
 * program's model with every effect off: ./bench_stripped
 *
 * What a compiled-out effect still costs shows here.  Both run the same gas from the same state by
 * turns; the least of the repeats counts.  Printed is the model's time over the stripped one's.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "base/clock.h"
#include "model/simulation.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 140.0
enum { CELLS = 100, NEIGHBOURS = 16, STEPS = 200, REPEATS = 15 };

static const double dt = 5e-4, stiffness = 1e4, skin = 0.2;

static const char text[] =
    "until = 1e3; box = [0, 0, 140, 140];"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
    "grains = ({ radius = 0.5; density = 1.2732395447351628; restitution = 1; stiffness = 1e4; });"
    "placements = ({ kind = \"square\"; spacing = 1.4; temperature = 1; });"
    "overlap_limit = 1.0; md = { dt = 5e-4; skin = 0.4; };";

struct gas {
    uint32_t count;
    double  *x, *y, *vx, *vy, *fx, *fy;
    uint32_t *order, *first, *partner;  /* partners of grain i: partner[first[i] .. first[i+1]) */
    uint32_t cell_first[CELLS * CELLS + 1];
    double   travel;
};

static double nearest(double d) { return d - SIDE * rint(d * (1 / SIDE)); }

static uint32_t cell_of(double x)
{
    x -= SIDE * floor(x / SIDE);
    const uint32_t c = (uint32_t)(x * (CELLS / SIDE));
    return c < CELLS ? c : CELLS - 1;
}

static uint32_t cell_at(const struct gas *g, uint32_t i)
{
    return cell_of(g->y[i]) * CELLS + cell_of(g->x[i]);
}

static void permute(double *values, const uint32_t *order, double *spare, uint32_t n)
{
    for (uint32_t k = 0; k < n; k++) spare[k] = values[order[k]];
    memcpy(values, spare, n * sizeof *values);
}

/* Sorts the grains by cell, then lists pairs closer than a diameter and a skin. */
static void list_pairs(struct gas *g)
{
    const uint32_t n = g->count;
    memset(g->cell_first, 0, sizeof g->cell_first);
    for (uint32_t i = 0; i < n; i++) g->cell_first[cell_at(g, i) + 1]++;
    for (uint32_t c = 0; c < CELLS * CELLS; c++) g->cell_first[c + 1] += g->cell_first[c];
    uint32_t *place = malloc((CELLS * CELLS + 1) * sizeof *place);
    memcpy(place, g->cell_first, sizeof g->cell_first);
    for (uint32_t i = 0; i < n; i++) g->order[place[cell_at(g, i)]++] = i;
    free(place);
    permute(g->x, g->order, g->fx, n);
    permute(g->y, g->order, g->fx, n);
    permute(g->vx, g->order, g->fx, n);
    permute(g->vy, g->order, g->fx, n);
    uint32_t links = 0;
    const double reach2 = (1 + skin) * (1 + skin);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t cx = cell_of(g->x[i]), cy = cell_of(g->y[i]);
        g->first[i] = links;
        for (uint32_t k = 0; k < 9; k++) {
            const uint32_t row = (cy + k / 3 + CELLS - 1) % CELLS;
            const uint32_t c = row * CELLS + (cx + k % 3 + CELLS - 1) % CELLS;
            for (uint32_t j = g->cell_first[c]; j < g->cell_first[c + 1]; j++) {
                const double dx = nearest(g->x[i] - g->x[j]), dy = nearest(g->y[i] - g->y[j]);
                if (j > i && dx * dx + dy * dy < reach2) g->partner[links++] = j;
            }
        }
    }
    g->first[n] = links;
    g->travel = 0;
}

static void step(struct gas *g)
{
    if (2 * g->travel > skin * 0.9) list_pairs(g);
    memset(g->fx, 0, g->count * sizeof *g->fx);
    memset(g->fy, 0, g->count * sizeof *g->fy);
    for (uint32_t i = 0; i < g->count; i++) {
        double fx = 0, fy = 0;
        for (uint32_t k = g->first[i]; k < g->first[i + 1]; k++) {
            const uint32_t j = g->partner[k];
            const double dx = nearest(g->x[i] - g->x[j]), dy = nearest(g->y[i] - g->y[j]);
            const double d2 = dx * dx + dy * dy;
            if (d2 >= 1) continue;
            const double d = sqrt(d2), push = stiffness * (1 - d) / d;
            fx += push * dx;
            fy += push * dy;
            g->fx[j] -= push * dx;
            g->fy[j] -= push * dy;
        }
        g->fx[i] += fx;
        g->fy[i] += fy;
    }
    double fastest = 0;
    for (uint32_t i = 0; i < g->count; i++) {
        g->vx[i] += dt * g->fx[i];
        g->vy[i] += dt * g->fy[i];
        g->x[i] += dt * g->vx[i];
        g->y[i] += dt * g->vy[i];
        fastest = fmax(fastest, g->vx[i] * g->vx[i] + g->vy[i] * g->vy[i]);
    }
    g->travel += dt * sqrt(fastest);
}

static bool take(struct gas *g, const struct simulation *sim)
{
    struct grains grains;
    const uint32_t n = (uint32_t)simulation_count(sim).grains;
    if (!grains_create(&grains, n, 0, NULL)) return false;
    simulation_observe(sim, &grains);
    g->count = n;
    double **const arrays[] = {&g->x, &g->y, &g->vx, &g->vy, &g->fx, &g->fy};
    for (int k = 0; k < 6; k++) *arrays[k] = calloc(n, sizeof(double));
    g->order = calloc(n, sizeof *g->order);
    g->first = calloc(n + 1, sizeof *g->first);
    g->partner = calloc((size_t)n * NEIGHBOURS, sizeof *g->partner);
    if (!g->partner || !g->first || !g->order || !g->fy) return false;
    memcpy(g->x, grains.x, n * sizeof(double));
    memcpy(g->y, grains.y, n * sizeof(double));
    memcpy(g->vx, grains.vx, n * sizeof(double));
    memcpy(g->vy, grains.vy, n * sizeof(double));
    grains_free(&grains);
    list_pairs(g);
    return true;
}

int main(void)
{
    static struct gas gas;
    static struct findings findings;
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = "gas", .text = text, .groups = groups,
        .group_count = model_settings(groups), .place = true};
    struct simulation sim;
    struct error error = {0};
    omp_set_num_threads(1);
    struct scene *scene = scene_load(&request, &findings);
    if (scene) model_find("md")->resolve(scene, &findings);
    if (!scene || !simulation_create(&sim, model_find("md"), scene, &error)
        || simulation_advance(&sim, 1, UINT64_MAX, &error) != ADVANCE_REACHED
        || !take(&gas, &sim)) {
        fprintf(stderr, "%s%s\n", error.text, findings.errors ? findings.list[0].text : "");
        return EXIT_FAILED;
    }
    double least[2] = {INFINITY, INFINITY}, t = 1;
    for (int k = 0; k < REPEATS; k++) {
        double start = clock_process();
        for (int s = 0; s < STEPS; s++) step(&gas);
        least[0] = fmin(least[0], clock_process() - start);
        start = clock_process();
        t += STEPS * dt;
        if (simulation_advance(&sim, t, UINT64_MAX, &error) != ADVANCE_REACHED) return EXIT_FAILED;
        least[1] = fmin(least[1], clock_process() - start);
    }
    const double work = (double)gas.count * STEPS;
    printf("%u discs: stripped %.2f ns a particle-step, md with nothing on %.2f; ratio %.3f\n",
           gas.count, 1e9 * least[0] / work, 1e9 * least[1] / work, least[1] / least[0]);
    simulation_destroy(&sim);
    scene_free(scene);
    return EXIT_DONE;
}
