/* overlay_layout.h - where in a picture the legend's parts go.  Private to the overlay.
 *
 *     +------------------------------+--------+
 *     | top: title, label            | column |
 *     +------------------------------+ colour |
 *     | area: the scene              | bars   |
 *     +------------------------------+        |
 *     | bottom: scale bar, arrows    |        |
 *     | caption                      |        |
 *     +------------------------------+--------+
 *
 * It depends on the view alone, never on numbers that change from frame to frame, so that a film
 * stands still.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef OVERLAY_LAYOUT_H
#define OVERLAY_LAYOUT_H

#include "draw/painter.h"

#include <stdbool.h>
#include <stdint.h>

/* What stands in the strip at the bottom, from left to right. */
enum layout_item { LAYOUT_SCALE, LAYOUT_GRAVITY, LAYOUT_FORCE, LAYOUT_VELOCITY, LAYOUT_ITEMS };

struct layout {
    double width, height;       /* of the picture, pixels */
    double text;                /* size of the letters */
    double unit;                /* what is a pixel in a picture 720 high: line widths */
    bool   small;               /* too small a picture for any legend */
    bool   grains_bar, field_bar;
    bool   title, label, one_line, caption;
    bool   item[LAYOUT_ITEMS];
    uint32_t columns, rows;     /* of the items */
    double item_width, row_height;
    double area[4], top[4], bottom[4], column[4];       /* x0 y0 x1 y1 */
    double caption_base;        /* y of the caption's letters */
};

void overlay_layout_make(const struct picture *picture, struct layout *layout);

#endif
