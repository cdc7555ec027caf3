/* ed_kernel.h - the loop over events.
 *
 * A template: ed_kernel_portable.c and ed_kernel_avx2.c include it, each under its own name, and
 * each compiles it once for every set of the constants below.  Both give the same bytes: no
 * multiply-add is fused, and among equal times the first candidate wins.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed.h"
#include "model/ed/ed_change.h"
#include "model/ed/ed_scan.h"
#include "model/ed/ed_watch.h"

#include <math.h>

#ifdef __SANITIZE_ADDRESS__     /* eight loops with every check in them cost the compiler minutes */
#define FORCE_INLINE static inline
#else
#define FORCE_INLINE static inline __attribute__((always_inline))
#endif

/* What a kernel is compiled for. */
enum {
    WITH_SIZES  = ED_KERNEL_SIZES,
    WITH_SOLIDS = ED_KERNEL_SOLIDS,
    WITH_SPINS  = ED_KERNEL_SPINS
};

enum {
    LIST_ROOM = 128,            /* candidates tried at a time */
    AHEAD_CELLS = 8,            /* events ahead for which memory is asked for */
    AHEAD_GRAINS = 3,
    FETCH_MIN = 30000,          /* grains; fewer of them lie in the cache anyway */
    CROWDED = 4096              /* events that arise in an open bucket before it is too wide */
};

static void make_room(struct ed *ed)
{
    ed_queue_rebuild(&ed->queue, ed->events, ed->count, ed->clock.now, 1 / ed->queue.per_time);
}

FORCE_INLINE void schedule(struct ed *ed, uint32_t i)
{
    if (!ed_queue_put(&ed->queue, ed->events[i].due, i)) make_room(ed);
}

/* When a coordinate leaves [low, high] under acceleration g, from the present on. */
static double leaves(double x, double v, double g, double low, double high)
{
    if (g == 0) return v > 0 ? (high - x) / v : v < 0 ? (low - x) / v : INFINITY;
    if (g > 0) return leaves(-x, -v, -g, -high, -low);
    /* It rises as far as `high` if it is fast enough, and else comes down to `low`. */
    const double up = v > 0 ? v * v + 2 * g * (high - x) : -1;
    if (up > 0) return 2 * (high - x) / (v + sqrt(up));
    if (isinf(low)) return INFINITY;
    const double depth = fmax(x - low, 0), root = sqrt(v * v - 2 * g * depth);
    if (v > 0) return (v + root) / -g;
    return root - v > 0 ? 2 * depth / (root - v) : 0;
}

/* When the grain leaves its cell, from the present on. */
FORCE_INLINE double crossing(const struct ed *ed, uint32_t i, int with)
{
    const struct ed_grain *g = &ed->grains[i];
    const struct ed_event *e = &ed->events[i];
    const struct ed_cells *c = &ed->cells;
    const double t = ed->clock.now;
    if (with & WITH_SOLIDS && (ed->gx != 0 || ed->gy != 0)) {
        const double x = g->x + t * (g->vx + 0.5 * ed->gx * t), vx = g->vx + ed->gx * t;
        const double y = g->y + t * (g->vy + 0.5 * ed->gy * t), vy = g->vy + ed->gy * t;
        const double tx = leaves(x, vx, ed->gx, c->west[e->cx], c->east[e->cx]),
                     ty = leaves(y, vy, ed->gy, c->south[e->cy], c->north[e->cy]);
        return scan_most(scan_least(tx, ty), 0);
    }
    const double face_x = g->vx > 0 ? c->east[e->cx] : c->west[e->cx],
                 face_y = g->vy > 0 ? c->north[e->cy] : c->south[e->cy];
    const double tx = g->vx != 0 ? (face_x - g->x) / g->vx : INFINITY,
                 ty = g->vy != 0 ? (face_y - g->y) / g->vy : INFINITY;
    return scan_most(scan_least(tx, ty) - t, 0);
}

/* Adds the grains of a cell to the list; a chained cell may fill it, then it is tried at once. */
FORCE_INLINE uint32_t gather(struct ed *ed, uint32_t cell, uint32_t *list, uint32_t n,
                             struct scan *scan, int with)
{
    uint32_t added = scan_gather(&ed->cells.cells[cell], list + n);
    n += added;
    while (__builtin_expect(added == ED_CELL_ROOM, 0)) {
        cell = ed->cells.chain[cell];
        if (cell == 0) break;
        if (n + ED_CELL_ROOM + 4 > LIST_ROOM - 9 * ED_CELL_ROOM) {
            scan_list(ed, scan, list, n, with & WITH_SIZES);
            n = 0;
        }
        added = scan_gather(&ed->cells.cells[cell], list + n);
        n += added;
    }
    return n;
}

/* The three columns (rows) of cells around c, wrapped where the box is periodic. */
FORCE_INLINE void around(uint32_t c, uint32_t n, bool wraps, uint32_t out[3])
{
    out[0] = wraps && c == 1 ? n : c - 1;
    out[1] = c;
    out[2] = wraps && c == n ? 1 : c + 1;
}

/* The cells in columns xs of row y; four of them if the row lies across a sheared seam from cy. */
FORCE_INLINE uint32_t gather_row(struct ed *ed, const uint32_t xs[3], uint32_t y, uint32_t cy,
                                 uint32_t *list, uint32_t n, struct scan *scan, int with)
{
    const struct ed_cells *c = &ed->cells;
    const bool above = cy == c->ny && y == 1, below = cy == 1 && y == c->ny;
    if (__builtin_expect(ed->sheared && (above || below), 0)) {
        uint32_t x = ed_shear_column(ed, xs[1], above);
        for (int k = 0; k < 4; k++, x = x == c->nx ? 1 : x + 1) {
            n = gather(ed, ed_cells_index(c, x, y), list, n, scan, with);
        }
        return n;
    }
    for (int k = 0; k < 3; k++) {
        n = gather(ed, ed_cells_index(c, xs[k], y), list, n, scan, with);
    }
    return n;
}

/* Completes grain i's event once its contact with grains is known: walls, and its cell's faces. */
FORCE_INLINE void conclude(struct ed *ed, uint32_t i, int with)
{
    struct ed_event *e = &ed->events[i];
    const double s = crossing(ed, i, with);
    if (with & WITH_SOLIDS) {
        uint32_t partner = ED_NOBODY;
        const double met = ed_walls_meet(ed, i, scan_least(s, e->contact - ed->clock.now),
                                         &partner);
        if (ed->clock.now + met < e->contact) {
            e->contact = ed->clock.now + met;
            e->partner = partner;
        }
    }
    e->due = scan_least(e->contact, ed->clock.now + s);
    schedule(ed, i);
}

FORCE_INLINE void begin_scan(const struct ed *ed, uint32_t i, bool wraps, struct scan *scan)
{
    const struct ed_event *e = &ed->events[i];
    *scan = (struct scan){.i = i, .wraps = wraps, .best = e->contact - ed->clock.now,
                          .partner = e->partner};
}

FORCE_INLINE void end_scan(struct ed *ed, const struct scan *scan)
{
    struct ed_event *e = &ed->events[scan->i];
    if (!scan->found) return;
    e->contact = ed->clock.now + scan->best;
    e->partner = scan->partner;
}

FORCE_INLINE bool at_seam(const struct ed_cells *c, uint32_t cx, uint32_t cy)
{
    return (c->wraps_x && (cx == 1 || cx == c->nx)) || (c->wraps_y && (cy == 1 || cy == c->ny));
}

/* Predicts grain i's event from nothing. */
FORCE_INLINE void predict(struct ed *ed, uint32_t i, int with)
{
    uint32_t list[LIST_ROOM], n = 0;
    struct ed_event *e = &ed->events[i];
    const struct ed_cells *c = &ed->cells;
    struct scan scan;
    e->contact = INFINITY;
    e->partner = ED_NOBODY;
    const bool seam = at_seam(c, e->cx, e->cy);
    begin_scan(ed, i, seam, &scan);
    if (__builtin_expect(!seam, 1)) {
        uint32_t cell = ed_cells_index(c, e->cx - 1u, e->cy - 1u);
        for (int row = 0; row < 3; row++, cell += c->stride) {
            n = gather(ed, cell, list, n, &scan, with);
            n = gather(ed, cell + 1, list, n, &scan, with);
            n = gather(ed, cell + 2, list, n, &scan, with);
        }
    } else {
        uint32_t xs[3], ys[3];
        around(e->cx, c->nx, c->wraps_x, xs);
        around(e->cy, c->ny, c->wraps_y, ys);
        for (int row = 0; row < 3; row++) {
            n = gather_row(ed, xs, ys[row], e->cy, list, n, &scan, with);
        }
    }
    scan_list(ed, &scan, list, n, with & WITH_SIZES);
    end_scan(ed, &scan);
    conclude(ed, i, with);
}

/* Through which face of its cell does grain i leave now: along x or y, up or down?  It is the one
 * that it is farthest beyond.  Rounding may leave it short of that by a hair; if by more, it turned
 * back in the last moment and stays: false. */
FORCE_INLINE bool leaving(const struct ed *ed, uint32_t i, int with, bool *along_x, bool *up)
{
    const struct ed_grain *g = &ed->grains[i];
    const struct ed_event *e = &ed->events[i];
    const struct ed_cells *c = &ed->cells;
    const double t = ed->clock.now;
    double x = g->x + t * g->vx, y = g->y + t * g->vy, vx = g->vx, vy = g->vy;
    if (with & WITH_SOLIDS) {
        x = g->x + t * (g->vx + 0.5 * ed->gx * t);
        y = g->y + t * (g->vy + 0.5 * ed->gy * t);
        vx += ed->gx * t;
        vy += ed->gy * t;
    }
    if (vx == 0) vx = ed->gx;
    if (vy == 0) vy = ed->gy;
    const double out_x = vx > 0 ? x - c->east[e->cx] : vx < 0 ? c->west[e->cx] - x : -INFINITY,
                 out_y = vy > 0 ? y - c->north[e->cy] : vy < 0 ? c->south[e->cy] - y : -INFINITY;
    *along_x = out_x >= out_y;
    *up = *along_x ? vx > 0 : vy > 0;
    return !(with & WITH_SOLIDS) || scan_most(out_x, out_y) >= -1e-9 * c->width_x;
}

/* Grain i goes over into the next cell: only the three cells that came into reach are new. */
FORCE_INLINE void cross(struct ed *ed, uint32_t i, int with)
{
    struct ed_grain *g = &ed->grains[i];
    struct ed_event *e = &ed->events[i];
    const struct ed_cells *c = &ed->cells;
    bool along_x, up;
    if (!leaving(ed, i, with, &along_x, &up)) {
        ed->clock.stale++;
        predict(ed, i, with);
        return;
    }
    ed->clock.crossings++;
    uint32_t cx = e->cx, cy = e->cy;
    cx += along_x ? (up ? 1 : UINT32_MAX) : 0;
    cy += along_x ? 0 : (up ? 1 : UINT32_MAX);
    if (with & WITH_SOLIDS && ed_change_leaves(ed, cx, cy)) {
        ed_change_remove(ed, i);
        return;
    }
    if (__builtin_expect(ed->sheared, 0) && ed_shear_concerns(ed, cy)) {
        ed_shear_cross(ed, i, cx, cy);
        predict(ed, i, with);
        return;
    }
    scan_remove(&ed->cells, ed_cells_index(c, e->cx, e->cy), i);
    if (c->wraps_x && (cx == 0 || cx > c->nx)) {
        g->x += cx == 0 ? ed->wrap_x : -ed->wrap_x;
        cx = cx == 0 ? c->nx : 1;
    }
    if (c->wraps_y && (cy == 0 || cy > c->ny)) {
        g->y += cy == 0 ? ed->wrap_y : -ed->wrap_y;
        cy = cy == 0 ? c->ny : 1;
    }
    e->cx = (uint16_t)cx;
    e->cy = (uint16_t)cy;
    const uint32_t cell = ed_cells_index(c, cx, cy), step = up ? 1 : UINT32_MAX;
    scan_put(&ed->cells, cell, i);
    uint32_t list[LIST_ROOM], n = 0;
    struct scan scan;
    const bool seam = at_seam(c, cx, cy);
    begin_scan(ed, i, seam, &scan);
    if (__builtin_expect(!seam, 1)) {
        const uint32_t side = along_x ? c->stride : 1;
        const uint32_t middle = cell + (along_x ? step : step * c->stride);
        n = gather(ed, middle - side, list, n, &scan, with);
        n = gather(ed, middle, list, n, &scan, with);
        n = gather(ed, middle + side, list, n, &scan, with);
    } else {
        uint32_t xs[3], ys[3];
        around(cx, c->nx, c->wraps_x, xs);
        around(cy, c->ny, c->wraps_y, ys);
        for (int k = 0; k < 3; k++) {
            const uint32_t ahead = up ? 2 : 0;
            const uint32_t new_cell = along_x ? ed_cells_index(c, xs[ahead], ys[k])
                                              : ed_cells_index(c, xs[k], ys[ahead]);
            n = gather(ed, new_cell, list, n, &scan, with);
        }
    }
    scan_list(ed, &scan, list, n, with & WITH_SIZES);
    end_scan(ed, &scan);
    conclude(ed, i, with);
}

/* Gives grain i a velocity without moving it. */
FORCE_INLINE void kick(struct ed *ed, uint32_t i, double dvx, double dvy)
{
    struct ed_grain *g = &ed->grains[i];
    g->vx += dvx;
    g->vy += dvy;
    g->x -= dvx * ed->clock.now;
    g->y -= dvy * ed->clock.now;
}

FORCE_INLINE void turn(struct ed *ed, uint32_t i, double dspin)
{
    ed->spin[i] += dspin;
    ed->angle[i] -= dspin * ed->clock.now;
}

/* Grain i met its partner, or it was deflected before and only a new prediction is due. */
FORCE_INLINE void collide(struct ed *ed, uint32_t i, int with)
{
    struct ed_event *e = &ed->events[i];
    const uint32_t j = e->partner;
    struct approach a;
    if (j >= ed->count || !scan_touches(ed, i, j, with & WITH_SIZES, &a)) {
        ed->clock.stale++;
        predict(ed, i, with);
        return;
    }
    struct ed_event *f = &ed->events[j];
    const double now = ed->clock.now, distance = sqrt(a.dx * a.dx + a.dy * a.dy);
    const double nx = a.dx / distance, ny = a.dy / distance;    /* from i to j */
    const double closing = -a.b / distance;
    const struct ed_pair *pair = &ed->law.pairs[ed_species(ed, i) * ed->law.species_count
                                                + ed_species(ed, j)];
    double r = pair->restitution;
    const bool elastic = ed->law.t_c > 0
                      && (now - e->last < ed->law.t_c || now - f->last < ed->law.t_c);
    if (elastic) {
        r = 1;
        ed->clock.elastic++;
    } else {
        r = ed_law_restitution(&ed->law, r, closing);
    }
    e->last = f->last = now;
    const double share = with & WITH_SIZES ? ed->mass[j] / (ed->mass[i] + ed->mass[j]) : 0.5;
    double normal = (1 + r) * closing * share;                  /* change of i's velocity, -n */
    double sx = 0, sy = 0;
    if (with & WITH_SPINS) {
        /* The normal of cooperative (1) points to body 1: i's is -n, so t = (ny, -nx). */
        const double tx = ny, ty = -nx, mi = ed_mass(ed, i), mj = ed_mass(ed, j);
        const double ri = ed_radius(ed, i), rj = ed_radius(ed, j);
        const double qi = ed->law.inertia_factor[ed_species(ed, i)],
                     qj = ed->law.inertia_factor[ed_species(ed, j)];
        const double slip = -(a.du * tx + a.dv * ty) - ri * ed->spin[i] - rj * ed->spin[j];
        const double mobility = (1 + 1 / qi) / mi + (1 + 1 / qj) / mj;
        const double impulse = ed_law_tangential(pair, slip, mobility, normal * mi);
        if (elastic && closing < ed->law.return_max) {
            normal = share * (closing + ed_law_return(&ed->law, closing, slip, mobility, impulse,
                                                      share * mi));
        }
        sx = impulse / mi * tx;
        sy = impulse / mi * ty;
        turn(ed, i, -impulse / (qi * mi * ri));
        turn(ed, j, -impulse / (qj * mj * rj));
    }
    sx -= normal * nx;
    sy -= normal * ny;
    const double back = with & WITH_SIZES ? ed->mass[i] / ed->mass[j] : 1;
    kick(ed, i, sx, sy);
    kick(ed, j, -sx * back, -sy * back);
    ed->clock.collisions++;
    if (ed->watches) {
        const struct ed_blow blow = {a.dx, a.dy, a.du, a.dv, ed_mass(ed, i) * sx,
                                     ed_mass(ed, i) * sy};
        ed_watch_pair(ed, i, j, &blow, elastic);
    }
    predict(ed, i, with);
    predict(ed, j, with);
}

FORCE_INLINE void handle(struct ed *ed, uint32_t i, int with)
{
    const struct ed_event *e = &ed->events[i];
    if (e->contact > e->due) {
        cross(ed, i, with);
    } else if (with & WITH_SOLIDS && e->partner & ED_SOLID && e->partner != ED_NOBODY) {
        if (ed_change_solid(ed, i)) predict(ed, i, with);
    } else {
        collide(ed, i, with);
    }
}

/* Asks for the memory that an event will need. */
FORCE_INLINE void fetch_ahead(const struct ed *ed, uint32_t i)
{
    const struct ed_event *e = &ed->events[i];
    const struct ed_cells *c = &ed->cells;
    const struct ed_cell *cell = &c->cells[ed_cells_index(c, e->cx - 1u, e->cy - 1u)];
    for (int row = 0; row < 3; row++, cell += c->stride) {
        __builtin_prefetch(cell);
        __builtin_prefetch(cell + 2);
    }
    if (e->contact <= e->due && e->partner < ed->count) {
        __builtin_prefetch(&ed->grains[e->partner], 1);
        __builtin_prefetch(&ed->events[e->partner], 1);
    }
}

/* The same later, when the cells have come: the first grain of each. */
FORCE_INLINE void fetch_grains(const struct ed *ed, uint32_t i)
{
    const struct ed_event *e = &ed->events[i];
    const struct ed_cells *c = &ed->cells;
    const struct ed_cell *cell = &c->cells[ed_cells_index(c, e->cx - 1u, e->cy - 1u)];
    for (int row = 0; row < 3; row++, cell += c->stride) {
        for (int k = 0; k < 3; k++) {
            const uint32_t id = cell[k].id[0];
            __builtin_prefetch(&ed->grains[id == ED_CELL_EMPTY ? i : id]);
        }
    }
}

FORCE_INLINE void fetch_bucket(const struct ed *ed)
{
    const struct ed_queue *q = &ed->queue;
    const struct ed_bucket *next = &q->buckets[(uint32_t)(q->current + 1) & q->mask];
    uint32_t block = next->block, used = next->used;
    while (used) {
        const struct ed_block *b = &q->blocks[block];
        for (uint32_t k = 0; k < used; k++) {
            __builtin_prefetch(&ed->events[b->id[k]], 1);
            __builtin_prefetch(&ed->grains[b->id[k]], 1);
        }
        block = b->next;
        used = block ? ED_BLOCK_ROOM : 0;
    }
    const struct ed_bucket *later = &q->buckets[(uint32_t)(q->current + 2) & q->mask];
    __builtin_prefetch(&q->blocks[later->block]);
    __builtin_prefetch((const char *)&q->blocks[later->block] + 64);
}

/* What the loop counts; held in registers, so told apart from the clock. */
struct tick { uint64_t events, epoch_most, stuck, stuck_most; };

/* Is `now` still moving on?  Counts events against a mark on the clock. */
FORCE_INLINE bool is_stuck(struct ed_clock *clock, struct tick *tick)
{
    if (clock->now > clock->stuck_mark) {
        clock->stuck_mark = clock->now + clock->stuck_step;
        tick->stuck = 0;
        return false;
    }
    return ++tick->stuck > tick->stuck_most;
}

/* The events until something else is due. */
FORCE_INLINE enum ed_stop run_events(struct ed *ed, double limit, uint64_t budget,
                                     struct tick *tick, int with)
{
    struct ed_queue *q = &ed->queue;
    struct ed_clock *clock = &ed->clock;
    const bool fetches = ed->count >= FETCH_MIN;
    for (;;) {
        struct ed_due first;
        bool from_heap, rebuild = false;
        if (!ed_queue_first(q, &first, &from_heap)) {
            if (ed_queue_open(q, ed->events, ed->count, limit, &rebuild)) {
                if (fetches) fetch_bucket(ed);
            } else if (!rebuild) {
                return ED_LIMIT;
            } else {
                ed_queue_rebuild(q, ed->events, ed->count, clock->now, 8 / q->per_time);
            }
            continue;
        }
        if (first.t > limit) return ED_LIMIT;
        const bool old = first.id >= ed->count || ed->events[first.id].due != first.t;
        if (!old && tick->events == budget) return ED_BUDGET;
        if (from_heap) ed_queue_drop_heap_top(q);
        else q->ready_count--;
        if (old) continue;
        if (fetches && q->ready_count >= AHEAD_CELLS) {
            fetch_ahead(ed, q->ready[q->ready_count - AHEAD_CELLS].id);
        }
        if (fetches && q->ready_count >= AHEAD_GRAINS) {
            fetch_grains(ed, q->ready[q->ready_count - AHEAD_GRAINS].id);
        }
        clock->now = first.t;
        tick->events++;
        handle(ed, first.id, with);
        if (q->pushed > CROWDED) {
            ed_queue_rebuild(q, ed->events, ed->count, clock->now, 0.125 / q->per_time);
        }
        if (is_stuck(clock, tick)) return ED_STUCK;
        if (tick->events > tick->epoch_most || clock->now > clock->epoch_end) return ED_EPOCH;
    }
}

FORCE_INLINE enum ed_stop run(struct ed *ed, double limit, uint64_t *budget, int with)
{
    struct ed_clock *clock = &ed->clock;
    const uint64_t epoch_events = 8ull * ed->count + 4096;
    struct tick tick = {.stuck = clock->stuck_events, .stuck_most = ed_stuck_events(ed->count)};
    if (epoch_events > clock->epoch_events) tick.epoch_most = epoch_events - clock->epoch_events;
    const enum ed_stop stop = run_events(ed, limit, *budget, &tick, with);
    clock->events += tick.events;
    clock->epoch_events += tick.events;
    clock->stuck_events = tick.stuck;
    *budget -= tick.events;
    return stop;
}

#define KERNEL(with)                                                                    \
    static enum ed_stop run_##with(struct ed *ed, double limit, uint64_t *budget)       \
    {                                                                                   \
        return run(ed, limit, budget, with);                                            \
    }
KERNEL(0) KERNEL(1) KERNEL(2) KERNEL(3) KERNEL(4) KERNEL(5) KERNEL(6) KERNEL(7)
#undef KERNEL

/* Makes a grain's event anew, at the present. */
static void predict_one(struct ed *ed, uint32_t i)
{
    if (ed->radius) predict(ed, i, WITH_SOLIDS | WITH_SIZES);
    else predict(ed, i, WITH_SOLIDS);
}

const struct ed_kernels KERNEL_SET = {
    predict_one, {run_0, run_1, run_2, run_3, run_4, run_5, run_6, run_7}
};
