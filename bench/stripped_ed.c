/* stripped_ed.c - hard discs by hand; see stripped.h.
 *
 * The algorithm of ed: positions as at the epoch; one event a grain, its soonest; cells with room
 * for a margin; epochs that move up.  The calendar and the grid know of no effect and are the
 * model's own; what reads grains and decides is written here, for equal discs that lose nothing.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#if defined __x86_64__ && defined __GNUC__ && !defined __clang__
#pragma GCC target("avx2")
#define SCAN_AVX2 1
#endif
#include "bench/stripped.h"

#include "model/ed/ed_scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 140.0

static const char text[] =
    "until = 1e3; box = [0, 0, 140, 140];"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
    "grains = ({ radius = 0.5; density = 1.2732395447351628; restitution = 1; });"
    "placements = ({ kind = \"square\"; spacing = 1.4; temperature = 1; });";

enum { LIST_ROOM = 128, AHEAD_CELLS = 8, AHEAD_GRAINS = 3, CROWDED = 4096 };

/* As in the model: what is rounding, and how far grains fly before the epoch moves up. */
static const double noise_share = 1e-15, way_max = 1e4, cell_width = 1.8, reach = 1 + 1e-6;

struct gas {
    uint32_t count;
    struct ed_grain *grains, *grains_spare;
    struct ed_event *events, *events_spare;
    uint32_t *ids, *ids_spare, *place;
    struct ed_cells cells;
    struct ed_queue queue;
    double   now, epoch, epoch_end, graze;
    uint64_t epoch_events, collisions;
    struct arena arena;
};

/* ---- who is met first ---------------------------------------------------------------------- */

struct found { double best; uint32_t partner; };

/* Grain j as seen from grain i now. */
static inline struct approach approach(const struct gas *g, const struct ed_grain *a,
                                       const struct ed_grain *b, bool wraps)
{
    struct approach s = {.du = b->vx - a->vx, .dv = b->vy - a->vy};
    s.dx = (b->x - a->x) + s.du * g->now;
    s.dy = (b->y - a->y) + s.dv * g->now;
    if (wraps) {
        s.dx -= SIDE * rint(s.dx * (1 / SIDE));
        s.dy -= SIDE * rint(s.dy * (1 / SIDE));
    }
    s.b = s.dx * s.du + s.dy * s.dv;
    return s;
}

#ifndef SCAN_AVX2
static void scan(const struct gas *g, uint32_t i, uint32_t *list, uint32_t n, bool wraps,
                 struct found *found)
{
    for (uint32_t k = 0; k < n; k++) {
        const struct approach a = approach(g, &g->grains[i], &g->grains[list[k]], wraps);
        const double c = (a.dx * a.dx + a.dy * a.dy) - 1, u2 = a.du * a.du + a.dv * a.dv;
        const double q = a.b * a.b - u2 * c;
        if (!(a.b < g->graze) || !(q > 0)) continue;
        const double s = scan_most(c / (sqrt(q) - a.b), 0);
        if (s < found->best) *found = (struct found){s, list[k]};
    }
}
#else
static inline __attribute__((always_inline)) void
scan(const struct gas *g, uint32_t i, uint32_t *list, uint32_t n, bool wraps, struct found *found)
{
    enum { nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC };
    const struct ed_grain *grains = g->grains, *own = &grains[i];
    const __m256d x = _mm256_set1_pd(own->x), y = _mm256_set1_pd(own->y),
                  vx = _mm256_set1_pd(own->vx), vy = _mm256_set1_pd(own->vy),
                  t = _mm256_set1_pd(g->now), zero = _mm256_setzero_pd(),
                  side = _mm256_set1_pd(SIDE), per_side = _mm256_set1_pd(1 / SIDE);
    __m256d best = _mm256_set1_pd(found->best), who = _mm256_set1_pd(-1);
    __m256d place = _mm256_set_pd(3, 2, 1, 0);
    for (uint32_t k = n; k < n + 3; k++) list[k] = g->count;        /* it is nowhere */
    for (uint32_t k = 0; k < n; k += 4) {
        const __m256d a = _mm256_load_pd(&grains[list[k]].x),
                      b = _mm256_load_pd(&grains[list[k + 1]].x),
                      c = _mm256_load_pd(&grains[list[k + 2]].x),
                      d = _mm256_load_pd(&grains[list[k + 3]].x);
        const __m256d ab_low = _mm256_unpacklo_pd(a, b), ab_high = _mm256_unpackhi_pd(a, b),
                      cd_low = _mm256_unpacklo_pd(c, d), cd_high = _mm256_unpackhi_pd(c, d);
        const __m256d du = _mm256_sub_pd(_mm256_permute2f128_pd(ab_low, cd_low, 0x31), vx),
                      dv = _mm256_sub_pd(_mm256_permute2f128_pd(ab_high, cd_high, 0x31), vy);
        __m256d dx = _mm256_sub_pd(_mm256_permute2f128_pd(ab_low, cd_low, 0x20), x),
                dy = _mm256_sub_pd(_mm256_permute2f128_pd(ab_high, cd_high, 0x20), y);
        dx = _mm256_add_pd(dx, _mm256_mul_pd(du, t));
        dy = _mm256_add_pd(dy, _mm256_mul_pd(dv, t));
        if (__builtin_expect(wraps, 0)) {
            dx = _mm256_sub_pd(dx, _mm256_mul_pd(side, _mm256_round_pd(_mm256_mul_pd(dx, per_side),
                                                                       nearest)));
            dy = _mm256_sub_pd(dy, _mm256_mul_pd(side, _mm256_round_pd(_mm256_mul_pd(dy, per_side),
                                                                       nearest)));
        }
        const __m256d bb = _mm256_add_pd(_mm256_mul_pd(dx, du), _mm256_mul_pd(dy, dv));
        const __m256d d2 = _mm256_add_pd(_mm256_mul_pd(dx, dx), _mm256_mul_pd(dy, dy));
        const __m256d cc = _mm256_sub_pd(d2, _mm256_set1_pd(1));
        const __m256d u2 = _mm256_add_pd(_mm256_mul_pd(du, du), _mm256_mul_pd(dv, dv));
        const __m256d q = _mm256_sub_pd(_mm256_mul_pd(bb, bb), _mm256_mul_pd(u2, cc));
        const __m256d root = _mm256_div_pd(cc, _mm256_sub_pd(_mm256_sqrt_pd(q), bb));
        const __m256d s = _mm256_max_pd(root, zero);
        const __m256d meets = _mm256_and_pd(
            _mm256_cmp_pd(bb, _mm256_set1_pd(g->graze), _CMP_LT_OQ),
            _mm256_cmp_pd(q, zero, _CMP_GT_OQ));
        const __m256d sooner = _mm256_and_pd(meets, _mm256_cmp_pd(s, best, _CMP_LT_OQ));
        best = _mm256_blendv_pd(best, s, sooner);
        who = _mm256_blendv_pd(who, place, sooner);
        place = _mm256_add_pd(place, _mm256_set1_pd(4));
    }
    struct scan kept = {.best = found->best, .partner = found->partner};
    scan_keep(&kept, best, who, list);
    *found = (struct found){kept.best, kept.partner};
}
#endif

/* ---- events -------------------------------------------------------------------------------- */

static inline __attribute__((always_inline)) void
conclude(struct gas *g, uint32_t i, const uint32_t *cells, uint32_t cell_count, bool wraps,
         struct found found)
{
    struct ed_event *e = &g->events[i];
    const struct ed_grain *p = &g->grains[i];
    const struct ed_cells *c = &g->cells;
    const double before = found.best;
    uint32_t list[LIST_ROOM], n = 0;
    for (uint32_t k = 0; k < cell_count; k++) n += scan_gather(&c->cells[cells[k]], list + n);
    scan(g, i, list, n, wraps, &found);
    if (found.best < before) {
        e->contact = g->now + found.best;
        e->partner = found.partner;
    }
    const double face_x = p->vx > 0 ? c->east[e->cx] : c->west[e->cx],
                 face_y = p->vy > 0 ? c->north[e->cy] : c->south[e->cy];
    const double tx = p->vx != 0 ? (face_x - p->x) / p->vx : INFINITY,
                 ty = p->vy != 0 ? (face_y - p->y) / p->vy : INFINITY;
    e->due = scan_least(e->contact, g->now + scan_most(scan_least(tx, ty) - g->now, 0));
    if (ed_queue_put(&g->queue, e->due, i)) return;
    ed_queue_rebuild(&g->queue, g->events, g->count, g->now, 1 / g->queue.per_time);
}

static inline uint32_t wrapped(uint32_t c, uint32_t n) { return c == 0 ? n : c > n ? 1 : c; }

static inline bool at_seam(const struct ed_cells *c, const struct ed_event *e)
{
    return e->cx == 1 || e->cx == c->nx || e->cy == 1 || e->cy == c->ny;
}

/* Columns x - dx .. x + dx and rows y - dy .. y + dy of cells, through the borders. */
static uint32_t cells_of(const struct ed_cells *c, uint32_t x, uint32_t y, uint32_t dx,
                         uint32_t dy, uint32_t *out)
{
    uint32_t count = 0;
    for (uint32_t b = y - dy; b <= y + dy; b++) {
        for (uint32_t a = x - dx; a <= x + dx; a++) {
            out[count++] = ed_cells_index(c, wrapped(a, c->nx), wrapped(b, c->ny));
        }
    }
    return count;
}

static inline __attribute__((always_inline)) void predict(struct gas *g, uint32_t i)
{
    struct ed_event *e = &g->events[i];
    const struct ed_cells *c = &g->cells;
    uint32_t cells[9];
    e->contact = INFINITY;
    e->partner = ED_NOBODY;
    if (__builtin_expect(at_seam(c, e), 0)) {
        cells_of(c, e->cx, e->cy, 1, 1, cells);
        conclude(g, i, cells, 9, true, (struct found){INFINITY, ED_NOBODY});
        return;
    }
    const uint32_t first = ed_cells_index(c, e->cx - 1u, e->cy - 1u);
    for (uint32_t k = 0; k < 9; k++) cells[k] = first + k % 3 + k / 3 * c->stride;
    conclude(g, i, cells, 9, false, (struct found){INFINITY, ED_NOBODY});
}

static inline __attribute__((always_inline)) void cross(struct gas *g, uint32_t i)
{
    struct ed_event *e = &g->events[i];
    struct ed_grain *p = &g->grains[i];
    const struct ed_cells *c = &g->cells;
    const double x = p->x + g->now * p->vx, y = p->y + g->now * p->vy;
    const double far_x = p->vx > 0 ? x - c->east[e->cx] : c->west[e->cx] - x,
                 far_y = p->vy > 0 ? y - c->north[e->cy] : c->south[e->cy] - y;
    const bool along_x = far_x > far_y, up = along_x ? p->vx > 0 : p->vy > 0;
    const uint32_t move = up ? 1 : UINT32_MAX;
    scan_remove(&g->cells, ed_cells_index(c, e->cx, e->cy), i);
    const uint32_t cx = e->cx + (along_x ? move : 0), cy = e->cy + (along_x ? 0 : move);
    if (cx == 0 || cx > c->nx) p->x += cx == 0 ? SIDE : -SIDE;
    if (cy == 0 || cy > c->ny) p->y += cy == 0 ? SIDE : -SIDE;
    e->cx = (uint16_t)wrapped(cx, c->nx);
    e->cy = (uint16_t)wrapped(cy, c->ny);
    const uint32_t cell = ed_cells_index(c, e->cx, e->cy), side = along_x ? c->stride : 1;
    scan_put(&g->cells, cell, i);
    const struct found known = {e->contact - g->now, e->partner};
    if (__builtin_expect(at_seam(c, e), 0)) {
        uint32_t cells[3];
        if (along_x) cells_of(c, wrapped(e->cx + move, c->nx), e->cy, 0, 1, cells);
        else cells_of(c, e->cx, wrapped(e->cy + move, c->ny), 1, 0, cells);
        conclude(g, i, cells, 3, true, known);
        return;
    }
    const uint32_t middle = cell + (along_x ? move : move * c->stride);
    conclude(g, i, (uint32_t[]){middle - side, middle, middle + side}, 3, false, known);
}

static inline void kick(struct gas *g, uint32_t i, double dvx, double dvy)
{
    struct ed_grain *p = &g->grains[i];
    p->vx += dvx;
    p->vy += dvy;
    p->x -= dvx * g->now;
    p->y -= dvy * g->now;
}

static inline __attribute__((always_inline)) void collide(struct gas *g, uint32_t i)
{
    const uint32_t j = g->events[i].partner;
    const struct approach a = approach(g, &g->grains[i], &g->grains[j], true);
    const double distance2 = a.dx * a.dx + a.dy * a.dy;
    if (a.b < g->graze && distance2 < 1 + touch_slack) {
        const double distance = sqrt(distance2), closing = -a.b / distance;
        const double nx = a.dx / distance, ny = a.dy / distance;
        kick(g, i, -closing * nx, -closing * ny);
        kick(g, j, closing * nx, closing * ny);
        g->collisions++;
        g->events[i].last = g->events[j].last = g->now;
        predict(g, i);
        predict(g, j);
    } else {
        predict(g, i);
    }
}

static inline void fetch_ahead(const struct gas *g, uint32_t i)
{
    const struct ed_event *e = &g->events[i];
    const struct ed_cell *cell = &g->cells.cells[ed_cells_index(&g->cells, e->cx - 1u,
                                                                e->cy - 1u)];
    for (int row = 0; row < 3; row++, cell += g->cells.stride) {
        __builtin_prefetch(cell);
        __builtin_prefetch(cell + 2);
    }
    if (e->partner == ED_NOBODY) return;
    __builtin_prefetch(&g->grains[e->partner], 1);
    __builtin_prefetch(&g->events[e->partner], 1);
}

static inline void fetch_grains(const struct gas *g, uint32_t i)
{
    const struct ed_event *e = &g->events[i];
    const struct ed_cell *cell = &g->cells.cells[ed_cells_index(&g->cells, e->cx - 1u,
                                                                e->cy - 1u)];
    for (int row = 0; row < 3; row++, cell += g->cells.stride) {
        for (int k = 0; k < 3; k++) {
            const uint32_t id = cell[k].id[0];
            __builtin_prefetch(&g->grains[id == ED_CELL_EMPTY ? i : id]);
        }
    }
}

static void begin_epoch(struct gas *g)
{
    const double t = g->now, span = t;
    double fastest2 = 0;
    uint32_t k = 0;
    for (uint32_t cell = 0; cell < g->cells.count; cell++) {
        uint32_t *ids = g->cells.cells[cell].id;
        for (uint32_t s = 0; s < ED_CELL_ROOM && ids[s] != ED_CELL_EMPTY; s++) {
            const uint32_t i = ids[s];
            struct ed_grain p = g->grains[i];
            struct ed_event e = g->events[i];
            p.x += t * p.vx;
            p.y += t * p.vy;
            e.contact -= t;
            e.due -= t;
            e.last -= t;
            fastest2 = fmax(fastest2, p.vx * p.vx + p.vy * p.vy);
            g->grains_spare[k] = p;
            g->events_spare[k] = e;
            g->ids_spare[k] = g->ids[i];
            g->place[i] = k;
            ids[s] = k++;
        }
    }
    memcpy(g->grains, g->grains_spare, g->count * sizeof *g->grains);
    memcpy(g->events, g->events_spare, g->count * sizeof *g->events);
    memcpy(g->ids, g->ids_spare, g->count * sizeof *g->ids);
    for (uint32_t i = 0; i < g->count; i++) {
        struct ed_event *e = &g->events[i];
        if (e->partner != ED_NOBODY) e->partner = g->place[e->partner];
    }
    g->epoch += t;
    g->now = 0;
    g->graze = -noise_share * sqrt(fastest2);
    g->epoch_end = way_max / sqrt(fastest2);
    double width = 1 / g->queue.per_time;
    if (span > 0 && g->epoch_events > g->count) {
        width = ED_BUCKET_FILL * span / (double)g->epoch_events;
    }
    g->epoch_events = 0;
    ed_queue_rebuild(&g->queue, g->events, g->count, 0, width);
}

static void gas_advance(void *state, double t_end)
{
    struct gas *g = state;
    struct ed_queue *q = &g->queue;
    for (;;) {
        struct ed_due first;
        bool from_heap, rebuild = false;
        const double limit = t_end - g->epoch;
        if (!ed_queue_first(q, &first, &from_heap)) {
            if (ed_queue_open(q, g->events, g->count, limit, &rebuild)) continue;
            if (!rebuild) return;
            ed_queue_rebuild(q, g->events, g->count, g->now, 8 / q->per_time);
            continue;
        }
        if (first.t > limit) return;
        if (from_heap) ed_queue_drop_heap_top(q);
        else q->ready_count--;
        if (g->events[first.id].due != first.t) continue;
        if (q->ready_count >= AHEAD_CELLS) {
            fetch_ahead(g, q->ready[q->ready_count - AHEAD_CELLS].id);
        }
        if (q->ready_count >= AHEAD_GRAINS) {
            fetch_grains(g, q->ready[q->ready_count - AHEAD_GRAINS].id);
        }
        g->now = first.t;
        g->epoch_events++;
        const struct ed_event *e = &g->events[first.id];
        if (e->contact > e->due) cross(g, first.id);
        else collide(g, first.id);
        if (q->pushed > CROWDED) {
            ed_queue_rebuild(q, g->events, g->count, g->now, 0.125 / q->per_time);
        }
        if (g->epoch_events > 8ull * g->count + 4096 || g->now > g->epoch_end) begin_epoch(g);
    }
}

/* ---- from the model's state ---------------------------------------------------------------- */

static void gas_close(void *state)
{
    struct gas *g = state;
    arena_free(&g->arena);
    free(g);
}

static bool take_arrays(struct gas *g)
{
    const struct ed_grid grid = {
        .box = {0, 0, SIDE, SIDE}, .reach = reach, .width = cell_width, .margin = 1,
        .cells_max = 4 * g->count, .wraps_x = true, .wraps_y = true, .beyond = 1,
    };
    struct arena *arena = &g->arena;
    const size_t n = (size_t)g->count + 1;
    return arena_array(arena, &g->grains, n) && arena_array(arena, &g->grains_spare, n)
        && arena_array(arena, &g->events, n) && arena_array(arena, &g->events_spare, n)
        && arena_array(arena, &g->ids, n) && arena_array(arena, &g->ids_spare, n)
        && arena_array(arena, &g->place, n)
        && ed_cells_create(&g->cells, &grid, g->count, arena)
        && ed_queue_create(&g->queue, g->count, arena);
}

static void *gas_open(const struct simulation *sim, double *bytes)
{
    struct grains grains;
    struct gas *g = calloc(1, sizeof *g);
#ifdef SCAN_AVX2
    if (!__builtin_cpu_supports("avx2")) {
        free(g);
        return NULL;
    }
#endif
    if (!g) return NULL;
    g->count = (uint32_t)simulation_count(sim).grains;
    if (!grains_create(&grains, g->count, 0, NULL) || !take_arrays(g)) {
        gas_close(g);
        return NULL;
    }
    simulation_observe(sim, &grains);
    for (uint32_t i = 0; i < g->count; i++) {
        struct ed_event *e = &g->events[i];
        g->grains[i] = (struct ed_grain){grains.x[i], grains.y[i], grains.vx[i], grains.vy[i]};
        g->ids[i] = grains.id[i];
        *e = (struct ed_event){INFINITY, INFINITY, ED_NOBODY, 0, 0, -INFINITY};
        ed_cells_place(&g->cells, grains.x[i], grains.y[i], &e->cx, &e->cy);
        ed_cells_put(&g->cells, ed_cells_index(&g->cells, e->cx, e->cy), i);
    }
    grains_free(&grains);
    g->grains[g->count] = (struct ed_grain){NAN, NAN, NAN, NAN};
    g->queue.per_time = 1;
    begin_epoch(g);
    ed_queue_rebuild(&g->queue, g->events, 0, 0, 0.1 * ED_BUCKET_FILL / g->count);
    for (uint32_t i = 0; i < g->count; i++) predict(g, i);
    const double cells = (g->cells.count + g->cells.block_count) * (sizeof(struct ed_cell) + 4.0);
    const double queue = g->queue.block_count * (double)sizeof(struct ed_block);
    *bytes = 2 * (sizeof *g->grains + sizeof *g->events) + 3 * sizeof *g->ids
           + (cells + queue) / g->count + sizeof(struct ed_due) + 5;
    return g;
}

/* The largest distance of a grain from itself, in the nearest image. */
static double gas_apart(const void *state, const struct simulation *sim)
{
    const struct gas *g = state;
    double *places = calloc(2 * (size_t)g->count, sizeof *places);
    const double t = simulation_count(sim).time - g->epoch;
    for (uint32_t i = 0; places && i < g->count; i++) {
        places[2 * g->ids[i]] = g->grains[i].x + t * g->grains[i].vx;
        places[2 * g->ids[i] + 1] = g->grains[i].y + t * g->grains[i].vy;
    }
    const double worst = places ? stripped_apart(sim, places, SIDE) : NAN;
    free(places);
    return worst;
}

/* The operations are the model's, but for the digits of the time; a collision multiplies what is
 * apart by ten, and there are two or three a grain in the warm turns. */
const struct stripped_kernel stripped_ed = {
    .model = "ed", .scene = text, .slice = 0.2, .warm = 5, .turns = 35,
    .open = gas_open, .advance = gas_advance, .close = gas_close,
    .apart = gas_apart, .apart_unit = "diameters", .apart_max = 1e-8,
};
