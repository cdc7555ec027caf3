/* overlay_forces.h - how forces are measured out, for the legend.  Private to the overlay.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef OVERLAY_FORCES_H
#define OVERLAY_FORCES_H

#include "draw/ink.h"
#include "draw/painter.h"
#include "draw/transform.h"

#include <stdbool.h>

/* A round force and the width in pixels of its line; false if there is none to speak of. */
bool overlay_forces_key(const struct picture *picture, const struct transform *t, double *force,
                        double *width);

/* The colour of a line of this share (0..1) of the key's width. */
struct ink_color overlay_forces_color(enum theme theme, double share);

#endif
