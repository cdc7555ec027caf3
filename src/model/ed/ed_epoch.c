/* ed_epoch.c - see ed_epoch.h.
 *
 * Positions at the epoch are x - v t, so they lose digits as v t grows; events too.  Every eight
 * events a grain, and whenever the fastest grain has flown some way, the epoch moves up.  That is
 * counted in events and in the model's own time, never in calls, so it does not depend on how a
 * run is cut into pieces.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_epoch.h"

#include "model/ed/ed.h"
#include "model/ed/ed_shear.h"
#include "model/speed.h"

#include <math.h>

/* The fastest grain's way until the epoch moves up, in diameters: 1e4 costs four digits of
 * sixteen. */
static const double way_max = 1e4;

/* Relative velocities below this share of the greatest speed are rounding.  Where grains rest
 * under gravity, what rattles with less than a share of sqrt(g d) rests too: a row of grains that
 * just fits between two walls would otherwise rattle without time going on.  At that speed an
 * overlap takes 1e4 free falls through a grain to grow to 1e-9. */
static const double noise_share = 1e-15, noise_at_rest = 1e-13;

/* Time counts as stuck if ed_stuck_events bring it on by less than this share of a grain's diameter
 * over its speed. */
static const double stuck_share = 1e-10;

/* It also does if every grain has more events than this while it could go its diameter at the pace
 * of the scene.  Where a wall leaves no room, grains grow faster as their gaps shrink, and time
 * told by their speed always moves on.  A gas has as many events as it has gaps in a diameter:
 * 1e9 of them are as narrow as an overlap may be, and one grain takes minutes for a diameter. */
static const double events_most = 1e9;

/* But t_c may be chosen so short that a bed at rest, with some ten contacts in t_c, has more. */
static const double contacts_most = 1e3;

void ed_epoch_copy(struct ed *ed, uint32_t to, uint32_t from)
{
    ed->grains[to] = ed->grains[from];
    ed->events[to] = ed->events[from];
    ed->id[to] = ed->id[from];
    if (ed->species) ed->species[to] = ed->species[from];
    if (ed->radius) {
        ed->radius[to] = ed->radius[from];
        ed->mass[to] = ed->mass[from];
    }
    if (ed->spin) {
        ed->spin[to] = ed->spin[from];
        ed->angle[to] = ed->angle[from];
    }
    if (ed->contacts) {
        ed->contacts[to] = ed->contacts[from];
        ed->rate[to] = ed->rate[from];
    }
    if (ed->begun) {
        ed->begun[to] = ed->begun[from];
        ed->elastic[to] = ed->elastic[from];
    }
}

/* Clocks are summed in two doubles, so that steps below the last digit of the time add up. */
static void clock_add(struct ed_clock *clock, double t)
{
    const double low = clock->epoch_low + t, sum = clock->epoch + low;
    clock->epoch_low = low - (sum - clock->epoch);
    clock->epoch = sum;
}

void ed_epoch_shift(struct ed *ed)
{
    const double t = ed->clock.now, gx = ed->clock.gx, gy = ed->clock.gy;
    for (uint32_t i = 0; i < ed->count; i++) {
        struct ed_grain *g = &ed->grains[i];
        struct ed_event *e = &ed->events[i];
        g->x += t * (g->vx + 0.5 * gx * t);
        g->y += t * (g->vy + 0.5 * gy * t);
        g->vx += gx * t;
        g->vy += gy * t;
        e->contact -= t;
        e->due -= t;
        e->last -= t;
        if (ed->spin) ed->angle[i] = remainder(ed->angle[i] + t * ed->spin[i], 2 * M_PI);
    }
    clock_add(&ed->clock, t);
    ed_shear_shift(ed, t);
    ed->clock.stuck_mark -= t;
    ed->clock.now = 0;
}

/* Exchanges grains until grain k is the one that `order` says; order is used up. */
static void permute(struct ed *ed, uint32_t *order)
{
    for (uint32_t k = 0; k < ed->count; k++) {
        if (order[k] == k) continue;
        ed_epoch_copy(ed, ed->count_max, k);                    /* the place beyond is spare */
        uint32_t hole = k;
        for (;;) {
            const uint32_t from = order[hole];
            order[hole] = hole;
            if (from == k) break;
            ed_epoch_copy(ed, hole, from);
            hole = from;
        }
        ed_epoch_copy(ed, hole, ed->count_max);
    }
    ed->grains[ed->count_max] = (struct ed_grain){NAN, NAN, NAN, NAN};
}

/* Numbers grains along the rows of cells, so that neighbours share cache lines. */
static void sort_in_space(struct ed *ed)
{
    uint32_t *order = ed->order, *place = ed->place, k = 0;
    const struct ed_cells *c = &ed->cells;
    for (uint32_t cell = 0; cell < c->count; cell++) {
        for (uint32_t block = cell; ; block = c->chain[block]) {
            uint32_t *ids = c->cells[block].id;
            for (uint32_t s = 0; s < ED_CELL_ROOM && ids[s] != ED_CELL_EMPTY; s++) {
                order[k] = ids[s];
                place[ids[s]] = k;
                ids[s] = k++;
            }
            if (!c->chain[block]) break;
        }
    }
    permute(ed, order);
    for (uint32_t i = 0; i < ed->count; i++) {
        const uint32_t partner = ed->events[i].partner;
        if (partner & ED_SOLID) continue;
        /* A partner that has gone since: nobody, found out when the event is due. */
        ed->events[i].partner = partner < ed->count ? place[partner] : ED_SOLID - 1;
    }
}

/* The time in which ed_stuck_events are due at the latest. */
static double stuck_step(const struct ed *ed)
{
    const struct ed_clock *clock = &ed->clock;
    const double d = 2 * ed->radius_one;
    const double own = clock->typical > 0 ? stuck_share * d / clock->typical : 0;
    if (clock->pace == 0 || ed->count == 0) return own;
    double rate = events_most * clock->pace / d;
    if (ed->law.t_c > 0) rate = fmax(rate, contacts_most / ed->law.t_c);
    return fmax(own, (double)ed_stuck_events(ed->count) / (rate * ed->count));
}

/* The speeds and times that thresholds are measured by. */
static void take_measures(struct ed *ed)
{
    struct ed_clock *clock = &ed->clock;
    double sum2 = 0, max2 = 0;
    for (uint32_t i = 0; i < ed->count; i++) {
        const struct ed_grain *g = &ed->grains[i];
        const double v2 = g->vx * g->vx + g->vy * g->vy;
        sum2 += v2;
        max2 = fmax(max2, v2);
    }
    const double d = 2 * ed->radius_one, g = hypot(ed->gx, ed->gy);
    double walls = 0;
    for (uint32_t w = 0; w < ed->walls.count; w++) {
        walls = fmax(walls, hypot(ed->walls.now[w].vx, ed->walls.now[w].vy));
    }
    const double fastest = fmax(sqrt(max2), walls);
    const double typical = fmax(fmax(sqrt(sum2 / fmax(ed->count, 1)), sqrt(g * d)), walls);
    /* Without the TC rule a lossy gas may collapse, and that shall be seen, not rounded away. */
    const bool collapses = ed->law.t_c == 0 && ed->effects & EFFECT_DISSIPATION;
    clock->noise = collapses ? 0 : fmax(noise_share * fastest, noise_at_rest * sqrt(g * d));
    clock->typical = typical;
    if (clock->pace == 0) clock->pace = fmax(typical, speed_greatest(ed->scene));
    clock->stuck_step = stuck_step(ed);
    /* v t + g t^2 / 2 = way, in the form that does not cancel. */
    const double way = way_max * d, speed = fmax(fastest, typical);
    const double root = speed + sqrt(speed * speed + 2 * g * way);
    clock->epoch_end = root > 0 ? 2 * way / root : INFINITY;
}

void ed_epoch_file(struct ed *ed)
{
    ed_cells_clear(&ed->cells);
    for (uint32_t i = 0; i < ed->count; i++) {
        const struct ed_path p = ed_walls_path(ed, i);
        struct ed_event *e = &ed->events[i];
        ed_cells_place(&ed->cells, p.x, p.y, &e->cx, &e->cy);
        ed_cells_put(&ed->cells, ed_cells_index(&ed->cells, e->cx, e->cy), i);
    }
}

void ed_epoch_begin(struct ed *ed)
{
    struct ed_clock *clock = &ed->clock;
    const double span = clock->now, events = (double)clock->epoch_events;
    ed_epoch_shift(ed);
    sort_in_space(ed);
    ed_walls_list_refresh(ed);
    take_measures(ed);
    clock->epochs++;
    clock->epoch_events = 0;
    /* Buckets as wide as the events of the last epoch came, or left as they are. */
    double width = 1 / ed->queue.per_time;
    if (span > 0 && events > ed->count) width = ED_BUCKET_FILL * span / events;
    ed_queue_rebuild(&ed->queue, ed->events, ed->count, 0, width);
}

void ed_epoch_predict(struct ed *ed)
{
    for (uint32_t i = 0; i < ed->count; i++) ed->kernels->predict_one(ed, i);
}
