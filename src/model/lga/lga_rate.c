/* lga_rate.c - how often grains collide: counted at the nodes, for grains here have no names.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Each node has two numbers, the collisions of this window of time and of the last whole one, in
 * planes of bits, so that a row of 64 nodes is counted at once.
 */
#include "model/lga/lga_bits.h"

#include <string.h>

static size_t size_of(const struct lga *lga)
{
    return lga->rate.window ? (size_t)lga->lattice.rows * LGA_RATE_DIGITS * lga->words : 0;
}

bool lga_rate_allocate(struct lga *lga)
{
    return arena_array(&lga->arena, &lga->rate.now, size_of(lga))
        && arena_array(&lga->arena, &lga->rate.last, size_of(lga));
}

uint64_t *lga_rate_row(const struct lga *lga, uint32_t row)
{
    return lga->rate.now ? lga->rate.now + (size_t)row * LGA_RATE_DIGITS * lga->words : NULL;
}

void lga_rate_note(struct lga *lga, uint32_t site)
{
    const uint32_t words = lga->words, x = site % lga->lattice.columns;
    uint64_t *number = lga_rate_row(lga, site / lga->lattice.columns) + x % words;
    const uint64_t bit = 1ull << x / words;
    uint32_t k = 0;
    while (k < LGA_RATE_DIGITS && number[k * words] & bit) k++;
    if (k == LGA_RATE_DIGITS) return;           /* as many as can be told */
    number[k * words] |= bit;
    while (k-- > 0) number[k * words] &= ~bit;
}

void lga_rate_end_tick(struct lga *lga)
{
    struct lga_rate *rate = &lga->rate;
    if (!rate->now || lga->ticks - rate->from < rate->window) return;
    uint64_t *last = rate->last;
    rate->last = rate->now;
    rate->now = last;
    memset(last, 0, size_of(lga) * sizeof *last);
    rate->from = lga->ticks;
}

double lga_rate_of(const struct lga *lga, uint32_t site)
{
    if (!lga->rate.last) return 0;
    const uint32_t words = lga->words, x = site % lga->lattice.columns;
    const uint64_t *number = lga->rate.last
        + (size_t)(site / lga->lattice.columns) * LGA_RATE_DIGITS * words + x % words;
    uint32_t count = 0;
    for (uint32_t k = 0; k < LGA_RATE_DIGITS; k++) {
        count |= (uint32_t)(number[k * words] >> x / words & 1) << k;
    }
    return count / ((double)lga->rate.window * lga->tick);
}

void lga_rate_archive(struct lga *lga, struct archive *archive)
{
    if (!lga->rate.now) return;
    archive_array(archive, "lga.rate_now", lga->rate.now, size_of(lga));
    archive_array(archive, "lga.rate_last", lga->rate.last, size_of(lga));
    archive_value(archive, "lga.rate_from", &lga->rate.from);
    if (archive->mode == ARCHIVE_LOAD && lga->rate.from > lga->ticks) {
        archive_fail(archive, "the saved clock does not show a time");
    }
}
