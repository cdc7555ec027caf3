/* fieldlayer.c - see fieldlayer.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/fieldlayer.h"

#include "draw/colormap.h"
#include "draw/percentile.h"
#include "draw/shortage.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

double fieldlayer_value(const struct field *field, uint32_t ix, uint32_t iy)
{
    const size_t cells = (size_t)field->nx * field->ny, cell = (size_t)iy * field->nx + ix;
    if (field->components == 1) return field->values[cell];
    double sum = 0;
    for (uint32_t c = 0; c < field->components; c++) {
        sum += field->values[c * cells + cell] * field->values[c * cells + cell];
    }
    return sqrt(sum);
}

void fieldlayer_range(const struct field *field, double range[2])
{
    range[0] = 0;
    range[1] = 1;
    float *const values = shortage_check(malloc((size_t)field->nx * field->ny * sizeof *values));
    if (!values) return;
    uint32_t count = 0;
    for (uint32_t iy = 0; iy < field->ny; iy++) {
        for (uint32_t ix = 0; ix < field->nx; ix++) {
            const float value = (float)fieldlayer_value(field, ix, iy);
            if (isfinite(value)) values[count++] = value;
        }
    }
    range[0] = fmin(0, percentile(values, count, 0.01));
    range[1] = percentile(values, count, 0.99);
    if (!(range[1] > range[0])) range[1] = range[0] + 1;
    free(values);
}

/* The value at a place given in cells from the corner; NAN outside. */
static double sample(const struct fieldlayer *layer, double x, double y)
{
    const struct field *const field = layer->field;
    if (!(x >= 0 && y >= 0 && x < field->nx && y < field->ny)) return NAN;
    const double here = fieldlayer_value(field, (uint32_t)x, (uint32_t)y);
    if (!layer->smooth || isnan(here)) return here;
    /* Between the middles of four cells; those without a value take no part. */
    const double fx = x - 0.5 - floor(x - 0.5), fy = y - 0.5 - floor(y - 0.5);
    const double weights[2][2] = {{(1 - fx) * (1 - fy), fx * (1 - fy)}, {(1 - fx) * fy, fx * fy}};
    double sum = 0, weight = 0;
    for (int k = 0; k < 4; k++) {
        const double ix = floor(x - 0.5) + (k & 1), iy = floor(y - 0.5) + (k >> 1);
        if (ix < 0 || iy < 0 || ix >= field->nx || iy >= field->ny) continue;
        const double value = fieldlayer_value(field, (uint32_t)ix, (uint32_t)iy);
        if (isnan(value)) continue;
        sum += weights[k >> 1][k & 1] * value;
        weight += weights[k >> 1][k & 1];
    }
    return sum / weight;        /* the cell that the place lies in always takes part */
}

void fieldlayer_draw(const struct fieldlayer *layer, const struct transform *transform,
                     uint32_t width, uint32_t height, const struct splat_area *area,
                     uint8_t *rgba)
{
    const struct field *const field = layer->field;
    const double step = 1 / (transform->scale * field->cell);
    const double left = (transform->x0 - field->x0) / field->cell;
    const double top = (transform->y1 - field->y0) / field->cell;
    for (uint32_t y = area->y0; y < area->y1; y++) {
        const double cell_y = top - ((double)(height - y) - 0.5) * step;
        uint8_t *pixel = rgba + ((size_t)(y - area->y0) * width + area->x0) * 4;
        for (uint32_t x = area->x0; x < area->x1; x++, pixel += 4) {
            const double value = sample(layer, left + (x + 0.5) * step, cell_y);
            if (isnan(value)) continue;
            const double place = colormap_position(layer->scale, layer->range, value);
            const uint8_t *const color = layer->colormap[(int)(place * (COLORMAP_SIZE - 1) + 0.5)];
            for (int k = 0; k < 3; k++) pixel[k] = color[k];
            pixel[3] = 255;
        }
    }
}
