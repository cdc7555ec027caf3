/* ed_change.c - see ed_change.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_change.h"

#include "model/ed/ed.h"
#include "model/ed/ed_epoch.h"
#include "model/ed/ed_shear.h"
#include "model/ed/ed_watch.h"

#include <math.h>

/* A grain at rest on a floor bounces with ever shorter steps; the TC rule ends that with elastic
 * bounces that last about t_c.  No bounce is made shorter than this share of t_c: a bed that was
 * set down at rest would otherwise have no motion at all, and its collisions no end; one pressed
 * by hardly moving neighbours would collide at a rate that goes as one over their speed.  So a bed
 * at rest keeps an agitation of about g t_c / 2. */
static const double bounce_least = 1;

bool ed_change_leaves(const struct ed *ed, uint32_t cx, uint32_t cy)
{
    const struct ed_cells *c = &ed->cells;
    return (!c->wraps_x && (cx == 0 || cx > c->nx)) || (!c->wraps_y && (cy == 0 || cy > c->ny));
}

/* Entries in the calendar and events of others that name a grain which is gone or has moved are
 * found out when they are due: what they name is then not there. */
void ed_change_remove(struct ed *ed, uint32_t i)
{
    const struct ed_event *gone = &ed->events[i];
    const uint32_t last = ed->count - 1;
    ed->clock.grains_out++;
    ed->tally.mass_out += ed_mass(ed, i);
    ed_cells_remove(&ed->cells, ed_cells_index(&ed->cells, gone->cx, gone->cy), i);
    ed->count--;
    if (i == last) return;
    const struct ed_event *moved = &ed->events[last];
    const uint32_t cell = ed_cells_index(&ed->cells, moved->cx, moved->cy);
    ed_cells_remove(&ed->cells, cell, last);
    ed_epoch_copy(ed, i, last);
    ed_cells_put(&ed->cells, cell, i);
    if (!ed_queue_put(&ed->queue, ed->events[i].due, i)) {
        ed_queue_rebuild(&ed->queue, ed->events, ed->count, ed->clock.now, 1 / ed->queue.per_time);
    }
}

static void tally_impulse(struct ed *ed, uint32_t wall, const struct ed_touch *touch, double px,
                          double py)
{
    const uint32_t body = ed->walls.walls[wall].body;
    if (body == WALL_NONE || body >= ed->tally.body_count) return;
    struct tally_body *sum = &ed->tally.bodies[body];
    const double *center = ed->scene->obstacles[body].center;
    sum->impulse_x += px;
    sum->impulse_y += py;
    sum->angular_impulse += (touch->x - center[0]) * py - (touch->y - center[1]) * px;
    sum->contacts++;
}

static void kick(struct ed *ed, uint32_t i, double dvx, double dvy)
{
    struct ed_grain *g = &ed->grains[i];
    g->vx += dvx;
    g->vy += dvy;
    g->x -= dvx * ed->clock.now;
    g->y -= dvy * ed->clock.now;
}

static void bounce(struct ed *ed, uint32_t i, uint32_t w, const struct ed_touch *touch)
{
    struct ed_event *e = &ed->events[i];
    const struct ed_law *law = &ed->law;
    const double now = ed->clock.now, m = ed_mass(ed, i), radius = ed_radius(ed, i);
    const uint32_t species = ed_species(ed, i), stuff = ed->walls.walls[w].species;
    const struct ed_pair *pair = &law->walls[species * law->species_count
                                             + (stuff < law->species_count ? stuff : 0)];
    double r = pair->restitution;
    const double closing = fmax(-touch->vn, 0);
    const bool elastic = law->t_c > 0 && now - e->last < law->t_c;
    r = elastic ? 1 : ed_law_restitution(law, r, closing);
    e->last = now;
    const double away = fmax(r * closing, bounce_least * 0.5 * touch->press * law->t_c);
    double dvn = away - touch->vn;
    double dvt = 0;
    if (ed->spin) {
        const double q = law->inertia_factor[species];
        const double slip = touch->vt - radius * ed->spin[i] - ed->walls.walls[w].surface_speed
                            * ed_walls_surface(ed, w, touch);
        const double mobility = (1 + 1 / q) / m;
        dvt = ed_law_tangential(pair, slip, mobility, m * dvn) / m;
        if (elastic && away < law->return_max) {
            dvn = ed_law_return(law, away, slip, mobility, m * dvt, m) - touch->vn;
        }
        const double dspin = -dvt / (q * radius);
        ed->spin[i] += dspin;
        ed->angle[i] -= dspin * now;
    }
    const double dvx = dvn * touch->nx - dvt * touch->ny, dvy = dvn * touch->ny + dvt * touch->nx;
    kick(ed, i, dvx, dvy);
    tally_impulse(ed, w, touch, -m * dvx, -m * dvy);
    ed->clock.wall_contacts++;
    if (ed->watches) ed_watch_wall(ed, i, touch, m * dvx, m * dvy, elastic);
}

bool ed_change_solid(struct ed *ed, uint32_t i)
{
    const uint32_t partner = ed->events[i].partner;
    const enum ed_part part = ed_partner_part(partner);
    if (part == ED_PART_SINK) {
        ed_change_remove(ed, i);
        return false;
    }
    if (part == ED_PART_SCREEN) {
        const struct ed_path p = ed_walls_path(ed, i);
        const double spin = ed->spin ? ed->spin[i] : 0;
        const double m = ed_mass(ed, i), radius = ed_radius(ed, i);
        const double inertia = ed->law.inertia_factor[ed_species(ed, i)] * m * radius * radius;
        const struct screen *screen = &ed->scene->screens[ed_partner_index(partner)];
        /* On the line itself rounding decides; a hair behind it there is no doubt. */
        const double hair = 1e-9 * radius;
        const double dx = p.x - screen->center[0], dy = p.y - screen->center[1];
        const bool line = screen->kind == SCREEN_LINE;
        const double away = fmax(hypot(dx, dy), 1e-300);
        tally_cross(&ed->tally, ed->scene, ed_scene_time(&ed->clock, ed->clock.now),
                    p.x + hair * (line ? 1 : dx / away), p.y + hair * (line ? 0 : dy / away),
                    p.vx, p.vy, spin, m, inertia);
        ed_change_remove(ed, i);
        return false;
    }
    struct ed_touch touch;
    const uint32_t w = ed_partner_index(partner);
    const bool meets = ed->walls.now[w].present && ed_walls_touch(ed, i, partner, &touch);
    if (meets) bounce(ed, i, w, &touch);
    else ed->clock.stale++;
    return true;
}

static double rate_window(const struct ed *ed)
{
    const double window = ed->scene->measure.collision_window;
    if (window > 0) return window;
    return ed->scene->output.frames > 0 ? ed->scene->output.frames : ed->scene->until / 100;
}

static double rate_end(const struct ed *ed)
{
    return ed->contacts ? ed->clock.rate_from + rate_window(ed) : INFINITY;
}

static double wall_change(const struct ed *ed)
{
    const struct ed_walls *walls = &ed->walls;
    return walls->change < walls->change_count ? walls->changes[walls->change] : INFINITY;
}

/* When the next grain wants in. */
static double inflow_due(const struct ed *ed)
{
    double due = INFINITY;
    for (uint32_t s = 0; ed->cursors && s < ed->scene->source_count; s++) {
        due = fmin(due, source_due(ed->scene, s, &ed->cursors[s]));
    }
    return fmax(due, ed->clock.retry);
}

/* Would it overlap a grain that is there?  All are asked: grains enter seldom. */
static bool has_room(const struct ed *ed, const struct source_grain *grain)
{
    for (uint32_t i = 0; i < ed->count; i++) {
        const struct ed_path p = ed_walls_path(ed, i);
        const double reach = ed_radius(ed, i) + grain->radius;
        const double dx = p.x - grain->x, dy = p.y - grain->y;
        if (dx * dx + dy * dy < reach * reach) return false;
    }
    return true;
}

static void add_grain(struct ed *ed, const struct source_grain *grain)
{
    const uint32_t i = ed->count++;
    const double t = ed->clock.now, vx = grain->vx - ed->gx * t, vy = grain->vy - ed->gy * t;
    ed->grains[i] = (struct ed_grain){grain->x - t * (vx + 0.5 * ed->gx * t),
                                      grain->y - t * (vy + 0.5 * ed->gy * t), vx, vy};
    struct ed_event *e = &ed->events[i];
    *e = (struct ed_event){INFINITY, INFINITY, ED_NOBODY, 0, 0, -INFINITY};
    ed->id[i] = ed->next_id++;
    const double mass = scene_mass(&ed->scene->species[grain->species], grain->radius);
    if (ed->species) ed->species[i] = grain->species;
    if (ed->radius) {
        ed->radius[i] = grain->radius;
        ed->mass[i] = mass;
    }
    if (ed->spin) ed->spin[i] = ed->angle[i] = 0;
    if (ed->contacts) {
        ed->contacts[i] = 0;
        ed->rate[i] = 0;
    }
    if (ed->begun) ed->begun[i] = ed->elastic[i] = 0;
    ed_cells_place(&ed->cells, grain->x, grain->y, &e->cx, &e->cy);
    ed_cells_put(&ed->cells, ed_cells_index(&ed->cells, e->cx, e->cy), i);
    ed->kernels->predict_one(ed, i);
    ed->clock.grains_in++;
    ed->tally.mass_in += mass;
}

/* Lets one batch in.  A grain of a point source waits for room; one of a stream that finds none is
 * refused, since the stream would run into it. */
static bool let_batch_in(struct ed *ed, uint32_t s, double t)
{
    struct source_cursor *cursor = &ed->cursors[s];
    const struct source *source = &ed->scene->sources[s];
    const uint32_t count = source_batch(ed->scene, s, cursor->next, ed->batch, ed->batch_max);
    if (ed->count + count > ed->count_max) return false;
    for (uint32_t k = 0; k < count; k++) {
        if (source->count > 0 && cursor->made >= source->count) break;
        const bool waits = source->kind == SOURCE_POINT;
        const struct source_grain grain = waits ? ed->batch[k]
                                                : source_flown(ed->scene, &ed->batch[k], t);
        const bool room = has_room(ed, &grain);
        if (waits && !room) return false;
        if (room) add_grain(ed, &grain);
        else ed->clock.refused++;
        cursor->made++;
    }
    cursor->next++;
    return true;
}

/* A grain without room tries again after a tenth of its source's interval, or of the run's
 * hundredth part. */
static void let_in(struct ed *ed, double t)
{
    for (uint32_t s = 0; s < ed->scene->source_count; s++) {
        while (source_due(ed->scene, s, &ed->cursors[s]) <= t) {
            if (let_batch_in(ed, s, t)) continue;
            const double rate = ed->scene->sources[s].rate;
            ed->clock.retry = t + 0.1 * (rate > 0 ? 1 / rate : ed->scene->until / 100);
            break;
        }
    }
}

double ed_change_next(const struct ed *ed)
{
    return fmin(fmin(rate_end(ed), wall_change(ed)), fmin(inflow_due(ed), ed_shear_due(ed)));
}

void ed_change_apply(struct ed *ed, double t)
{
    if (rate_end(ed) <= t) {
        const double window = rate_window(ed);
        for (uint32_t i = 0; i < ed->count; i++) {
            ed->rate[i] = (float)(ed->contacts[i] / window);
            ed->contacts[i] = 0;
        }
        ed->clock.rate_from += window;
    }
    if (wall_change(ed) <= t) {
        ed->walls.change++;
        ed->clock.now = fmax(ed->clock.now, ed_since_epoch(&ed->clock, t));
        ed_epoch_begin(ed);
        ed_epoch_predict(ed);
    }
    if (ed_shear_due(ed) <= t) {
        ed->clock.now = fmax(ed->clock.now, ed_since_epoch(&ed->clock, t));
        ed_shear_slide(ed);
    }
    if (inflow_due(ed) <= t) {
        ed->clock.now = fmax(ed->clock.now, ed_since_epoch(&ed->clock, t));
        let_in(ed, t);
    }
}
