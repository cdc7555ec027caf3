/* place.c - see place.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/place.h"

#include "scene/place_file.h"
#include "scene/place_lattice.h"
#include "scene/place_random.h"
#include "scene/resolve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void place_bounds(const struct scene *scene, const struct placement *placement, double bounds[4])
{
    const struct key_reals *outline = &placement->outline;
    memcpy(bounds, isnan(placement->region[0]) ? scene->box : placement->region,
           4 * sizeof *bounds);
    for (uint32_t k = 0; k + 1 < outline->count; k += 2) {
        const double x = outline->values[k], y = outline->values[k + 1];
        bounds[0] = k ? fmin(bounds[0], x) : x;
        bounds[1] = k ? fmin(bounds[1], y) : y;
        bounds[2] = k ? fmax(bounds[2], x) : x;
        bounds[3] = k ? fmax(bounds[3], y) : y;
    }
}

double place_area(const struct scene *scene, const struct placement *placement)
{
    const struct key_reals *outline = &placement->outline;
    double bounds[4], twice = 0;
    place_bounds(scene, placement, bounds);
    if (outline->count == 0) return (bounds[2] - bounds[0]) * (bounds[3] - bounds[1]);
    for (uint32_t k = 0; k + 1 < outline->count; k += 2) {
        const double *p = &outline->values[k], *q = &outline->values[(k + 2) % outline->count];
        twice += p[0] * q[1] - p[1] * q[0];
    }
    return fabs(twice) / 2;
}

/* ---- velocities ---------------------------------------------------------------------------- */

/* Normal deviates, then shifted and scaled: the mean is zero and <v'^2>/2 is exact.  A sheared
 * scene begins with its profile, u_x = rate (y - middle). */
static void set_velocities(const struct placer *placer, const struct placement *placement,
                           uint32_t number, uint32_t from)
{
    const struct placed *g = &placer->grains;
    const uint32_t count = g->count - from;
    struct rng rng = rng_stream(placer->scene->seed, STREAM_VELOCITY, number);
    double mx = 0, my = 0, square = 0;
    const bool warm = placement->temperature > 0 && count > 1;
    for (uint32_t i = from; warm && i < g->count; i++) {
        mx += (g->vx[i] = rng_normal(&rng)) / count;
        my += (g->vy[i] = rng_normal(&rng)) / count;
    }
    for (uint32_t i = from; warm && i < g->count; i++) {
        g->vx[i] -= mx;
        g->vy[i] -= my;
        square += g->vx[i] * g->vx[i] + g->vy[i] * g->vy[i];
    }
    const double factor = warm ? sqrt(2 * placement->temperature * count / square) : 0;
    const struct scene *scene = placer->scene;
    const double middle = 0.5 * (scene->box[1] + scene->box[3]);
    const double shear_rate = placement->kind == PLACEMENT_FILE ? 0 : scene->shear_rate;
    for (uint32_t i = from; i < g->count; i++) {
        g->vx[i] = factor * g->vx[i] + placement->velocity[0] + shear_rate * (g->y[i] - middle);
        g->vy[i] = factor * g->vy[i] + placement->velocity[1];
        g->spin[i] = placement->spin;
    }
}

/* A file's own velocities, and what the placement says on top of them. */
static bool add_velocities(const struct placer *placer, const struct placement *placement,
                           uint32_t number, uint32_t from)
{
    const struct placed *g = &placer->grains;
    const size_t count = g->count - from;
    double *const arrays[3] = {g->vx, g->vy, g->spin};
    double *own = calloc(3 * count + 1, sizeof *own);
    if (!own) return false;
    for (size_t k = 0; k < 3 * count; k++) own[k] = arrays[k / count][from + k % count];
    set_velocities(placer, placement, number, from);
    for (size_t k = 0; k < 3 * count; k++) arrays[k / count][from + k % count] += own[k];
    free(own);
    return true;
}

/* ---- all placements ------------------------------------------------------------------------ */

/* Too few is an error if a number was asked for, and always if there is none at all. */
static void tell_missing(const struct placer *placer, const struct placement *placement,
                         uint32_t number, uint32_t placed)
{
    char key[64];
    if (placed > 0 && placed >= placement->count) return;
    snprintf(key, sizeof key, "placements.[%u]%s", number, placement->count ? ".count" : "");
    if (placed == 0) {
        findings_tell(placer->findings, placer->scene, FINDING_ERROR, key,
                      "placements.[%u]: no grain "
                      "fits: the region is too small, or walls or other grains fill it", number);
    } else {
        findings_tell(placer->findings, placer->scene, FINDING_ERROR, key,
                      "placements.[%u]: only %u "
                      "of %u grains fit clear of walls and other grains; ask for at most %u or "
                      "enlarge the region", number, placed, placement->count, placed);
    }
}

static bool keep_grains(struct placer *placer)
{
    struct placed *kept = &placer->scene->placed;
    const struct placed *g = &placer->grains;
    struct arena *arena = &placer->scene->arena;
    double **const to[] = {&kept->x, &kept->y, &kept->vx, &kept->vy, &kept->spin, &kept->radius};
    double *const from[] = {g->x, g->y, g->vx, g->vy, g->spin, g->radius};
    for (size_t k = 0; k < sizeof to / sizeof *to; k++) {
        if (!arena_array(arena, to[k], g->count)) return false;
        if (g->count) memcpy(*to[k], from[k], g->count * sizeof **to);
    }
    if (!arena_array(arena, &kept->species, g->count)) return false;
    if (g->count) memcpy(kept->species, g->species, g->count * sizeof *g->species);
    kept->count = g->count;
    return true;
}

bool place_grains(struct scene *scene, struct findings *findings)
{
    struct placer placer = {.scene = scene, .findings = findings};
    const uint32_t before = findings->errors;
    bool done = placer_take(&placer);
    for (uint32_t k = 0; done && k < scene->placement_count; k++) {
        const struct placement *placement = &scene->placements[k];
        const uint32_t from = placer.grains.count, errors = findings->errors;
        const uint32_t species = resolve_species(scene, placement->grains);
        switch ((enum placement_kind)placement->kind) {
        case PLACEMENT_TRIANGULAR:
        case PLACEMENT_SQUARE: done = place_lattice(&placer, placement, k, species); break;
        case PLACEMENT_RANDOM: done = place_random(&placer, placement, k, species); break;
        case PLACEMENT_FILE: done = place_file(&placer, placement, k, species); break;
        }
        if (!done) break;
        if (placement->kind != PLACEMENT_FILE) set_velocities(&placer, placement, k, from);
        else if (!add_velocities(&placer, placement, k, from)) done = false;
        if (findings->errors == errors) tell_missing(&placer, placement, k,
                                                     placer.grains.count - from);
    }
    done = done && keep_grains(&placer);
    if (!done) findings_tell(findings, scene, FINDING_ERROR, "placements",
                             "not enough memory for the "
                             "grains");
    placer_free(&placer);
    return findings->errors == before;
}
