/* overlay_legend.h - what the legend's parts share.  Private to the overlay.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef OVERLAY_LEGEND_H
#define OVERLAY_LEGEND_H

#include "draw/ink.h"
#include "draw/overlay_layout.h"
#include "draw/painter.h"
#include "draw/transform.h"

struct legend {
    struct ink *ink;
    const struct picture *picture;
    const struct transform *t;
    const double *range, *field_range;
    struct layout layout;
    struct ink_color text, plate;
    double rule;                /* width of thin lines: whole pixels */
};

/* Height of DejaVu's capitals and digits, per size. */
#define OVERLAY_LEGEND_CAPITAL 0.73

/* The size, at most `size`, at which the text is not wider than `room`. */
double overlay_legend_fit(const struct legend *legend, double size, double room, const char *text);

/* Under the transparent theme, a plate that keeps what stands on it readable on any ground. */
void overlay_legend_plate(const struct legend *legend, double x0, double y0, double x1, double y1);

/* The column: colour bars of grains and field, or the species. */
void overlay_legend_bars(const struct legend *legend);

/* The strip at the bottom: scale bar, gravity, forces, velocities. */
void overlay_legend_items(const struct legend *legend);

#endif
