/* dsmc_collide.c - collisions by chance between the grains of a cell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * In a cell of n grains M = n (n - 1) d chi v dt / V pairs are candidates (000 eq. 1, 001 eq. 15
 * with sigma = 2d), rounded by chance so that the mean is exact, and each collides with probability
 * g / v, g its relative speed: 000 (2) and 001 (16) print the opposite.  For v any bound on g will
 * do.  Here it is sqrt(2 sum |v_k - mean|^2) of the cell's own grains: |a - b|^2 <= 2 (a^2 + b^2),
 * exact for a pair, found in one pass, and no collision inside the cell can break it.
 *
 * The local form (dense, hsmc) takes chi from the 5 x 5 cells around, and scales M so that those
 * cells have as many pairs together as a uniform gas of their density would: with one grain a cell
 * the pairs met would otherwise be too many or too few wherever grains keep apart or cluster.
 */
#include "model/dsmc/dsmc_collide.h"

#include "model/dsmc/dsmc_walls.h"
#include "model/dsmc/dsmc_words.h"

#include <math.h>
#include <string.h>

enum { LOCAL = 1, DISPLACE = 2, ROUGH = 4, KERNELS = 8 };

enum {
    BATCH = 512,                /* candidates whose random words are drawn at a time */
    PER_GRAIN_MAX = 64          /* candidates a grain and step; in a collapse there is no limit */
};

static float printed_speed;     /* for tests: as printed, with this v; 0: as it should be */

void dsmc_collide_as_printed(float speed) { printed_speed = speed; }

struct block {
    struct dsmc *dsmc;
    struct dsmc_words words;
    uint32_t number;
    uint32_t row, x0, x1;       /* cells x0 .. x1 - 1 of that row */
    uint32_t cell;              /* number of the first */
    float    factor[DSMC_BLOCK];        /* chi, pair factor and 1 / volume of each cell */
    float    bound2[DSMC_BLOCK];        /* square of the bound on relative speeds */
    uint32_t pairs[DSMC_BLOCK];         /* candidates */
    uint64_t collisions, rejected, tangential;
};

static float volume(const struct dsmc_axis *axis, uint32_t k)
{
    return k == 0 ? axis->first : k == axis->cells - 1 ? axis->last : 1;
}

/* ---- how crowded ---------------------------------------------------------------------------- */

enum { WIDTH = DSMC_BLOCK + 2 * DSMC_HOOD };

struct hood { float grains[WIDTH], pairs[WIDTH], volume[WIDTH]; };      /* by column of cells */

static int reach_of(const struct dsmc_axis *axis)
{
    return axis->cells >= 2 * DSMC_HOOD + 1 ? DSMC_HOOD : ((int)axis->cells - 1) / 2;
}

/* The cell `step` beyond k; false if the grid ends before. */
static bool neighbour(const struct dsmc_axis *axis, uint32_t k, int step, uint32_t *out)
{
    const int64_t at = (int64_t)k + step, cells = axis->cells;
    if (!axis->wraps && (at < 0 || at >= cells)) return false;
    *out = (uint32_t)(at < 0 ? at + cells : at >= cells ? at - cells : at);
    return true;
}

/* Adds the cells of one row, whose height is `height`; column 0 is `reach` cells before the block. */
FORCE_INLINE void add_row(const struct block *block, uint32_t y, float height, struct hood *sum)
{
    const struct dsmc_axis *ax = &block->dsmc->ax;
    const uint32_t *restrict row = &block->dsmc->first[(size_t)y * ax->cells];
    const int reach = reach_of(ax), columns = (int)(block->x1 - block->x0) + 2 * reach;
    const int begin = (int)block->x0 - reach, inner = begin < 0 ? -begin : 0;
    const int end = begin + columns > (int)ax->cells ? (int)ax->cells - begin : columns;
    const float weight = 1 / height;
    for (int k = inner; k < end; k++) {
        const float n = (float)(int32_t)(row[begin + k + 1] - row[begin + k]);
        sum->grains[k] += n;
        sum->pairs[k] += weight * n * (n - 1);
        sum->volume[k] += height;
    }
    for (int k = 0; k < columns; k++) {
        if (k == inner) k = end;                                /* beyond the grid's sides */
        uint32_t x;
        if (k >= columns || !neighbour(ax, block->x0, k - reach, &x)) continue;
        const float n = (float)(int32_t)(row[x + 1] - row[x]);
        sum->grains[k] += n;
        sum->pairs[k] += weight * n * (n - 1);
        sum->volume[k] += height;
    }
}

/* Border cells of a grid that does not wrap are wider or narrower than the others. */
static void scale_borders(const struct block *block, struct hood *sum)
{
    const struct dsmc_axis *ax = &block->dsmc->ax;
    const int64_t at[2] = {0, ax->cells - 1}, begin = (int64_t)block->x0 - reach_of(ax);
    if (ax->wraps) return;
    for (int side = 0; side < 2; side++) {
        const int64_t k = at[side] - begin;
        if (k < 0 || k >= WIDTH || (side == 1 && at[1] == at[0])) continue;
        const float width = volume(ax, (uint32_t)at[side]);
        sum->pairs[k] /= width;
        sum->volume[k] *= width;
    }
}

FORCE_INLINE void find_local_factors(struct block *block)
{
    const struct dsmc *dsmc = block->dsmc;
    const int reach = reach_of(&dsmc->ax), rows = reach_of(&dsmc->ay);
    const int count = (int)(block->x1 - block->x0);
    struct hood columns, sums;
    memset(&columns, 0, sizeof columns);
    memset(&sums, 0, sizeof sums);
    for (int step = -rows; step <= rows; step++) {
        uint32_t y;
        if (!neighbour(&dsmc->ay, block->row, step, &y)) continue;
        add_row(block, y, volume(&dsmc->ay, y), &columns);
    }
    scale_borders(block, &columns);
    for (int o = 0; o <= 2 * reach; o++) {
        for (int k = 0; k < count; k++) {
            sums.grains[k] += columns.grains[k + o];
            sums.pairs[k] += columns.pairs[k + o];
            sums.volume[k] += columns.volume[k + o];
        }
    }
    const float area = (float)(M_PI * dsmc->radius * dsmc->radius / dsmc->settings.weight)
                     * dsmc->ax.per * dsmc->ay.per;             /* of a particle, in cells */
    const float height = volume(&dsmc->ay, block->row);
    const int kind = dsmc->settings.chi;
    for (int k = 0; k < count; k++) {
        const float q = sums.grains[k], v = sums.volume[k], pairs = sums.pairs[k];
        const float chi = dsmc_chi(kind, q * area / v);
        block->factor[k] = pairs > 0 ? chi * q * (q - 1) / (v * pairs * height) : 0;
    }
    if (dsmc->ax.wraps) return;
    if (block->x0 == 0) block->factor[0] /= volume(&dsmc->ax, 0);
    const uint32_t last = dsmc->ax.cells - 1;
    if (block->x1 == last + 1 && last > 0) block->factor[last - block->x0] /= volume(&dsmc->ax, last);
}

/* Without neighbours: the whole box is as crowded on average. */
static void find_global_factors(struct block *block)
{
    const struct dsmc *dsmc = block->dsmc;
    const double area = M_PI * dsmc->radius * dsmc->radius / dsmc->settings.weight * dsmc->count;
    const float nu = (float)(area / ((double)dsmc->ax.length * (double)dsmc->ay.length));
    const float chi = dsmc_chi(dsmc->settings.chi, nu);
    const float fy = volume(&dsmc->ay, block->row);
    for (uint32_t k = 0; k < block->x1 - block->x0; k++) {
        block->factor[k] = chi / (fy * volume(&dsmc->ax, block->x0 + k));
    }
}

/* ---- how many candidates -------------------------------------------------------------------- */

typedef float vector4 __attribute__((vector_size(16), may_alias));

/* n sum |v_k|^2 - |sum v_k|^2 = n sum |v_k - mean|^2; velocities count from the first grain's, so
 * that a fast stream does not cost digits.  Two sums at a time, because each addition waits for
 * the one before. */
FORCE_INLINE float spread_of(const struct dsmc_grain *grains, uint32_t n)
{
    const vector4 *records = (const vector4 *)(const void *)grains;
    const vector4 origin = records[0];
    vector4 sum = {0}, sum2 = {0}, squares = {0}, squares2 = {0};
    uint32_t k = 1;
    for (; k + 1 < n; k += 2) {
        const vector4 v = records[k] - origin, w = records[k + 1] - origin;
        sum += v;
        sum2 += w;
        squares += v * v;
        squares2 += w * w;
    }
    if (k < n) {
        const vector4 v = records[k] - origin;
        sum += v;
        squares += v * v;
    }
    sum += sum2;
    squares += squares2;
    return (float)n * (squares[2] + squares[3]) - (sum[2] * sum[2] + sum[3] * sum[3]);
}

/* The bound of each cell, still times n / 2; false if nothing moves against anything here. */
FORCE_INLINE bool find_spreads(struct block *block)
{
    const struct dsmc *dsmc = block->dsmc;
    const uint32_t *first = &dsmc->first[block->cell], count = block->x1 - block->x0;
    const struct dsmc_grain *grains = dsmc->grains;
    float most = 0;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t n = first[k + 1] - first[k];
        const float spread = n < 2 ? 0 : spread_of(&grains[first[k]], n);
        block->bound2[k] = spread;
        most = spread > most ? spread : most;
    }
    return most > 0;
}

/* The square of the bound and the number of candidates; no branches, several cells at a time. */
FORCE_INLINE void find_pairs(struct block *block)
{
    const struct dsmc *dsmc = block->dsmc;
    const uint32_t count = block->x1 - block->x0, *first = &dsmc->first[block->cell];
    const float rate = dsmc->rate, printed2 = printed_speed * printed_speed;
    uint32_t chance[DSMC_BLOCK];
    float *bound2 = block->bound2;
    const float *factor = block->factor;
    uint32_t *pairs = block->pairs;
    dsmc_words_fill(&block->words, chance, count);
    for (uint32_t k = 0; k < count; k++) {
        const float n = (float)(int32_t)(first[k + 1] - first[k]);
        const float spread = bound2[k] > 0 ? bound2[k] : 0;
        const float own = 2.00002f * spread / (n > 1 ? n : 1);
        const float bound = printed2 > 0 ? printed2 : own;
        const float mean = rate * factor[k] * n * (n - 1) * sqrtf(bound);
        const float most = (float)PER_GRAIN_MAX * n;
        const float u = (float)(int32_t)(chance[k] >> 8) * 0x1p-24f;
        const float wanted = (mean < most ? mean : most) + u;
        bound2[k] = bound;
        pairs[k] = (uint32_t)(int32_t)(n > 1 ? wanted : 0);
    }
}

/* ---- one collision -------------------------------------------------------------------------- */

static void displace(const struct dsmc *dsmc, struct dsmc_grain *grain, float dx, float dy)
{
    if (dsmc->walls.first && dsmc_walls_near(dsmc, grain->x, grain->y)) {
        dsmc_walls_slide(dsmc, grain, dx, dy);
        return;
    }
    grain->x += dx;
    grain->y += dy;
}

/* A grain at rest stays so if the blow was weak, and then the heap takes it up. */
static void wake(struct dsmc *dsmc, uint32_t i)
{
    if (!(dsmc->tags[i] & DSMC_RESTS)) return;
    struct dsmc_grain *grain = &dsmc->grains[i];
    const double g = fabs(dsmc->scene->gravity[1]);
    const double weak2 = 0.25 * g * 2 * dsmc->radius;
    if (grain->vx * grain->vx + grain->vy * grain->vy > weak2) {
        dsmc->tags[i] &= DSMC_NAME;
    } else {
        grain->vx = grain->vy = 0;
    }
}

static void note(struct dsmc *dsmc, uint32_t i, uint32_t j)
{
    if (dsmc->contacts) {
        if (dsmc->contacts[i].now < UINT16_MAX) dsmc->contacts[i].now++;
        if (dsmc->contacts[j].now < UINT16_MAX) dsmc->contacts[j].now++;
    }
    if (!dsmc->full) return;
    wake(dsmc, i);
    wake(dsmc, j);
}

/* Tangential part after Walton and Braun (001 eqs. 1-6), n from i to j, closing speed un:
 * sticking reverses the slip by beta0, sliding is limited by Coulomb. */
static void rub(struct dsmc *dsmc, uint32_t i, uint32_t j, float nx, float ny, float un, float ut)
{
    const float slip = ut + dsmc->spins[i] + dsmc->spins[j], q = dsmc->q;
    const float limit = dsmc->friction * dsmc->half_impulse * un;
    float blow = 0.5f * (1 + dsmc->tangential) * q / (1 + q) * slip;
    if (fabsf(blow) > limit) blow = copysignf(limit, slip);
    struct dsmc_grain *a = &dsmc->grains[i], *b = &dsmc->grains[j];
    a->vx += blow * ny;
    a->vy -= blow * nx;
    b->vx -= blow * ny;
    b->vy += blow * nx;
    dsmc->spins[i] -= blow / q;
    dsmc->spins[j] -= blow / q;
}

/* The impact parameter b = sin(angle between g and the normal) is uniform in [-1, 1) in two
 * dimensions; the normal part of g, (g n) n = g (1 - b^2) + (g turned left) b sqrt(1 - b^2). */
FORCE_INLINE void collide_pair(struct block *block, uint32_t i, uint32_t j, float gx, float gy,
                               float b, unsigned flags)
{
    struct dsmc *dsmc = block->dsmc;
    struct dsmc_grain *p = &dsmc->grains[i], *q = &dsmc->grains[j];
    const float c2 = 1 - b * b, cs = b * sqrtf(c2);
    const float nx = gx * c2 - gy * cs, ny = gy * c2 + gx * cs;         /* (g n) n */
    const float f = dsmc->half_impulse;
    p->vx -= f * nx;
    p->vy -= f * ny;
    q->vx += f * nx;
    q->vy += f * ny;
    if (flags & (DISPLACE | ROUGH)) {
        const float un = sqrtf(nx * nx + ny * ny);
        if (!(un > 0)) return;
        const float ex = nx / un, ey = ny / un;
        if (flags & ROUGH) rub(dsmc, i, j, ex, ey, un, gy * ex - gx * ey);
        if (flags & DISPLACE) {
            const float way = dsmc->displacement;
            displace(dsmc, p, -way * ex, -way * ey);
            displace(dsmc, q, way * ex, way * ey);
        }
    }
    if (dsmc->contacts || dsmc->full) note(dsmc, i, j);
}

/* ---- a block of cells ----------------------------------------------------------------------- */

/* Does the candidate collide?  g / v > U, without the root. */
FORCE_INLINE bool accepted(float g2, float bound2, float u)
{
    if (__builtin_expect(printed_speed > 0, 0)) return g2 < u * u * bound2;
    return g2 > u * u * bound2;
}

FORCE_INLINE void collide_cells(struct block *block, unsigned flags)
{
    const struct dsmc *dsmc = block->dsmc;
    const uint32_t *first = &dsmc->first[block->cell];
    uint32_t words[3 * BATCH], used = BATCH, made = BATCH;
    uint64_t left = 0;
    for (uint32_t k = 0; k < block->x1 - block->x0; k++) left += block->pairs[k];
    for (uint32_t k = 0; k < block->x1 - block->x0; k++) {
        const uint32_t n = first[k + 1] - first[k], start = first[k];
        for (uint32_t pair = block->pairs[k]; pair > 0; pair--, used++) {
            if (used == made) {
                made = left < BATCH ? ((uint32_t)left + 7) / 8 * 8 : BATCH;
                dsmc_words_fill(&block->words, words, 3 * made);
                used = 0;
            }
            left--;
            const uint32_t a = words[used], b = words[made + used];
            uint32_t i = (uint32_t)((uint64_t)(a & 0xffff) * n >> 16);
            uint32_t j = (uint32_t)((uint64_t)(a >> 16) * (n - 1) >> 16);
            j += j >= i;
            i += start;
            j += start;
            const float gx = dsmc->grains[i].vx - dsmc->grains[j].vx;
            const float gy = dsmc->grains[i].vy - dsmc->grains[j].vy;
            if (!accepted(gx * gx + gy * gy, block->bound2[k], dsmc_words_unit(b))) {
                block->rejected++;
                continue;
            }
            block->collisions++;
            collide_pair(block, i, j, gx, gy, 2 * dsmc_words_unit(words[2 * made + used]) - 1,
                         flags);
        }
    }
}

FORCE_INLINE void collide_block(struct block *block, unsigned flags)
{
    if (!find_spreads(block)) return;
    if (flags & LOCAL) find_local_factors(block);
    else find_global_factors(block);
    block->words = dsmc_words_begin(block->dsmc->seed, block->dsmc->steps, block->number);
    find_pairs(block);
    collide_cells(block, flags);
    if (flags & ROUGH) block->tangential = block->collisions;
}

/* X(flags): the loops that exist */
#define LOOPS(X) X(0) X(1) X(3) X(4) X(5) X(7)

#define X(flags) CLONES static void loop_##flags(struct block *block) { collide_block(block, flags); }
LOOPS(X)
#undef X

static void (*const loops[KERNELS])(struct block *) = {
#define X(flags) [flags] = loop_##flags,
    LOOPS(X)
#undef X
};

static uint32_t blocks_in_row(const struct dsmc *dsmc)
{
    return (dsmc->ax.cells + DSMC_BLOCK - 1) / DSMC_BLOCK;
}

uint32_t dsmc_collide_blocks(const struct dsmc *dsmc)
{
    return blocks_in_row(dsmc) * dsmc->ay.cells;
}

uint32_t dsmc_collide_cell(const struct dsmc *dsmc, uint32_t block)
{
    const uint32_t per_row = blocks_in_row(dsmc);
    return block / per_row * dsmc->ax.cells + block % per_row * DSMC_BLOCK;
}

void dsmc_collide(struct dsmc *dsmc, uint32_t number, struct dsmc_sums *sums)
{
    const int method = dsmc->settings.method;
    const unsigned flags = (method == DSMC_PLAIN ? 0 : LOCAL) | (method == DSMC_DENSE ? DISPLACE : 0)
                         | (dsmc->spins ? ROUGH : 0);
    struct block block;
    block.dsmc = dsmc;
    block.number = number;
    block.cell = dsmc_collide_cell(dsmc, number);
    block.row = block.cell / dsmc->ax.cells;
    block.x0 = block.cell % dsmc->ax.cells;
    block.x1 = block.x0 + DSMC_BLOCK < dsmc->ax.cells ? block.x0 + DSMC_BLOCK : dsmc->ax.cells;
    block.collisions = block.rejected = block.tangential = 0;
    loops[flags](&block);
    sums->collisions += block.collisions;
    sums->rejected += block.rejected;
    sums->tangential += block.tangential;
}
