/* overlay_arrows.h - how velocities are measured out, for the legend.  Private to the overlay.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef OVERLAY_ARROWS_H
#define OVERLAY_ARROWS_H

#include "draw/ink.h"
#include "draw/painter.h"
#include "draw/transform.h"

#include <stdbool.h>

/* A round speed, the length in pixels of its arrow, and the width of all arrows; false if nothing
 * moves. */
bool overlay_arrows_key(const struct picture *picture, const struct transform *t, double *speed,
                        double *length, double *width);

#endif
