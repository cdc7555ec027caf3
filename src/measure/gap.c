/* gap.c - see gap.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/gap.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Wide enough for grains, narrow enough that the corona is as thick as on the axis. */
static const double sector = 20 * M_PI / 180;

bool gap_create(struct gap *gap, const double center[2], double radius, double reach,
                uint32_t bins, struct error *error)
{
    assert(bins > 0);
    *gap = (struct gap){.center = {center[0], center[1]}, .radius = radius, .half_angle = sector,
                        .width = reach / bins, .bins = bins};
    gap->area = calloc(bins, sizeof *gap->area);
    return gap->area || error_set(error, "not enough memory to measure a gap");
}

void gap_free(struct gap *gap)
{
    free(gap->area);
    *gap = (struct gap){0};
}

void gap_add(struct gap *gap, const struct grains *grains)
{
    gap->snapshots++;
    for (uint32_t i = 0; i < grains->count; i++) {
        const double dx = gap->center[0] - grains->x[i], dy = grains->y[i] - gap->center[1];
        const double off = (hypot(dx, dy) - gap->radius) / gap->width;
        if (!(fabs(atan2(dy, dx)) <= gap->half_angle) || !(off >= 0) || off >= gap->bins) continue;
        gap->area[(uint32_t)off] += M_PI * grains->radius[i] * grains->radius[i];
        gap->radius_sum += grains->radius[i];
        gap->seen++;
    }
}

double gap_fraction(const struct gap *gap, uint32_t k)
{
    assert(k < gap->bins);
    const double r0 = gap->radius + k * gap->width, r1 = r0 + gap->width;
    return gap->area[k] / (gap->half_angle * (r1 * r1 - r0 * r0) * (double)gap->snapshots);
}

double gap_width(const struct gap *gap)
{
    if (gap->seen == 0) return NAN;
    double most = 0;
    for (uint32_t k = 0; k < gap->bins; k++) most = fmax(most, gap_fraction(gap, k));
    const double mean_radius = gap->radius_sum / (double)gap->seen;
    double before = 0;
    for (uint32_t k = 0; k < gap->bins; k++) {
        const double here = gap_fraction(gap, k);
        if (here >= most / 2) {         /* a straight line between the middles of two bins */
            const double share = (most / 2 - before) / (here - before);
            const double at = k == 0 ? 0 : (k - 0.5 + share) * gap->width;
            return fmax(0, at - mean_radius);
        }
        before = here;
    }
    return NAN;
}
