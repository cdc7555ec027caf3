/* overlay.h - what is drawn over and around the grains: walls, velocity arrows, contact forces,
 * and the legend (colour bar with ticks and unit, scale bar, gravity arrow, labels).
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef OVERLAY_H
#define OVERLAY_H

#include "draw/ink.h"
#include "draw/painter.h"
#include "draw/transform.h"

void overlay_walls(struct ink *ink, const struct picture *picture, const struct transform *t);
void overlay_arrows(struct ink *ink, const struct picture *picture, const struct transform *t);
void overlay_forces(struct ink *ink, const struct picture *picture, const struct transform *t);
void overlay_spokes(struct ink *ink, const struct picture *picture, const struct transform *t);

/* `range` is the one in force for the grains' colours, after NANs were replaced; `field_range` for
 * the field's. */
void overlay_legend(struct ink *ink, const struct picture *picture, const struct transform *t,
                    const double range[2], const double field_range[2]);

/* The part of the picture that the legend leaves to the scene, in pixels from the upper left:
 * x0 y0 x1 y1.  The painter fits the view's window into it. */
void overlay_layout(const struct picture *picture, double area[4]);

/* Colours of a theme. */
struct ink_color overlay_ground(enum theme theme);
struct ink_color overlay_text_color(enum theme theme);
struct ink_color overlay_wall_color(enum theme theme);

#endif
