/* dsmc_collide.c - collisions by chance between the grains of a cell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * In a cell of n grains M = n (n - 1) d chi v dt / V pairs are candidates (000 eq. 1, 001 eq. 15
 * with sigma = 2d), rounded by chance so that the mean is exact, and each collides with probability
 * g / v, g its relative speed: 000 (2) and 001 (16) print the opposite.  For v any bound on g will
 * do.  Here it is the diagonal of the smallest box around the velocities of the cell's own grains:
 * exact for a pair, and found in one pass.  Collisions of this same step may make a pair faster
 * than that.  It collides for certain and then, with probability g / v - 1, once more: so every
 * pair has on average the g / v collisions that are due, whether or not v is a bound.
 *
 * A block of cells goes in three passes: the bounds, then the numbers of candidates, then the
 * candidates themselves, some hundred at a time, of which everything that does not depend on
 * velocities is worked out before the first of them collides.
 */
#include "model/dsmc/dsmc_collide.h"

#include "model/dsmc/dsmc_crowd.h"
#include "model/dsmc/dsmc_vector.h"
#include "model/dsmc/dsmc_walls.h"
#include "model/dsmc/dsmc_words.h"

#include <math.h>
#include <string.h>

enum { DISPLACE = 1, ROUGH = 2, NOTED = 4, KERNELS = 8 };

enum {
    BATCH = 512,                /* candidates that are worked out at a time */
    FEW = 4, MANY = 16,         /* grains of a cell that are looked at without asking how many */
    SPARSE = 3,                 /* grains a cell on average up to which FEW is the better guess */
    PER_GRAIN_MAX = 64          /* candidates a grain and step; in a collapse there is no limit */
};

static const uint64_t repay_key = 0x7265706179; /* "repay": apart from other streams */

static float printed_speed;     /* for tests: as printed, with this v; 0: as it should be */

void dsmc_collide_as_printed(float speed) { printed_speed = speed; }

struct block {
    struct dsmc *dsmc;
    struct dsmc_words words;
    uint32_t number;
    struct dsmc_crowd crowd;
    uint32_t cell, cells;       /* number of the first, how many */
    float    width[DSMC_BLOCK], height[DSMC_BLOCK];     /* of the box around a cell's velocities */
    float    bound2[DSMC_BLOCK];        /* square of the bound on relative speeds */
    uint32_t pairs[DSMC_BLOCK];         /* candidates */
    uint64_t candidates, collisions, rejected, tangential;
    uint64_t owing, repaid;     /* chances of pairs faster than the bound, and what came of them */
    double  *impacts;
};

/* ---- how many candidates -------------------------------------------------------------------- */

FORCE_INLINE void widen(const struct dsmc_grain *pair, vector8 *low, vector8 *high)
{
    const vector8 v = *(const vector8 *)(const void *)pair;
    const mask8 below = v < *low, above = v > *high;
    *low = (vector8)(((mask8)v & below) | ((mask8)*low & ~below));
    *high = (vector8)(((mask8)v & above) | ((mask8)*high & ~above));
}

/* The boxes around the velocities of each cell.  `often` grains are looked at without a branch: a
 * grain may be looked at twice, and cells of less than two read a neighbour's, in vain. */
FORCE_INLINE void find_boxes(struct block *block, uint32_t often)
{
    const struct dsmc *dsmc = block->dsmc;
    const uint32_t *first = &dsmc->first[block->cell];
    const struct dsmc_grain *grains = dsmc->grains;
    const uint32_t end = first[block->cells] - 2;       /* no pair begins after this */
    for (uint32_t k = 0; k < block->cells; k++) {
        const uint32_t start = first[k] < end ? first[k] : end;
        const uint32_t n = first[k + 1] - first[k], most = n > 2 ? n - 2 : 0;
        vector8 low = *(const vector8 *)(const void *)&grains[start], high = low;
#pragma GCC unroll 8
        for (uint32_t i = 2; i < often; i += 2) {
            widen(&grains[start + (i < most ? i : most)], &low, &high);
        }
        for (uint32_t i = often; i < n; i += 2) {
            widen(&grains[start + (i < most ? i : most)], &low, &high);
        }
        block->width[k] = (high[2] > high[6] ? high[2] : high[6])
                        - (low[2] < low[6] ? low[2] : low[6]);
        block->height[k] = (high[3] > high[7] ? high[3] : high[7])
                         - (low[3] < low[7] ? low[3] : low[7]);
    }
}

/* The square of the bound and the number of candidates; no branches, several cells at a time. */
FORCE_INLINE void find_pairs(struct block *block)
{
    const struct dsmc *dsmc = block->dsmc;
    const uint32_t count = block->cells, *first = &dsmc->first[block->cell];
    const float rate = dsmc->rate, printed2 = printed_speed * printed_speed;
    uint32_t chance[DSMC_BLOCK];
    const float *width = block->width, *height = block->height, *factor = block->crowd.factor;
    float *bound2 = block->bound2;
    uint32_t *pairs = block->pairs;
    dsmc_words_fill(&block->words, chance, count);
    for (uint32_t k = 0; k < count; k++) {
        const float n = (float)(int32_t)(first[k + 1] - first[k]);
        const float own = width[k] * width[k] + height[k] * height[k];
        const float bound = printed2 > 0 ? printed2 : own;
        const float mean = rate * factor[k] * n * (n - 1) * sqrtf(bound);
        const float most = (float)PER_GRAIN_MAX * n;
        const float u = (float)(int32_t)(chance[k] >> 8) * 0x1p-24f;
        const float wanted = (mean < most ? mean : most) + u;
        bound2[k] = bound;
        pairs[k] = (uint32_t)(int32_t)(n > 1 ? wanted : 0);
    }
}

/* ---- candidates ----------------------------------------------------------------------------- */

enum { EIGHT = 8 };

struct batch {
    uint32_t count;
    uint32_t k[BATCH + EIGHT];          /* which cell of the block */
    uint32_t i[BATCH], j[BATCH];        /* which grains */
    float bound2[BATCH];        /* of their cell */
    float least[BATCH];         /* they collide if the square of their relative speed is more */
    float b[BATCH];             /* impact parameter, a share of the diameter */
    float along[BATCH], across[BATCH];  /* share of the relative velocity, and of it turned left */
};

/* The cells of the next candidates, from cell `k` on; returns the cell to go on with. */
FORCE_INLINE uint32_t take_cells(struct block *block, uint32_t k, struct batch *batch)
{
    uint32_t count = 0;
    while (k < block->cells) {
        const uint32_t room = BATCH - count, wanted = block->pairs[k];
        const uint32_t n = wanted < room ? wanted : room;
        for (int e = 0; e < EIGHT; e++) batch->k[count + (uint32_t)e] = k;      /* mostly enough */
        for (uint32_t e = EIGHT; e < n; e++) batch->k[count + e] = k;
        count += n;
        if (n < wanted) {
            block->pairs[k] -= n;
            break;
        }
        k++;
    }
    batch->count = count;
    return k;
}

/* All that is known of the candidates before anything collides.  The impact parameter b = sin(angle
 * between g and the normal) is uniform in [-1, 1) in two dimensions; the normal part of g,
 * (g n) n = g (1 - b^2) + (g turned left) b sqrt(1 - b^2). */
FORCE_INLINE void work_out(struct block *block, struct batch *batch)
{
    const uint32_t *first = &block->dsmc->first[block->cell], count = batch->count;
    uint32_t words[3 * BATCH], start[BATCH], n[BATCH];
    const uint32_t made = (count + DSMC_LANES - 1) / DSMC_LANES * DSMC_LANES;
    dsmc_words_fill(&block->words, words, 3 * made);
    for (uint32_t c = 0; c < count; c++) {
        const uint32_t k = batch->k[c];
        start[c] = first[k];
        n[c] = first[k + 1] - first[k];
        batch->bound2[c] = block->bound2[k];
    }
    for (uint32_t c = 0; c < count; c++) {
        const uint32_t word = words[c];
        const uint32_t i = (uint32_t)((uint64_t)(word & 0xffff) * n[c] >> 16);
        const uint32_t j = (uint32_t)((uint64_t)(word >> 16) * (n[c] - 1) >> 16);
        batch->i[c] = start[c] + i;
        batch->j[c] = start[c] + j + (j >= i);
    }
    for (uint32_t c = 0; c < count; c++) {
        const float u = (float)(int32_t)(words[made + c] >> 8) * 0x1p-24f;
        const float b = (float)(int32_t)(words[2 * made + c] >> 8) * 0x1p-23f - 1;
        const float c2 = 1 - b * b;
        batch->least[c] = u * u * batch->bound2[c];
        batch->b[c] = b;
        batch->along[c] = c2;
        batch->across[c] = b * sqrtf(c2);
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

/* (nx, ny): the normal part of their relative velocity. */
FORCE_INLINE void collide_pair(struct dsmc *dsmc, uint32_t i, uint32_t j, float nx, float ny,
                               float gx, float gy, unsigned flags)
{
    struct dsmc_grain *p = &dsmc->grains[i], *q = &dsmc->grains[j];
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
    if (flags & NOTED) note(dsmc, i, j);
}

/* A pair that has just collided and was faster than the bound, g2 > bound2: it is owed g / v - 1 of
 * a collision. */
FORCE_INLINE void repay(struct block *block, uint32_t i, uint32_t j, float g2, float bound2,
                        unsigned flags)
{
    struct dsmc *dsmc = block->dsmc;
    for (float owed = fminf(sqrtf(g2 / bound2) - 1, PER_GRAIN_MAX); owed > 0; owed -= 1) {
        const uint64_t word = rng_keyed(dsmc->seed, repay_key, dsmc->steps,
                                        (uint64_t)block->number << 32 | block->owing++);
        if (dsmc_words_unit((uint32_t)word) >= owed) break;
        const float b = (float)(int32_t)(word >> 40) * 0x1p-23f - 1, along = 1 - b * b;
        const float across = b * sqrtf(along);
        const float gx = dsmc->grains[i].vx - dsmc->grains[j].vx;
        const float gy = dsmc->grains[i].vy - dsmc->grains[j].vy;
        collide_pair(dsmc, i, j, gx * along - gy * across, gy * along + gx * across, gx, gy, flags);
        if (flags & NOTED && block->impacts) dsmc_note_impact(dsmc, block->impacts, b);
        block->repaid++;
    }
}

/* ---- a block of cells ----------------------------------------------------------------------- */

/* Kicks only: every candidate is worked out alike, and one that does not collide gets nothing. */
FORCE_INLINE uint32_t kick_all(struct block *block, const struct batch *batch)
{
    struct dsmc *dsmc = block->dsmc;
    vector4 *grains = (vector4 *)(void *)dsmc->grains;
    const float f = dsmc->half_impulse;
    const vector4 along = {0, 0, f, f}, across = {0, 0, -f, f};
    uint32_t collisions = 0;
    for (uint32_t c = 0; c < batch->count; c++) {
        vector4 *p = &grains[batch->i[c]], *q = &grains[batch->j[c]];
        const vector4 a = *p, b = *q, g = a - b;
        const float g2 = g[2] * g[2] + g[3] * g[3];
        const bool collides = g2 > batch->least[c];
        const float here = collides ? 1 : 0;
        const float s = here * batch->along[c], t = here * batch->across[c];
        const vector4 turned = {0, 0, g[3], g[2]};
        const vector4 kick = g * (along * s) + turned * (across * t);
        *p = a - kick;
        *q = b + kick;
        collisions += collides;
        if (g2 > batch->bound2[c]) repay(block, batch->i[c], batch->j[c], g2, batch->bound2[c], 0);
    }
    return collisions;
}

FORCE_INLINE uint32_t collide_all(struct block *block, const struct batch *batch, unsigned flags)
{
    struct dsmc *dsmc = block->dsmc;
    double *impacts = block->impacts;
    const bool printed = printed_speed > 0;
    uint32_t collisions = 0;
    for (uint32_t c = 0; c < batch->count; c++) {
        const uint32_t i = batch->i[c], j = batch->j[c];
        const float gx = dsmc->grains[i].vx - dsmc->grains[j].vx;
        const float gy = dsmc->grains[i].vy - dsmc->grains[j].vy;
        const float g2 = gx * gx + gy * gy, s = batch->along[c], t = batch->across[c];
        if (printed ? g2 >= batch->least[c] : g2 <= batch->least[c]) continue;
        collisions++;
        if (flags & NOTED && impacts) dsmc_note_impact(dsmc, impacts, batch->b[c]);
        collide_pair(dsmc, i, j, gx * s - gy * t, gy * s + gx * t, gx, gy, flags);
        if (!printed && g2 > batch->bound2[c]) repay(block, i, j, g2, batch->bound2[c], flags);
    }
    return collisions;
}

FORCE_INLINE void collide_block(struct block *block, unsigned flags)
{
    struct dsmc *dsmc = block->dsmc;
    struct batch batch;
    if (dsmc->count < SPARSE * (uint64_t)dsmc->cells) find_boxes(block, FEW);
    else find_boxes(block, MANY);
    find_pairs(block);
    for (uint32_t k = 0; k < block->cells;) {
        k = take_cells(block, k, &batch);
        work_out(block, &batch);
        const bool simple = flags == 0 && !(printed_speed > 0);
        block->collisions += simple ? kick_all(block, &batch) : collide_all(block, &batch, flags);
        block->candidates += batch.count;
    }
    block->rejected = block->candidates - block->collisions;
    block->collisions += block->repaid;
    if (flags & ROUGH) block->tangential = block->collisions;
}

/* X(flags): the loops that exist */
#define LOOPS(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)

#define X(flags) \
    CLONES static void loop_##flags(struct block *block) { collide_block(block, flags); }
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
    const unsigned flags = (dsmc->settings.method == DSMC_DENSE ? DISPLACE : 0)
                         | (dsmc->spins ? ROUGH : 0)
                         | (dsmc->contacts || dsmc->full || sums->impacts ? NOTED : 0);
    struct block block;
    const uint32_t cell = dsmc_collide_cell(dsmc, number), row = cell / dsmc->ax.cells;
    const uint32_t x0 = cell % dsmc->ax.cells, wide = dsmc->ax.cells - x0;
    block.dsmc = dsmc;
    block.impacts = sums->impacts;
    block.cell = cell;
    block.cells = wide < DSMC_BLOCK ? wide : DSMC_BLOCK;
    if (dsmc->first[cell + block.cells] - dsmc->first[cell] < 2) return;
    block.crowd.dsmc = dsmc;
    block.crowd.row = row;
    block.crowd.x0 = x0;
    block.crowd.x1 = x0 + block.cells;
    if (dsmc->settings.method == DSMC_PLAIN) dsmc_crowd_global(&block.crowd);
    else dsmc_crowd_local(&block.crowd);
    block.words = dsmc_words_begin(dsmc->seed, dsmc->steps, number);
    block.number = number;
    block.candidates = block.collisions = block.tangential = block.owing = block.repaid = 0;
    loops[flags](&block);
    sums->collisions += block.collisions;
    sums->rejected += block.rejected;
    sums->tangential += block.tangential;
}
