/* dsmc_collide.h - collisions by chance between the grains of a cell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_COLLIDE_H
#define DSMC_COLLIDE_H

#include "model/dsmc/dsmc.h"

/* Which candidates become collisions.  Only tests choose the second, to show what the printed
 * inequality of 000 (2) and 001 (16) gives; no setting reaches it. */
enum dsmc_acceptance { DSMC_FASTER_MORE_OFTEN, DSMC_AS_PRINTED };

/* The first cell of a block (also of the one past the last); blocks may be done in any order and
 * at once. */
uint32_t dsmc_collide_cell(const struct dsmc *dsmc, uint32_t block);

/* How many blocks such a grid has. */
uint32_t dsmc_collide_blocks(const struct dsmc *dsmc);

/* Collides within the cells of a block. */
void dsmc_collide(struct dsmc *dsmc, uint32_t block, struct dsmc_sums *sums);

/* The acceptance rule of all runs of this process. */
void dsmc_collide_accept(enum dsmc_acceptance rule);

#endif
