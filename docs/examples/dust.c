/* dust.c - a model of its own: grains that never meet.
 *
 * The worked example of docs/extending.md.  Grains fly on parabolas in a periodic box, so the state
 * is where they began and the time: advance() only moves the clock, and splitting it into pieces
 * cannot change a bit.  tests/test_example.c builds and runs it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/model.h"

#include <math.h>
#include <stdlib.h>

struct dust {
    const struct scene *scene;
    struct arena arena;
    double   time;
    uint32_t count;
    double  *x, *y, *vx, *vy;   /* at time 0; radii and species stay those of the scene */
};

static void dust_destroy(void *state)
{
    struct dust *dust = state;
    arena_free(&dust->arena);
    free(dust);
}

/* All memory is taken here; the grains are those that the scene has placed. */
static void *dust_create(const struct scene *scene, struct error *error)
{
    const struct placed *placed = &scene->placed;
    struct dust *dust = calloc(1, sizeof *dust);
    if (dust) {
        dust->scene = scene;
        dust->count = placed->count;
        if (arena_array(&dust->arena, &dust->x, placed->count)
            && arena_array(&dust->arena, &dust->y, placed->count)
            && arena_array(&dust->arena, &dust->vx, placed->count)
            && arena_array(&dust->arena, &dust->vy, placed->count)) {
            for (uint32_t i = 0; i < placed->count; i++) {
                dust->x[i] = placed->x[i];
                dust->y[i] = placed->y[i];
                dust->vx[i] = placed->vx[i];
                dust->vy[i] = placed->vy[i];
            }
            return dust;
        }
        dust_destroy(dust);
    }
    error_set(error, "not enough memory for %u grains of dust", placed->count);
    return NULL;
}

/* A model with a loop counts its steps against `budget` and returns ADVANCE_BUDGET. */
static enum advance dust_advance(void *state, double t_end, uint64_t budget)
{
    struct dust *dust = state;
    (void)budget;
    dust->time = fmax(dust->time, t_end);
    return ADVANCE_REACHED;
}

static double fold(double x, double low, double high)
{
    return x - (high - low) * floor((x - low) / (high - low));
}

/* The state is const: looking never disturbs.  Only what the caller has arrays for is filled. */
static void dust_observe(const void *state, struct grains *out)
{
    const struct dust *dust = state;
    const double *box = dust->scene->box, *g = dust->scene->gravity, t = dust->time;
    const uint32_t count = dust->count < out->capacity ? dust->count : out->capacity;
    out->time = t;
    out->count = count;
    out->contact_count = 0;
    out->missed = dust->count - count;
    for (uint32_t i = 0; i < count; i++) {
        const uint16_t species = dust->scene->placed.species[i];
        const double radius = dust->scene->placed.radius[i];
        const double x = dust->x[i] + t * (dust->vx[i] + 0.5 * t * g[0]);
        const double y = dust->y[i] + t * (dust->vy[i] + 0.5 * t * g[1]);
        if (out->id) out->id[i] = i;
        if (out->x) out->x[i] = fold(x, box[0], box[2]);
        if (out->y) out->y[i] = fold(y, box[1], box[3]);
        if (out->vx) out->vx[i] = dust->vx[i] + t * g[0];
        if (out->vy) out->vy[i] = dust->vy[i] + t * g[1];
        if (out->angle) out->angle[i] = 0;
        if (out->spin) out->spin[i] = 0;
        if (out->radius) out->radius[i] = radius;
        if (out->mass) out->mass[i] = scene_mass(&dust->scene->species[species], radius);
        if (out->collision_rate) out->collision_rate[i] = 0;
        if (out->species) out->species[i] = species;
    }
}

/* One list saves, loads and hashes. */
static void dust_archive(void *state, struct archive *archive)
{
    struct dust *dust = state;
    archive_value(archive, "time", &dust->time);
    archive_array(archive, "x", dust->x, dust->count);
    archive_array(archive, "y", dust->y, dust->count);
    archive_array(archive, "vx", dust->vx, dust->count);
    archive_array(archive, "vy", dust->vy, dust->count);
}

static void dust_count(const void *state, struct counters *out)
{
    const struct dust *dust = state;
    *out = (struct counters){.time = dust->time, .grains = dust->count,
                             .potential_energy = NAN, .overlap_max = NAN};
    for (uint32_t i = 0; i < dust->count; i++) {
        const struct placed *placed = &dust->scene->placed;
        const double m = scene_mass(&dust->scene->species[placed->species[i]], placed->radius[i]);
        const double vx = dust->vx[i] + dust->time * dust->scene->gravity[0];
        const double vy = dust->vy[i] + dust->time * dust->scene->gravity[1];
        out->kinetic_energy += 0.5 * m * (vx * vx + vy * vy);
        out->momentum_x += m * vx;
        out->momentum_y += m * vy;
    }
}

extern const struct model model_dust;

/* Collisions that never happen lose no energy, so `dissipation` changes nothing; walls would. */
const struct model model_dust = {
    .name    = "dust",
    .summary = "Grains that fly freely and never meet.",
    .work    = "flights",
    .effects = EFFECT_GRAVITY | EFFECT_DISSIPATION | EFFECT_POLYDISPERSE | EFFECT_PERIODIC,
    .create  = dust_create,
    .destroy = dust_destroy,
    .advance = dust_advance,
    .observe = dust_observe,
    .archive = dust_archive,
    .count   = dust_count,
};
