/* ed_look.c - see ed_look.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_look.h"

#include "model/ed/ed_shear.h"

#include <math.h>
#include <stdlib.h>

/* Gaps of a bed at rest, in units of g t_c^2.  A lone grain bounces 1/8 high, at g t_c / 2
 * (ed_change.c); in columns of twenty the widest gap was 1.0 in many looks, so twice that. */
static const double bed_gap = 2;

/* Gaps below this share of a diameter are rounding: positions are kept to 1e-12 of the way that a
 * grain flies in an epoch, 1e4 diameters at most (ed_epoch.c). */
static const double rounding_gap = 1e-8;

/* No contact is wider than this share of a radius, so that one can be taken for the other in a
 * picture, and because the lists of walls see no farther (ed.c, make_cells). */
static const double gap_max = 1e-3;

enum { NOBODY = UINT32_MAX };

/* A grain that is shown, at the place of its entry; `next` is in the same bin. */
struct seen { double x, y, vx, vy, radius; uint32_t i, next; };

/* Bins that hold the grains shown, by place; wider than a contact, so that it spans two at most. */
struct bins {
    struct seen *seen;          /* by entry */
    uint32_t    *first;         /* by bin */
    uint32_t     nx, ny;
    double       width_x, width_y;
};

static uint32_t bin_count(double length, double width, uint32_t grains)
{
    /* No more than about one a grain. */
    const double most = 2 + sqrt(grains);
    return (uint32_t)fmax(1, fmin(floor(length / width), most));
}

static bool make_bins(const struct ed *ed, struct bins *bins)
{
    const double *box = ed->scene->box, lx = box[2] - box[0], ly = box[3] - box[1];
    const double width = (2 + gap_max) * ed->scene->radius_max;
    bins->nx = bin_count(lx, width, ed->count);
    bins->ny = bin_count(ly, width, ed->count);
    bins->width_x = lx / bins->nx;
    bins->width_y = ly / bins->ny;
    bins->seen = malloc(ed->count * sizeof *bins->seen);
    bins->first = malloc((size_t)bins->nx * bins->ny * sizeof *bins->first);
    if (!bins->seen || !bins->first) return false;
    for (uint32_t b = 0; b < bins->nx * bins->ny; b++) bins->first[b] = NOBODY;
    return true;
}

/* Who is beyond an open border belongs to the bin along it. */
static int64_t bin_at(double x, double low, double width, uint32_t count)
{
    return (int64_t)fmin(fmax(floor((x - low) / width), 0), count - 1.0);
}

static uint32_t bin_of(const struct ed *ed, const struct bins *bins, const struct seen *s)
{
    const double *box = ed->scene->box;
    return (uint32_t)(bin_at(s->y, box[1], bins->width_y, bins->ny) * bins->nx
                      + bin_at(s->x, box[0], bins->width_x, bins->nx));
}

static double gap_tolerance(const struct ed *ed, double normal_speed)
{
    const double t_c = ed->law.t_c, g = hypot(ed->gx, ed->gy);
    const double gap = rounding_gap * 2 * ed->radius_one + t_c * (fabs(normal_speed)
                                                                  + bed_gap * g * t_c);
    return fmin(gap, gap_max * ed->scene->radius_min);
}

static void add_contact(struct grains *out, const struct contact *contact)
{
    if (out->contact_count == out->contact_capacity) out->missed++;
    else out->contacts[out->contact_count++] = *contact;
}

/* Entry b as seen from entry a, where it stands `up` boxes above. */
static void show_pair(const struct ed *ed, const struct bins *bins, uint32_t a, uint32_t b,
                      double up, struct grains *out)
{
    const struct seen *p = &bins->seen[a], *q = &bins->seen[b];
    const double ahead = up != 0 ? ed_shear_ahead(ed, ed_since_epoch(&ed->clock, out->time)) : 0;
    const double y = q->y - p->y + up * ed->wrap_y, away = q->x - p->x + up * ahead;
    const double x = away - ed->wrap_x * rint(away * ed->unwrap_x);
    const double distance = hypot(x, y), reach = p->radius + q->radius;
    const double widest = reach + gap_max * ed->scene->radius_min;
    if (!(distance > 0 && distance <= widest)) return;
    const double nx = x / distance, ny = y / distance;
    const double normal_speed = (q->vx - p->vx + up * ed->clock.shear_speed) * nx
                              + (q->vy - p->vy) * ny;
    if (distance - reach > gap_tolerance(ed, normal_speed)) return;
    add_contact(out, &(struct contact){
        .i = a, .j = b, .x = (float)(p->x + p->radius * nx), .y = (float)(p->y + p->radius * ny),
        .overlap = (float)fmax(reach - distance, 0)});
}

/* Contacts of entry a with the entries before it in row `row` of bins, columns around it. */
static void show_row(const struct ed *ed, const struct bins *bins, uint32_t a, int64_t row,
                     struct grains *out)
{
    const double *box = ed->scene->box;
    const struct seen *p = &bins->seen[a];
    double x = p->x, up = 0;
    if (row < 0 || row >= bins->ny) {
        if (ed->wrap_y == 0) return;
        up = row < 0 ? -1 : 1;
        row -= (int64_t)up * bins->ny;
        x -= up * ed_shear_ahead(ed, ed_since_epoch(&ed->clock, out->time));
        if (ed->wrap_x > 0) x -= ed->wrap_x * floor((x - box[0]) * ed->unwrap_x);
    }
    const int64_t middle = bin_at(x, box[0], bins->width_x, bins->nx);
    for (int64_t column = middle - 1; column <= middle + 1; column++) {
        int64_t bin = column;
        if (bin < 0 || bin >= bins->nx) {
            if (ed->wrap_x == 0) continue;
            bin += bin < 0 ? bins->nx : -(int64_t)bins->nx;
        }
        for (uint32_t b = bins->first[row * bins->nx + bin]; b != NOBODY;
             b = bins->seen[b].next) {
            if (b < a) show_pair(ed, bins, a, b, up, out);
        }
    }
}

/* A grain is near a wall at its nearest point; an end counts with the wall that answers for it. */
static void show_walls(const struct ed *ed, const struct seen *p, uint32_t entry,
                       struct grains *out)
{
    const struct ed_walls *walls = &ed->walls;
    if (!walls->start) return;
    const struct ed_event *e = &ed->events[p->i];
    const uint32_t cell = ed_cells_index(&ed->cells, e->cx, e->cy);
    for (uint32_t k = walls->start[cell]; k < walls->start[cell + 1]; k++) {
        const uint32_t w = walls->list[k];
        if (!wall_present(&walls->walls[w], out->time)) continue;
        const struct wall wall = wall_at(&walls->walls[w], out->time);
        const struct wall_nearest near = wall_nearest(&wall, p->x, p->y);
        if (near.end != 0 && !walls->now[w].ends[near.end - 1]) continue;
        const double normal_speed = (p->vx - wall.vx) * near.nx + (p->vy - wall.vy) * near.ny;
        const double gap = near.distance - p->radius;
        if (gap > gap_tolerance(ed, normal_speed)) continue;
        add_contact(out, &(struct contact){
            .i = entry, .j = CONTACT_WALL + w, .x = (float)(p->x - near.distance * near.nx),
            .y = (float)(p->y - near.distance * near.ny), .overlap = (float)fmax(-gap, 0)});
    }
}

static void show_contacts(const struct ed *ed, const struct bins *bins, struct grains *out)
{
    for (uint32_t a = 0; a < out->count; a++) {
        const struct seen *p = &bins->seen[a];
        const int64_t row = bin_at(p->y, ed->scene->box[1], bins->width_y, bins->ny);
        for (int64_t r = row - 1; r <= row + 1; r++) show_row(ed, bins, a, r, out);
        show_walls(ed, p, a, out);
    }
}

static void show_grain(const struct ed *ed, uint32_t i, const struct ed_path *p, double t,
                       struct grains *out, uint32_t k)
{
    if (out->id) out->id[k] = ed->id[i];
    if (out->x) out->x[k] = p->x;
    if (out->y) out->y[k] = p->y;
    if (out->vx) out->vx[k] = p->vx;
    if (out->vy) out->vy[k] = p->vy;
    if (out->angle) out->angle[k] = ed->spin ? ed->angle[i] + t * ed->spin[i] : 0;
    if (out->spin) out->spin[k] = ed->spin ? ed->spin[i] : 0;
    if (out->radius) out->radius[k] = ed_radius(ed, i);
    if (out->mass) out->mass[k] = ed_mass(ed, i);
    if (out->collision_rate) out->collision_rate[k] = ed->rate ? ed->rate[i] : 0;
    if (out->collisions) out->collisions[k] = ed->begun ? ed->begun[i] : 0;
    if (out->collisions_elastic) out->collisions_elastic[k] = ed->elastic ? ed->elastic[i] : 0;
    if (out->species) out->species[k] = (uint16_t)ed_species(ed, i);
}

void ed_look_observe(const void *state, struct grains *out)
{
    const struct ed *ed = state;
    const double t = ed_since_epoch(&ed->clock, ed->clock.present);
    const double *w = out->window;
    const bool all = w[0] > w[2];
    struct bins bins = {0};
    const bool touches = out->contacts && ed->count > 0 && make_bins(ed, &bins);
    out->time = ed->clock.present;
    out->count = out->contact_count = out->missed = 0;
    for (uint32_t i = 0; i < ed->count; i++) {
        const struct ed_path p = ed_shear_place(ed, i, t);
        const double r = ed_radius(ed, i);
        if (!all && (p.x + r < w[0] || p.y + r < w[1] || p.x - r > w[2] || p.y - r > w[3])) {
            continue;
        }
        if (out->count == out->capacity) {
            out->missed++;
            continue;
        }
        const uint32_t k = out->count++;
        show_grain(ed, i, &p, t, out, k);
        if (!touches) continue;
        bins.seen[k] = (struct seen){p.x, p.y, p.vx, p.vy, r, i, NOBODY};
        uint32_t *first = &bins.first[bin_of(ed, &bins, &bins.seen[k])];
        bins.seen[k].next = *first;
        *first = k;
    }
    if (touches) show_contacts(ed, &bins, out);
    free(bins.seen);
    free(bins.first);
}

void ed_look_count(const void *state, struct counters *out)
{
    const struct ed *ed = state;
    const struct ed_clock *c = &ed->clock;
    const double t = ed_since_epoch(c, c->present);
    *out = (struct counters){.time = c->present, .steps = c->events, .grains = ed->count,
        .grains_in = c->grains_in, .grains_out = c->grains_out, .collisions = c->collisions,
        .collisions_elastic = c->elastic, .rejected = c->refused, .rebuilds = c->epochs};
    for (uint32_t i = 0; i < ed->count; i++) {
        const struct ed_grain *g = &ed->grains[i];
        const double m = ed_mass(ed, i), r = ed_radius(ed, i);
        const double x = g->x + t * (g->vx + 0.5 * ed->gx * t);
        const double y = g->y + t * (g->vy + 0.5 * ed->gy * t), vy = g->vy + ed->gy * t;
        const double vx = ed->sheared ? ed_shear_place(ed, i, t).vx : g->vx + ed->gx * t;
        out->kinetic_energy += 0.5 * m * (vx * vx + vy * vy);
        out->potential_energy -= m * (ed->gx * x + ed->gy * y);
        out->momentum_x += m * vx;
        out->momentum_y += m * vy;
        if (!ed->spin) continue;
        const double inertia = ed->law.inertia_factor[ed_species(ed, i)] * m * r * r;
        out->rotational_energy += 0.5 * inertia * ed->spin[i] * ed->spin[i];
        out->tangential = c->collisions + c->wall_contacts;
    }
    out->overlap_max = NAN;
}
