/* bench.c - see bench.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/bench.h"

#include "base/clock.h"
#include "base/rng.h"
#include "bench/bench_dsmc.h"
#include "bench/bench_ed.h"
#include "bench/bench_lga.h"
#include "bench/bench_live.h"
#include "bench/bench_md.h"
#include "draw/painter.h"
#include "measure/map.h"
#include "model/simulation.h"
#include "run/setup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS_MAX = 25 };

static void stop(struct bench_result *result, double cpu, double wall)
{
    result->cpu = clock_process() - cpu;
    result->wall = clock_wall() - wall;
}

/* Simulates the scene for the case's time; work is the model's steps, or each grain's. */
static bool measure_model(const struct bench_case *which, struct bench_result *result,
                          struct error *error)
{
    char model[64];
    snprintf(model, sizeof model, "model=%s", which->model);
    const char *const overrides[] = {model, which->set};
    struct setup setup;
    const struct setup_request request = {.path = which->scene, .text = which->text,
        .overrides = overrides, .override_count = which->set ? 2 : 1, .place = true};
    struct simulation sim = {0};
    bool done = setup_load(&setup, &request, error)
        && simulation_create(&sim, setup.model, setup.scene, error);
    /* The first tenth warms caches and lists, and lets the scene leave its ideal start. */
    done = done && simulation_advance(&sim, 0.1 * which->amount, UINT64_MAX, error)
                   == ADVANCE_REACHED;
    if (done) {
        const struct counters before = simulation_count(&sim);
        const double cpu = clock_process(), wall = clock_wall();
        done = simulation_advance(&sim, which->amount, UINT64_MAX, error) == ADVANCE_REACHED;
        stop(result, cpu, wall);
        const struct counters after = simulation_count(&sim);
        const double work = (double)(after.steps - before.steps)
                          * (which->per_grain ? (double)after.grains : 1);
        result->value = work / fmax(result->cpu, 1e-9);
    }
    if (sim.state) simulation_destroy(&sim);
    setup_free(&setup);
    return done;
}

/* The settled bed of frictional discs that other DEM codes are measured on (bench_md.h); the tile
 * is settled once for all cases.  `amount` is the number of threads, `per_grain` means friction,
 * `scene` that the ratio of two threads to one is wanted. */
static bool measure_bed(const struct bench_case *which, struct bench_result *result,
                        struct error *error)
{
    static struct grains tile;
    static bool settled;
    const struct bench_md_case bed = {.tiles = 10, .steps = 60, .repeats = 5,
                                      .friction = which->per_grain};
    struct bench_md_result measured;
    if (!settled && !bench_md_settle(&tile, error)) return false;
    settled = true;
    const double cpu = clock_process(), wall = clock_wall();
    if (!bench_md(&bed, &tile, &measured, error)) return false;
    stop(result, cpu, wall);
    const int threads = (int)which->amount;
    result->value = which->scene ? measured.gain
                  : threads == 1 ? measured.per_core[1] : measured.particle_steps[threads];
    return true;
}

/* Hard discs in a periodic box (bench_ed.h).  `amount` is the number of grains, `scene` the area
 * fraction, `set` the restitution, `text` what is told: NULL for the time. */
static bool measure_discs(const struct bench_case *which, struct bench_result *result,
                          struct error *error)
{
    const double n = which->amount;
    const struct bench_ed_case gas = {.side = (uint32_t)sqrt(which->amount),
        .fraction = strtod(which->scene, NULL), .restitution = strtod(which->set, NULL),
        .settle = n > 5e5 ? 3 : 10, .collisions = n > 5e5 ? 4 : n > 5e4 ? 20 : 80};
    struct bench_ed_result measured;
    const double wall = clock_wall();
    if (!bench_ed(&gas, &measured, error)) return false;
    result->wall = clock_wall() - wall;
    const char *of = which->text ? which->text : "";
    result->value = strcmp(of, "crossings") == 0 ? measured.crossings
                  : strcmp(of, "memory") == 0 ? measured.bytes : measured.ns;
    result->cpu = 1e-9 * measured.ns * (double)measured.collisions;
    return true;
}

/* Nodes of a lattice gas; `scene` names one of bench_lga's cases.  The threads are as they are: the
 * rate is that of the processor time of all. */
static bool measure_nodes(const struct bench_case *which, struct bench_result *result,
                          struct error *error)
{
    const struct bench_lga_case *what = bench_lga_list;
    struct bench_lga_result measured;
    while (what->name && strcmp(what->name, which->scene) != 0) what++;
    if (!what->name) return error_set(error, "no lattice gas is called '%s'", which->scene);
    if (!bench_lga(what, &measured, error)) return false;
    *result = (struct bench_result){1e-9 * measured.updates, measured.cpu, measured.wall};
    return true;
}

/* Direct simulation Monte Carlo (bench_dsmc.h); `scene` names one of its cases, `amount` is 1 for
 * the rate of one thread, 2 for what a second one gains. */
static bool measure_points(const struct bench_case *which, struct bench_result *result,
                           struct error *error)
{
    const struct bench_dsmc_case *what = bench_dsmc_list;
    struct bench_dsmc_result r[BENCH_DSMC_THREADS] = {0};
    while (what->name && strcmp(what->name, which->scene) != 0) what++;
    if (!what->name) return error_set(error, "no gas is called '%s'", which->scene);
    const bool both = which->amount > 1;
    if (!bench_dsmc(what, 5, both, r, error)) return false;
    if (both && r[0].digest != r[1].digest) {
        return error_set(error, "%s: two threads end in another state than one", which->name);
    }
    const double value = both ? r[1].per_wall / r[0].per_wall : 1e-6 * r[0].per_core;
    *result = (struct bench_result){value, r[both].cpu, r[both].wall};
    return true;
}

static const char square_scene[] =
    "model = \"md\"; until = 1.0; box = (0.0, 0.0, 1000.0, 1000.0);\n"
    "grains = ({ radius = 0.4; restitution = 0.9; });\n"
    "placements = ({ count = 1; });\n";

/* Grains thrown at random into a square of this side, at random speeds. */
static bool scatter(struct grains *grains, uint32_t count, double side, struct error *error)
{
    if (!grains_create(grains, count, 0, error)) return false;
    struct rng rng = rng_stream(1, 0, 0);
    grains->count = count;
    for (uint32_t i = 0; i < count; i++) {
        grains->x[i] = side * rng_uniform(&rng);
        grains->y[i] = side * rng_uniform(&rng);
        grains->vx[i] = rng_normal(&rng);
        grains->vy[i] = rng_normal(&rng);
        grains->radius[i] = 0.4;
        grains->mass[i] = 1;
    }
    return true;
}

/* Random grains mapped with the default kernel. */
static bool measure_map(const struct bench_case *which, struct bench_result *result,
                        struct error *error)
{
    struct setup setup;
    const struct setup_request request = {.path = which->name, .text = square_scene,
                                          .place = false};
    struct grains grains = {0};
    struct map *map = NULL;
    bool done = setup_load(&setup, &request, error)
        && scatter(&grains, (uint32_t)which->amount, 1000, error)
        && (map = map_create(setup.scene, &setup.scene->measure, error));
    if (done) {
        struct field field = {0};
        const double cpu = clock_process(), wall = clock_wall();
        map_add(map, &grains);
        done = map_field(map, MAP_temperature, &field, error);
        stop(result, cpu, wall);
        result->value = 1e3 * result->cpu;
        field_free(&field);
    }
    if (map) map_destroy(map);
    grains_free(&grains);
    setup_free(&setup);
    return done;
}

/* A picture like a frame: a plain ground with discs in many colours. */
static void paint_discs(struct image *image)
{
    memset(image->rgba, 255, 4 * (size_t)image->width * image->height);
    for (uint32_t y = 0; y < image->height; y++) {
        for (uint32_t x = 0; x < image->width; x++) {
            const int dx = (int)(x % 8) - 4, dy = (int)(y % 8) - 4;
            const uint64_t word = rng_keyed(1, x / 8, y / 8, 0);
            if (dx * dx + dy * dy > 12 || word % 3 == 0) continue;
            uint8_t *pixel = image->rgba + 4 * ((size_t)y * image->width + x);
            for (int c = 0; c < 3; c++) pixel[c] = (uint8_t)(word >> (8 + 8 * c));
        }
    }
}

static bool measure_png(const struct bench_case *which, struct bench_result *result,
                        struct error *error)
{
    (void)which;
    struct image image = {0};
    uint8_t *bytes = NULL;
    size_t size;
    if (!image_create(&image, 1280, 720, error)) return false;
    paint_discs(&image);
    const double cpu = clock_process(), wall = clock_wall();
    const bool done = image_encode(&image, 1, NULL, 0, &bytes, &size, error);
    stop(result, cpu, wall);
    result->value = 1e3 * result->cpu;
    free(bytes);
    image_free(&image);
    return done;
}

static bool measure_frame(const struct bench_case *which, struct bench_result *result,
                          struct error *error)
{
    struct setup setup;
    const struct setup_request request = {.path = which->name, .text = square_scene};
    struct grains grains = {0};
    struct image image = {0};
    struct painter *painter = NULL;
    uint8_t *bytes = NULL;
    size_t size;
    bool done = setup_load(&setup, &request, error)
        && scatter(&grains, (uint32_t)which->amount, 1000, error)
        && image_create(&image, 1280, 720, error)
        && (painter = painter_create(&setup.scene->view, error));
    const struct picture picture = {.scene = setup.scene, .grains = &grains,
        .view = done ? &setup.scene->view : NULL, .range = {0, 3}, .field_range = {NAN, NAN}};
    /* The first frame also fills the caches of glyphs and shaders. */
    done = done && painter_frame(painter, &picture, &image, error);
    const double cpu = clock_process(), wall = clock_wall();
    done = done && painter_frame(painter, &picture, &image, error)
        && image_encode(&image, 1, NULL, 0, &bytes, &size, error);
    stop(result, cpu, wall);
    result->value = 1e3 * result->cpu;
    free(bytes);
    if (painter) painter_destroy(painter);
    image_free(&image);
    grains_free(&grains);
    setup_free(&setup);
    return done;
}

/* A live session that is watched (bench_live.h); `amount` says which of its numbers. */
static bool measure_live(const struct bench_case *which, struct bench_result *result,
                         struct error *error)
{
    const double cpu = clock_process(), wall = clock_wall();
    if (!bench_live((enum bench_live_what)which->amount, &result->value, error)) return false;
    stop(result, cpu, wall);
    return true;
}

static const char gas_scene[] =
    "until = 1000.0; box = (0.0, 0.0, 280.0, 280.0);\n"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";\n"
    "grains = ({ radius = 0.5; restitution = 0.9; });\n"
    "placements = ({ kind = \"random\"; count = 20000; temperature = 1.0; });\n";

const struct bench_case bench_list[] = {
    {"md-bed", "100,000 settled discs, tangential springs, one thread", "particle-steps/cpu-s",
     true, measure_bed, .amount = 1, .per_grain = true},
    {"md-bed-2", "the same on two threads, by the wall clock", "particle-steps/s", true,
     measure_bed, .amount = 2, .per_grain = true},
    {"md-bed-gain", "two threads / one, runs by turns", "times", true, measure_bed,
     .amount = 2, .per_grain = true, .scene = "gain"},
    {"md-bed-smooth", "the same discs without friction, one thread", "particle-steps/cpu-s", true,
     measure_bed, .amount = 1},
    {"md-gas", "20,000 dissipative discs, area fraction 0.2, periodic", "particle-steps/cpu-s",
     true, measure_model, .scene = "md-gas", .text = gas_scene, .model = "md", .amount = 0.05,
     .per_grain = true},
    {"ed-gas-1e5", "99,856 hard discs, area fraction 0.25, r = 0.8", "ns/collision", false,
     measure_discs, .scene = "0.25", .set = "0.8", .amount = 99856},
    {"ed-gas-1e4", "10,000 hard discs, area fraction 0.25, elastic", "ns/collision", false,
     measure_discs, .scene = "0.25", .set = "1", .amount = 10000},
    {"ed-dense-1e5", "99,856 hard discs, area fraction 0.70, elastic", "ns/collision", false,
     measure_discs, .scene = "0.70", .set = "1", .amount = 99856},
    {"ed-gas-1e6", "1,000,000 hard discs, area fraction 0.25, elastic", "ns/collision", false,
     measure_discs, .scene = "0.25", .set = "1", .amount = 1e6},
    {"ed-crossings", "cell crossings, and predictions made anew, of ed-gas-1e4", "a collision",
     false, measure_discs, .scene = "0.25", .set = "1", .amount = 10000, .text = "crossings"},
    {"ed-memory", "state of ed-gas-1e4", "bytes/grain", false,
     measure_discs, .scene = "0.25", .set = "1", .amount = 10000, .text = "memory"},
    {"dsmc-1e5", "99,856 points, ten a cell, mean free path two cells, one thread",
     "M particle-steps/cpu-s", true, measure_points, .scene = "1e5", .amount = 1},
    {"dsmc-1e5-2", "the same on two threads, against one by turns", "times as fast", true,
     measure_points, .scene = "1e5", .amount = 2},
    {"dsmc-1e6", "a million of them, one thread", "M particle-steps/cpu-s", true, measure_points,
     .scene = "1e6", .amount = 1},
    {"dsmc-dense", "99,856 discs, area fraction 0.25, dense form, one thread",
     "M particle-steps/cpu-s", true, measure_points, .scene = "dense", .amount = 1},
    {"dsmc-hsmc", "the same with cells that can be full, one thread", "M particle-steps/cpu-s",
     true, measure_points, .scene = "hsmc", .amount = 1},
    {"dsmc-hsmc-2", "the same on two threads, against one by turns", "times as fast", true,
     measure_points, .scene = "hsmc", .amount = 2},
    {"lga-hourglass", "the hourglass with 20,000 grains as a lattice gas", "ticks/cpu-s", true,
     measure_model, .scene = "hourglass", .set = "grains.[0].radius=[0.018, 0.027]",
     .model = "lga", .amount = 3},
    {"lga-fhp2", "FHP-II, 2048 x 2048 nodes, walls, gravity, dissipation", "G nodes/cpu-s", true,
     measure_nodes, .scene = "fhp2"},
    {"lga-fhp2-gas", "FHP-II, 2048 x 2048 nodes, nothing else", "G nodes/cpu-s", true,
     measure_nodes, .scene = "fhp2-gas"},
    {"lga-sandpile", "sandpile, 2048 x 2048 nodes, walls and gravity", "G nodes/cpu-s", true,
     measure_nodes, .scene = "sandpile"},
    {"lga-gmlg", "many rest grains, 2048 x 2048 nodes, walls and gravity", "G nodes/cpu-s", true,
     measure_nodes, .scene = "gmlg"},
    {"map-1e6", "temperature map of 1,000,000 grains", "cpu-ms", false, measure_map, .amount = 1e6},
    {"png", "encoding a frame of 1280 x 720, level 1", "cpu-ms", false, measure_png,
     .amount = 1},
    {"frame-5e3", "drawing and encoding 5,000 grains, 1280 x 720", "cpu-ms", false, measure_frame,
     .amount = 5e3},
    {"frame-1e5", "drawing and encoding 100,000 grains, 1280 x 720", "cpu-ms", false, measure_frame,
     .amount = 1e5},
    {"live-pictures", "20,000 discs simulated and watched, 1280 x 720", "pictures/s", true,
     measure_live, .amount = BENCH_LIVE_PICTURES},
    {"live-delay", "the same: from a command to its picture", "ms", false, measure_live,
     .amount = BENCH_LIVE_DELAY},
    {"live-kept", "the same: speed with a viewer of 10 pictures/s over that without", "times",
     true, measure_live, .amount = BENCH_LIVE_KEPT},
    {0}
};

static int compare(const void *a, const void *b)
{
    const double x = ((const struct bench_result *)a)->value;
    const double y = ((const struct bench_result *)b)->value;
    return (x > y) - (x < y);
}

bool bench_measure(const struct bench_case *which, uint32_t repeats, struct bench_result *median,
                   struct error *error)
{
    struct bench_result results[REPEATS_MAX] = {0};
    if (repeats > REPEATS_MAX) repeats = REPEATS_MAX;
    for (uint32_t k = 0; k < repeats; k++) {
        if (!which->measure(which, &results[k], error)) return false;
    }
    qsort(results, repeats, sizeof *results, compare);
    *median = results[repeats / 2];
    return true;
}
