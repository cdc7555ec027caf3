/* bench.c - see bench.h. */
#include "run/bench.h"

#include "base/clock.h"
#include "base/rng.h"
#include "bench_draw.h"
#include "bench_lga.h"
#include "draw/image.h"
#include "measure/map.h"
#include "model/simulation.h"
#include "run/setup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS_MAX = 25 };

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
        result->cpu = clock_process() - cpu;
        result->wall = clock_wall() - wall;
        const struct counters after = simulation_count(&sim);
        const double work = (double)(after.steps - before.steps)
                          * (which->per_grain ? (double)after.grains : 1);
        result->value = work / fmax(result->cpu, 1e-9);
    }
    if (sim.state) simulation_destroy(&sim);
    setup_free(&setup);
    return done;
}

static const char square_scene[] =
    "model = \"md\"; until = 1.0; box = (0.0, 0.0, 1000.0, 1000.0);\n"
    "grains = ({ radius = 0.4; restitution = 0.9; });\n"
    "placements = ({ count = 1; });\n";

/* Grains thrown at random into a square, mapped with the default kernel. */
static bool measure_map(const struct bench_case *which, struct bench_result *result,
                        struct error *error)
{
    struct setup setup;
    const struct setup_request request = {.path = which->name, .text = square_scene,
                                          .place = false};
    struct grains grains = {0};
    struct map *map = NULL;
    const uint32_t count = (uint32_t)which->amount;
    bool done = setup_load(&setup, &request, error) && grains_create(&grains, count, 0, error)
        && (map = map_create(setup.scene, &setup.scene->measure, error));
    if (done) {
        struct rng rng = rng_stream(1, 0, 0);
        grains.count = count;
        for (uint32_t i = 0; i < count; i++) {
            grains.x[i] = 1000 * rng_uniform(&rng);
            grains.y[i] = 1000 * rng_uniform(&rng);
            grains.vx[i] = rng_normal(&rng);
            grains.vy[i] = rng_normal(&rng);
            grains.radius[i] = 0.4;
            grains.mass[i] = 1;
        }
        struct field field = {0};
        const double cpu = clock_process(), wall = clock_wall();
        map_add(map, &grains);
        done = map_field(map, MAP_temperature, &field, error);
        result->cpu = clock_process() - cpu;
        result->wall = clock_wall() - wall;
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
    result->cpu = clock_process() - cpu;
    result->wall = clock_wall() - wall;
    result->value = 1e3 * result->cpu;
    free(bytes);
    image_free(&image);
    return done;
}

static bool measure_frame(const struct bench_case *which, struct bench_result *result,
                          struct error *error)
{
    const struct bench_draw_case what = {.grains = (uint32_t)which->amount, .width = 1280,
                                         .height = 720, .path = PAINTER_AUTO, .rims = true};
    struct bench_draw_result drawn;
    const double wall = clock_wall();
    if (!bench_draw(&what, 3, &drawn, error)) return false;
    result->wall = clock_wall() - wall;
    result->value = drawn.paint_ms + drawn.encode_ms;
    result->cpu = 1e-3 * result->value;
    return true;
}

/* Nodes of a lattice gas; the case is one of bench_lga's. */
static bool measure_lga(const struct bench_case *which, struct bench_result *result,
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

static const char gas_scene[] =
    "until = 1000.0; box = (0.0, 0.0, 280.0, 280.0);\n"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";\n"
    "grains = ({ radius = 0.5; restitution = 0.9; });\n"
    "placements = ({ kind = \"random\"; count = 20000; temperature = 1.0; });\n";

const struct bench_case bench_list[] = {
    {"md-gas", "20,000 dissipative discs, area fraction 0.2, periodic", "particle-steps/cpu-s",
     true, measure_model, .scene = "md-gas", .text = gas_scene, .model = "md", .amount = 0.05,
     .per_grain = true},
    {"lga-hourglass", "the hourglass with 20,000 grains as a lattice gas", "ticks/cpu-s", true,
     measure_model, .scene = "hourglass", .set = "grains.[0].radius=[0.018, 0.027]",
     .model = "lga", .amount = 3},
    {"lga-fhp2", "FHP-II, 2048 x 2048 nodes, walls, gravity and dissipation", "G sites/cpu-s", true,
     measure_lga, .scene = "fhp2"},
    {"lga-fhp2-gas", "FHP-II, 2048 x 2048 nodes, nothing else", "G sites/cpu-s", true,
     measure_lga, .scene = "fhp2-gas"},
    {"lga-sandpile", "sandpile, 2048 x 2048 nodes, walls and gravity", "G sites/cpu-s", true,
     measure_lga, .scene = "sandpile"},
    {"lga-gmlg", "many rest grains, 1024 x 1024 nodes, walls and gravity", "G sites/cpu-s", true,
     measure_lga, .scene = "gmlg"},
    {"map-1e6", "temperature map of 1,000,000 grains", "cpu-ms", false, measure_map, .amount = 1e6},
    {"png", "encoding a frame of 1280 x 720, level 1", "cpu-ms", false, measure_png,
     .amount = 1},
    {"frame-5e3", "drawing and encoding 5,000 grains, 1280 x 720", "cpu-ms", false, measure_frame,
     .amount = 5e3},
    {"frame-1e5", "drawing and encoding 100,000 grains, 1280 x 720", "cpu-ms", false, measure_frame,
     .amount = 1e5},
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
