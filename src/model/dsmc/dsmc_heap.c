/* dsmc_heap.c - hsmc: grains move one after the other and never into a full cell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Paper 000 (2.2) refuses a move into a full cell and leaves open what becomes of the grain.  A
 * heap stands if the refused grain tries the vertical part of its way, then the horizontal, else
 * collides with a grain of the full cell; and if it rests once both are slow, unless it can roll
 * down to one side.  A grain at rest is passed over while the cell below it stays full and no drop
 * of two cells opens beside it, as it does where sand runs out.  Cells are
 * two diameters wide and hold four grains, an area fraction of 0.785.
 *
 * A sweep goes through the grains in their order, from a random one on and in a random sense,
 * and asks for the numbers of grains as they are by then.  Threads sweep stripes of rows, first
 * every other one, then the rest.  A stripe is so high that two of the same turn never look at the
 * same cell, so it does not matter who takes which; where stripes meet is drawn anew each step.
 */
#include "model/dsmc/dsmc_heap.h"

#include "base/rng.h"
#include "model/dsmc/dsmc_collide.h"
#include "model/dsmc/dsmc_flight.h"
#include "model/dsmc/dsmc_walls.h"

#include <math.h>
#include <omp.h>
#include <string.h>

static const uint64_t sweep_key = 0x7377656570, reach_key = 0x7265616368;
static const float  way_max = 0.95f;            /* in cells */
static const double slow = 0.5;                 /* relative speed at which grains rest, sqrt(g d) */

enum {
    STRIPE = 12,                /* rows: more than 2 (FAR_ROWS + 2), what two stripes reach */
    FAR_ROWS = DSMC_HEAP_ROWS   /* that walls may push a grain in a step; else it stays */
};

struct sweep {
    struct dsmc *dsmc;
    struct dsmc_flight flight;
    struct dsmc_finder finder;
    float gx, gy, dt, way_max, slow2, roll;
    int   down;                 /* row step along gravity, 0: none */
    uint32_t nx, ny;
    uint64_t key;               /* of the random numbers of this step */
    uint32_t block;             /* of this stripe: where impulses on obstacles are summed up */
    uint64_t collisions, rejected;
    double  *impacts;           /* of this thread; NULL if nobody asks */
    bool moved;                 /* has a grain changed its cell? */
};

/* Is the cell one step along (dx, dy) full?  What lies outside of the grid is full where a wall
 * is, and free where the border is open. */
static bool is_full(const struct sweep *sweep, uint32_t cell, int dx, int dy)
{
    const struct dsmc *dsmc = sweep->dsmc;
    int64_t x = (int64_t)(cell % sweep->nx) + dx, y = (int64_t)(cell / sweep->nx) + dy;
    const int64_t nx = sweep->nx, ny = sweep->ny;
    if (x < 0 || x >= nx) {
        if (!dsmc->ax.wraps) {
            return (x < 0 ? dsmc->scene->left : dsmc->scene->right) == BORDER_WALL;
        }
        x = (x + nx) % nx;
    }
    if (y < 0 || y >= ny) {
        if (!dsmc->ay.wraps) {
            return (y < 0 ? dsmc->scene->bottom : dsmc->scene->top) == BORDER_WALL;
        }
        y = (y + ny) % ny;
    }
    return dsmc->load[y * nx + x] >= dsmc->full;
}

/* Is the cell below full?  The common case without a division. */
static bool lies_on_full(const struct sweep *sweep, uint32_t cell)
{
    if (sweep->down < 0 && cell >= sweep->nx) {
        return sweep->dsmc->load[cell - sweep->nx] >= sweep->dsmc->full;
    }
    return is_full(sweep, cell, 0, sweep->down);
}

/* Columns within which this grain rolls. */
static int reach_of(const struct dsmc *dsmc, uint32_t i)
{
    const double *reach = dsmc->settings.reach;
    const uint64_t word = rng_keyed(dsmc->seed, reach_key, dsmc->tags[i] & DSMC_NAME, 0);
    return (int)floor(reach[0] + rng_unit(word) * (reach[1] - reach[0] + 1));
}

/* To which side it can roll: within its reach the cells beside are free and one below them too. */
static int roll_side(const struct sweep *sweep, uint32_t i, uint32_t cell, uint64_t word)
{
    const int reach = reach_of(sweep->dsmc, i), begin = word & 1 ? 1 : -1;
    for (int turn = 0; turn < 2; turn++) {
        const int side = turn == 0 ? begin : -begin;
        for (int k = 1; k <= reach; k++) {
            if (is_full(sweep, cell, side * k, 0)) break;
            if (!is_full(sweep, cell, side * k, sweep->down)) return side;
        }
    }
    return 0;
}

/* Collides grain i, at (x, y) before its move, with one of the full cell `to`: the normal is that
 * of the face between, turned at random.  Returns the square of their relative speed after. */
static float bump(struct sweep *sweep, uint32_t i, uint32_t cell, uint32_t to, struct rng *rng)
{
    struct dsmc *dsmc = sweep->dsmc;
    const uint32_t n = dsmc->first[to + 1] - dsmc->first[to];
    struct dsmc_grain *p = &dsmc->grains[i];
    const double b = 2 * rng_uniform(rng) - 1, u = rng_uniform(rng);
    struct dsmc_grain none = {0};
    const uint32_t j = n > 0 ? dsmc->first[to] + (uint32_t)(u * n) : i;
    struct dsmc_grain *q = j == i ? &none : &dsmc->grains[j];
    const uint32_t rows = to / sweep->nx, row = cell / sweep->nx;
    float fx = 0, fy = 0;                                       /* the face's normal */
    if (rows != row) fy = p->vy > 0 ? 1 : -1;
    else fx = p->vx > 0 ? 1 : -1;
    const float s = (float)b, c = sqrtf(1 - s * s);
    const float nx = c * fx - s * fy, ny = c * fy + s * fx;
    const float un = (p->vx - q->vx) * nx + (p->vy - q->vy) * ny;
    if (un > 0) {
        const float blow = dsmc->half_impulse * un;
        p->vx -= blow * nx;
        p->vy -= blow * ny;
        q->vx += blow * nx;
        q->vy += blow * ny;
        sweep->collisions++;
        if (sweep->impacts) dsmc_note_impact(dsmc, sweep->impacts, s);
    }
    const float ux = p->vx - q->vx, uy = p->vy - q->vy;
    if (j != i && dsmc->tags[j] & DSMC_RESTS) {
        if (q->vx * q->vx + q->vy * q->vy > sweep->slow2) dsmc->tags[j] &= DSMC_NAME;
        else q->vx = q->vy = 0;
    }
    return ux * ux + uy * uy;
}

/* A refused grain: it stays where it was. */
static void refuse(struct sweep *sweep, uint32_t i, uint32_t cell, uint32_t to)
{
    struct dsmc *dsmc = sweep->dsmc;
    struct rng rng = rng_stream(sweep->key, i, 0);
    const float u2 = bump(sweep, i, cell, to, &rng);
    sweep->rejected++;
    if (sweep->down == 0 || u2 > sweep->slow2) return;
    if (!lies_on_full(sweep, cell)) return;
    struct dsmc_grain *p = &dsmc->grains[i];
    const int side = roll_side(sweep, i, cell, rng_u64(&rng));
    if (side == 0) {
        dsmc->tags[i] |= DSMC_RESTS;
        p->vx = p->vy = 0;
    } else {
        p->vx = (float)side * sweep->roll;
        p->vy = 0;
    }
}

/* Has a cell beside it room?  Most grains of a heap learn from this that they cannot roll. */
static bool has_free_side(const struct sweep *sweep, uint32_t cell)
{
    const struct dsmc *dsmc = sweep->dsmc;
    const uint32_t x = cell % sweep->nx;
    if (x == 0 || x + 1 == sweep->nx) return true;
    return dsmc->load[cell - 1] < dsmc->full || dsmc->load[cell + 1] < dsmc->full;
}

/* A grain at rest starts only where the drop beside it is two cells: a slope that stands is steeper
 * than one on which grains come to rest. */
static int drop_side(const struct sweep *sweep, uint32_t cell, uint64_t word)
{
    const int begin = word & 1 ? 1 : -1;
    for (int turn = 0; turn < 2; turn++) {
        const int side = turn == 0 ? begin : -begin;
        if (!is_full(sweep, cell, side, 0) && !is_full(sweep, cell, side, sweep->down)
            && !is_full(sweep, cell, side, 2 * sweep->down)) return side;
    }
    return 0;
}

/* Does grain i, which is at rest, stay so?  Not if what carried it has gone, nor beside a drop. */
static bool rests(struct sweep *sweep, uint32_t i, uint32_t cell)
{
    struct dsmc *dsmc = sweep->dsmc;
    const uint32_t tag = dsmc->tags[i];
    if (tag & DSMC_PLATE) {
        if (!dsmc->walls.vary || dsmc_walls_carries(dsmc, &dsmc->grains[i])) return true;
    } else if (lies_on_full(sweep, cell)) {
        if (!has_free_side(sweep, cell)) return true;
        const int side = drop_side(sweep, cell, rng_keyed(sweep->key, i, 1, 0));
        if (side == 0) return true;
        dsmc->grains[i].vx = (float)side * sweep->roll;
    }
    dsmc->tags[i] = tag & DSMC_NAME;
    return false;
}

/* Where a grain would be after this step: never farther than the cap.  The speed grows with the
 * whole step even where the way is cut. */
FORCE_INLINE vector4 flown(const struct sweep *sweep, vector4 p, float time)
{
    const float half = 0.5f * time * time;
    const vector4 v = {p[2], p[3], p[2], p[3]}, times = {time, time, 0, 0};
    const vector4 fall = {half * sweep->gx, half * sweep->gy, sweep->dt * sweep->gx,
                          sweep->dt * sweep->gy};
    return p + (v * times + fall);
}

/* The same among walls; true if one of them carries it. */
static bool fly_among_walls(struct sweep *sweep, uint32_t i, float time)
{
    struct dsmc_grain *p = &sweep->dsmc->grains[i];
    const bool plate = dsmc_walls_fly(sweep->dsmc, i, time, sweep->block);
    p->vx += (sweep->dt - time) * sweep->gx;
    p->vy += (sweep->dt - time) * sweep->gy;
    return plate;
}

static bool is_far(const struct sweep *sweep, uint32_t cell, uint32_t to)
{
    const uint32_t a = cell / sweep->nx, b = to / sweep->nx, rows = a > b ? a - b : b - a;
    return rows > FAR_ROWS && (!sweep->dsmc->ay.periodic || sweep->ny - rows > FAR_ROWS);
}

/* A move into the full cell `to`: the upright part of the way, then the level one, else none.
 * False if it is refused. */
static bool give_way(struct sweep *sweep, uint32_t i, struct dsmc_grain before, uint32_t cell,
                     uint32_t *to)
{
    const struct dsmc *dsmc = sweep->dsmc;
    struct dsmc_grain *p = &dsmc->grains[i];
    const uint32_t upright = dsmc_cell(&dsmc->ax, &dsmc->ay, before.x, p->y);
    const uint32_t level = dsmc_cell(&dsmc->ax, &dsmc->ay, p->x, before.y);
    const bool near_walls = dsmc->walls.first && dsmc_walls_near(dsmc, p->x, p->y);
    if (!near_walls && upright != cell && dsmc->load[upright] < dsmc->full) {
        p->x = before.x;
        *to = upright;
        return true;
    }
    if (!near_walls && level != cell && dsmc->load[level] < dsmc->full) {
        p->y = before.y;
        *to = level;
        return true;
    }
    p->x = before.x;
    p->y = before.y;
    return false;
}

/* Grain i goes from one cell to another, if it may. */
static void change_cell(struct sweep *sweep, uint32_t i, struct dsmc_grain before, uint32_t cell,
                        uint32_t to)
{
    struct dsmc *dsmc = sweep->dsmc;
    const uint32_t wanted = to;
    if (dsmc->load[to] >= dsmc->full && !give_way(sweep, i, before, cell, &to)) {
        refuse(sweep, i, cell, wanted);
        return;
    }
    dsmc->load[cell]--;
    dsmc->load[to]++;
    sweep->moved = true;
}

FORCE_INLINE void move_grain(struct sweep *sweep, uint32_t i, bool walls, bool shear)
{
    struct dsmc *dsmc = sweep->dsmc;
    vector4 *at = &((vector4 *)(void *)dsmc->grains)[i];
    if (dsmc->tags[i] & DSMC_RESTS
        && rests(sweep, i, dsmc_flight_one(&sweep->finder, *at))) return;
    const struct dsmc_grain before = dsmc->grains[i];
    const vector4 old = *at;
    const float speed2 = old[2] * old[2] + old[3] * old[3];
    const float most2 = sweep->way_max * sweep->way_max;
    const bool fast = speed2 * sweep->dt * sweep->dt > most2;
    const float time = fast ? sweep->way_max / sqrtf(speed2) : sweep->dt;
    const bool wall = walls && (dsmc_walls_near(dsmc, before.x, before.y)
                                || speed2 * time * time > sweep->flight.stride2);
    const bool plate = wall && fly_among_walls(sweep, i, time);
    vector4 p = wall ? *at : flown(sweep, old, time);
    if (shear) p = dsmc_flight_sheared(&sweep->flight, p);
    p = dsmc_flight_inside(&sweep->flight, p);
    *at = p;
    const vector8 both = {old[0], old[1], old[2], old[3], p[0], p[1], p[2], p[3]};
    uint32_t cells[2];
    dsmc_flight_two(&sweep->finder, &both, false, cells);
    if (wall && is_far(sweep, cells[0], cells[1])) {
        dsmc->grains[i].x = before.x;
        dsmc->grains[i].y = before.y;
        return;
    }
    if (cells[0] != cells[1]) change_cell(sweep, i, before, cells[0], cells[1]);
    if (!plate) return;
    dsmc->grains[i].vx = dsmc->grains[i].vy = 0;
    dsmc->tags[i] |= DSMC_RESTS | DSMC_PLATE;
}

/* ---- stripes -------------------------------------------------------------------------------- */

/* Rows from .. to - 1; beyond the last row they begin anew. */
struct stripe { uint32_t from, to; };

/* How many stripes; `shift` is a random word. */
static uint32_t stripe_count(const struct dsmc *dsmc, uint32_t shift)
{
    const uint32_t rows = dsmc->ay.cells;
    if (rows < 2 * STRIPE) return 1;
    if (dsmc->ay.periodic) return rows / STRIPE & ~1u;          /* two turns around a ring */
    return 1 + (rows - (1 + shift % STRIPE) + STRIPE - 1) / STRIPE;
}

static struct stripe stripe_at(const struct dsmc *dsmc, uint32_t shift, uint32_t count,
                               uint32_t k)
{
    const uint32_t rows = dsmc->ay.cells, first = 1 + shift % STRIPE;
    if (count == 1) return (struct stripe){0, rows};
    if (dsmc->ay.periodic) {
        const uint32_t begin = shift % rows;
        return (struct stripe){begin + (uint32_t)((uint64_t)rows * k / count),
                               begin + (uint32_t)((uint64_t)rows * (k + 1) / count)};
    }
    const uint32_t end = first + k * STRIPE;
    return (struct stripe){k == 0 ? 0 : end - STRIPE, end < rows ? end : rows};
}

/* Sweeps a stripe from a random grain on, in a random sense. */
FORCE_INLINE void sweep_stripe(struct sweep *sweep, struct stripe stripe, bool walls, bool shear)
{
    const struct dsmc *dsmc = sweep->dsmc;
    const uint32_t ny = sweep->ny, rows = stripe.to - stripe.from, from = stripe.from % ny;
    const uint32_t begin = dsmc->first[from * sweep->nx];
    const uint32_t end = dsmc->first[(from + rows <= ny ? from + rows : from + rows - ny)
                                     * sweep->nx];
    const uint32_t n = rows == ny ? dsmc->count
                     : from + rows <= ny ? end - begin : dsmc->count - begin + end;
    sweep->block = from * (dsmc->blocks / ny);
    if (n == 0) return;
    const uint64_t word = rng_keyed(sweep->key, stripe.from, 2, 0);
    const bool upwards = word & 1;
    uint32_t k = (uint32_t)((word >> 32) * n >> 32);
    for (uint32_t left = n; left > 0; left--) {
        const uint32_t i = begin + k < dsmc->count ? begin + k : begin + k - dsmc->count;
        move_grain(sweep, i, walls, shear);
        if (upwards) k = k + 1 == n ? 0 : k + 1;
        else k = k == 0 ? n - 1 : k - 1;
    }
}

CLONES static void sweep_freely(struct sweep *sweep, struct stripe stripe)
{
    sweep_stripe(sweep, stripe, false, false);
}

CLONES static void sweep_any(struct sweep *sweep, struct stripe stripe)
{
    const bool shear = sweep->dsmc->effects & EFFECT_SHEAR;
    sweep_stripe(sweep, stripe, sweep->dsmc->walls.first, shear);
}

static struct sweep sweep_of(struct dsmc *dsmc)
{
    const double *g = dsmc->scene->gravity, d = 2 * dsmc->radius;
    const double weight = hypot(g[0], g[1]);
    return (struct sweep){
        .dsmc = dsmc, .flight = dsmc_flight_of(dsmc), .finder = dsmc_flight_finder(dsmc),
        .gx = (float)g[0], .gy = (float)g[1], .dt = (float)dsmc->dt,
        .way_max = way_max / fmaxf(dsmc->ax.per, dsmc->ay.per),
        .slow2 = (float)(slow * slow * weight * d), .roll = (float)sqrt(weight * d),
        .down = g[1] < 0 ? -1 : g[1] > 0 ? 1 : 0,
        .nx = dsmc->ax.cells, .ny = dsmc->ay.cells};
}

void dsmc_heap_load(struct dsmc *dsmc, uint32_t t)
{
    const uint32_t begin = dsmc->shares[t].from, end = begin + dsmc->shares[t].cells;
    for (uint32_t c = begin; c < end; c++) dsmc->load[c] = dsmc->first[c + 1] - dsmc->first[c];
}

void dsmc_heap_sweep(struct dsmc *dsmc, struct dsmc_sums *sums)
{
    struct sweep sweep = sweep_of(dsmc);
    struct rng rng = rng_stream(dsmc->seed, sweep_key, dsmc->steps);
    const uint32_t shift = (uint32_t)rng_u64(&rng), turn = (uint32_t)rng_u64(&rng) & 1;
    const uint32_t count = stripe_count(dsmc, shift);
    const bool freely = !dsmc->walls.first && !(dsmc->effects & EFFECT_SHEAR);
    sweep.key = rng.state;
    sweep.impacts = sums->impacts;
    for (uint32_t half = 0; half < 2; half++) {
        if (half == 1) {
#pragma omp barrier
        }
#pragma omp for schedule(dynamic, 1) nowait
        for (uint32_t k = (half + turn) & 1; k < count; k += 2) {
            const struct stripe stripe = stripe_at(dsmc, shift, count, k);
            (freely ? sweep_freely : sweep_any)(&sweep, stripe);
        }
    }
    sums->collisions += sweep.collisions;
    sums->rejected += sweep.rejected;
    sums->moved |= sweep.moved;
#pragma omp barrier
}
