/* dsmc.c - direct simulation Monte Carlo: create, advance, archive.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/dsmc/dsmc.h"

#include "model/dsmc/dsmc_collide.h"
#include "model/dsmc/dsmc_flow.h"
#include "model/dsmc/dsmc_look.h"
#include "model/dsmc/dsmc_move.h"
#include "model/dsmc/dsmc_sort.h"
#include "model/dsmc/dsmc_walls.h"
#include "model/stepping.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

static const double full_fraction = M_PI / 4;   /* hsmc: four discs in a cell of two diameters */
static const double displacement_max = 3;       /* diameters; (1 + r) / (2 r) has no limit */

static uint32_t room_for(const struct scene *scene, const struct dsmc_settings *settings)
{
    return (uint32_t)fmin((double)stepping_room(scene) * settings->weight, DSMC_NAME);
}

static struct dsmc_axis axis_of(double length, double cell, int low, int high, double radius)
{
    struct dsmc_axis axis = {.length = (float)length, .periodic = low == BORDER_PERIODIC};
    if ((double)axis.length > length) axis.length = nextafterf(axis.length, 0);
    axis.cells = (uint32_t)fmax(1, round(length / cell));
    axis.per = (float)axis.cells / axis.length;
    axis.border[0] = low == BORDER_WALL ? (float)radius * axis.per : 0;
    axis.border[1] = high == BORDER_WALL ? (float)radius * axis.per : 0;
    return axis;
}

static void choose_grid(struct dsmc *dsmc)
{
    const struct scene *scene = dsmc->scene;
    const double cell = dsmc->settings.cell, radius = dsmc->radius;
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    dsmc->ax = axis_of(width, cell, scene->left, scene->right, radius);
    dsmc->ay = axis_of(height, cell, scene->bottom, scene->top, radius);
    dsmc->ax.wraps = dsmc->ax.periodic;
    dsmc->ay.wraps = dsmc->ay.periodic && scene->shear_rate == 0;
    dsmc->cells = dsmc->ax.cells * dsmc->ay.cells;
    dsmc->blocks = dsmc_collide_blocks(dsmc);
}

static void choose_law(struct dsmc *dsmc)
{
    const struct species *species = &dsmc->scene->species[0];
    const double cell = 1 / ((double)dsmc->ax.per * (double)dsmc->ay.per);
    const double d = 2 * dsmc->radius, weight = dsmc->settings.weight;
    const double r = isfinite(species->restitution) ? species->restitution : 1;
    dsmc->restitution = r;
    dsmc->mass = scene_mass(species, dsmc->radius) / weight;
    dsmc->inertia = scene_inertia(species, dsmc->radius) / weight;
    dsmc->q = (float)(dsmc->inertia / (dsmc->mass * dsmc->radius * dsmc->radius));
    dsmc->half_impulse = (float)(0.5 * (1 + r));
    dsmc->friction = (float)species->friction;
    dsmc->tangential = (float)dsmc->settings.tangential;
    dsmc->rate = (float)(d * dsmc->dt / (cell * weight));
    /* The momentum that it carries over must be that of a contact at distance d. */
    dsmc->displacement = (float)(d * fmin((1 + r) / (2 * r), displacement_max));
    if (dsmc->settings.method != DSMC_HSMC) return;
    const double grain = M_PI * dsmc->radius * dsmc->radius;
    dsmc->full = (uint32_t)fmax(1, round(weight * full_fraction * cell / grain));
}

static bool allocate(struct dsmc *dsmc)
{
    const struct scene *scene = dsmc->scene;
    struct arena *arena = &dsmc->arena;
    const uint32_t n = dsmc->count_max;
    dsmc->batch_max = source_batch_max(scene);
    return arena_array(arena, &dsmc->grains, n) && arena_array(arena, &dsmc->sorted, n)
        && arena_array(arena, &dsmc->tags, n)
        && arena_array(arena, &dsmc->spins, dsmc->effects & EFFECT_ROTATION ? n : 0)
        && arena_array(arena, &dsmc->contacts, dsmc->effects & EFFECT_COLLISION_RATE ? n : 0)
        && arena_array(arena, &dsmc->sums, dsmc->threads)
        && arena_array(arena, &dsmc->cursors, scene->source_count)
        && arena_array(arena, &dsmc->batch, dsmc->batch_max)
        && dsmc_sort_create(dsmc) && dsmc_walls_create(dsmc)
        && tally_create(&dsmc->tally, scene, arena)
        && arena_array(arena, &dsmc->impacts, (size_t)dsmc->tally.impact.bins * dsmc->threads);
}

static void dsmc_destroy(void *state)
{
    struct dsmc *dsmc = state;
    arena_free(&dsmc->arena);
    free(dsmc);
}

static void set_up(struct dsmc *dsmc, const struct scene *scene)
{
    dsmc->scene = scene;
    dsmc->settings = dsmc_settings_completed(scene);
    dsmc->effects = scene->effects;
    dsmc->seed = scene->seed;
    dsmc->dt = dsmc->settings.dt;
    dsmc->radius = scene->radius_mean;
    dsmc->threads = (uint32_t)omp_get_max_threads();
    dsmc->window_length = stepping_window(scene, dsmc->dt);
    dsmc->count_max = room_for(scene, &dsmc->settings);
    choose_grid(dsmc);
    choose_law(dsmc);
}

static void *dsmc_create(const struct scene *scene, struct error *error)
{
    struct dsmc *dsmc = calloc(1, sizeof *dsmc);
    if (!dsmc) {
        error_set(error, "not enough memory for the cells");
        return NULL;
    }
    set_up(dsmc, scene);
    if (!allocate(dsmc)) {
        error_set(error, "not enough memory for %u grains in %u cells; set a smaller count_max or "
                  "a larger dsmc.cell", dsmc->count_max, dsmc->cells);
        dsmc_destroy(dsmc);
        return NULL;
    }
    dsmc_flow_place(dsmc);
    dsmc_move_sort(dsmc);
    return dsmc;
}

static enum advance dsmc_advance(void *state, double t_end, uint64_t budget)
{
    struct dsmc *dsmc = state;
    const double wanted = (t_end - dsmc->epoch) / dsmc->dt;
    const uint64_t target = wanted > 0 ? (uint64_t)llround(wanted) : 0;
    for (; dsmc->steps_here < target; budget--) {
        if (budget == 0) return ADVANCE_BUDGET;
        dsmc_move_step(dsmc);
        dsmc_flow_window(dsmc);
    }
    return ADVANCE_REACHED;
}

/* Positions count from the corner of the box, which a phase may move. */
static void archive_origin(struct dsmc *dsmc, struct archive *archive)
{
    double origin[2] = {dsmc->scene->box[0], dsmc->scene->box[1]};
    archive_array(archive, "dsmc.origin", origin, 2);
    const float dx = (float)(origin[0] - dsmc->scene->box[0]);
    const float dy = (float)(origin[1] - dsmc->scene->box[1]);
    if (dx == 0 && dy == 0) return;
    for (uint32_t i = 0; i < dsmc->count; i++) {
        dsmc->grains[i].x += dx;
        dsmc->grains[i].y += dy;
    }
}

/* A resting particle that is pushed moves again; the next step finds out how far. */
static void dsmc_push(void *state, const struct impulse *impulse)
{
    struct dsmc *dsmc = state;
    const double *box = dsmc->scene->box;
    for (uint32_t i = 0; i < dsmc->count; i++) {
        struct dsmc_grain *g = &dsmc->grains[i];
        const double share = impulse_share(impulse, box[0] + (double)g->x, box[1] + (double)g->y);
        if (share == 0) continue;
        g->vx += (float)(share * impulse->vx);
        g->vy += (float)(share * impulse->vy);
        dsmc->tags[i] &= DSMC_NAME;
    }
}

/* The hashes of a checkpoint tell damage, not intent.  Cells are found anew from the positions,
 * so these are all that could lead astray. */
static bool grains_hold(const struct dsmc *dsmc)
{
    for (uint32_t i = 0; i < dsmc->count; i++) {
        const struct dsmc_grain *g = &dsmc->grains[i];
        if (!isfinite(g->x) || !isfinite(g->y)) return false;
        if (!isfinite(g->vx) || !isfinite(g->vy)) return false;
        if (dsmc->spins && !isfinite(dsmc->spins[i])) return false;
    }
    return true;
}

static void dsmc_archive(void *state, struct archive *archive)
{
    struct dsmc *dsmc = state;
    archive_count(archive, "dsmc.count", &dsmc->count, dsmc->count_max);
    archive_value(archive, "dsmc.id_next", &dsmc->id_next);
    archive_array(archive, "dsmc.grains", dsmc->grains, dsmc->count);
    archive_array(archive, "dsmc.tags", dsmc->tags, dsmc->count);
    archive_array(archive, "dsmc.spins", dsmc->spins, dsmc->count);
    archive_array(archive, "dsmc.contacts", dsmc->contacts, dsmc->count);
    archive_value(archive, "dsmc.window", &dsmc->window);
    stepping_archive(archive, "dsmc", dsmc->dt,
                     (struct stepping_clock){&dsmc->epoch, &dsmc->steps, &dsmc->steps_here});
    archive_origin(dsmc, archive);
    source_archive(dsmc->scene, dsmc->cursors, archive);
    uint64_t *const totals[] = {&dsmc->collisions, &dsmc->rejected, &dsmc->tangential_count,
                                &dsmc->grains_in, &dsmc->grains_out};
    const char *const names[] = {"dsmc.collisions", "dsmc.rejected", "dsmc.tangential",
                                 "dsmc.grains_in", "dsmc.grains_out"};
    for (size_t k = 0; k < sizeof totals / sizeof *totals; k++) {
        archive_value(archive, names[k], totals[k]);
    }
    tally_archive(&dsmc->tally, archive);
    if (archive->mode != ARCHIVE_LOAD || archive->failed) return;
    if (!grains_hold(dsmc)) {
        archive_fail(archive, "the saved state holds an impossible particle");
        return;
    }
    dsmc->walls.stale = true;
    dsmc_move_sort(dsmc);               /* changes nothing in a grid like the one of the save */
}

static const struct tally *dsmc_tally(const void *state)
{
    return &((const struct dsmc *)state)->tally;
}

static uint64_t dsmc_memory(const struct scene *scene)
{
    const struct dsmc_settings s = dsmc_settings_completed(scene);
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    const double cells = width / s.cell * (height / s.cell);
    const size_t grain = 2 * sizeof(struct dsmc_grain) + sizeof(uint32_t)
                       + (scene->effects & EFFECT_ROTATION ? sizeof(float) : 0)
                       + (scene->effects & EFFECT_COLLISION_RATE ? sizeof(struct dsmc_contacts)
                                                                 : 0);
    const double grains = room_for(scene, &s);
    return (uint64_t)((double)grain * grains
                      + dsmc_sort_memory(grains, cells, height / s.cell, omp_get_max_threads()));
}

const struct model model_dsmc = {
    .name     = "dsmc",
    .summary  = "Point grains that fly freely and collide by chance within a cell.",
    .work     = "steps",
    .effects  = EFFECT_GRAVITY | EFFECT_DISSIPATION | EFFECT_ROTATION | EFFECT_FRICTION
              | EFFECT_POLYDISPERSE | EFFECT_PERIODIC | EFFECT_WALLS
              | EFFECT_MOVING_WALLS | EFFECT_GATES | EFFECT_OBSTACLE | EFFECT_INFLOW | EFFECT_RISING
              | EFFECT_OUTFLOW | EFFECT_SCREEN | EFFECT_COLLISION_RATE | EFFECT_SHEAR
              | EFFECT_IMPACT,
    .settings = &dsmc_settings_group,
    .resolve  = dsmc_settings_resolve,
    .memory   = dsmc_memory,
    .create   = dsmc_create,
    .destroy  = dsmc_destroy,
    .advance  = dsmc_advance,
    .observe  = dsmc_look_observe,
    .push     = dsmc_push,
    .archive  = dsmc_archive,
    .count    = dsmc_look_count,
    .tally    = dsmc_tally,
};
