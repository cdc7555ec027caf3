/* gap.h - how densely grains stand in front of a round obstacle, and the gap between the two
 * (stream, section III B and Fig. 11).
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GAP_H
#define GAP_H

#include "base/error.h"
#include "model/grains.h"

#include <stdbool.h>
#include <stdint.h>

struct gap {
    double   center[2], radius; /* of the obstacle; the stream comes along +x */
    double   half_angle;        /* of the sector in front that is looked at, radians */
    double   width;             /* of a bin; bin k lies k .. k + 1 widths off the surface */
    uint32_t bins;
    double  *area;              /* of grains whose centre lies in a bin, all snapshots together */
    double   radius_sum;        /* of all grains seen, for their mean radius */
    uint64_t seen, snapshots;
};

bool gap_create(struct gap *gap, const double center[2], double radius, double reach,
                uint32_t bins, struct error *error);
void gap_free(struct gap *gap);
void gap_add(struct gap *gap, const struct grains *grains);     /* one snapshot more */

/* Mean area fraction of bin k. */
double gap_fraction(const struct gap *gap, uint32_t k);

/* From the surface of the obstacle to where the area fraction first reaches half of its maximum,
 * less a mean radius: 0 where the grains touch the obstacle.  NAN without grains. */
double gap_width(const struct gap *gap);

#endif
