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
 * The sweep goes through the grains in their order, from a random one on and in a random sense,
 * and asks for the numbers of grains as they are by then.
 */
#include "model/dsmc/dsmc_heap.h"

#include "base/rng.h"
#include "model/dsmc/dsmc_walls.h"

#include <math.h>

static const uint64_t sweep_key = 0x7377656570, reach_key = 0x7265616368;
static const float  way_max = 0.95f;            /* in cells */
static const double slow = 0.5;                 /* relative speed at which grains rest, sqrt(g d) */

struct sweep {
    struct dsmc *dsmc;
    float gx, gy, dt, way_max, slow2, roll;
    int   down;                 /* row step along gravity, 0: none */
    uint32_t nx, ny;
    struct dsmc_image image;    /* Lees-Edwards */
    uint64_t key;               /* of the random numbers of this step */
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

static void change_cell(struct dsmc *dsmc, uint32_t from, uint32_t to)
{
    dsmc->load[from]--;
    dsmc->load[to]++;
    dsmc->unsorted = true;
}

static uint32_t cell_at(const struct dsmc *dsmc, float x, float y)
{
    return dsmc_cell(&dsmc->ax, &dsmc->ay, x, y);
}

/* Back into a periodic box; never beyond a solid border. */
static float kept_inside(const struct dsmc_axis *axis, int low, int high, float x)
{
    if (axis->periodic) return x < 0 ? x + axis->length : x >= axis->length ? x - axis->length : x;
    if (low == BORDER_WALL && x < 0) return 0;
    return high == BORDER_WALL && x > axis->length ? axis->length : x;
}

/* What leaves at the top comes in at the bottom, slower by the speed of the image above. */
static void shear(const struct sweep *sweep, struct dsmc_grain *p)
{
    const float side = p->y >= sweep->dsmc->ay.length ? 1 : p->y < 0 ? -1 : 0;
    p->x -= side * sweep->image.way;
    p->vx -= side * sweep->image.speed;
    if (p->x < 0) p->x += sweep->dsmc->ax.length;
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
        dsmc->collisions++;
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
    dsmc->rejected++;
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

/* Moves grain i, which was in `cell` before. */
static void move_grain(struct sweep *sweep, uint32_t i, uint32_t cell)
{
    struct dsmc *dsmc = sweep->dsmc;
    struct dsmc_grain *p = &dsmc->grains[i];
    if (dsmc->tags[i] & DSMC_RESTS && rests(sweep, i, cell)) return;
    const struct dsmc_grain before = *p;
    const float speed2 = p->vx * p->vx + p->vy * p->vy, most2 = sweep->way_max * sweep->way_max;
    const bool fast = speed2 * sweep->dt * sweep->dt > most2;
    const float time = fast ? sweep->way_max / sqrtf(speed2) : sweep->dt;
    bool plate = false;
    if (dsmc->walls.first && (dsmc_walls_near(dsmc, p->x, p->y)
                              || speed2 * time * time > dsmc->walls.stride * dsmc->walls.stride)) {
        plate = dsmc_walls_fly(dsmc, i, time, 0);
    } else {
        p->x += time * (p->vx + 0.5f * time * sweep->gx);
        p->y += time * (p->vy + 0.5f * time * sweep->gy);
        p->vx += time * sweep->gx;
        p->vy += time * sweep->gy;
    }
    /* The speed grows with the whole step even where the way is cut. */
    p->vx += (sweep->dt - time) * sweep->gx;
    p->vy += (sweep->dt - time) * sweep->gy;
    if (dsmc->effects & EFFECT_SHEAR) shear(sweep, p);
    p->x = kept_inside(&dsmc->ax, dsmc->scene->left, dsmc->scene->right, p->x);
    p->y = kept_inside(&dsmc->ay, dsmc->scene->bottom, dsmc->scene->top, p->y);
    uint32_t to = cell_at(dsmc, p->x, p->y);
    if (to != cell && dsmc->load[to] >= dsmc->full) {
        const float x = p->x, y = p->y;
        const uint32_t upright = cell_at(dsmc, before.x, y), level = cell_at(dsmc, x, before.y);
        const bool near_walls = dsmc->walls.first && dsmc_walls_near(dsmc, x, y);
        if (!near_walls && upright != cell && dsmc->load[upright] < dsmc->full) {
            p->x = before.x;
            to = upright;
        } else if (!near_walls && level != cell && dsmc->load[level] < dsmc->full) {
            p->y = before.y;
            to = level;
        } else {
            p->x = before.x;
            p->y = before.y;
            refuse(sweep, i, cell, to);
            return;
        }
    }
    if (to != cell) change_cell(dsmc, cell, to);
    if (plate) {
        p->vx = p->vy = 0;
        dsmc->tags[i] |= DSMC_RESTS | DSMC_PLATE;
    }
}

void dsmc_heap_sweep(struct dsmc *dsmc)
{
    const double *g = dsmc->scene->gravity, d = 2 * dsmc->radius;
    const double weight = hypot(g[0], g[1]);
    struct sweep sweep = {
        .dsmc = dsmc, .gx = (float)g[0], .gy = (float)g[1], .dt = (float)dsmc->dt,
        .way_max = way_max / fmaxf(dsmc->ax.per, dsmc->ay.per),
        .slow2 = (float)(slow * slow * weight * d), .roll = (float)sqrt(weight * d),
        .image = dsmc_image(dsmc),
        .down = g[1] < 0 ? -1 : g[1] > 0 ? 1 : 0, .nx = dsmc->ax.cells, .ny = dsmc->ay.cells};
    for (uint32_t c = 0; c < dsmc->cells; c++) {
        dsmc->load[c] = (uint16_t)(dsmc->first[c + 1] - dsmc->first[c]);
    }
    struct rng rng = rng_stream(dsmc->seed, sweep_key, dsmc->steps);
    const uint32_t n = dsmc->count;
    if (n == 0) return;
    uint32_t i = (uint32_t)(rng_uniform(&rng) * n);
    const bool upwards = rng_u64(&rng) & 1;
    sweep.key = rng.state;
    uint32_t cell = cell_at(dsmc, dsmc->grains[i].x, dsmc->grains[i].y);
    for (uint32_t k = 0; k < n; k++) {
        /* Grains lie cell by cell, so the next one's cell is this one or soon after. */
        while (i < dsmc->first[cell]) cell--;
        while (i >= dsmc->first[cell + 1]) cell++;
        move_grain(&sweep, i, cell);
        if (upwards) i = i + 1 == n ? 0 : i + 1;
        else i = i == 0 ? n - 1 : i - 1;
    }
}
