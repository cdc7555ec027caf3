/* look.h - a look at a simulation with arrays that are always large enough.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LOOK_H
#define LOOK_H

#include "model/simulation.h"

/* More grains than this are not listed one by one, if the model can tell what stands in the cells
 * of a grid instead: they are smaller than a pixel anyway, and a listed grain takes 100 bytes. */
enum { LOOK_LIST_MAX = 20000000 };

/* Will a look at this simulation give a sample (grains->sample) instead of a list? */
bool look_samples(const struct simulation *sim);

/* Fills `grains` (all zero before the first call, or from the last) with every grain, and with
 * every contact if asked for.  Grows the arrays when they are too small.  The caller frees them
 * with grains_free(). */
bool look_at(const struct simulation *sim, struct grains *grains, bool contacts,
             struct error *error);

#endif
