/* painter_value.c - what grains are coloured by: one number a grain, its name, and its range.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/painter.h"

#include "draw/percentile.h"
#include "draw/shortage.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Grains looked at for the range of one frame; evenly chosen among more.  The 99th percentile of
 * so many values lies between the true 98.9th and 99.1th. */
enum { RANGE_SAMPLES = 1 << 16 };

/* X(colour, name, dimension) */
#define COLORS(X)                                \
    X(COLOR_SPEED, "speed", "speed")             \
    X(COLOR_COLLISIONS, "collision rate", "1/time") \
    X(COLOR_SPIN, "spin", "1/time")              \
    X(COLOR_SPECIES, "species", "")              \
    X(COLOR_RADIUS, "radius", "length")          \
    X(COLOR_PRESSURE, "pressure", "force/length") \
    X(COLOR_NONE, "", "")

const char *painter_value_name(const struct view *view)
{
    switch ((enum color_by)view->color) {
#define X(color, name, dimension) case color: return name;
    COLORS(X)
#undef X
    }
    return "";
}

const char *painter_value_dimension(const struct view *view)
{
    switch ((enum color_by)view->color) {
#define X(color, name, dimension) case color: return dimension;
    COLORS(X)
#undef X
    }
    return "";
}

/* Adds up the sizes of the forces on each grain, or on grain `only` alone. */
static void force_sums(const struct grains *grains, float *sums, uint32_t only)
{
    for (uint32_t k = 0; k < grains->contact_count && grains->contacts; k++) {
        const struct contact *const contact = &grains->contacts[k];
        const float force = hypotf(contact->fx, contact->fy);
        const uint32_t ends[2] = {contact->i, contact->j};
        for (int e = 0; e < 2; e++) {
            if (ends[e] >= grains->count) continue;     /* a wall */
            if (only == UINT32_MAX) sums[ends[e]] += force;
            else if (ends[e] == only) sums[0] += force;
        }
    }
}

/* All but the pressure, whose forces are given. */
static double value(const struct view *view, const struct grains *grains, uint32_t i, float force)
{
    switch ((enum color_by)view->color) {
    case COLOR_SPEED:
        return grains->vx && grains->vy
             ? sqrt(grains->vx[i] * grains->vx[i] + grains->vy[i] * grains->vy[i]) : 0;
    case COLOR_COLLISIONS: return grains->collision_rate ? (double)grains->collision_rate[i] : 0;
    case COLOR_SPIN: return grains->spin ? grains->spin[i] : 0;
    case COLOR_SPECIES: return grains->species ? grains->species[i] : 0;
    case COLOR_RADIUS: return grains->radius[i];
    case COLOR_PRESSURE: return (double)force / (2 * M_PI * grains->radius[i]);
    case COLOR_NONE: break;
    }
    return 0;
}

double painter_value(const struct view *view, const struct grains *grains, uint32_t i)
{
    assert(i < grains->count);
    float force = 0;
    if (view->color == COLOR_PRESSURE) force_sums(grains, &force, i);
    return value(view, grains, i, force);
}

void painter_value_all(const struct view *view, const struct grains *grains, float *values)
{
    for (uint32_t i = 0; i < grains->count; i++) values[i] = 0;
    if (view->color == COLOR_PRESSURE) force_sums(grains, values, UINT32_MAX);
    for (uint32_t i = 0; i < grains->count; i++) {
        values[i] = (float)value(view, grains, i, values[i]);
    }
}

static void range_of_species(const struct grains *grains, double range[2])
{
    uint16_t last = 0;
    for (uint32_t i = 0; i < grains->count && grains->species; i++) {
        if (grains->species[i] > last) last = grains->species[i];
    }
    range[0] = 0;
    range[1] = last > 0 ? last : 1;
}

void painter_value_range(const struct view *view, const struct grains *grains,
                         const float *values, double range[2])
{
    range[0] = 0;
    range[1] = 1;
    if (view->color == COLOR_SPECIES) {
        range_of_species(grains, range);
        return;
    }
    const uint32_t step = grains->count / RANGE_SAMPLES + 1;
    const uint32_t most = grains->count / step + 1;
    float *const samples = shortage_check(malloc(most * sizeof *samples));
    if (!samples) return;
    uint32_t count = 0;
    for (uint32_t i = 0; i < grains->count; i += step) {
        if (isfinite(values[i])) samples[count++] = values[i];
    }
    if (view->color == COLOR_SPIN) {
        for (uint32_t i = 0; i < count; i++) samples[i] = fabsf(samples[i]);
    }
    const double high = percentile(samples, count, 0.99);
    if (view->color == COLOR_RADIUS) {
        range[0] = percentile(samples, count, 0);
        range[1] = percentile(samples, count, 1);
        if (!(range[1] > range[0])) range[0] = 0;
    } else if (high > 0) {
        range[1] = high;
    }
    if (view->color == COLOR_SPIN) range[0] = -range[1];
    free(samples);
}
