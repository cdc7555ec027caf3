/* spread.h - a measurement of its own: how wide a cloud of grains is.
 *
 * The worked example of docs/extending.md.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SPREAD_H
#define SPREAD_H

#include "model/grains.h"

struct spread {
    double x, y;                /* centre of mass, a length */
    double width;               /* root mean square distance from it, weighted by mass */
};

/* Of all grains; NANs if there are none. */
struct spread spread_of(const struct grains *grains);

#endif
