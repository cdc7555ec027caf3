/* md_pairs.h - forces between grains, a window of links at a time.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MD_PAIRS_H
#define MD_PAIRS_H

#include "model/md/md.h"

/* The touching pairs of a window: what the force loop reads, and the forces it leaves. */
struct md_window {
    uint32_t count;
    uint32_t link[WINDOW];
    double dx[WINDOW], dy[WINDOW];
    double ux[WINDOW], uy[WINDOW];      /* velocity of i relative to j */
    double rims[WINDOW];                /* sum of the rim speeds */
    double reach[WINDOW], inverse_mass[WINDOW], radius_product[WINDOW];
    double spring[WINDOW];
    struct md_pair_law law[WINDOW];     /* filled for mixtures only */
    double fx[WINDOW], fy[WINDOW], ft[WINDOW];
} __attribute__((aligned(64)));

/* Which compiled force loop serves this law and these effects. */
unsigned md_pairs_kernel(const struct md *md);

/* Finds the pairs that touch among the links first..last-1 (at most WINDOW), keeps account of
 * contacts begun and ended, and computes the forces. */
void md_pairs_window(struct md *md, uint32_t first, uint32_t last, struct md_window *window,
                     struct strip_sums *sums);

#endif
