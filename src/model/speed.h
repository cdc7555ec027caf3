/* speed.h - what speeds a scene lets expect before it has run, the same for every model.
 *
 * Time steps, stiffnesses and ticks that nobody has set are chosen by these.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SPEED_H
#define SPEED_H

#include "scene/scene.h"

/* Greatest speed with which the scene lets grains begin or enter: the common velocity of a
 * placement and `deviations` times sqrt(2T) of its random velocities, or the velocity of a
 * source.  0 if everything begins at rest. */
double speed_at_start(const struct scene *scene, double deviations);

/* Greatest speed that grains of this scene can have: the fastest placed grain (4 sqrt(2T) before
 * they are placed: one of 9 million Maxwellian grains in two dimensions is faster), a fall
 * through the whole box, what moving walls and sheared borders add. */
double speed_greatest(const struct scene *scene);

#endif
