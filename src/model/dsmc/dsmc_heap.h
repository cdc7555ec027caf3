/* dsmc_heap.h - hsmc: grains move one after the other and never into a full cell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_HEAP_H
#define DSMC_HEAP_H

#include "model/dsmc/dsmc.h"

/* Counts the grains in the cells of thread t's share, its blocks `from` .. `to` - 1.  A sweep keeps
 * these counts up to date, `load` and (in a team) each thread's `places`. */
void dsmc_heap_load(struct dsmc *dsmc, uint32_t t, uint32_t team, uint32_t from, uint32_t to);

/* Moves all grains by one step, once all cells are counted.  Every thread of a team calls it, with
 * its own sums. */
void dsmc_heap_sweep(struct dsmc *dsmc, struct dsmc_sums *sums);

#endif
