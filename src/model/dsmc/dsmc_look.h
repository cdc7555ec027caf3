/* dsmc_look.h - what others see of the state.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_LOOK_H
#define DSMC_LOOK_H

#include "model/dsmc/dsmc.h"

void dsmc_look_observe(const void *state, struct grains *out);
void dsmc_look_count(const void *state, struct counters *out);

#endif
