/* stripped_md.c - soft discs by hand; see stripped.h.
 *
 * The algorithm of md: leapfrog; grains sorted by cell; a list of pairs with a skin; windows of
 * pairs that touch, worked by SIMD.  It does what any run must: velocities of the present, contacts
 * counted (those that go on are known again in a new list), overlaps watched.  It has no radii,
 * masses or spins, no walls, one strip and one thread.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/stripped.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Not with Clang, as in model/md/md.h: its ThreadSanitizer is not ready when the loader chooses. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

#define SIDE 140.0
enum { CELLS = 107, CELL_COUNT = CELLS * CELLS, PAIRS = 5, WINDOW = 256, AHEAD = 32, IMAGES = 9,
       INDEX_BITS = 27,
       CELL_PAIRS = 144 };     /* more than a cell of discs that hardly overlap can have */

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
    struct pair *pairs, *kept;          /* kept: contacts that go on, by new indices */
    uint32_t *ids, *ids_spare, *cell_of, *place, *pair_first;
    uint32_t cell_first[CELL_COUNT + 1];
    double   image_x[IMAGES], image_y[IMAGES];
    double   travel, stride;
    uint64_t steps;
};

struct window {
    uint32_t count, link[WINDOW];
    double dx[WINDOW], dy[WINDOW];
};

/* ---- the list ------------------------------------------------------------------------------ */

static void sort_bodies(struct gas *g)
{
    uint32_t *first = g->cell_first;
    memset(first, 0, sizeof g->cell_first);
    for (uint32_t i = 0; i < g->count; i++) {
        struct body *b = &g->bodies[i];
        if (b->x < 0 || b->x >= SIDE) b->x -= SIDE * floor(b->x / SIDE);
        if (b->y < 0 || b->y >= SIDE) b->y -= SIDE * floor(b->y / SIDE);
        const uint32_t cx = (uint32_t)(b->x * (CELLS / SIDE));
        const uint32_t cy = (uint32_t)(b->y * (CELLS / SIDE));
        const uint32_t cell = (cx < CELLS ? cx : CELLS - 1) * CELLS + (cy < CELLS ? cy : CELLS - 1);
        g->cell_of[i] = cell;
        first[cell + 1]++;
    }
    for (uint32_t c = 0; c < CELL_COUNT; c++) first[c + 1] += first[c];
    for (uint32_t i = 0; i < g->count; i++) {
        const uint32_t place = first[g->cell_of[i]]++;
        g->bodies_spare[place] = g->bodies[i];
        g->halves_spare[place] = g->halves[i];
        g->ids_spare[place] = g->ids[i];
        g->place[i] = place;
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

/* Grains first..last-1 that are near, seen as that image. */
struct stretch { uint32_t first, last, image; };

/* The cells around cell (cx, cy), itself too, that hold grains of its own or a larger index. */
static uint32_t around(const struct gas *g, uint32_t cx, uint32_t cy, struct stretch out[static 9])
{
    const uint32_t here = cx * CELLS + cy, *const at = &g->cell_first[here];
    uint32_t count = 0;
    if (cx > 0 && cy > 0 && cx + 1 < CELLS && cy + 1 < CELLS) {
        out[0] = (struct stretch){at[0], at[2], 0};
        out[1] = (struct stretch){at[CELLS - 1], at[CELLS + 2], 0};
        return 2;
    }
    for (uint32_t a = 0; a < 3; a++) {
        for (uint32_t b = 0; b < 3; b++) {
            const uint32_t x = (cx + a + CELLS - 1) % CELLS, y = (cy + b + CELLS - 1) % CELLS;
            const uint32_t cell = x * CELLS + y;
            if (cell < here) continue;
            const uint32_t image_x = cx + a == 0 ? 2 : cx + a > CELLS ? 1 : 0;
            const uint32_t image_y = cy + b == 0 ? 6 : cy + b > CELLS ? 3 : 0;
            out[count++] = (struct stretch){g->cell_first[cell], g->cell_first[cell + 1],
                                            image_x + image_y};
        }
    }
    return count;
}

/* The pairs of grain i with that stretch, from place `count` on.  Whether a pair is near is as good
 * as random, so there is no branch. */
static inline uint32_t list_body(const struct gas *g, uint32_t i, struct stretch stretch,
                                 struct pair *pairs, uint32_t count)
{
    const struct body *const bodies = g->bodies;
    const double reach2 = (1 + skin) * (1 + skin);
    const double x = bodies[i].x - g->image_x[stretch.image];
    const double y = bodies[i].y - g->image_y[stretch.image];
    for (uint32_t j = stretch.first > i ? stretch.first : i + 1; j < stretch.last; j++) {
        const double dx = x - bodies[j].x, dy = y - bodies[j].y;
        pairs[count] = (struct pair){i, j | stretch.image << INDEX_BITS};
        count += dx * dx + dy * dy < reach2;
    }
    return count;
}

static uint32_t keep_contacts(struct gas *g)
{
    uint32_t kept = 0;
    for (uint32_t k = 0; k < g->pair_count && kept < g->count; k++) {
        const struct pair p = g->pairs[k];
        if (!(p.j >> 31)) continue;
        const uint32_t a = g->place[p.i], b = g->place[p.j & ((1u << INDEX_BITS) - 1)];
        g->kept[kept++] = a < b ? (struct pair){a, b} : (struct pair){b, a};
    }
    return kept;
}

static void carry_contacts(struct gas *g, uint32_t kept)
{
    for (uint32_t c = 0; c < kept; c++) {
        const struct pair contact = g->kept[c];
        for (uint32_t k = g->pair_first[contact.i]; k < g->pair_count; k++) {
            if (g->pairs[k].i != contact.i) break;
            if ((g->pairs[k].j & ((1u << INDEX_BITS) - 1)) == contact.j) g->pairs[k].j |= 1u << 31;
        }
    }
}

static void list_pairs(struct gas *g)
{
    struct stretch near[9];
    sort_bodies(g);
    const uint32_t kept = keep_contacts(g);
    uint32_t pairs = 0;
    g->travel = 0;
    for (uint32_t cx = 0; cx < CELLS; cx++) {
        for (uint32_t cy = 0; cy < CELLS; cy++) {
            const uint32_t cell = cx * CELLS + cy;
            if (g->cell_first[cell] == g->cell_first[cell + 1]) continue;
            if (g->pair_max - pairs < CELL_PAIRS) break;
            const uint32_t count = around(g, cx, cy, near);
            for (uint32_t i = g->cell_first[cell]; i < g->cell_first[cell + 1]; i++) {
                g->pair_first[i] = pairs;
                for (uint32_t r = 0; r < count; r++) {
                    pairs = list_body(g, i, near[r], g->pairs, pairs);
                }
            }
        }
    }
    g->pair_count = pairs;
    carry_contacts(g, kept);
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
        double dx = bodies[p.i].x - bodies[j].x, dy = bodies[p.i].y - bodies[j].y;
        if (__builtin_expect(p.j & 15u << INDEX_BITS, 0)) {
            const uint32_t image = p.j >> INDEX_BITS & 15;
            dx -= g->image_x[image];
            dy -= g->image_y[image];
        }
        w->link[n] = k;
        w->dx[n] = dx;
        w->dy[n] = dy;
        const bool touches = dx * dx + dy * dy < 1;
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
        const double distance = sqrt(w->dx[k] * w->dx[k] + w->dy[k] * w->dy[k]);
        const double share = stiffness * (1 - distance) / distance;
        w->dx[k] *= share;
        w->dy[k] *= share;
        suspects += 1 - distance > overlap_limit;
    }
    return suspects;
}

static void move(struct gas *g, uint32_t first, uint32_t last, double kick)
{
    const double half = 0.5 * dt / mass;
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
    }
}

/* The largest speed squared.  As whole numbers, which have the same order and are compared many at
 * once. */
CLONES static uint64_t fastest_of(const struct half *halves, uint32_t count, uint64_t fastest)
{
    for (uint32_t i = 0; i < count; i++) {
        const double speed2 = halves[i].hx * halves[i].hx + halves[i].hy * halves[i].hy;
        uint64_t bits;
        memcpy(&bits, &speed2, sizeof bits);
        fastest = bits > fastest ? bits : fastest;
    }
    return fastest;
}

static void step(struct gas *g)
{
    struct window w;
    const double kick = (g->steps > 0 ? dt : 0.5 * dt) / mass;
    uint64_t fastest = 0;
    uint32_t done = 0;
    if (2 * (g->travel + g->stride) >= skin) list_pairs(g);
    for (uint32_t k = 0; k < g->pair_count;) {
        const uint32_t left = g->pair_count - k, count = left < WINDOW ? left : WINDOW;
        find(g, g->pairs + k, count, &w);
        g->suspects += press(&w);
        for (uint32_t c = 0; c < w.count; c++) {
            const struct pair *pair = &g->pairs[k + w.link[c]];
            struct push *a = &g->pushes[pair->i];
            struct push *b = &g->pushes[pair->j & ((1u << INDEX_BITS) - 1)];
            a->x += w.dx[c];
            a->y += w.dy[c];
            b->x -= w.dx[c];
            b->y -= w.dy[c];
        }
        k += count;
        const uint32_t next = k < g->pair_count ? g->pairs[k].i : g->count;
        move(g, done, next, kick);
        fastest = fastest_of(g->halves + done, next - done, fastest);
        done = next;
    }
    move(g, done, g->count, kick);
    fastest = fastest_of(g->halves + done, g->count - done, fastest);
    double speed2;
    memcpy(&speed2, &fastest, sizeof speed2);
    g->steps++;
    g->stride = dt * sqrt(speed2);
    g->travel += g->stride;
}

/* ---- from the model's state -------------------------------------------------------------- */

static void gas_close(void *state)
{
    struct gas *g = state;
    void *const arrays[] = {g->bodies, g->bodies_spare, g->halves, g->halves_spare, g->pushes,
                            g->pairs, g->kept, g->ids, g->ids_spare, g->cell_of, g->place,
                            g->pair_first};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) free(arrays[k]);
    free(g);
}

static void *gas_open(const struct simulation *sim, double *bytes)
{
    struct grains grains;
    const uint32_t n = (uint32_t)simulation_count(sim).grains;
    struct gas *g = calloc(1, sizeof *g);
    if (!g || !grains_create(&grains, n, 0, NULL)) {
        free(g);
        return NULL;
    }
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
    g->kept = calloc(n, sizeof *g->kept);
    g->ids = calloc(n, sizeof *g->ids);
    g->ids_spare = calloc(n, sizeof *g->ids);
    g->cell_of = calloc(n, sizeof *g->cell_of);
    g->place = calloc(n, sizeof *g->place);
    g->pair_first = calloc(n, sizeof *g->pair_first);
    const bool done = g->bodies && g->bodies_spare && g->halves && g->halves_spare && g->pushes
                   && g->pairs && g->kept && g->ids && g->ids_spare && g->cell_of && g->place
                   && g->pair_first;
    for (uint32_t k = 0; done && k < n; k++) {
        g->bodies[k] = (struct body){grains.x[k], grains.y[k], grains.vx[k], grains.vy[k]};
        g->halves[k] = (struct half){grains.vx[k], grains.vy[k]};
        g->ids[k] = grains.id[k];
    }
    *bytes = 2.0 * (sizeof(struct body) + sizeof(struct half)) + sizeof(struct push)
           + (PAIRS + 1) * sizeof(struct pair) + 5 * sizeof(uint32_t)
           + sizeof g->cell_first / (double)n;
    grains_free(&grains);
    if (done) {
        list_pairs(g);
        return g;
    }
    gas_close(g);
    return NULL;
}

static void gas_advance(void *state, double t_end)
{
    struct gas *g = state;
    const uint64_t target = (uint64_t)llround(t_end / dt);
    while (g->steps < target) step(g);
}

/* The largest distance of a grain from itself, in the nearest image; another number of collisions
 * is as bad as any distance. */
static double gas_apart(const void *state, const struct simulation *sim)
{
    const struct gas *g = state;
    if (g->contacts != simulation_count(sim).collisions) return INFINITY;
    double *places = calloc(2 * (size_t)g->count, sizeof *places);
    for (uint32_t k = 0; places && k < g->count; k++) {
        places[2 * g->ids[k]] = g->bodies[k].x;
        places[2 * g->ids[k] + 1] = g->bodies[k].y;
    }
    const double worst = places ? stripped_apart(sim, places, SIDE) : NAN;
    free(places);
    return worst;
}

/* Sums are taken in another order by hand: 1e-16 d, ten times more with each collision (the mean
 * way is that many radii), and about one collision a grain in the warm turns. */
const struct stripped_kernel stripped_md = {
    .model = "md", .scene = text, .slice = 0.1, .warm = 7, .turns = 25,
    .open = gas_open, .advance = gas_advance, .close = gas_close,
    .apart = gas_apart, .apart_unit = "diameters", .apart_max = 1e-9,
};
