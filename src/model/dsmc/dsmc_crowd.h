/* dsmc_crowd.h - how crowded the cells of a block are.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_CROWD_H
#define DSMC_CROWD_H

#include "model/dsmc/dsmc.h"

struct dsmc_crowd {
    const struct dsmc *dsmc;
    uint32_t row, x0, x1;       /* the block: cells x0 .. x1 - 1 of that row */
    float    factor[DSMC_BLOCK];        /* chi, pair factor and 1 / volume of each cell */
};

/* Fills `factor` from the cells around each cell. */
void dsmc_crowd_local(struct dsmc_crowd *crowd);

/* Fills `factor` as if the whole box were as crowded as it is on average. */
void dsmc_crowd_global(struct dsmc_crowd *crowd);

#endif
