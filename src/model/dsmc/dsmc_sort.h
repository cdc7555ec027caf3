/* dsmc_sort.h - the sort by cell that ends a step.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_SORT_H
#define DSMC_SORT_H

#include "model/dsmc/dsmc_flight.h"

/* Room for counts, shares and lists; `grains` and `sorted` are there already. */
bool dsmc_sort_create(struct dsmc *dsmc);

/* What that takes in bytes, for so many grains in `rows` rows of cells. */
double dsmc_sort_memory(double grains, double cells, double rows, double threads);

/* Gives thread t of a team its share; no grain of it has arrived anywhere. */
void dsmc_sort_begin(struct dsmc *dsmc, uint32_t t, uint32_t team);

/* The same once grains have come or gone: counts all of the share into the next grid. */
void dsmc_sort_recount(struct dsmc *dsmc, uint32_t t, uint32_t team);

/* hsmc, where `load` already holds what arrived from all shares: lists who has left this one.  No
 * grain has gone farther than `rows` rows of cells. */
void dsmc_sort_list(struct dsmc *dsmc, uint32_t t, uint32_t rows);

/* Copies the grains of the share into their new cells.  Every thread of the team calls it once all
 * shares are counted; others may still be at it when it returns. */
void dsmc_sort_share(struct dsmc *dsmc, uint32_t t, uint32_t team);

/* Sorts all grains into the next grid, with one thread. */
void dsmc_sort_all(struct dsmc *dsmc);

/* The next grid becomes this one, once all have sorted. */
void dsmc_sort_end(struct dsmc *dsmc);

/* A grain of the share has arrived in a cell.  For loops that work on a copy of their share, whose
 * `gone` they put back. */
FORCE_INLINE void dsmc_sort_arrive(struct dsmc_share *share, uint32_t *restrict load, uint32_t cell)
{
    if (cell - share->from < share->cells) {
        load[cell]++;
        return;
    }
    if (share->gone < share->gone_max) share->away[share->gone] = cell;
    share->gone++;
}

#endif
