/* spread.c - see spread.h.
 *
 * A measurement reads struct grains and nothing else, so it works with every model, with dumps and
 * while a run goes on alike.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "spread.h"

#include <math.h>

struct spread spread_of(const struct grains *grains)
{
    struct spread spread = {NAN, NAN, NAN};
    double mass = 0, sum_x = 0, sum_y = 0, square = 0;
    for (uint32_t i = 0; i < grains->count; i++) {
        mass += grains->mass[i];
        sum_x += grains->mass[i] * grains->x[i];
        sum_y += grains->mass[i] * grains->y[i];
    }
    if (!(mass > 0)) return spread;
    spread.x = sum_x / mass;
    spread.y = sum_y / mass;
    /* About the centre: the difference of two large sums would cancel. */
    for (uint32_t i = 0; i < grains->count; i++) {
        const double dx = grains->x[i] - spread.x, dy = grains->y[i] - spread.y;
        square += grains->mass[i] * (dx * dx + dy * dy);
    }
    spread.width = sqrt(square / mass);
    return spread;
}
