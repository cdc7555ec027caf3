/* stripped.c - see stripped.h.
 *
 * What a compiled-out effect still costs shows against a kernel that never had any: the same
 * algorithm as md (leapfrog; grains sorted by cell; a list of pairs with a skin; windows of pairs
 * that touch, worked by SIMD), written for one kind of elastic grain in a periodic square.  It does
 * what any run must: velocities of the present, contacts counted (anew with each list), overlaps
 * watched.  It has no radii, masses or spins, no walls, one strip and one thread.
 *
 * Both must give the same motion, or the comparison would mean nothing: `apart` tells.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/stripped.h"

#include "base/clock.h"
#include "model/simulation.h"

#include <malloc.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Not with Clang, as in model/md/md.h: its ThreadSanitizer is not ready when the loader chooses. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

#define SIDE 140.0
enum { CELLS = 107, CELL_COUNT = CELLS * CELLS, PAIRS = 5, WINDOW = 128, AHEAD = 32, IMAGES = 9,
       STEPS = 200, WARM = 7, REPEATS = 15, INDEX_BITS = 27 };

static const double dt = 5e-4, stiffness = 1e4, skin = 0.15, mass = 1, overlap_limit = 0.5;

static const char text[] =
    "until = 1e3; box = [0, 0, 140, 140];"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
    "grains = ({ radius = 0.5; density = 1.2732395447351628; restitution = 1; stiffness = 1e4; });"
    "placements = ({ kind = \"square\"; spacing = 1.4; temperature = 1; });"
    "overlap_limit = 1.0; md = { dt = 5e-4; skin = 0.3; };";

struct body { double x, y, ux, uy; };
struct half { double hx, hy; };         /* velocities half a step back */
struct pair { uint32_t i, j; };         /* above the index in j: its image, does it touch */
struct push { double x, y; };

struct gas {
    uint32_t count, pair_count, pair_max;
    struct body *bodies, *bodies_spare;
    struct half *halves, *halves_spare;
    uint64_t contacts, suspects;
    struct push *pushes;
    struct pair *pairs;
    uint32_t *ids, *ids_spare, *cell_of;
    uint32_t cell_first[CELL_COUNT + 1];
    double   image_x[IMAGES], image_y[IMAGES];
    double   travel, stride;
    bool     begun;             /* the first kick is half a one */
};

struct window {
    uint32_t count, i[WINDOW], j[WINDOW];
    double dx[WINDOW], dy[WINDOW], distance2[WINDOW];
};

/* ---- the list ------------------------------------------------------------------------------ */

static void sort_bodies(struct gas *g)
{
    uint32_t *first = g->cell_first;
    memset(first, 0, sizeof g->cell_first);
    for (uint32_t i = 0; i < g->count; i++) {
        struct body *b = &g->bodies[i];
        b->x -= SIDE * floor(b->x / SIDE);
        b->y -= SIDE * floor(b->y / SIDE);
        const uint32_t cx = (uint32_t)(b->x * (CELLS / SIDE));
        const uint32_t cy = (uint32_t)(b->y * (CELLS / SIDE));
        g->cell_of[i] = (cx < CELLS ? cx : CELLS - 1) * CELLS + (cy < CELLS ? cy : CELLS - 1);
        first[g->cell_of[i] + 1]++;
    }
    for (uint32_t c = 0; c < CELL_COUNT; c++) first[c + 1] += first[c];
    for (uint32_t i = 0; i < g->count; i++) {
        const uint32_t place = first[g->cell_of[i]]++;
        g->bodies_spare[place] = g->bodies[i];
        g->halves_spare[place] = g->halves[i];
        g->ids_spare[place] = g->ids[i];
    }
    for (uint32_t c = CELL_COUNT; c > 0; c--) first[c] = first[c - 1];
    first[0] = 0;
    struct body *bodies = g->bodies;
    uint32_t *ids = g->ids;
    g->bodies = g->bodies_spare;
    g->bodies_spare = bodies;
    struct half *halves = g->halves;
    g->halves = g->halves_spare;
    g->halves_spare = halves;
    g->ids = g->ids_spare;
    g->ids_spare = ids;
}

/* Partners of grain i with a larger index in one column of cells, rows cy-1 to cy+1. */
static void list_column(struct gas *g, uint32_t i, uint32_t column, uint32_t cy, uint32_t image_x)
{
    const struct body *b = &g->bodies[i];
    const double reach2 = (1 + skin) * (1 + skin);
    for (int row = (int)cy - 1; row <= (int)cy + 1; row++) {
        const uint32_t image = image_x + (row < 0 ? 6u : row == CELLS ? 3u : 0u);
        const uint32_t cell = column * CELLS + (uint32_t)(row + CELLS) % CELLS;
        const double x = b->x - g->image_x[image], y = b->y - g->image_y[image];
        const uint32_t from = g->cell_first[cell] > i ? g->cell_first[cell] : i + 1;
        for (uint32_t j = from; j < g->cell_first[cell + 1]; j++) {
            const double dx = x - g->bodies[j].x, dy = y - g->bodies[j].y;
            if (dx * dx + dy * dy >= reach2 || g->pair_count == g->pair_max) continue;
            g->pairs[g->pair_count++] = (struct pair){i, j | image << INDEX_BITS};
        }
    }
}

static void list_pairs(struct gas *g)
{
    sort_bodies(g);
    g->pair_count = 0;
    g->travel = 0;
    for (uint32_t cell = 0; cell < CELL_COUNT; cell++) {
        const uint32_t cx = cell / CELLS, cy = cell % CELLS;
        for (uint32_t i = g->cell_first[cell]; i < g->cell_first[cell + 1]; i++) {
            list_column(g, i, cx, cy, 0);
            list_column(g, i, (cx + 1) % CELLS, cy, cx + 1 == CELLS ? 1 : 0);
            list_column(g, i, (cx + CELLS - 1) % CELLS, cy, cx == 0 ? 2 : 0);
        }
    }
    memset(&g->pairs[g->pair_count], 0, AHEAD * sizeof *g->pairs);
}

/* ---- one step ------------------------------------------------------------------------------ */

CLONES static void find(struct gas *g, struct pair *pairs, uint32_t count, struct window *w)
{
    const struct body *const bodies = g->bodies;
    uint32_t n = 0;
    for (uint32_t k = 0; k < count; k++) {
        const struct pair p = pairs[k];
        __builtin_prefetch(&bodies[pairs[k + AHEAD].j & ((1u << INDEX_BITS) - 1)]);
        const uint32_t j = p.j & ((1u << INDEX_BITS) - 1);
        const uint32_t image = p.j >> INDEX_BITS & 15;
        const double dx = bodies[p.i].x - bodies[j].x - g->image_x[image];
        const double dy = bodies[p.i].y - bodies[j].y - g->image_y[image];
        const double distance2 = dx * dx + dy * dy;
        w->i[n] = p.i;
        w->j[n] = j;
        w->dx[n] = dx;
        w->dy[n] = dy;
        w->distance2[n] = distance2;
        const bool touches = distance2 < 1;
        n += touches;
        if (__builtin_expect(touches != p.j >> 31, 0)) {
            pairs[k].j ^= 1u << 31;
            g->contacts += touches;
        }
    }
    w->count = n;
}

CLONES static uint64_t press(struct window *w)
{
    uint64_t suspects = 0;
#pragma GCC ivdep
    for (uint32_t k = 0; k < w->count; k++) {
        const double distance = sqrt(w->distance2[k]);
        const double share = stiffness * (1 - distance) / distance;
        w->dx[k] *= share;
        w->dy[k] *= share;
        suspects += 1 - distance > overlap_limit;
    }
    return suspects;
}

static double move(struct gas *g, uint32_t first, uint32_t last, double kick)
{
    const double half = 0.5 * dt / mass;
    double fastest = 0;
    for (uint32_t i = first; i < last; i++) {
        struct body *b = &g->bodies[i];
        struct half *h = &g->halves[i];
        const struct push p = g->pushes[i];
        g->pushes[i] = (struct push){0, 0};
        h->hx += kick * p.x;
        h->hy += kick * p.y;
        b->ux = h->hx + half * p.x;
        b->uy = h->hy + half * p.y;
        b->x += dt * h->hx;
        b->y += dt * h->hy;
        const double speed2 = h->hx * h->hx + h->hy * h->hy;
        fastest = speed2 > fastest ? speed2 : fastest;
    }
    return fastest;
}

static void step(struct gas *g)
{
    struct window w;
    const double kick = (g->begun ? dt : 0.5 * dt) / mass;
    double fastest = 0;
    uint32_t done = 0;
    if (2 * (g->travel + g->stride) >= skin) list_pairs(g);
    for (uint32_t k = 0; k < g->pair_count;) {
        const uint32_t left = g->pair_count - k, count = left < WINDOW ? left : WINDOW;
        find(g, g->pairs + k, count, &w);
        g->suspects += press(&w);
        for (uint32_t c = 0; c < w.count; c++) {
            struct push *a = &g->pushes[w.i[c]], *b = &g->pushes[w.j[c]];
            a->x += w.dx[c];
            a->y += w.dy[c];
            b->x -= w.dx[c];
            b->y -= w.dy[c];
        }
        k += count;
        const uint32_t next = k < g->pair_count ? g->pairs[k].i : g->count;
        fastest = fmax(fastest, move(g, done, next, kick));
        done = next;
    }
    fastest = fmax(fastest, move(g, done, g->count, kick));
    g->begun = true;
    g->stride = dt * sqrt(fastest);
    g->travel += g->stride;
}

/* ---- both from the same state -------------------------------------------------------------- */

static bool gas_open(struct gas *g, const struct simulation *sim, double *bytes)
{
    struct grains grains;
    const uint32_t n = (uint32_t)simulation_count(sim).grains;
    if (!grains_create(&grains, n, 0, NULL)) return false;
    simulation_observe(sim, &grains);
    *g = (struct gas){.count = n, .pair_max = n * PAIRS};
    for (uint32_t image = 0; image < IMAGES; image++) {
        const double shifts[] = {0, SIDE, -SIDE};
        g->image_x[image] = shifts[image % 3];
        g->image_y[image] = shifts[image / 3];
    }
    g->bodies = calloc(n, sizeof *g->bodies);
    g->bodies_spare = calloc(n, sizeof *g->bodies);
    g->halves = calloc(n, sizeof *g->halves);
    g->halves_spare = calloc(n, sizeof *g->halves);
    g->pushes = calloc(n, sizeof *g->pushes);
    g->pairs = calloc(g->pair_max + AHEAD, sizeof *g->pairs);
    g->ids = calloc(n, sizeof *g->ids);
    g->ids_spare = calloc(n, sizeof *g->ids);
    g->cell_of = calloc(n, sizeof *g->cell_of);
    const bool done = g->bodies && g->bodies_spare && g->halves && g->halves_spare && g->pushes
                   && g->pairs && g->ids && g->ids_spare && g->cell_of;
    for (uint32_t k = 0; done && k < n; k++) {
        g->bodies[k] = (struct body){grains.x[k], grains.y[k], grains.vx[k], grains.vy[k]};
        g->halves[k] = (struct half){grains.vx[k], grains.vy[k]};
        g->ids[k] = grains.id[k];
    }
    *bytes = 2.0 * (sizeof(struct body) + sizeof(struct half)) + sizeof(struct push)
           + PAIRS * sizeof(struct pair) + 3 * sizeof(uint32_t) + sizeof g->cell_first / (double)n;
    grains_free(&grains);
    if (done) list_pairs(g);
    return done;
}

static void gas_close(struct gas *g)
{
    void *const arrays[] = {g->bodies, g->bodies_spare, g->halves, g->halves_spare, g->pushes,
                            g->pairs, g->ids, g->ids_spare, g->cell_of};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) free(arrays[k]);
}

/* The largest distance of a grain from itself, in the nearest image. */
static double distance_apart(const struct gas *g, const struct simulation *sim)
{
    struct grains grains;
    double worst = 0;
    if (!grains_create(&grains, g->count, 0, NULL)) return NAN;
    simulation_observe(sim, &grains);
    double *places = calloc(2 * (size_t)g->count, sizeof *places);
    for (uint32_t k = 0; places && k < g->count; k++) {
        places[2 * g->ids[k]] = g->bodies[k].x;
        places[2 * g->ids[k] + 1] = g->bodies[k].y;
    }
    for (uint32_t k = 0; places && k < grains.count; k++) {
        const double dx = grains.x[k] - places[2 * grains.id[k]];
        const double dy = grains.y[k] - places[2 * grains.id[k] + 1];
        worst = fmax(worst, hypot(dx - SIDE * rint(dx / SIDE), dy - SIDE * rint(dy / SIDE)));
    }
    free(places);
    grains_free(&grains);
    return worst;
}

static double heap_bytes(void)
{
    const struct mallinfo2 now = mallinfo2();
    return (double)now.uordblks + (double)now.hblkhd;
}

/* The lattice of the start must become a gas first: until then nobody touches. */
static bool compare(struct gas *gas, struct simulation *sim, struct stripped_result *result,
                    struct error *error)
{
    result->model = result->by_hand = INFINITY;
    for (int k = 0; k < WARM + REPEATS; k++) {
        const double start = clock_process();
        for (int s = 0; s < STEPS; s++) step(gas);
        const double middle = clock_process();
        if (simulation_advance(sim, (k + 1) * STEPS * dt, UINT64_MAX, error) != ADVANCE_REACHED) {
            return false;
        }
        const double end = clock_process();
        if (k + 1 == WARM) result->apart = distance_apart(gas, sim);
        if (k < WARM) continue;
        result->by_hand = fmin(result->by_hand, (middle - start) / STEPS);
        result->model = fmin(result->model, (end - middle) / STEPS);
    }
    return true;
}

bool stripped_measure(struct stripped_result *result, struct error *error)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = "gas", .text = text, .groups = groups,
        .group_count = model_settings(groups), .place = true};
    const struct model *model = model_find("md");
    struct findings *findings = calloc(1, sizeof *findings);
    struct gas *gas = calloc(1, sizeof *gas);
    struct simulation sim = {0};
    const int threads = omp_get_max_threads();
    struct scene *scene = findings && gas ? scene_load(&request, findings) : NULL;
    *result = (struct stripped_result){0};
    if (scene) model->resolve(scene, findings);
    omp_set_num_threads(1);             /* the other one has no more */
    const double before = heap_bytes();
    bool done = scene && simulation_create(&sim, model, scene, error);
    const double taken = heap_bytes() - before;
    done = done && gas_open(gas, &sim, &result->by_hand_bytes) && compare(gas, &sim, result, error);
    if (done) result->model_bytes = taken / gas->count;
    omp_set_num_threads(threads);
    if (sim.state) simulation_destroy(&sim);
    if (gas) gas_close(gas);
    if (scene) scene_free(scene);
    free(gas);
    free(findings);
    return done || error_set(error, "the gas by hand could not be run");
}
