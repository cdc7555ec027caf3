/* md_look.c - see md_look.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/md/md_look.h"

#include "model/md/md_walls.h"

#include <math.h>
#include <stdlib.h>

enum { GROUP_MAX = 24, OUTSIDE = -1 };

/* A grain may be out of a periodic box until the next rebuild; nobody need know. */
static double wrapped(double x, double low, double high, bool periodic)
{
    if (!periodic) return x;
    return x < low ? x + (high - low) : x >= high ? x - (high - low) : x;
}

static void place_of(const struct md *md, const struct grain *g, double *x, double *y)
{
    const double *box = md->scene->box;
    *x = wrapped(g->x, box[0], box[2], md->scene->left == BORDER_PERIODIC);
    *y = wrapped(g->y, box[1], box[3], md->scene->bottom == BORDER_PERIODIC);
}

static bool is_seen(const struct grains *out, double x, double y, double radius)
{
    const double *w = out->window;
    return w[0] > w[2] || (x + radius >= w[0] && x - radius <= w[2]
                           && y + radius >= w[1] && y - radius <= w[3]);
}

static void show_grain(const struct md *md, uint32_t i, struct grains *out, uint32_t at)
{
    const struct grain *g = &md->grains[i];
    const double radius = md_radius(md, i);
    double x, y;
    place_of(md, g, &x, &y);
    if (out->id) out->id[at] = md->tags[i].id;
    if (out->x) out->x[at] = x;
    if (out->y) out->y[at] = y;
    if (out->vx) out->vx[at] = g->ux;
    if (out->vy) out->vy[at] = g->uy;
    if (out->angle) out->angle[at] = md->turns ? md->turns[i].angle / radius : 0;
    if (out->spin) out->spin[at] = md_rim(md, i) / radius;
    if (out->radius) out->radius[at] = radius;
    if (out->mass) out->mass[at] = 1 / md_inverse_mass(md, i);
    if (out->collision_rate) {
        out->collision_rate[at] = md->collision_rate ? md->collision_rate[i] : 0;
    }
    if (out->species) out->species[at] = md->tags[i].species;
}

/* The contact of one link, its force and energy; false if the two do not touch. */
struct pair_touch { double nx, ny, overlap, fx, fy, energy, smaller; };

static bool touch_pair(const struct md *md, uint32_t k, struct pair_touch *touch)
{
    const struct link link = md->links[k];
    const uint32_t i = link.i, j = link.j & LINK_INDEX, image = link.j >> LINK_IMAGE_SHIFT & 15;
    const struct grain *a = &md->grains[i], *b = &md->grains[j];
    const double ri = md_radius(md, i), rj = md_radius(md, j);
    const double dx = a->x - b->x - md->image_x[image], dy = a->y - b->y - md->image_y[image];
    const double distance = sqrt(dx * dx + dy * dy), reach = ri + rj;
    if (!(distance < reach)) return false;
    const double nx = dx / distance, ny = dy / distance;
    const double ux = a->ux - b->ux, uy = a->uy - b->uy;
    const struct md_pair_law *law = md_pair_law(md, md->tags[i].species, md->tags[j].species);
    const struct md_touch contact = {
        .overlap = reach - distance, .closing = -(ux * nx + uy * ny),
        .slip = uy * nx - ux * ny - distance / reach * (md_rim(md, i) + md_rim(md, j)),
        .mass = 1 / (md_inverse_mass(md, i) + md_inverse_mass(md, j)),
        .radius = ri * rj / reach, .spring = md->springs ? md->springs[k] : 0, .dt = md->dt,
    };
    const struct md_force_out force = md_law_force(&md->law, law, &contact);
    *touch = (struct pair_touch){
        .nx = nx, .ny = ny, .overlap = contact.overlap, .smaller = fmin(ri, rj),
        .fx = force.normal * nx - force.tangential * ny,
        .fy = force.normal * ny + force.tangential * nx,
        .energy = md_law_energy(&md->law, law, contact.overlap, contact.radius,
                                force.stretched),
    };
    return true;
}

static void add_contact(struct grains *out, const struct contact *contact)
{
    if (out->contact_count == out->contact_capacity) out->missed++;
    else out->contacts[out->contact_count++] = *contact;
}

/* `entry` gives the entry of each grain in `out`, or OUTSIDE. */
static void show_contacts(const struct md *md, const int64_t *entry, struct grains *out)
{
    for (uint32_t k = 0; k < md->link_count; k++) {
        const struct link link = md->links[k];
        const int64_t i = entry[link.i], j = entry[link.j & LINK_INDEX];
        struct pair_touch touch;
        if (i == OUTSIDE || j == OUTSIDE || !touch_pair(md, k, &touch)) continue;
        double x, y;
        place_of(md, &md->grains[link.i], &x, &y);
        const double arm = md_radius(md, link.i) - 0.5 * touch.overlap;
        add_contact(out, &(struct contact){
            .i = (uint32_t)i, .j = (uint32_t)j, .x = (float)(x - arm * touch.nx),
            .y = (float)(y - arm * touch.ny), .fx = (float)touch.fx, .fy = (float)touch.fy,
            .overlap = (float)touch.overlap,
        });
    }
    struct md_wall_touch touches[GROUP_MAX];
    for (uint32_t k = 0; k < md->wall_link_count;) {
        const uint32_t first = k, i = md->wall_links[k].grain;
        while (k < md->wall_link_count && md->wall_links[k].grain == i
               && k - first < GROUP_MAX) k++;
        if (entry[i] == OUTSIDE) continue;
        md_walls_touch(md, first, k, touches);
        for (uint32_t o = 0; o < k - first; o++) {
            if (!touches[o].counts) continue;
            const struct wall_nearest *nearest = &touches[o].nearest;
            double x, y;
            place_of(md, &md->grains[i], &x, &y);
            add_contact(out, &(struct contact){
                .i = (uint32_t)entry[i], .j = CONTACT_WALL + md->wall_links[first + o].wall,
                .x = (float)(x - nearest->distance * nearest->nx),
                .y = (float)(y - nearest->distance * nearest->ny),
                .fx = (float)touches[o].fx, .fy = (float)touches[o].fy,
                .overlap = (float)touches[o].overlap,
            });
        }
    }
}

void md_look_observe(const void *state, struct grains *out)
{
    const struct md *md = state;
    out->time = md_time(md);
    out->count = out->contact_count = out->missed = 0;
    int64_t *entry = out->contacts && md->count > 0 ? malloc(md->count * sizeof *entry) : NULL;
    for (uint32_t i = 0; i < md->count; i++) {
        const struct grain *g = &md->grains[i];
        double x, y;
        place_of(md, g, &x, &y);
        if (entry) entry[i] = OUTSIDE;
        if (md->tags[i].gone || !is_seen(out, x, y, md_radius(md, i))) continue;
        if (out->count == out->capacity) {
            out->missed++;
            continue;
        }
        if (entry) entry[i] = out->count;
        show_grain(md, i, out, out->count++);
    }
    if (entry) show_contacts(md, entry, out);
    free(entry);
}

static void count_grains(const struct md *md, struct counters *out)
{
    const double *gravity = md->scene->gravity;
    for (uint32_t i = 0; i < md->count; i++) {
        const struct grain *g = &md->grains[i];
        if (md->tags[i].gone) continue;
        const double mass = 1 / md_inverse_mass(md, i);
        out->kinetic_energy += 0.5 * mass * (g->ux * g->ux + g->uy * g->uy);
        if (md->traits) {
            const struct trait *t = &md->traits[i];
            out->rotational_energy += 0.5 * mass / t->inverse_inertia * t->rim * t->rim;
        }
        out->potential_energy -= mass * (gravity[0] * g->x + gravity[1] * g->y);
        out->momentum_x += mass * g->ux;
        out->momentum_y += mass * g->uy;
    }
}

void md_look_count(const void *state, struct counters *out)
{
    const struct md *md = state;
    *out = (struct counters){
        .time = md_time(md), .steps = md->steps, .grains = md->count, .grains_in = md->grains_in,
        .grains_out = md->grains_out, .collisions = md->begun, .tangential = md->tangential,
        .rejected = md->rejected, .rebuilds = md->rebuilds,
    };
    count_grains(md, out);
    for (uint32_t k = 0; k < md->link_count; k++) {
        struct pair_touch touch;
        if (!touch_pair(md, k, &touch)) continue;
        out->potential_energy += touch.energy;
        out->overlap_max = fmax(out->overlap_max, touch.overlap / touch.smaller);
    }
    struct md_wall_touch touches[GROUP_MAX];
    for (uint32_t k = 0; k < md->wall_link_count;) {
        const uint32_t first = k, i = md->wall_links[k].grain;
        while (k < md->wall_link_count && md->wall_links[k].grain == i
               && k - first < GROUP_MAX) k++;
        md_walls_touch(md, first, k, touches);
        for (uint32_t o = 0; o < k - first; o++) {
            if (!touches[o].counts) continue;
            out->potential_energy += touches[o].energy;
            out->overlap_max = fmax(out->overlap_max, touches[o].overlap / md_radius(md, i));
        }
    }
}
