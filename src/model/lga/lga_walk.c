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

static const int hop_x[2][LGA_DIRECTIONS] = {{1, 0, -1, -1, -1, 0}, {1, 1, 0, -1, 0, 1}};
static const int hop_y[LGA_DIRECTIONS] = {0, 1, 1, 0, -1, -1};

static uint32_t draw_direction(struct rng *rng)
{
    return (uint32_t)((rng_u64(rng) >> 32) * LGA_DIRECTIONS >> 32);
}

/* at + step, on a ring. */
static uint32_t stepped(uint32_t at, int step, uint32_t length)
{
    const uint32_t to = at + (uint32_t)step;
    return to == length ? 0 : to > length ? length - 1 : to;
}

enum found { WALKS_ON, RESTS, SINKS, BLOCKED };

/* A node of the fast form: a bit of a word in each of its planes. */
struct place { uint32_t row, word; uint64_t bit; };

static enum found try_bits(struct lga *lga, struct place to, bool heap)
{
    const struct lga_bits *bits = lga->bits;
    const size_t here = (size_t)to.row * bits->words + to.word;
    const size_t apart = (size_t)to.row * bits->stride + LGA_LANES + to.word;
    if (bits->wall[apart] & to.bit) return BLOCKED;
    if (bits->sink && bits->sink[here] & to.bit) return SINKS;
    uint64_t *rest = bits->planes + ((size_t)to.row * LGA_PLANES + LGA_DIRECTIONS) * bits->words
                   + to.word;
    if (*rest & to.bit) return WALKS_ON;
    *rest |= to.bit;
    if (heap) bits->heap[apart] |= to.bit;
    return RESTS;
}

/* The node beside it in its row: to the right of a row's last word is the next bit of the first.  A
 * row's last node may be any; on a ring its neighbour is the first. */
static struct place beside(struct place at, int step, struct place end, uint32_t words)
{
    if ((step > 0) & (at.bit == end.bit) & (at.word == end.word)) return (struct place){0, 0, 1};
    if ((step < 0) & (at.bit == 1) & (at.word == 0)) return end;
    const uint32_t word = at.word + (uint32_t)step;
    const uint64_t bit = word == words ? at.bit << 1 : word > words ? at.bit >> 1 : at.bit;
    return (struct place){0, stepped(at.word, step, words), bit};
}

/* In a large heap a grain takes thousands of hops, and nobody can foretell them: so the common ones
 * have neither branches nor divisions. */
static enum found walk_bits(struct lga *lga, struct rng *rng, uint32_t row, uint32_t x, bool heap)
{
    const uint32_t rows = lga->lattice.rows, words = lga->words, last = lga->lattice.columns - 1;
    const struct place end = {0, last % words, 1ull << last / words};
    struct place at = {row, x % words, 1ull << x / words};
    for (uint32_t hop = 0; hop < HOPS_MAX; hop++) {
        const uint32_t d = draw_direction(rng);
        struct place to = beside(at, hop_x[at.row & 1][d], end, words);
        to.row = stepped(at.row, hop_y[d], rows);
        const enum found found = try_bits(lga, to, heap);
        if (found == RESTS || found == SINKS) return found;
        if (found == WALKS_ON) at = to;
    }
    return WALKS_ON;
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

static enum found walk_bytes(struct lga *lga, struct rng *rng, uint32_t row, uint32_t x, bool heap)
{
    const uint32_t columns = lga->lattice.columns, rows = lga->lattice.rows;
    for (uint32_t hop = 0; hop < HOPS_MAX; hop++) {
        const uint32_t d = draw_direction(rng);
        const uint32_t to_x = stepped(x, hop_x[row & 1][d], columns);
        const uint32_t to_row = stepped(row, hop_y[d], rows);
        const enum found found = try_bytes(lga, to_row * columns + to_x, heap);
        if (found == RESTS || found == SINKS) return found;
        if (found == BLOCKED) continue;
        row = to_row;
        x = to_x;
    }
    return WALKS_ON;
}

void lga_walk(struct lga *lga, uint32_t site, uint32_t surplus, bool heap)
{
    struct rng rng = rng_stream(lga->seed ^ heap, lga->ticks, site);
    for (; surplus > 0; surplus--) {
        const uint32_t row = site / lga->lattice.columns, x = site % lga->lattice.columns;
        const enum found found = (lga->bits ? walk_bits : walk_bytes)(lga, &rng, row, x, heap);
        lga->grains_out += found == SINKS;
        if (found != WALKS_ON) continue;
        /* No place anywhere near: on it flies.  What was brought to rest has left slots free. */
        const struct lga_node node = lga_node_get(lga, site);
        assert(node.moving + 1 < LGA_STATES);
        lga_node_set(lga, site, node.moving | (node.moving + 1u), node.rest);
    }
}
