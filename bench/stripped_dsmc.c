/* stripped_dsmc.c - Bird's method by hand; see stripped.h.
 *
 * The algorithm of dsmc for method plain: blocks of cells collide, fly and are counted into their
 * new cells while they are in the cache, then all are sorted.  Elastic grains without spin in a
 * periodic square, one thread.  The random words have the model's names, so both give the same
 * motion to the last bit.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/stripped.h"

#include "model/dsmc/dsmc.h"
#include "model/dsmc/dsmc_vector.h"
#include "model/dsmc/dsmc_words.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char text[] =
    "until = 1e3; box = [0, 0, 280, 280];"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
    "grains = ({ radius = 0.5; density = 1.2732395447351628; restitution = 1; });"
    "placements = ({ kind = \"square\"; spacing = 1.4; temperature = 1; });"
    "dsmc = { method = \"plain\"; };";

enum { BATCH = 512, FEW = 4, MANY = 16, SPARSE = 3, PER_GRAIN_MAX = 64, SCATTER = 512, EIGHT = 8 };

static const uint64_t repay_key = 0x7265706179;

struct gas {
    uint32_t count, nx, ny, cells;
    uint64_t seed, steps, collisions;
    double   step;
    float    dt, length_x, length_y, per_x, per_y, offset;
    float    rate;              /* chi d dt / V: pairs per n (n - 1) v */
    struct dsmc_grain *grains, *sorted;
    uint32_t *tags, *first, *places;
    struct arena arena;
};

struct block {
    struct dsmc_words words;
    uint32_t number, cell, cells;
    float    bound2[DSMC_BLOCK];
    uint32_t pairs[DSMC_BLOCK];
    uint64_t owing, collisions;
};

struct batch {
    uint32_t count, k[BATCH + EIGHT], i[BATCH], j[BATCH];
    float bound2[BATCH], least[BATCH], along[BATCH], across[BATCH];
};

/* ---- how many candidates ------------------------------------------------------------------- */

FORCE_INLINE void widen(const struct dsmc_grain *pair, vector8 *low, vector8 *high)
{
    const vector8 v = *(const vector8 *)(const void *)pair;
    const mask8 below = v < *low, above = v > *high;
    *low = (vector8)(((mask8)v & below) | ((mask8)*low & ~below));
    *high = (vector8)(((mask8)v & above) | ((mask8)*high & ~above));
}

/* The diagonal of the box around the velocities of each cell. */
FORCE_INLINE void find_bounds(const struct gas *g, struct block *block, uint32_t often)
{
    const uint32_t *first = &g->first[block->cell], end = first[block->cells] - 2;
    float width[DSMC_BLOCK], height[DSMC_BLOCK];
    for (uint32_t k = 0; k < block->cells; k++) {
        const uint32_t start = first[k] < end ? first[k] : end;
        const uint32_t n = first[k + 1] - first[k], most = n > 2 ? n - 2 : 0;
        vector8 low = *(const vector8 *)(const void *)&g->grains[start], high = low;
#pragma GCC unroll 8
        for (uint32_t i = 2; i < often; i += 2) {
            widen(&g->grains[start + (i < most ? i : most)], &low, &high);
        }
        for (uint32_t i = often; i < n; i += 2) {
            widen(&g->grains[start + (i < most ? i : most)], &low, &high);
        }
        width[k] = (high[2] > high[6] ? high[2] : high[6]) - (low[2] < low[6] ? low[2] : low[6]);
        height[k] = (high[3] > high[7] ? high[3] : high[7]) - (low[3] < low[7] ? low[3] : low[7]);
    }
    for (uint32_t k = 0; k < block->cells; k++) {
        block->bound2[k] = width[k] * width[k] + height[k] * height[k];
    }
}

FORCE_INLINE void find_pairs(const struct gas *g, struct block *block)
{
    const uint32_t *first = &g->first[block->cell];
    uint32_t chance[DSMC_BLOCK];
    dsmc_words_fill(&block->words, chance, block->cells);
    for (uint32_t k = 0; k < block->cells; k++) {
        const float n = (float)(int32_t)(first[k + 1] - first[k]);
        const float mean = g->rate * n * (n - 1) * sqrtf(block->bound2[k]);
        const float most = (float)PER_GRAIN_MAX * n;
        const float u = (float)(int32_t)(chance[k] >> 8) * 0x1p-24f;
        const float wanted = (mean < most ? mean : most) + u;
        block->pairs[k] = (uint32_t)(int32_t)(n > 1 ? wanted : 0);
    }
}

/* ---- candidates ---------------------------------------------------------------------------- */

FORCE_INLINE uint32_t take_cells(struct block *block, uint32_t k, struct batch *batch)
{
    uint32_t count = 0;
    while (k < block->cells) {
        const uint32_t room = BATCH - count, wanted = block->pairs[k];
        const uint32_t n = wanted < room ? wanted : room;
        for (uint32_t e = 0; e < EIGHT; e++) batch->k[count + e] = k;
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

FORCE_INLINE void work_out(const struct gas *g, struct block *block, struct batch *batch)
{
    const uint32_t *first = &g->first[block->cell], count = batch->count;
    const uint32_t made = (count + DSMC_LANES - 1) / DSMC_LANES * DSMC_LANES;
    uint32_t words[3 * BATCH], start[BATCH], n[BATCH];
    dsmc_words_fill(&block->words, words, 3 * made);
    for (uint32_t c = 0; c < count; c++) {
        const uint32_t k = batch->k[c];
        start[c] = first[k];
        n[c] = first[k + 1] - first[k];
        batch->bound2[c] = block->bound2[k];
    }
    for (uint32_t c = 0; c < count; c++) {
        const uint32_t i = (uint32_t)((uint64_t)(words[c] & 0xffff) * n[c] >> 16);
        const uint32_t j = (uint32_t)((uint64_t)(words[c] >> 16) * (n[c] - 1) >> 16);
        batch->i[c] = start[c] + i;
        batch->j[c] = start[c] + j + (j >= i);
    }
    for (uint32_t c = 0; c < count; c++) {
        const float u = (float)(int32_t)(words[made + c] >> 8) * 0x1p-24f;
        const float b = (float)(int32_t)(words[2 * made + c] >> 8) * 0x1p-23f - 1;
        const float c2 = 1 - b * b;
        batch->least[c] = u * u * batch->bound2[c];
        batch->along[c] = c2;
        batch->across[c] = b * sqrtf(c2);
    }
}

FORCE_INLINE void kick(vector4 *p, vector4 *q, float s, float t)
{
    const vector4 a = *p, b = *q, v = a - b, turned = {0, 0, v[3], v[2]};
    const vector4 along = {0, 0, 1, 1}, across = {0, 0, -1, 1};
    const vector4 way = v * (along * s) + turned * (across * t);
    *p = a - way;
    *q = b + way;
}

/* A pair faster than the bound is owed g / v - 1 of a collision. */
static void repay(const struct gas *g, struct block *block, vector4 *p, vector4 *q, float owed)
{
    for (owed = fminf(owed, PER_GRAIN_MAX); owed > 0; owed -= 1) {
        const uint64_t word = rng_keyed(g->seed, repay_key, g->steps,
                                        (uint64_t)block->number << 32 | block->owing++);
        if (dsmc_words_unit((uint32_t)word) >= owed) break;
        const float b = (float)(int32_t)(word >> 40) * 0x1p-23f - 1, along = 1 - b * b;
        kick(p, q, along, b * sqrtf(along));
        block->collisions++;
    }
}

CLONES static void collide_block(struct gas *g, struct block *block)
{
    vector4 *grains = (vector4 *)(void *)g->grains;
    struct batch batch;
    if (g->count < SPARSE * (uint64_t)g->cells) find_bounds(g, block, FEW);
    else find_bounds(g, block, MANY);
    find_pairs(g, block);
    for (uint32_t k = 0; k < block->cells;) {
        k = take_cells(block, k, &batch);
        work_out(g, block, &batch);
        for (uint32_t c = 0; c < batch.count; c++) {
            vector4 *p = &grains[batch.i[c]], *q = &grains[batch.j[c]];
            const vector4 v = *p - *q;
            const float g2 = v[2] * v[2] + v[3] * v[3], bound2 = batch.bound2[c];
            const bool collides = g2 > batch.least[c];
            const float here = collides ? 1 : 0;
            kick(p, q, here * batch.along[c], here * batch.across[c]);
            block->collisions += collides;
            if (g2 > bound2) repay(g, block, p, q, sqrtf(g2 / bound2) - 1);
        }
    }
}

/* ---- flight and sort ----------------------------------------------------------------------- */

struct finder { vector8 per, offset; mask8 cells; uint32_t columns; };

FORCE_INLINE void find_cells(const struct finder *f, const vector8 *p, uint32_t cell[2])
{
    mask8 k = __builtin_convertvector(*p * f->per + f->offset, mask8);
    k &= k < f->cells;
    const words4 words = (words4)k;
    cell[0] = (uint32_t)(words[0] >> 32) * f->columns + (uint32_t)words[0];
    cell[1] = (uint32_t)(words[2] >> 32) * f->columns + (uint32_t)words[2];
}

#define FINDER(g) {                                                                              \
        .per = {(g)->per_x, (g)->per_y, 0, 0, (g)->per_x, (g)->per_y, 0, 0},                     \
        .offset = {(g)->offset, (g)->offset, 0, 0, (g)->offset, (g)->offset, 0, 0},              \
        .cells = {(int32_t)(g)->nx, (int32_t)(g)->ny, 1, 1, (int32_t)(g)->nx, (int32_t)(g)->ny,  \
                  1, 1}, .columns = (g)->nx}

CLONES static void fly(struct gas *g, uint32_t from, uint32_t to)
{
    const struct finder finder = FINDER(g);
    const float dt = g->dt, x = g->length_x, y = g->length_y, inf = INFINITY;
    const vector8 time = {dt, dt, 0, 0, dt, dt, 0, 0}, by = {x, y, 0, 0, x, y, 0, 0};
    const vector8 below = {0, 0, -inf, -inf, 0, 0, -inf, -inf};
    const vector8 above = {x, y, inf, inf, x, y, inf, inf};
    uint32_t *restrict places = g->places, cell[2];
    for (uint32_t i = from; i < to; i += 2) {
        const bool alone = i + 1 == to;         /* the last may be moved together with nobody */
        vector8 *at = (vector8 *)(void *)&g->grains[alone ? i - (i > 0) : i];
        const uint32_t lane = alone && i > 0;
        vector8 p = *at;
        const vector8 before = p, v = {p[2], p[3], p[2], p[3], p[6], p[7], p[6], p[7]};
        p += v * time;
        const vector8 up = (vector8)((mask8)by & (p < below));
        const vector8 down = (vector8)((mask8)by & (p >= above));
        p = p + up - down;
        if (__builtin_expect(alone, 0)) {
            find_cells(&finder, &p, cell);
            for (uint32_t k = 0; k < 4; k++) {
                p[lane ? k : k + 4] = before[lane ? k : k + 4];
            }
            *at = p;
            places[cell[lane]]++;
            return;
        }
        *at = p;
        find_cells(&finder, &p, cell);
        places[cell[0]]++;
        places[cell[1]]++;
    }
}

struct __attribute__((may_alias)) carry { uint32_t place, tag; };

CLONES static void sort(struct gas *g)
{
    const struct finder finder = FINDER(g);
    const vector4 *from = (const vector4 *)(const void *)g->grains;
    vector4 *restrict to = (vector4 *)(void *)g->sorted;
    struct carry *carries = (struct carry *)(void *)g->grains;
    uint32_t place[SCATTER], at = 0;
    for (uint32_t c = 0; c < g->cells; c++) {
        const uint32_t n = g->places[c];
        g->first[c] = g->places[c] = at;
        at += n;
    }
    g->first[g->cells] = at;
    for (uint32_t i = 0; i < g->count; i += SCATTER) {
        const uint32_t n = g->count - i < SCATTER ? g->count - i : SCATTER;
        for (uint32_t m = 0; m < n; m += 2) {
            find_cells(&finder, (const vector8 *)(const void *)&from[i + m], &place[m]);
        }
        for (uint32_t k = 0; k < n; k++) {
            place[k] = g->places[place[k]]++;
            __builtin_prefetch(&to[place[k]], 1);
        }
        for (uint32_t k = 0; k < n; k++) {
            to[place[k]] = from[i + k];
            carries[i + k] = (struct carry){place[k], g->tags[i + k]};
        }
    }
    for (uint32_t i = 0; i < g->count; i++) g->tags[carries[i].place] = carries[i].tag;
    struct dsmc_grain *old = g->grains;
    g->grains = g->sorted;
    g->sorted = old;
}

static void gas_advance(void *state, double t_end)
{
    struct gas *g = state;
    const uint32_t per_row = (g->nx + DSMC_BLOCK - 1) / DSMC_BLOCK;
    const uint64_t target = (uint64_t)llround(t_end / g->step);
    for (; g->steps < target; g->steps++) {
        memset(g->places, 0, g->cells * sizeof *g->places);
        for (uint32_t number = 0; number < per_row * g->ny; number++) {
            const uint32_t x0 = number % per_row * DSMC_BLOCK, left = g->nx - x0;
            struct block block;
            block.number = number;
            block.cell = number / per_row * g->nx + x0;
            block.cells = left < DSMC_BLOCK ? left : DSMC_BLOCK;
            block.owing = block.collisions = 0;
            const uint32_t from = g->first[block.cell], to = g->first[block.cell + block.cells];
            if (to - from >= 2) {
                block.words = dsmc_words_begin(g->seed, g->steps, number);
                collide_block(g, &block);
                g->collisions += block.collisions;
            }
            fly(g, from, to);
        }
        sort(g);
    }
}

/* ---- from the model's state ---------------------------------------------------------------- */

static void gas_close(void *state)
{
    struct gas *g = state;
    arena_free(&g->arena);
    free(g);
}

static void *gas_open(const struct simulation *sim, double *bytes)
{
    const struct dsmc *dsmc = sim->state;
    struct gas *g = calloc(1, sizeof *g);
    if (!g) return NULL;
    const double area = M_PI * dsmc->radius * dsmc->radius * dsmc->count;
    const float nu = (float)(area / ((double)dsmc->ax.length * (double)dsmc->ay.length));
    *g = (struct gas){
        .count = dsmc->count, .nx = dsmc->ax.cells, .ny = dsmc->ay.cells, .cells = dsmc->cells,
        .seed = dsmc->seed, .step = dsmc->dt, .dt = (float)dsmc->dt,
        .length_x = dsmc->ax.length, .length_y = dsmc->ay.length, .per_x = dsmc->ax.per,
        .per_y = dsmc->ay.per, .offset = dsmc->ax.offset,
        .rate = dsmc->rate * dsmc_chi(dsmc->settings.chi, nu),
    };
    const size_t n = (size_t)g->count + 1, cells = g->cells;    /* the last is read in pairs */
    if (!arena_array(&g->arena, &g->grains, n) || !arena_array(&g->arena, &g->sorted, n)
        || !arena_array(&g->arena, &g->tags, n) || !arena_array(&g->arena, &g->first, cells + 1)
        || !arena_array(&g->arena, &g->places, cells)) {
        gas_close(g);
        return NULL;
    }
    memcpy(g->grains, dsmc->grains, g->count * sizeof *g->grains);
    memcpy(g->tags, dsmc->tags, g->count * sizeof *g->tags);
    memcpy(g->first, dsmc->first, (cells + 1) * sizeof *g->first);
    *bytes = 2 * sizeof *g->grains + sizeof *g->tags + 8.0 * (double)cells / g->count;
    return g;
}

/* Grains that differ in anything. */
static double gas_apart(const void *state, const struct simulation *sim)
{
    const struct gas *g = state;
    const struct dsmc *dsmc = sim->state;
    uint32_t count = g->collisions != dsmc->collisions;
    for (uint32_t i = 0; i < g->count; i++) {
        count += memcmp(&g->grains[i], &dsmc->grains[i], sizeof *g->grains) != 0
              || g->tags[i] != dsmc->tags[i];
    }
    return count;
}

const struct stripped_kernel stripped_dsmc = {
    .model = "dsmc", .scene = text, .slice = 2, .warm = 3, .turns = 35,
    .open = gas_open, .advance = gas_advance, .close = gas_close,
    .apart = gas_apart, .apart_unit = "grains", .apart_max = 0,
};
