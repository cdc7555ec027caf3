/* place_lattice.c - see place_lattice.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/place_lattice.h"

#include "scene/resolve.h"

#include <math.h>

struct lattice { double ax, ay, x0, y0; uint32_t columns, rows; bool shifted; };

/* Along a periodic side the lattice is stretched to fit the box a whole number of times. */
static struct lattice lattice_of(const struct region *region, const struct placement *placement,
                                 double radius_max)
{
    const double *b = region->bounds, width = b[2] - b[0], height = b[3] - b[1];
    const double a = 2 * radius_max * placement->spacing;
    struct lattice l = {.shifted = placement->kind == PLACEMENT_TRIANGULAR, .ax = a, .ay = a};
    if (l.shifted) l.ay = a * sqrt(3) / 2;
    l.x0 = b[0] + a / 2;
    l.y0 = b[1] + a / 2;
    l.columns = (uint32_t)fmin(floor((width - a) / l.ax * (1 + 1e-12) + 1e-9) + 1, 1e9);
    l.rows = (uint32_t)fmin(floor((height - a) / l.ay * (1 + 1e-12) + 1e-9) + 1, 1e9);
    if (width < a) l.columns = 0;
    if (height < a) l.rows = 0;
    if (region->free_x) {
        l.columns = (uint32_t)floor(width / a + 1e-9);
        l.ax = l.columns ? width / l.columns : a;
        l.x0 = b[0] + l.ax / 4;
    }
    if (region->free_y) {
        const double step = l.shifted ? 2 : 1;
        l.rows = (uint32_t)(step * floor(height / (step * l.ay) + 1e-9));
        l.ay = l.rows ? height / l.rows : l.ay;
        l.y0 = b[1] + l.ay / 2;
    }
    return l;
}

/* A site is used if a grain of the largest radius fits there, so that small grains are not
 * favoured along slopes. */
static bool site_is_free(const struct placer *placer, const struct region *region, double x,
                         double y,
                         double radius)
{
    return placer_region_holds(region, x, y, radius) && !placer_meets_wall(placer, x, y, radius)
        && !placer_is_taken(placer, x, y, radius);
}

bool place_lattice(struct placer *placer, const struct placement *placement, uint32_t number,
                          uint32_t species_index)
{
    const struct species *species = &placer->scene->species[species_index];
    const struct region region = placer_region(placer, placement);
    const double radius_max = resolve_radius_max(species);
    const struct lattice l = lattice_of(&region, placement, radius_max);
    const double gap = 2 * radius_max * (placement->spacing - 1);
    const double limit = placement->count ? (double)placement->count : INFINITY;
    double done = 0;
    for (uint32_t row = 0; row < l.rows; row++) {
        for (uint32_t column = 0; column < l.columns && done < limit; column++) {
            double x = l.x0 + (column + (l.shifted && row % 2 ? 0.5 : 0)) * l.ax;
            double y = l.y0 + row * l.ay;
            if (!site_is_free(placer, &region, x, y, radius_max)) continue;
            const uint64_t draw = 2 * (uint64_t)done;
            const double r = placement->jitter * gap / 2
                * sqrt(rng_unit(placer_word(placer, STREAM_POSITION, number, draw)));
            const double phase = 2 * M_PI * rng_unit(placer_word(placer, STREAM_POSITION, number,
                                                             draw + 1));
            const double xs = x + r * cos(phase), ys = y + r * sin(phase);
            if (r > 0 && site_is_free(placer, &region, xs, ys, radius_max)) {
                x = xs;
                y = ys;
            }
            const double radius = placer_radius(species, placer_word(placer, STREAM_RADIUS, number,
                                                               (uint64_t)done));
            if (!placer_add(placer, x, y, radius, species_index)) return false;
            done++;
        }
    }
    return true;
}
