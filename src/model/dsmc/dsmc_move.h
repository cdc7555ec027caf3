/* dsmc_move.h - the rest of a step: free flight, and the sort by cell that prepares the next one.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_MOVE_H
#define DSMC_MOVE_H

#include "model/dsmc/dsmc.h"

/* One whole step: collide, move, let in and out, sort. */
void dsmc_move_step(struct dsmc *dsmc);

/* Lays this step's grid over the box and sorts all grains into it. */
void dsmc_move_sort(struct dsmc *dsmc);

#endif
