/* pins.h - what a model chose for the past of a session stays as it was.
 *
 * Some models choose one time step, or one lattice, for all phases of a scene; a phase that is
 * added later would then change what has already been computed.  Where that happens, the choices
 * of the start are laid over the scene as if its author had written them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PINS_H
#define PINS_H

#include "live/timeline.h"

/* *needed: would models compute the start of `fresh` with other settings than that of `base`?
 * False if memory is short. */
bool pins_needed(const struct scene *base, const struct scene *fresh, bool *needed,
                 struct error *error);

/* Lays the settings of `base` over the timeline's scene. */
bool pins_put(struct timeline *timeline, const struct scene *base, struct error *error);

#endif
