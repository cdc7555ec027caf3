/* ed.c - the event-driven model as a struct model: made, run, looked at and saved here.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed.h"

#include "model/ed/ed_change.h"
#include "model/ed/ed_check.h"
#include "model/ed/ed_epoch.h"
#include "model/ed/ed_look.h"
#include "model/ed/ed_shear.h"
#include "model/ed/ed_watch.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Widest cell that still holds hardly more than eight equal grains, and the width that is fastest
 * below the density where grains crowd (measured by bench). */
static const double cell_width_default = 1.8;

static bool has_solids(const struct scene *scene)
{
    return scene->effects & (EFFECT_GRAVITY | EFFECT_OUTFLOW | EFFECT_SCREEN) || scene->wall_count
        || scene->left != BORDER_PERIODIC || scene->bottom != BORDER_PERIODIC;
}

static uint32_t capacity(const struct scene *scene)
{
    const uint32_t most = scene->count_max, placed = scene->placed.count;
    return most > placed ? most : placed > 0 ? placed : 1;
}

static bool take_arrays(struct ed *ed)
{
    const size_t n = (size_t)ed->count_max + 1;
    const effects_t effects = ed->effects;
    const bool sizes = effects & (EFFECT_POLYDISPERSE | EFFECT_MIXTURE);
    const bool spins = effects & (EFFECT_FRICTION | EFFECT_ROTATION);
    const bool rates = effects & EFFECT_COLLISION_RATE, counts = effects & EFFECT_COLLISION_COUNT;
    struct arena *arena = &ed->arena;
    return arena_array(arena, &ed->grains, n) && arena_array(arena, &ed->events, n)
        && arena_array(arena, &ed->id, n)
        && arena_array(arena, &ed->order, n) && arena_array(arena, &ed->place, n)
        && arena_array(arena, &ed->species, ed->scene->species_count > 1 ? n : 0)
        && arena_array(arena, &ed->radius, sizes ? n : 0)
        && arena_array(arena, &ed->mass, sizes ? n : 0)
        && arena_array(arena, &ed->spin, spins ? n : 0)
        && arena_array(arena, &ed->angle, spins ? n : 0)
        && arena_array(arena, &ed->contacts, rates ? n : 0)
        && arena_array(arena, &ed->rate, rates ? n : 0)
        && arena_array(arena, &ed->begun, counts ? n : 0)
        && arena_array(arena, &ed->elastic, counts ? n : 0)
        && arena_array(arena, &ed->cursors, ed->scene->source_count)
        && arena_array(arena, &ed->batch, ed->batch_max);
}

static bool make_cells(struct ed *ed)
{
    const struct scene *scene = ed->scene;
    const double d = 2 * scene->radius_max;
    struct ed_grid grid = {
        .reach = d * (1 + 1e-6), .margin = ed->settings.margin,
        .wraps_x = scene->left == BORDER_PERIODIC, .wraps_y = scene->bottom == BORDER_PERIODIC,
        .beyond = 2 * scene->radius_max,
        .shut_west = scene->left == BORDER_WALL, .shut_east = scene->right == BORDER_WALL,
        .shut_south = scene->bottom == BORDER_WALL, .shut_north = scene->top == BORDER_WALL
    };
    memcpy(grid.box, scene->box, sizeof grid.box);
    const double width = isnan(ed->settings.cell) ? cell_width_default : ed->settings.cell;
    grid.width = fmax(width * d, grid.reach);
    grid.cells_max = ed->count_max < 1000 ? 4000 : 4 * ed->count_max;
    if (grid.wraps_x) {
        ed->wrap_x = scene->box[2] - scene->box[0];
        ed->unwrap_x = 1 / ed->wrap_x;
    }
    if (grid.wraps_y) {
        ed->wrap_y = scene->box[3] - scene->box[1];
        ed->unwrap_y = 1 / ed->wrap_y;
    }
    if (!ed_cells_create(&ed->cells, &grid, ed->count_max, &ed->arena)) return false;
    const double spare = fmax(ed->cells.width_x, ed->cells.width_y) - grid.reach;
    return ed_walls_list_create(&ed->walls, scene, &ed->cells,
                           1.001 * scene->radius_max + 0.5 * grid.margin * fmax(spare, 0),
                           &ed->arena);
}

/* What predictions depend on: an archive of another scene (a later phase) keeps its grains, but
 * its events are made anew. */
static uint64_t fingerprint(const struct ed *ed)
{
    const struct scene *s = ed->scene;
    uint64_t hash = ARCHIVE_HASH_START;
#define PRINT(value) hash = archive_hash(hash, &(value), sizeof (value))
    PRINT(s->shear_rate);
    PRINT(s->effects); PRINT(s->box); PRINT(s->gravity); PRINT(s->left); PRINT(s->right);
    PRINT(s->bottom); PRINT(s->top); PRINT(s->wall_count); PRINT(ed->cells.nx); PRINT(ed->cells.ny);
    PRINT(ed->settings.margin); PRINT(ed->cells.block_count);
    for (uint32_t k = 0; k < s->wall_count; k++) {
        const struct wall *w = &s->walls[k];
        PRINT(w->shape); PRINT(w->x0); PRINT(w->y0); PRINT(w->x1); PRINT(w->y1); PRINT(w->cx);
        PRINT(w->cy); PRINT(w->radius); PRINT(w->angle0); PRINT(w->angle1); PRINT(w->vx);
        PRINT(w->vy); PRINT(w->moves_from); PRINT(w->moves_to); PRINT(w->opens); PRINT(w->closes);
    }
    for (uint32_t k = 0; k < s->sink_count; k++) PRINT(s->sinks[k].region);
    for (uint32_t k = 0; k < s->screen_count; k++) {
        const struct screen *screen = &s->screens[k];
        PRINT(screen->kind); PRINT(screen->center); PRINT(screen->radius); PRINT(screen->x);
    }
#undef PRINT
    return hash;
}

static void place_grains(struct ed *ed)
{
    const struct placed *placed = &ed->scene->placed;
    ed->count = ed->next_id = placed->count;
    for (uint32_t i = 0; i < placed->count; i++) {
        const uint16_t kind = placed->species ? placed->species[i] : 0;
        const struct species *species = &ed->scene->species[kind];
        ed->grains[i] = (struct ed_grain){placed->x[i], placed->y[i], placed->vx[i], placed->vy[i]};
        ed->events[i] = (struct ed_event){INFINITY, INFINITY, ED_NOBODY, 0, 0, -INFINITY};
        ed->id[i] = i;
        if (ed->species) ed->species[i] = placed->species[i];
        if (ed->spin) ed->spin[i] = placed->spin ? placed->spin[i] : 0;
        if (ed->radius) {
            ed->radius[i] = placed->radius[i];
            ed->mass[i] = scene_mass(species, placed->radius[i]);
        }
    }
}

/* Expects that a grain meets something every tenth of a diameter; it is corrected as it runs. */
static double first_width(const struct ed *ed)
{
    const double speed = ed->clock.typical;
    return speed > 0 ? 0.2 * ed->radius_one / speed * ED_BUCKET_FILL / fmax(ed->count, 1) : 1;
}

/* Events of all grains from nothing, at the present. */
static void start_anew(struct ed *ed)
{
    struct ed_walls *walls = &ed->walls;
    ed->clock.now = ed_since_epoch(&ed->clock, ed->clock.present);
    ed_epoch_shift(ed);                                 /* still under the gravity before */
    ed_shear_begin(ed);
    ed->clock.gx = ed->gx;
    ed->clock.gy = ed->gy;
    ed->clock.pace = 0;                                 /* to be taken anew */
    walls->change = 0;
    while (walls->change < walls->change_count
           && walls->changes[walls->change] <= ed->clock.present) walls->change++;
    ed_epoch_file(ed);
    ed_epoch_begin(ed);
    ed_queue_rebuild(&ed->queue, ed->events, 0, 0, first_width(ed));
    ed->clock.stuck_events = 0;
    ed->clock.stuck_mark = 0;
    ed_epoch_predict(ed);
}

static const struct ed_kernels *choose_kernels(const struct ed_settings *settings)
{
#if defined __x86_64__ && defined __GNUC__
    if (settings->vectors == ED_VECTORS_AUTO && __builtin_cpu_supports("avx2")) {
        return &ed_kernel_avx2;
    }
#else
    (void)settings;
#endif
    return &ed_kernel_portable;
}

static void ed_destroy(void *state)
{
    struct ed *ed = state;
    arena_free(&ed->arena);
    free(ed);
}

static void *ed_create(const struct scene *scene, struct error *error)
{
    struct ed *ed = calloc(1, sizeof *ed);
    if (!ed) {
        error_set(error, "not enough memory for the event-driven model");
        return NULL;
    }
    ed->scene = scene;
    ed->settings = ed_settings_of(scene);
    ed->effects = scene->effects;
    ed->count_max = capacity(scene);
    ed->batch_max = scene->source_count ? source_batch_max(scene) : 0;
    ed->gx = scene->gravity[0];
    ed->gy = scene->gravity[1];
    ed->radius_one = scene->radius_min;
    ed->diameter2 = 4 * scene->radius_min * scene->radius_min;
    ed->mass_one = scene_mass(&scene->species[0], scene->radius_min);
    ed->kernels = choose_kernels(&ed->settings);
    ed->kernel = (scene->effects & (EFFECT_POLYDISPERSE | EFFECT_MIXTURE) ? ED_KERNEL_SIZES : 0u)
               | (has_solids(scene) ? ED_KERNEL_SOLIDS : 0u)
               | (scene->effects & (EFFECT_FRICTION | EFFECT_ROTATION) ? ED_KERNEL_SPINS : 0u);
    if (!take_arrays(ed) || !make_cells(ed)
        || !ed_queue_create(&ed->queue, ed->count_max, &ed->arena)
        || !ed_law_create(&ed->law, scene, &ed->settings, &ed->arena)
        || !tally_create(&ed->tally, scene, &ed->arena)) {
        error_set(error, "not enough memory for %u grains of the event-driven model",
                  ed->count_max);
        ed_destroy(ed);
        return NULL;
    }
    ed->watches = ed_watch_wanted(ed);
    place_grains(ed);
    ed->queue.per_time = 1;
    start_anew(ed);
    ed->clock.epochs = 0;
    ed->clock.fingerprint = fingerprint(ed);
    return ed;
}

/* Grains so many times faster than the scene lets expect were driven, and not left alone. */
static const double heated = 10;

static bool wall_runs(const struct ed *ed)
{
    bool runs = false;
    for (uint32_t w = 0; w < ed->walls.count; w++) {
        runs = runs || ed->walls.now[w].vx != 0 || ed->walls.now[w].vy != 0;
    }
    return runs;
}

/* The soonest event says where time has stopped. */
static void tell_stuck(struct ed *ed)
{
    struct ed_due first = {0, 0};
    bool from_heap;
    const bool known = ed_queue_first(&ed->queue, &first, &from_heap) && first.id < ed->count;
    const uint32_t i = known ? first.id : 0;
    const struct ed_path p = ed_walls_path(ed, i);
    struct fault *fault = &ed->fault;
    *fault = (struct fault){.time = ed_scene_time(&ed->clock, ed->clock.now), .x = p.x, .y = p.y,
                            .grain = ed->id[i]};
    if (ed->clock.typical > heated * ed->clock.pace) {
        snprintf(fault->text, sizeof fault->text,
            "time stopped at %.9g: grain %u at (%.4g, %.4g) and the others have no room left and "
            "collide ever faster (at a speed of %.2g, where %.2g was expected); what presses them "
            "or drives them must end before (walls.moves), or use a model of soft discs",
            fault->time, fault->grain, p.x, p.y, ed->clock.typical, ed->clock.pace);
        return;
    }
    const double t_c = ed->law.t_c;
    snprintf(fault->text, sizeof fault->text,
        "time stopped at %.9g: grain %u at (%.4g, %.4g) and its neighbours collide ever faster "
        "(inelastic collapse, or grains that rest on each other); %s ed.t_c%s to the duration of a "
        "contact, for instance %.2g%s", fault->time, fault->grain, p.x, p.y,
        t_c > 0 ? "raise" : "set", t_c > 0 ? "" : " (now 0)",
        fmax(10 * t_c, 2e-6 * ed->radius_one / fmax(ed->clock.typical, DBL_MIN)),
        wall_runs(ed) ? "; or let the wall that presses them end before (walls.moves)" : "");
}

static enum advance ed_advance(void *state, double t_end, uint64_t budget)
{
    struct ed *ed = state;
    struct ed_clock *clock = &ed->clock;
    if (ed->fault.text[0]) return ADVANCE_BROKEN;
    for (;;) {
        const double change = ed_change_next(ed), t = fmin(change, t_end);
        const double limit = ed_since_epoch(clock, t);
        switch (ed->kernels->run[ed->kernel](ed, limit, &budget)) {
        case ED_EPOCH:
            ed_epoch_begin(ed);
            break;
        case ED_BUDGET:
            clock->present = fmax(clock->present, ed_scene_time(clock, clock->now));
            return ADVANCE_BUDGET;
        case ED_STUCK:
            clock->present = fmax(clock->present, ed_scene_time(clock, clock->now));
            tell_stuck(ed);
            return ADVANCE_BROKEN;
        case ED_LIMIT:
            if (change <= t_end) {
                ed_change_apply(ed, change);
                break;
            }
            clock->present = fmax(clock->present, t_end);
            return ADVANCE_REACHED;
        }
    }
}

static void ed_push(void *state, const struct impulse *impulse)
{
    struct ed *ed = state;
    const double t = ed_since_epoch(&ed->clock, ed->clock.present);
    for (uint32_t i = 0; i < ed->count; i++) {
        struct ed_grain *g = &ed->grains[i];
        const double x = g->x + t * (g->vx + 0.5 * ed->gx * t);
        const double y = g->y + t * (g->vy + 0.5 * ed->gy * t);
        const double share = impulse_share(impulse, x, y);
        if (share == 0) continue;
        g->vx += share * impulse->vx;           /* as if it had always flown so: ed.h */
        g->vy += share * impulse->vy;
        g->x -= share * impulse->vx * t;
        g->y -= share * impulse->vy * t;
    }
    start_anew(ed);
}

static void ed_archive(void *state, struct archive *archive)
{
    struct ed *ed = state;
    const uint64_t own = ed->clock.fingerprint;
    const bool loads = archive->mode == ARCHIVE_LOAD;
    const bool had_rates = archive_has(archive, "ed.rate");
    archive_count(archive, "ed.count", &ed->count, ed->count_max);
    archive_value(archive, "ed.next_id", &ed->next_id);
    archive_value(archive, "ed.clock", &ed->clock);
    archive_array(archive, "ed.grains", ed->grains, ed->count);
    archive_array(archive, "ed.events", ed->events, ed->count);
    archive_array(archive, "ed.id", ed->id, ed->count);
    archive_array(archive, "ed.species", ed->species, ed->count);
    archive_array(archive, "ed.radius", ed->radius, ed->count);
    archive_array(archive, "ed.mass", ed->mass, ed->count);
    archive_array(archive, "ed.spin", ed->spin, ed->count);
    archive_array(archive, "ed.angle", ed->angle, ed->count);
    archive_array(archive, "ed.contacts", ed->contacts, ed->count);
    archive_array(archive, "ed.rate", ed->rate, ed->count);
    archive_array(archive, "ed.begun", ed->begun, ed->count);
    archive_array(archive, "ed.elastic", ed->elastic, ed->count);
    source_archive(ed->scene, ed->cursors, archive);
    tally_archive(&ed->tally, archive);
    const bool same = !loads || ed->clock.fingerprint == own;
    if (same) {
        archive_value(archive, "ed.wall_change", &ed->walls.change);
        ed_cells_archive(&ed->cells, archive);
    }
    if (!loads || archive->failed) return;
    const char *wrong = ed_check_grains(ed);
    if (!wrong && same) wrong = ed_check_events(ed);
    if (wrong) {
        archive_fail(archive, wrong);
        return;
    }
    ed->fault = (struct fault){0};
    ed->sheared |= ed->clock.ahead != 0 || ed->clock.shear_speed != 0;
    ed->clock.fingerprint = own;
    if (ed->rate && !had_rates) ed->clock.rate_from = ed->clock.present;
    if (!same) {
        start_anew(ed);
        return;
    }
    ed_walls_list_refresh(ed);
    ed_queue_rebuild(&ed->queue, ed->events, ed->count, ed->clock.now, first_width(ed));
}

static const struct tally *ed_tally(const void *state)
{
    return &((const struct ed *)state)->tally;
}

static const struct fault *ed_fault(const void *state)
{
    return &((const struct ed *)state)->fault;
}

static uint64_t ed_memory(const struct scene *scene)
{
    const uint64_t n = capacity(scene), bytes_per_grain = 170;
    const double d = 2 * scene->radius_max;
    const double cells = (scene->box[2] - scene->box[0]) * (scene->box[3] - scene->box[1])
                       / (cell_width_default * cell_width_default * d * d);
    return n * bytes_per_grain + (uint64_t)fmin(cells, 4.0 * (double)n + 4000) * 40;
}

const struct model model_ed = {
    .name     = "ed",
    .summary  = "Hard discs that fly freely from collision to collision (ED); the TC rule lets "
                "them rest (TCED).",
    .work     = "events",
    .effects  = EFFECT_GRAVITY | EFFECT_DISSIPATION | EFFECT_ROTATION | EFFECT_FRICTION
              | EFFECT_POLYDISPERSE | EFFECT_MIXTURE | EFFECT_PERIODIC | EFFECT_WALLS
              | EFFECT_MOVING_WALLS | EFFECT_GATES | EFFECT_OBSTACLE | EFFECT_OUTFLOW
              | EFFECT_INFLOW | EFFECT_SCREEN | EFFECT_COLLISION_RATE | EFFECT_COLLISION_COUNT
              | EFFECT_IMPACT | EFFECT_STRESS | EFFECT_SHEAR,
    .settings = &ed_settings_group,
    .resolve  = ed_settings_resolve,
    .memory   = ed_memory,
    .create   = ed_create,
    .destroy  = ed_destroy,
    .advance  = ed_advance,
    .observe  = ed_look_observe,
    .push     = ed_push,
    .archive  = ed_archive,
    .count    = ed_look_count,
    .tally    = ed_tally,
    .fault    = ed_fault,
};
