/* ed_change.c - see ed_change.h. */
#include "model/ed/ed_change.h"

#include "model/ed/ed.h"
#include "model/ed/ed_epoch.h"

#include <math.h>

/* A grain at rest on a floor bounces with ever shorter steps; the TC rule ends that with elastic
 * bounces that last about t_c.  One that lies there without any bounce (set down so, or stopped
 * dead by a neighbour) gets this share of such a bounce's speed, so that time can go on.  Its
 * energy is 1e-3 of that of the bounces. */
static const double bounce_least = 0.03;

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
    if (law->t_c > 0 && now - e->last < law->t_c) r = 1;
    else r = ed_law_restitution(law, r, closing);
    e->last = now;
    const double away = fmax(r * closing, bounce_least * 0.5 * touch->press * law->t_c);
    const double dvn = away - touch->vn;
    double dvt = 0;
    if (ed->spin) {
        const double q = law->inertia_factor[species];
        const double slip = touch->vt - radius * ed->spin[i] - ed->walls.walls[w].surface_speed
                            * ed_walls_surface(ed, w, touch);
        dvt = ed_law_tangential(pair, slip, (1 + 1 / q) / m, m * dvn) / m;
        const double dspin = -dvt / (q * radius);
        ed->spin[i] += dspin;
        ed->angle[i] -= dspin * now;
    }
    const double dvx = dvn * touch->nx - dvt * touch->ny, dvy = dvn * touch->ny + dvt * touch->nx;
    kick(ed, i, dvx, dvy);
    tally_impulse(ed, w, touch, -m * dvx, -m * dvy);
    ed->clock.wall_contacts++;
    if (ed->contacts) ed->contacts[i]++;
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
        const double spin = ed->spin ? ed->spin[i] : 0, m = ed_mass(ed, i), radius = ed_radius(ed, i);
        const struct screen *screen = &ed->scene->screens[ed_partner_index(partner)];
        /* On the line itself rounding decides; a hair behind it there is no doubt. */
        const double hair = 1e-9 * radius;
        const double dx = p.x - screen->center[0], dy = p.y - screen->center[1];
        const bool line = screen->kind == SCREEN_LINE;
        const double away = fmax(hypot(dx, dy), 1e-300);
        tally_cross(&ed->tally, ed->scene, ed_scene_time(&ed->clock, ed->clock.now),
                    p.x + hair * (line ? 1 : dx / away), p.y + hair * (line ? 0 : dy / away),
                    p.vx, p.vy, spin, m, ed->law.inertia_factor[ed_species(ed, i)] * m * radius * radius);
        ed_change_remove(ed, i);
        return false;
    }
    struct ed_touch touch;
    const uint32_t w = ed_partner_index(partner);
    if (ed->walls.now[w].present && ed_walls_touch(ed, i, partner, &touch)) bounce(ed, i, w, &touch);
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

double ed_change_next(const struct ed *ed)
{
    return fmin(rate_end(ed), wall_change(ed));
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
        ed->kernels->predict_all(ed);
    }
}
