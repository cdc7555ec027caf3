/* difference.c - see difference.h.
 *
 * The unchanged part is laid half-way to white, so that the place of a difference is seen and red
 * stands out from any colour map.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/difference.h"

#include <assert.h>
#include <stdlib.h>

static int largest_of(const uint8_t *p, const uint8_t *q)
{
    int largest = 0;
    for (int c = 0; c < 4; c++) {
        const int d = abs(p[c] - q[c]);
        if (d > largest) largest = d;
    }
    return largest;
}

bool difference_draw(const struct image *a, const struct image *b, int tolerance,
                     struct image *out, struct error *error)
{
    assert(a->width == b->width);
    assert(a->height == b->height);
    if (!image_create(out, a->width, a->height, error)) return false;
    const size_t count = (size_t)a->width * a->height;
    for (size_t k = 0; k < count; k++) {
        const uint8_t *p = a->rgba + 4 * k;
        uint8_t *to = out->rgba + 4 * k;
        const int difference = largest_of(p, b->rgba + 4 * k);
        const int grey = (255 + (2 * p[0] + 5 * p[1] + p[2]) / 8) / 2;
        const bool differs = difference > tolerance;
        to[0] = (uint8_t)(differs ? 255 - difference / 3 : grey);
        to[1] = to[2] = (uint8_t)(differs ? 0 : grey);
        to[3] = 255;
    }
    return true;
}
