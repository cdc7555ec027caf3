/* bench_md.c - see bench_md.h.
 *
 * 10,000 discs of diameter 0.9 .. 1.1 sink from a loose lattice and settle in a periodic tile 100
 * wide; copies of the tile, side by side, make the bed.  The first steps after that load the
 * springs again and are not measured.  Without friction the bed flows on a little, which wants a
 * wider skin.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/bench_md.h"

#include "base/clock.h"
#include "model/simulation.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TILE = 10000, SETTLE_TIME = 8, WARM_STEPS = 100, REPEATS_MAX = 99 };

static const double tile_width = 100, time_step = 5e-4;

/* gamma_n = 60 per reduced mass of 1/2 and k = 1e4: eta / omega0 = 30 / 141.4, which the clipped
 * law turns into a restitution of 0.55; gamma_t is half of gamma_n as in gran/hooke/history. */
static const char text_format[] =
    "until = 1e6; box = [0.0, 0.0, %.17g, 200.0]; left = \"periodic\"; right = \"periodic\";"
    "top = \"open\"; gravity = (0.0, -1.0); overlap_limit = 1.0; count_max = %u;"
    "grains = ({ radius = [0.45, 0.55]; density = 1.2732395447351628; stiffness = 1e4;"
    "            restitution = 0.55; friction = %g; });"
    "placements = ({ kind = \"square\"; region = [0.0, 0.0, %.17g, 130.0]; count = %u;"
    "                spacing = 1.01; jitter = 0.5; });"
    "md = { dt = 5e-4; skin = %g; };";

static struct scene *load(uint32_t tiles, double friction, double skin, bool place,
                          struct error *error)
{
    static const struct key_group *groups[MODEL_MAX];
    char text[2000];
    snprintf(text, sizeof text, text_format, tile_width * tiles, TILE * tiles, friction,
             tile_width * tiles, TILE, skin);
    const struct scene_request request = {.path = "bench.cfg", .text = text, .groups = groups,
        .group_count = model_settings(groups), .place = place};
    struct findings *findings = calloc(1, sizeof *findings);
    if (!findings) return NULL;
    struct scene *scene = scene_load(&request, findings);
    if (scene) model_find("md")->resolve(scene, findings);
    if (findings->errors > 0) error_set(error, "%s", findings->list[0].text);
    free(findings);
    return scene;
}

bool bench_md_settle(struct grains *tile, struct error *error)
{
    struct simulation sim;
    struct scene *scene = load(1, 0.5, 0.3, true, error);
    if (!scene) return false;
    bool done = simulation_create(&sim, model_find("md"), scene, error);
    if (done) {
        done = simulation_advance(&sim, SETTLE_TIME, UINT64_MAX, error) == ADVANCE_REACHED
            && grains_create(tile, TILE, 0, error);
        if (done) simulation_observe(&sim, tile);
        simulation_destroy(&sim);
    }
    scene_free(scene);
    return done;
}

/* Copies of the tile as the placed grains of the scene. */
static bool lay_tiles(struct scene *scene, const struct grains *tile, uint32_t tiles)
{
    struct placed *placed = &scene->placed;
    const uint32_t n = tile->count;
    placed->count = n * tiles;
    const bool room = arena_array(&scene->arena, &placed->x, placed->count)
        && arena_array(&scene->arena, &placed->y, placed->count)
        && arena_array(&scene->arena, &placed->vx, placed->count)
        && arena_array(&scene->arena, &placed->vy, placed->count)
        && arena_array(&scene->arena, &placed->spin, placed->count)
        && arena_array(&scene->arena, &placed->radius, placed->count)
        && arena_array(&scene->arena, &placed->species, placed->count);
    for (uint32_t k = 0; room && k < placed->count; k++) {
        placed->x[k] = tile->x[k % n] + tile_width * (k / n);
        placed->y[k] = tile->y[k % n];
        placed->radius[k] = tile->radius[k % n];
    }
    return room;
}

/* Moves the bed on by `steps`; counts what that took. */
static bool advance(struct simulation *sim, const struct bench_md_case *what, double *t,
                    double *wall, double *cpu, struct error *error)
{
    *wall = -clock_wall();
    *cpu = -clock_process();
    *t += what->steps * time_step;
    const bool done = simulation_advance(sim, *t, UINT64_MAX, error) == ADVANCE_REACHED;
    *wall += clock_wall();
    *cpu += clock_process();
    return done;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The same bed on one thread and on two by turns, so that both meet the same machine. */
static bool measure(const struct bench_md_case *what, struct simulation sims[static 3],
                    struct bench_md_result *result, struct error *error)
{
    double t[3] = {0}, gains[REPEATS_MAX], wall[3], cpu[3];
    const uint32_t repeats = what->repeats < REPEATS_MAX ? what->repeats : REPEATS_MAX;
    const double work = (double)what->steps * result->grains;
    bool done = true;
    for (int threads = 1; done && threads <= 2; threads++) {
        t[threads] = WARM_STEPS * time_step;
        done = simulation_advance(&sims[threads], t[threads], UINT64_MAX, error)
            == ADVANCE_REACHED;
    }
    for (uint32_t k = 0; done && k < repeats; k++) {
        for (int threads = 1; done && threads <= 2; threads++) {
            done = advance(&sims[threads], what, &t[threads], &wall[threads], &cpu[threads], error);
            result->particle_steps[threads] = fmax(result->particle_steps[threads],
                                                   work / wall[threads]);
            result->per_core[threads] = fmax(result->per_core[threads], work / cpu[threads]);
        }
        gains[k] = wall[1] / wall[2];
    }
    qsort(gains, repeats, sizeof *gains, compare);
    result->gain = gains[repeats / 2];
    return done;
}

static bool look(struct simulation *sim, struct bench_md_result *result, struct error *error)
{
    struct grains grains;
    if (!grains_create(&grains, result->grains, 4 * result->grains, error)) return false;
    simulation_observe(sim, &grains);
    result->contacts = 2.0 * grains.contact_count / result->grains;
    result->tangential = simulation_count(sim).tangential;
    grains_free(&grains);
    return true;
}

bool bench_md(const struct bench_md_case *what, const struct grains *tile,
              struct bench_md_result *result, struct error *error)
{
    *result = (struct bench_md_result){.grains = tile->count * what->tiles};
    struct scene *scene = load(what->tiles, what->friction ? 0.5 : 0, what->friction ? 0.1 : 0.3,
                               false, error);
    struct simulation sims[3] = {0};
    bool done = scene && lay_tiles(scene, tile, what->tiles);
    for (int threads = 1; done && threads <= 2; threads++) {
        omp_set_num_threads(threads);
        done = simulation_create(&sims[threads], model_find("md"), scene, error);
    }
    done = done && measure(what, sims, result, error) && look(&sims[1], result, error);
    for (int threads = 1; threads <= 2; threads++) {
        if (sims[threads].state) simulation_destroy(&sims[threads]);
    }
    scene_free(scene);
    return done;
}

bool bench_md_export(const struct grains *tile, const char *path, struct error *error)
{
    FILE *file = fopen(path, "w");
    if (file) {
        fprintf(file, "settled tile\n\n%u atoms\n1 atom types\n\n0 %g xlo xhi\n0 200 ylo yhi\n"
                "-0.5 0.5 zlo zhi\n\nAtoms # sphere\n\n", tile->count, tile_width);
        for (uint32_t k = 0; k < tile->count; k++) {
            fprintf(file, "%u 1 %.17g 1.2732395447 %.17g %.17g 0\n", tile->id[k] + 1,
                    2 * tile->radius[k], tile->x[k], tile->y[k]);
        }
        fclose(file);
    }
    return file || error_set(error, "%s: cannot create this file", path);
}
