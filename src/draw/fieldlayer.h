/* fieldlayer.h - a field as coloured pixels, beneath the grains.
 *
 * Made by the processor: looking up a cell and a colour for each pixel of a row is all there is to
 * do.  Cells without a value (NAN) and all around the grid stay as the ground is.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FIELDLAYER_H
#define FIELDLAYER_H

#include "draw/splat.h"
#include "draw/transform.h"
#include "model/field.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

struct fieldlayer {
    const struct field *field;  /* of several components: their magnitude */
    const uint8_t (*colormap)[3];
    enum scale scale;
    double range[2];
    bool   smooth;              /* bilinear between the cells' middles */
};

/* One value of a field: of a vector field, its magnitude. */
double fieldlayer_value(const struct field *field, uint32_t ix, uint32_t iy);

/* 0, or the least value if there are negative ones, to the 99th percentile. */
void fieldlayer_range(const struct field *field, double range[2]);

/* Colours the pixels of an area; `rgba` begins at row area->y0, rows counted from the bottom of a
 * picture of this height and `width` pixels long. */
void fieldlayer_draw(const struct fieldlayer *layer, const struct transform *transform,
                     uint32_t width, uint32_t height, const struct splat_area *area,
                     uint8_t *rgba);

#endif
