/* md_step.h - one time step, by velocity Verlet or Gear's predictor-corrector.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MD_STEP_H
#define MD_STEP_H

#include "model/md/md.h"

/* One step of md->dt; false if the state stopped being physical (md->fault). */
bool md_step_take(struct md *md);

/* The state was saved with another time step: carries velocities and derivatives over. */
void md_step_rescale(struct md *md, double dt_before);

#endif
