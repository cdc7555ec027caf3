/* dsmc_heap.h - hsmc: grains move one after the other and never into a full cell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_HEAP_H
#define DSMC_HEAP_H

#include "model/dsmc/dsmc.h"

enum { DSMC_HEAP_ROWS = 3 };    /* that a grain may go in a step, pushed by a wall */

/* Counts the grains in the cells of thread t's share; a sweep keeps these counts, `load`, up to
 * date. */
void dsmc_heap_load(struct dsmc *dsmc, uint32_t t);

/* Moves all grains by one step, once all cells are counted.  Every thread of a team calls it, with
 * its own sums. */
void dsmc_heap_sweep(struct dsmc *dsmc, struct dsmc_sums *sums);

#endif
