/* stepping.h - what models that go in time steps do alike: room for grains, grains that have
 * left, windows of rates, and time across phases of different steps.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STEPPING_H
#define STEPPING_H

#include "base/archive.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

/* Grains that there may be at once; at least 1. */
uint32_t stepping_room(const struct scene *scene);

/* Has a grain of this radius at (x, y) left the scene: beyond an open border by a diameter, or in
 * a sink? */
bool stepping_left(const struct scene *scene, double x, double y, double radius);

/* Time over which a collision rate is formed: as measured, else from frame to frame, else 100
 * steps. */
double stepping_window(const struct scene *scene, double dt);

/* Time = epoch + here * dt, `steps` are those of the whole run. */
struct stepping_clock { double *epoch; uint64_t *steps, *here; };

/* Passes the clock under the model's name.  A state that comes from a phase of another step begins
 * to count anew.  Returns the step of that phase, `dt` if it is the same. */
double stepping_archive(struct archive *archive, const char *model, double dt,
                        struct stepping_clock clock);

#endif
