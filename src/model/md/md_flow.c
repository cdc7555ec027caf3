/* md_flow.c - grains that enter and leave.
 *
 * Grains leave when the list is made anew, that is before any has moved farther than half the
 * skin.  One that leaves is marked and dropped by the sort.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_flow.h"

#include "model/stepping.h"

#include <math.h>

enum { RETRY_STEPS = 20 };      /* a grain without room tries again so much later */

bool md_flow_due(const struct md *md)
{
    if (!md->cursors) return false;
    const double t = md_time(md);
    if (md->steps < md->retry_step) return false;
    for (uint32_t s = 0; s < md->scene->source_count; s++) {
        if (source_due(md->scene, s, &md->cursors[s]) <= t) return true;
    }
    return false;
}

static bool has_left(struct md *md, uint32_t i, double t)
{
    const struct scene *scene = md->scene;
    const struct grain *g = &md->grains[i];
    const double radius = md_radius(md, i);
    if (stepping_left(scene, g->x, g->y, radius)) return true;
    if (scene->screen_count == 0) return false;
    const struct species *species = &scene->species[md->tags[i].species];
    return tally_cross(&md->tally, scene, t, g->x, g->y, g->ux, g->uy, md_rim(md, i) / radius,
                       1 / md_inverse_mass(md, i), scene_inertia(species, radius));
}

static void let_out(struct md *md)
{
    const double t = md_time(md);
    if (!(md->effects & (EFFECT_OUTFLOW | EFFECT_SCREEN))) return;
    for (uint32_t i = 0; i < md->count; i++) {
        if (!has_left(md, i, t)) continue;
        md->tally.mass_out += 1 / md_inverse_mass(md, i);
        md->tags[i].gone = true;
        md->grains_out++;
    }
}

/* Would it overlap a grain that is there?  All are asked: grains enter seldom. */
static bool has_room(const struct md *md, const struct source_grain *grain)
{
    for (uint32_t i = 0; i < md->count; i++) {
        const struct grain *g = &md->grains[i];
        if (md->tags[i].gone) continue;
        const double reach = md_radius(md, i) + grain->radius;
        const double dx = g->x - grain->x, dy = g->y - grain->y;
        if (dx * dx + dy * dy < reach * reach) return false;
    }
    return true;
}

struct trait md_flow_trait(const struct species *species, double radius)
{
    return (struct trait){.radius = radius, .inverse_mass = 1 / scene_mass(species, radius),
                          .inverse_inertia = species->inertia == INERTIA_SPHERE ? 2.5 : 2};
}

bool md_flow_add(struct md *md, const struct source_grain *grain, double spin)
{
    if (md->count == md->count_max) return false;
    const struct species *species = &md->scene->species[grain->species];
    const double *gravity = md->scene->gravity;
    const uint32_t i = md->count;
    md->grains[i] = (struct grain){grain->x, grain->y, grain->vx, grain->vy};
    md->halves[i] = (struct half){grain->vx, grain->vy};
    md->tags[i] = (struct tag){.id = md->id_next++, .species = grain->species,
                               .fresh = !md->gears};
    md->some_fresh = !md->gears;
    if (md->traits) {
        md->traits[i] = md_flow_trait(species, grain->radius);
        if (md->turns) md->traits[i].rim = spin * grain->radius;
    }
    if (md->turns) md->turns[i] = (struct turn){.hrim = md->traits[i].rim};
    if (md->gears) {
        md->gears[i] = (struct gear){.x2 = 0.5 * md->dt * md->dt * gravity[0],
                                             .y2 = 0.5 * md->dt * md->dt * gravity[1]};
    }
    if (md->collisions) {
        md->collisions[i] = 0;
        md->collision_rate[i] = 0;
    }
    md->count++;
    return true;
}

/* Lets one batch in; false if it must wait for room. */
static bool let_batch_in(struct md *md, uint32_t s)
{
    struct source_cursor *cursor = &md->cursors[s];
    const struct source *source = &md->scene->sources[s];
    const double t = md_time(md);
    const uint32_t count = source_batch(md->scene, s, cursor->next, md->batch, md->batch_max);
    if (md->count + count > md->count_max) return false;
    for (uint32_t k = 0; k < count; k++) {
        if (source->count > 0 && cursor->made >= source->count) break;
        struct source_grain grain = source_flown(md->scene, &md->batch[k], t);
        if (source->kind == SOURCE_POINT) {
            grain = md->batch[k];                               /* it may have waited there */
            if (!has_room(md, &grain)) return false;
        } else if (!has_room(md, &grain)) {
            md->rejected++;                                     /* a stream does not wait */
            continue;
        }
        md_flow_add(md, &grain, 0);
        md->tally.mass_in += scene_mass(&md->scene->species[grain.species], grain.radius);
        md->grains_in++;
        cursor->made++;
    }
    cursor->next++;
    return true;
}

void md_flow_pass(struct md *md)
{
    if (md->effects & (EFFECT_OUTFLOW | EFFECT_SCREEN)) let_out(md);
    if (!md->cursors) return;
    const double t = md_time(md);
    bool waits = false;
    for (uint32_t s = 0; s < md->scene->source_count; s++) {
        while (source_due(md->scene, s, &md->cursors[s]) <= t) {
            if (let_batch_in(md, s)) continue;
            waits = true;
            break;
        }
    }
    md->retry_step = waits ? md->steps + RETRY_STEPS : 0;
}

void md_flow_window(struct md *md)
{
    if (!md->collisions) return;
    const double length = md->window_length;
    const uint64_t window = (uint64_t)(md_time(md) / length);
    if (window == md->window) return;
    for (uint32_t i = 0; i < md->count; i++) {
        md->collision_rate[i] = (float)(md->collisions[i] / length);
        md->collisions[i] = 0;
    }
    md->window = window;
}
