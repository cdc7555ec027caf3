/* dsmc_flow.h - grains that enter and leave.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_FLOW_H
#define DSMC_FLOW_H

#include "model/dsmc/dsmc.h"

/* Adds one particle; false if there is no room.  Coordinates are the scene's. */
bool dsmc_flow_add(struct dsmc *dsmc, double x, double y, double vx, double vy, double spin);

/* Places the scene's grains. */
void dsmc_flow_place(struct dsmc *dsmc);

/* Lets grains out and in at the present time. */
void dsmc_flow_pass(struct dsmc *dsmc);

/* Ends a window of collision rates where one ends. */
void dsmc_flow_window(struct dsmc *dsmc);

#endif
