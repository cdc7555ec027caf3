/* lga_step.c - one tick of a lattice gas, and the streaming that all of them share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Streaming goes by links and reads the lattice before it only.  No two grains can come into one
 * slot: a grain that a wall sends back (or reflects) takes a slot whose only other source is that
 * wall.
 */
#include "model/lga/lga_bits.h"

#include <assert.h>

static unsigned bit(int direction) { return 1u << direction; }
static int reverse(int direction) { return (direction + 3) % LGA_DIRECTIONS; }
static int turned(int direction, int by) { return (direction + by + 6) % LGA_DIRECTIONS; }

/* Where a wall with these blocked links reflects direction d to: like a mirror where it is flat
 * ({a, a+1}) or the zigzag across the rows ({a, a+1, a+2}), back where it has no clear normal. */
static int mirror(unsigned blocked, int d)
{
    for (int a = 0; a < LGA_DIRECTIONS; a++) {
        const unsigned flat = bit(a) | bit(turned(a, 1));
        if (blocked == flat) return d == a ? turned(a, -2) : turned(a, 3);
        if (blocked != (flat | bit(turned(a, 2)))) continue;
        return d == a ? turned(a, -1) : d == turned(a, 1) ? turned(a, 4) : turned(a, 3);
    }
    return reverse(d);
}

unsigned lga_step_mirrored(unsigned blocked, unsigned stuck, unsigned moving)
{
    for (int d = 0; d < LGA_DIRECTIONS; d++) if (stuck & bit(d)) moving &= ~bit(reverse(d));
    for (int d = 0; d < LGA_DIRECTIONS; d++) if (stuck & bit(d)) moving |= bit(mirror(blocked, d));
    return moving;
}

struct streamed { uint64_t left, refused; };

/* A grain that cannot leave its node in direction d stops there, or not. */
static bool stops(struct lga *lga, uint32_t site, int d, unsigned rest)
{
    if (lga->rule.method == LGA_GMLG) {
        return rest < LGA_ROOM && lga_plain_die(lga, LGA_DIE_STOP + d, site);
    }
    if (!lga->heap || d < 4 || !lga_plain_die(lga, LGA_DIE_PLATE, site)) return false;
    lga->heap[site] = true;
    return true;
}

/* The node after streaming: who was let in, and those of its own movers that could not leave:
 * they stop, bounce back or are mirrored.  A grain that is not let in bounces back into a free
 * slot, because whoever could have come through it would have met that grain head-on, and they
 * would have swapped. */
static struct streamed stream(struct lga *lga, uint32_t site)
{
    struct streamed sum = {0};
    unsigned next = lga->admitted[site], rest = lga->rest[site], blocked = 0, stuck = 0;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        const uint32_t to = lga->beside[site][d];
        if (lga->kind[to] == LGA_WALL) blocked |= bit(d);
        if (!(lga->moving[site] & bit(d))) continue;
        if (lga->kind[to] == LGA_SINK) {
            sum.left++;
            continue;
        }
        if (lga->kind[to] == LGA_FLUID) {
            if (lga->admitted[to] & bit(d)) continue;
            sum.refused++;
        }
        if (stops(lga, site, d, rest)) {
            rest++;
        } else {
            assert(!(next & bit(reverse(d))));
            next |= bit(reverse(d));
            if (lga->kind[to] == LGA_WALL) stuck |= bit(d);
        }
    }
    if (stuck && lga->rule.method != LGA_GMLG) {
        const bool plate = lga->heap && blocked == (bit(4) | bit(5));
        if (plate || lga_plain_die(lga, LGA_DIE_MIRROR, site)) {
            next = lga_step_mirrored(blocked, stuck, next);
        }
    }
    lga->moving_next[site] = (uint8_t)next;
    lga->rest_next[site] = (uint8_t)rest;
    return sum;
}

static void swap(uint8_t **a, uint8_t **b)
{
    uint8_t *kept = *a;
    *a = *b;
    *b = kept;
}

static void stream_all(struct lga *lga)
{
    const uint32_t sites = lga->sites;
    uint64_t left = 0, refused = 0;
    #pragma omp parallel for reduction(+ : left, refused) if (sites >= LGA_LOOP_MIN)
    for (uint32_t n = 0; n < sites; n++) {
        if (lga->kind[n] != LGA_FLUID) {
            lga->moving_next[n] = lga->moving[n];       /* trapped: waits until it is released */
            lga->rest_next[n] = lga->rest[n];
            continue;
        }
        const struct streamed sum = stream(lga, n);
        left += sum.left;
        refused += sum.refused;
    }
    swap(&lga->moving, &lga->moving_next);
    swap(&lga->rest, &lga->rest_next);
    lga->grains_out += left;
    lga->refused += refused;
}

void lga_step(struct lga *lga)
{
    if (lga->bits) {
        lga_bits_step(lga);
    } else {
        if (lga->rule.method == LGA_GMLG) lga_gmlg_collide(lga);
        else lga_sand_collide(lga);
        stream_all(lga);
        if (lga->heap) lga_sand_settle(lga);
    }
    lga->ticks++;
    lga_rate_end_tick(lga);
}

double lga_step_time(const struct lga *lga)
{
    return lga->base_time + (double)(lga->ticks - lga->base_ticks) * lga->tick;
}

static bool allocate_plain(struct lga *lga)
{
    struct arena *arena = &lga->arena;
    const bool gmlg = lga->rule.method == LGA_GMLG;
    const bool done = arena_array(arena, &lga->kind, lga->sites)
        && arena_array(arena, &lga->moving, lga->sites)
        && arena_array(arena, &lga->rest, lga->sites)
        && arena_array(arena, &lga->load, lga->sites)
        && arena_array(arena, &lga->admitted, lga->sites)
        && arena_array(arena, &lga->hit, gmlg ? lga->sites : 0)
        && arena_array(arena, &lga->moving_next, lga->sites)
        && arena_array(arena, &lga->rest_next, lga->sites)
        && arena_array(arena, &lga->beside, lga->sites);
    if (!done) return false;
    lga_lattice_join(&lga->lattice, lga->beside);
    return lga_plain_allocate(lga) && (gmlg || lga_sand_allocate(lga));
}

bool lga_step_allocate(struct lga *lga)
{
    struct arena *arena = &lga->arena;
    lga->words = lga_dice_words(lga->lattice.columns);
    lga->dice = lga_dice_of(&lga->rule);
    lga->simd = lga_dice_simd();
    lga->queue_length = lga->sites < LGA_QUEUE ? lga->sites : LGA_QUEUE;
    if (!arena_array(arena, &lga->table, 1) || !arena_array(arena, &lga->queue, lga->queue_length)
        || !arena_array(arena, &lga->seen, lga->sites / 64 + 1)) return false;
    lga_table_fill(lga->table);
    if (!lga_rate_allocate(lga)) return false;
    return lga->plain ? allocate_plain(lga) : lga_bits_allocate(lga);
}
