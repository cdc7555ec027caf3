/* dsmc_collide.h - collisions by chance between the grains of a cell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_COLLIDE_H
#define DSMC_COLLIDE_H

#include "model/dsmc/dsmc.h"

/* The first cell of a block (also of the one past the last); blocks may be done in any order and
 * at once. */
uint32_t dsmc_collide_cell(const struct dsmc *dsmc, uint32_t block);

/* How many blocks such a grid has. */
uint32_t dsmc_collide_blocks(const struct dsmc *dsmc);

/* Collides within the cells of a block. */
void dsmc_collide(struct dsmc *dsmc, uint32_t block, struct dsmc_sums *sums);

/* For tests, which show what the inequality of 000 (2) and 001 (16) gives as it is printed, with
 * `speed` for vmax: from now on all runs of this process accept so.  0: as it should be.  No
 * setting reaches this. */
void dsmc_collide_as_printed(float speed);

#endif
