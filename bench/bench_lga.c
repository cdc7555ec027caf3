/* bench_lga.c - see bench_lga.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A square lattice filled at random, in a box or on a torus; the first ticks are not measured.
 */
#include "bench/bench_lga.h"

#include "base/clock.h"
#include "model/simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WARM_TICKS = 10 };

const struct bench_lga_case bench_lga_list[] = {
    {"fhp2", "fhp2", "p = 0.9; g = 0.05;", 0.15, true, true, 2048, 400},
    {"fhp2-gas", "fhp2", "p = 0.0;", 0.15, false, false, 2048, 400},
    {"fhp2-lossy", "fhp2", "p = 0.9;", 0.15, true, false, 2048, 400},
    {"fhp2-wide", "fhp2", "p = 0.9; g = 0.05;", 0.15, true, true, 16384, 10},
    {"sandpile", "sandpile", "p = 0.5; g = 0.5; fly = false; strict = true;", 0.15, true, true,
     2048, 50},
    {"sandpile-fly", "sandpile", "p = 0.5; g = 0.5;", 0.15, true, true, 2048, 50},
    {"heap", "sandpile", "p = 0.5; g = 0.5; heap = true;", 0.01, true, true, 2048, 50},
    {"gmlg", "gmlg", "k = 0.5; pw = 0.5; g = 0.5; orientation = \"H\";", 0.15, true, true, 2048,
     40},
    {"gmlg-V", "gmlg", "k = 0.5; pw = 0.5; g = 0.5; orientation = \"V\";", 0.15, true, true, 2048,
     40},
    {0}
};

static const char text_format[] =
    "model = \"lga\"; until = 1e9; box = [0.0, 0.0, %.17g, %.17g]; %s %s"
    "grains = ({ radius = 0.5; restitution = 0.5; }); placements = ({ count = 1; });"
    "lga = { method = \"%s\"; spacing = 1.0; tick = 1.0; fill = %.17g; %s };";

static const char periodic[] = "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\";"
                               "top = \"periodic\";";

static struct scene *load(const struct bench_lga_case *what, struct error *error)
{
    static const struct key_group *groups[MODEL_MAX];
    char text[2000];
    const double ring = what->walls ? 4 : 0;    /* nodes of the wall, and outside of it */
    snprintf(text, sizeof text, text_format, what->side - ring, (what->side - ring) * sqrt(0.75),
             what->walls ? "" : periodic, what->gravity ? "gravity = (0.0, -1e-3);" : "",
             what->method, what->fill, what->rule);
    const struct scene_request request = {.path = "bench.cfg", .text = text, .groups = groups,
        .group_count = model_settings(groups), .place = true};
    struct findings *findings = calloc(1, sizeof *findings);
    if (!findings) return NULL;
    struct scene *scene = scene_load(&request, findings);
    if (scene) model_find("lga")->resolve(scene, findings);
    if (findings->errors > 0) error_set(error, "%s", findings->list[0].text);
    free(findings);
    return scene;
}

bool bench_lga(const struct bench_lga_case *what, struct bench_lga_result *result,
               struct error *error)
{
    struct simulation sim;
    struct scene *scene = load(what, error);
    bool done = scene && simulation_create(&sim, model_find("lga"), scene, error);
    if (done) {
        done = simulation_advance(&sim, WARM_TICKS, UINT64_MAX, error) == ADVANCE_REACHED;
        const double cpu = clock_process(), wall = clock_wall();
        done = done && simulation_advance(&sim, WARM_TICKS + what->ticks, UINT64_MAX, error)
                       == ADVANCE_REACHED;
        const double nodes = (double)what->side * what->side;
        result->cpu = clock_process() - cpu;
        result->wall = clock_wall() - wall;
        result->updates = nodes * what->ticks / fmax(result->cpu, 1e-9);
        result->grains = (double)simulation_count(&sim).grains / nodes;
        simulation_destroy(&sim);
    }
    scene_free(scene);
    return done;
}
