/* md.c - the soft-disc model: create, advance, archive.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/md/md.h"

#include "model/md/md_check.h"
#include "model/md/md_fault.h"
#include "model/md/md_flow.h"
#include "model/md/md_list.h"
#include "model/md/md_look.h"
#include "model/md/md_pairs.h"
#include "model/md/md_step.h"
#include "model/md/md_walls.h"
#include "model/stepping.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static const double skin_default = 0.3;         /* of the largest radius */

static void choose_law(struct md *md)
{
    const struct md_settings *settings = md->settings;
    md->law = (struct md_law){
        .hertz = settings->force == MD_HERTZ, .clip = settings->clip,
        .tangential = md->effects & EFFECT_FRICTION,
        .spring = md->effects & EFFECT_STATIC_FRICTION,
    };
    md_law_pairs(md->scene, settings, md->pairs);
    md->kernel = md_pairs_kernel(md);
}

static void choose_lengths(struct md *md)
{
    const struct scene *scene = md->scene;
    const double share = isfinite(md->settings->skin) ? md->settings->skin : skin_default;
    md->reach_max = 2 * scene->radius_max;
    md->radius_one = scene->radius_max;
    md->inverse_mass_one = md_flow_trait(&scene->species[0], md->radius_one).inverse_mass;
    md->skin = share * scene->radius_max;
    md->suspect_overlap = scene->overlap_limit * scene->radius_min;
    md->wall_speed = md_walls_speed(md);
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    for (int image = 0; image < LINK_IMAGES; image++) {
        const int ix = image % 3, iy = image / 3;
        const double shift_x = ix == 2 ? -width : ix * width;
        const double shift_y = iy == 2 ? -height : iy * height;
        md->image_x[image] = scene->left == BORDER_PERIODIC ? shift_x : 0;
        md->image_y[image] = scene->bottom == BORDER_PERIODIC ? shift_y : 0;
    }
}

static bool allocate(struct md *md)
{
    const struct scene *scene = md->scene;
    struct arena *arena = &md->arena;
    const uint32_t n = md->count_max, species = scene->species_count;
    const bool gear = md->settings->integrator == MD_GEAR;
    const bool rates = md->effects & EFFECT_COLLISION_RATE;
    const bool spins = md->effects & EFFECT_FRICTION;
    const bool differ = md->effects & (EFFECT_POLYDISPERSE | EFFECT_MIXTURE);
    md->strip_room = n < STRIP_GRAINS_MAX ? n : STRIP_GRAINS_MAX;
    md->batch_max = source_batch_max(scene);
    return arena_array(arena, &md->pairs, species * species)
        && arena_array(arena, &md->grains, n) && arena_array(arena, &md->halves, n)
        && arena_array(arena, &md->tags, n)
        && arena_array(arena, &md->traits, spins || differ ? n : 0)
        && arena_array(arena, &md->turns, spins ? n : 0)
        && arena_array(arena, &md->gears, gear ? n : 0)
        && arena_array(arena, &md->collisions, rates ? n : 0)
        && arena_array(arena, &md->collision_rate, rates ? n : 0)
        && arena_array(arena, &md->pushes, (size_t)md->strip_room * md->thread_count)
        && arena_array(arena, &md->twists,
                       spins ? (size_t)md->strip_room * md->thread_count : 0)
        && arena_array(arena, &md->cursors, scene->source_count)
        && arena_array(arena, &md->batch, md->batch_max)
        && md_list_create(md) && md_walls_create(md) && tally_create(&md->tally, scene, arena);
}

static void place_grains(struct md *md)
{
    const struct placed *placed = &md->scene->placed;
    for (uint32_t k = 0; k < placed->count; k++) {
        const struct source_grain grain = {
            .x = placed->x[k], .y = placed->y[k], .vx = placed->vx[k], .vy = placed->vy[k],
            .radius = placed->radius[k], .species = placed->species ? placed->species[k] : 0,
        };
        md_flow_add(md, &grain, placed->spin ? placed->spin[k] : 0);
    }
}

static void md_destroy(void *state)
{
    struct md *md = state;
    arena_free(&md->arena);
    free(md);
}

static void *md_create(const struct scene *scene, struct error *error)
{
    struct md *md = calloc(1, sizeof *md);
    if (!md) {
        error_set(error, "not enough memory for the soft discs");
        return NULL;
    }
    md->scene = scene;
    md->settings = scene_settings(scene, "md");
    md->effects = scene->effects;
    md->dt = md->settings->dt;
    md->count_max = stepping_room(scene);
    md->thread_count = (uint32_t)omp_get_max_threads();
    md->law.spring = md->effects & EFFECT_STATIC_FRICTION;
    md->window_length = stepping_window(scene, md->dt);
    md->stale = true;
    choose_lengths(md);
    if (!allocate(md)) {
        error_set(error, "not enough memory for %u soft discs; set a smaller count_max",
                  md->count_max);
        md_destroy(md);
        return NULL;
    }
    choose_law(md);
    place_grains(md);
    return md;
}

static bool list_is_old(const struct md *md)
{
    return md->stale || 2 * (md->travel + md->stride) >= md->skin || md_flow_due(md);
}

static bool renew_list(struct md *md)
{
    md_flow_pass(md);
    return md_fault_escaped(md) && md_list_rebuild(md);
}

static enum advance md_advance(void *state, double t_end, uint64_t budget)
{
    struct md *md = state;
    const double wanted = (t_end - md->epoch) / md->dt;
    const uint64_t target = wanted > 0 ? (uint64_t)llround(wanted) : 0;
    for (; md->steps_here < target; budget--) {
        if (md->broken) return ADVANCE_BROKEN;
        if (budget == 0) return ADVANCE_BUDGET;
        if (list_is_old(md) && !renew_list(md)) return ADVANCE_BROKEN;
        if (!md_step_take(md)) return ADVANCE_BROKEN;
        md_flow_window(md);
    }
    return ADVANCE_REACHED;
}

/* Tells scenes apart for which a neighbour list means different things. */
static uint64_t list_signature(const struct md *md)
{
    const struct scene *scene = md->scene;
    uint64_t hash = archive_hash(ARCHIVE_HASH_START, scene->box, sizeof scene->box);
    hash = archive_hash(hash, &md->skin, sizeof md->skin);
    hash = archive_hash(hash, &md->effects, sizeof md->effects);
    hash = archive_hash(hash, &scene->left, sizeof scene->left);
    hash = archive_hash(hash, &scene->bottom, sizeof scene->bottom);
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        const struct wall *wall = &scene->walls[w];
        const double numbers[] = {wall->x0, wall->y0, wall->x1, wall->y1, wall->cx, wall->cy,
                                  wall->radius, wall->angle0, wall->angle1, wall->vx, wall->vy,
                                  wall->amplitude_x, wall->amplitude_y, wall->frequency};
        hash = archive_hash(hash, numbers, sizeof numbers);
    }
    return hash;
}

static void archive_list(struct md *md, struct archive *archive)
{
    uint64_t signature = list_signature(md);
    const uint64_t own = signature;
    uint32_t strips = md->strip_count;
    uint8_t stale = md->stale;          /* as a number: a loaded byte may be neither yes nor no */
    archive_value(archive, "md.signature", &signature);
    archive_value(archive, "md.stale", &stale);
    md->stale = stale != 0;
    archive_value(archive, "md.travel", &md->travel);
    archive_value(archive, "md.stride", &md->stride);
    archive_count(archive, "md.links", &md->link_count, md->link_max);
    archive_count(archive, "md.cross", &md->cross_count, md->link_max / 2);
    archive_array(archive, "md.link", md->links, md->link_count);
    archive_array(archive, "md.spring", md->springs, md->link_count);
    archive_array(archive, "md.incoming", md->incoming, md->cross_count);
    archive_count(archive, "md.strips", &strips, md->strip_max);
    md->strip_count = strips;
    archive_array(archive, "md.strip", md->strips, md->strip_count);
    if (md->wall_links) {
        archive_count(archive, "md.wall_links", &md->wall_link_count, md->wall_link_max);
        archive_array(archive, "md.wall_link", md->wall_links, md->wall_link_count);
    }
    if (archive->mode != ARCHIVE_LOAD || archive->failed || signature == own) return;
    md->stale = true;           /* the contacts of pairs go on; those of walls begin anew */
    md->wall_link_count = 0;
}

static void archive_time(struct md *md, struct archive *archive)
{
    const struct stepping_clock clock = {&md->epoch, &md->steps, &md->steps_here};
    const double dt = stepping_archive(archive, "md", md->dt, clock);
    if (dt != md->dt) md_step_rescale(md, dt);
}

/* The leapfrog's velocities lie half a step apart; both gain the same.  The list of neighbours
 * holds for as long as nobody moves farther than it knows of, so it hears of the new speeds. */
static void md_push(void *state, const struct impulse *impulse)
{
    struct md *md = state;
    double fastest = 0;
    for (uint32_t i = 0; i < md->count; i++) {
        struct grain *g = &md->grains[i];
        struct half *h = &md->halves[i];
        const double share = impulse_share(impulse, g->x, g->y);
        if (share == 0) continue;
        g->ux += share * impulse->vx;
        g->uy += share * impulse->vy;
        h->hx += share * impulse->vx;
        h->hy += share * impulse->vy;
        fastest = fmax(fastest, hypot(h->hx, h->hy));
    }
    md->stride = fmax(md->stride, fastest * md->dt);
}

/* What a scene of fewer effects did not keep: grains that are all alike, and spins. */
static void add_absent(struct md *md, const struct archive *archive)
{
    const bool had_traits = archive_has(archive, "md.traits");
    const bool had_turns = archive_has(archive, "md.turns");
    md->some_fresh = false;
    for (uint32_t i = 0; i < md->count; i++) {
        md->some_fresh = md->some_fresh || md->tags[i].fresh;
        if (md->traits && !had_traits) {
            const struct species *species = &md->scene->species[md->tags[i].species];
            md->traits[i] = md_flow_trait(species, md->radius_one);
        }
        if (md->turns && !had_turns) md->turns[i] = (struct turn){.hrim = md->traits[i].rim};
    }
}

static void md_archive(void *state, struct archive *archive)
{
    struct md *md = state;
    archive_count(archive, "md.count", &md->count, md->count_max);
    archive_value(archive, "md.id_next", &md->id_next);
    archive_array(archive, "md.grains", md->grains, md->count);
    archive_array(archive, "md.halves", md->halves, md->count);
    archive_array(archive, "md.tags", md->tags, md->count);
    archive_array(archive, "md.traits", md->traits, md->count);
    archive_array(archive, "md.turns", md->turns, md->count);
    archive_array(archive, "md.gears", md->gears, md->count);
    archive_array(archive, "md.collisions", md->collisions, md->count);
    archive_array(archive, "md.collision_rate", md->collision_rate, md->count);
    archive_value(archive, "md.window", &md->window);
    archive_time(md, archive);
    archive_list(md, archive);
    source_archive(md->scene, md->cursors, archive);
    archive_value(archive, "md.retry_step", &md->retry_step);
    uint64_t *const totals[] = {&md->begun, &md->tangential, &md->rebuilds, &md->grains_in,
                                &md->grains_out, &md->rejected};
    const char *const names[] = {"md.begun", "md.tangential", "md.rebuilds", "md.grains_in",
                                 "md.grains_out", "md.rejected"};
    for (size_t k = 0; k < sizeof totals / sizeof *totals; k++) {
        archive_value(archive, names[k], totals[k]);
    }
    tally_archive(&md->tally, archive);
    if (archive->mode != ARCHIVE_LOAD || archive->failed) return;
    const char *wrong = md_check(md);
    if (!wrong) add_absent(md, archive);
    if (wrong) archive_fail(archive, wrong);
    else if (md->wall_here) md_walls_place(md);
}

static const struct tally *md_tally(const void *state)
{
    return &((const struct md *)state)->tally;
}

static const struct fault *md_fault(const void *state)
{
    return &((const struct md *)state)->fault;
}

static uint64_t md_memory(const struct scene *scene)
{
    const bool spins = scene->effects & EFFECT_FRICTION;
    const bool differ = scene->effects & (EFFECT_POLYDISPERSE | EFFECT_MIXTURE);
    const uint64_t spring = scene->effects & EFFECT_STATIC_FRICTION ? 24 : 0;
    const uint64_t record = sizeof(struct grain) + sizeof(struct half) + sizeof(struct tag)
        + (spins || differ ? sizeof(struct trait) : 0) + (spins ? sizeof(struct turn) : 0);
    const uint64_t grain = 2 * record + 4 * sizeof(uint32_t);
    const uint64_t links = 2 * sizeof(struct link) + sizeof(struct push) / 2 + 6 + spring;
    const uint64_t walls = scene->wall_count > 0 ? 8 * sizeof(struct wall_link) : 0;
    return (grain + 10 * links + walls) * stepping_room(scene);
}

const struct model model_md = {
    .name     = "md",
    .summary  = "Soft discs that push where they overlap; Newton's equations in small time steps.",
    .work     = "steps",
    .effects  = EFFECT_GRAVITY | EFFECT_DISSIPATION | EFFECT_ROTATION | EFFECT_FRICTION
              | EFFECT_STATIC_FRICTION | EFFECT_POLYDISPERSE | EFFECT_MIXTURE | EFFECT_PERIODIC
              | EFFECT_WALLS | EFFECT_MOVING_WALLS | EFFECT_GATES | EFFECT_OBSTACLE
              | EFFECT_INFLOW | EFFECT_OUTFLOW | EFFECT_SCREEN | EFFECT_COLLISION_RATE,
    .settings = &md_settings_group,
    .resolve  = md_settings_resolve,
    .memory   = md_memory,
    .create   = md_create,
    .destroy  = md_destroy,
    .advance  = md_advance,
    .observe  = md_look_observe,
    .push     = md_push,
    .archive  = md_archive,
    .count    = md_look_count,
    .tally    = md_tally,
    .fault    = md_fault,
};
