/* lga_walk.c - the surplus of a lossy collision walks until it finds a place to rest.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The walks of a tick go one after the other, in the order of the words in which the fast form
 * holds the nodes; each has a stream of random numbers of its own, named by tick and start.
 */
#include "model/lga/lga_bits.h"

#include "base/rng.h"

#include <assert.h>

enum { HOPS_MAX = 1 << 12 };

/* The bit of a node in rows of `stride` words. */
static uint64_t *word_of(const struct lga *lga, uint64_t *rows, size_t stride, uint32_t row,
                         uint32_t x, uint64_t *bit)
{
    *bit = 1ull << x / lga->words;
    return rows + row * stride + x % lga->words;
}

enum found { WALKS_ON, RESTS, SINKS, BLOCKED };

/* Tries a node of the fast form. */
static enum found try_bits(struct lga *lga, uint32_t row, uint32_t x, bool heap)
{
    const struct lga_bits *bits = lga->bits;
    uint64_t bit;
    if (*word_of(lga, bits->wall + LGA_LANES, bits->stride, row, x, &bit) & bit) return BLOCKED;
    if (bits->sink && *word_of(lga, bits->sink, bits->words, row, x, &bit) & bit) return SINKS;
    uint64_t *rest = word_of(lga, bits->planes + LGA_DIRECTIONS * bits->words,
                             (size_t)LGA_PLANES * bits->words, row, x, &bit);
    if (*rest & bit) return WALKS_ON;
    *rest |= bit;
    if (heap) *word_of(lga, bits->heap + LGA_LANES, bits->stride, row, x, &bit) |= bit;
    return RESTS;
}

static enum found try_bytes(struct lga *lga, uint32_t site, bool heap)
{
    if (lga->kind[site] == LGA_WALL) return BLOCKED;
    if (lga->kind[site] == LGA_SINK) return SINKS;
    if (lga->rest[site]) return WALKS_ON;
    lga->rest[site] = 1;
    if (heap) lga->heap[site] = true;
    return RESTS;
}

static bool walk(struct lga *lga, struct rng *rng, uint32_t row, uint32_t x, bool heap)
{
    static const int dx[2][LGA_DIRECTIONS] = {{1, 0, -1, -1, -1, 0}, {1, 1, 0, -1, 0, 1}};
    static const int dy[LGA_DIRECTIONS] = {0, 1, 1, 0, -1, -1};
    const uint32_t columns = lga->lattice.columns, rows = lga->lattice.rows;
    for (uint32_t hop = 0; hop < HOPS_MAX; hop++) {
        const uint32_t d = (uint32_t)((rng_u64(rng) >> 32) * LGA_DIRECTIONS >> 32);
        const int shift = dx[row & 1][d];
        const uint32_t to_x = shift < 0 ? (x ? x : columns) - 1
                            : shift > 0 ? (x + 1 == columns ? 0 : x + 1) : x;
        const uint32_t to_row = dy[d] < 0 ? (row ? row : rows) - 1
                              : dy[d] > 0 ? (row + 1 == rows ? 0 : row + 1) : row;
        const enum found found = lga->bits ? try_bits(lga, to_row, to_x, heap)
                                           : try_bytes(lga, to_row * columns + to_x, heap);
        if (found == BLOCKED) continue;
        lga->grains_out += found == SINKS;
        if (found != WALKS_ON) return true;
        row = to_row;
        x = to_x;
    }
    return false;
}

void lga_walk(struct lga *lga, uint32_t site, uint32_t surplus, bool heap)
{
    struct rng rng = rng_stream(lga->seed ^ heap, lga->ticks, site);
    for (; surplus > 0; surplus--) {
        const uint32_t row = site / lga->lattice.columns, x = site % lga->lattice.columns;
        if (walk(lga, &rng, row, x, heap)) continue;
        /* No place anywhere near: on it flies.  What was brought to rest has left slots free. */
        const struct lga_node node = lga_node_get(lga, site);
        assert(node.moving + 1 < LGA_STATES);
        lga_node_set(lga, site, node.moving | (node.moving + 1u), node.rest);
    }
}
