/* source.c - see source.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/source.h"

#include "base/rng.h"
#include "scene/resolve.h"

#include <math.h>
#include <stdio.h>

static const uint64_t rng_key = 0x736f75726365;         /* "source": apart from other streams */

static uint16_t species_of(const struct scene *scene, const struct source *source)
{
    const uint32_t species = resolve_species(scene, source->grains);
    return (uint16_t)(species < scene->species_count ? species : 0);
}

static double draw_radius(const struct species *species, struct rng *rng)
{
    const double u = rng_uniform(rng);
    if (species->radii.count > 0) {
        return species->radii.values[(uint32_t)(u * species->radii.count)];
    }
    return species->radius[0] + u * (species->radius[1] - species->radius[0]);
}

/* Distance of neighbours in a stream, along it and across (004 eqs. 2a and 2b). */
static double stream_spacing(const struct scene *scene, const struct source *source)
{
    const double radius = resolve_radius_max(&scene->species[species_of(scene, source)]);
    return 2 * radius * sqrt(1 / source->density);
}

double source_time(const struct scene *scene, uint32_t s, uint64_t k)
{
    const struct source *source = &scene->sources[s];
    const double speed = hypot(source->velocity[0], source->velocity[1]);
    const double interval = source->kind == SOURCE_POINT ? 1 / source->rate
                          : stream_spacing(scene, source) / speed;
    const double t = source->from + (double)k * interval;
    return t < source->to ? t : INFINITY;
}

static struct source_grain point_grain(const struct scene *scene, uint32_t s, uint64_t k)
{
    const struct source *source = &scene->sources[s];
    const uint16_t species = species_of(scene, source);
    struct rng rng = rng_stream(scene->seed, rng_key + s, k);
    const double radius = draw_radius(&scene->species[species], &rng);
    return (struct source_grain){
        .t = source_time(scene, s, k),
        .x = source->position[0] + source->width * (rng_uniform(&rng) - 0.5),
        .y = source->position[1], .vx = source->velocity[0], .vy = source->velocity[1],
        .radius = radius, .species = species,
    };
}

/* One half of a column: from the first grain on, upwards (sign 1) or downwards, to the edge. */
static uint32_t fill_column(const struct scene *scene, const struct source *source,
                            struct source_grain first, double y, double sign, struct rng *rng,
                            struct source_grain *out, uint32_t room)
{
    const double speed = hypot(source->velocity[0], source->velocity[1]);
    const double ex = source->velocity[0] / speed, ey = source->velocity[1] / speed;
    const double spacing = stream_spacing(scene, source);
    double radius = first.radius;
    uint32_t count = 0;
    while (count < room) {
        const double next = draw_radius(&scene->species[first.species], rng);
        const double gap = spacing * (1 + source->jitter * rng_normal(rng));
        y += sign * fmax(gap, radius + next);                   /* never into its neighbour */
        if (fabs(y) > 0.5 * source->width) break;
        out[count] = first;
        out[count].radius = radius = next;
        out[count].x = source->position[0] - y * ey;
        out[count].y = source->position[1] + y * ex;
        count++;
    }
    return count;
}

static uint32_t stream_column(const struct scene *scene, uint32_t s, uint64_t k,
                              struct source_grain *out, uint32_t room)
{
    const struct source *source = &scene->sources[s];
    const double speed = hypot(source->velocity[0], source->velocity[1]);
    struct rng rng = rng_stream(scene->seed, rng_key + s, k);
    const double y = source->width * (rng_uniform(&rng) - 0.5);
    struct source_grain first = {
        .t = source_time(scene, s, k),
        .x = source->position[0] - y * source->velocity[1] / speed,
        .y = source->position[1] + y * source->velocity[0] / speed,
        .vx = source->velocity[0], .vy = source->velocity[1],
        .species = species_of(scene, source),
    };
    first.radius = draw_radius(&scene->species[first.species], &rng);
    if (room == 0) return 0;
    out[0] = first;
    uint32_t count = 1;
    count += fill_column(scene, source, first, y, 1, &rng, out + count, room - count);
    count += fill_column(scene, source, first, y, -1, &rng, out + count, room - count);
    return count;
}

uint32_t source_batch(const struct scene *scene, uint32_t s, uint64_t k,
                      struct source_grain *out, uint32_t room)
{
    if (scene->sources[s].kind == SOURCE_STREAM) return stream_column(scene, s, k, out, room);
    if (room == 0) return 0;
    out[0] = point_grain(scene, s, k);
    return 1;
}

uint32_t source_batch_max(const struct scene *scene)
{
    uint32_t most = 0;
    for (uint32_t s = 0; s < scene->source_count; s++) {
        const struct source *source = &scene->sources[s];
        uint32_t count = 1;
        if (source->kind == SOURCE_STREAM) {
            /* A gap is never less than two of the smallest radii. */
            const struct species *species = &scene->species[species_of(scene, source)];
            const double radius = resolve_radius_min(species);
            count = (uint32_t)(source->width / (2 * radius)) + 2;
        }
        most = count > most ? count : most;
    }
    return most;
}

double source_due(const struct scene *scene, uint32_t s, const struct source_cursor *cursor)
{
    const struct source *source = &scene->sources[s];
    if (source->count > 0 && cursor->made >= source->count) return INFINITY;
    return source_time(scene, s, cursor->next);
}

void source_archive(const struct scene *scene, struct source_cursor *cursors,
                    struct archive *archive)
{
    for (uint32_t s = 0; s < scene->source_count; s++) {
        char name[32];
        snprintf(name, sizeof name, "source.%u", s);
        archive_value(archive, name, &cursors[s]);
    }
}

struct source_grain source_flown(const struct scene *scene, const struct source_grain *grain,
                                 double t)
{
    struct source_grain flown = *grain;
    const double since = t - grain->t, *g = scene->gravity;
    flown.x += since * (grain->vx + 0.5 * since * g[0]);
    flown.y += since * (grain->vy + 0.5 * since * g[1]);
    flown.vx += since * g[0];
    flown.vy += since * g[1];
    return flown;
}
