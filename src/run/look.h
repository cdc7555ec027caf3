/* look.h - a look at a simulation with arrays that are always large enough.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LOOK_H
#define LOOK_H

#include "model/simulation.h"

/* Fills `grains` (all zero before the first call, or from the last) with every grain, and with
 * every contact if asked for.  Grows the arrays when they are too small.  The caller frees them
 * with grains_free(). */
bool look_at(const struct simulation *sim, struct grains *grains, bool contacts,
             struct error *error);

#endif
