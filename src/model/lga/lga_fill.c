/* lga_fill.c - grains that come to the lattice from outside: those placed by the scene, those of
 * its sources, and those that a closing gate has caught.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/lga/lga.h"

#include "base/rng.h"

#include <math.h>

static uint32_t load_of(const struct lga *lga, uint32_t site)
{
    return lga->rest[site] + (uint32_t)__builtin_popcount(lga->moving[site]);
}

/* The first node with room, ring by ring from `home` through fluid nodes; LGA_NONE if the first
 * `limit` of them are full. */
static uint32_t find_room(struct lga *lga, uint32_t home, uint32_t limit)
{
    uint32_t head = 0, tail = 0;
    lga->searches++;
    lga->queue[tail++] = home;
    lga->stamp[home] = lga->searches;
    while (head < tail && head < limit) {
        const uint32_t site = lga->queue[head++];
        if (load_of(lga, site) < LGA_ROOM) return site;
        for (int d = 0; d < LGA_DIRECTIONS; d++) {
            const uint32_t next = lga->beside[site][d];
            if (lga->kind[next] != LGA_FLUID || lga->stamp[next] == lga->searches) continue;
            lga->stamp[next] = lga->searches;
            lga->queue[tail++] = next;
        }
    }
    return LGA_NONE;
}

/* Puts a grain onto a node with room: it flies if it is faster than half of the lattice's one
 * speed and the slot is free, else it rests. */
static void put(struct lga *lga, uint32_t site, double vx, double vy)
{
    int best = 0;
    double most = -INFINITY;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        double cx, cy;
        lga_lattice_vector(&lga->lattice, d * M_PI / 3, &cx, &cy);
        const double along = (cx * vx + cy * vy) / hypot(cx, cy);
        if (along <= most) continue;
        most = along;
        best = d;
    }
    const bool flies = hypot(vx, vy) * lga->tick > 0.5 * lga->lattice.spacing;
    if (flies && !(lga->moving[site] >> best & 1)) lga->moving[site] |= (uint8_t)(1u << best);
    else lga->rest[site]++;
}

bool lga_fill_placed(struct lga *lga, struct error *error)
{
    const struct placed *placed = &lga->scene->placed;
    for (uint32_t i = 0; i < placed->count; i++) {
        const double x = placed->x[i], y = placed->y[i];
        const uint32_t home = lga_lattice_home(&lga->lattice, lga->scene, 0, lga->kind, x, y);
        if (home == LGA_NONE) {
            return error_set_code(error, EXIT_SCENE, "%s: the grain at (%g, %g) lies where walls "
                "leave the lattice no node; give lga.spacing a smaller value than %g",
                lga->scene->path, x, y, lga->lattice.spacing);
        }
        const uint32_t site = find_room(lga, home, lga->sites);
        if (site == LGA_NONE) {
            return error_set_code(error, EXIT_SCENE, "%s: the lattice is full after %u of %u "
                "grains, seven to a node; give lga.spacing a smaller value than %g, or place "
                "fewer grains", lga->scene->path, i, placed->count, lga->lattice.spacing);
        }
        put(lga, site, placed->vx[i], placed->vy[i]);
    }
    return true;
}

/* How many grains a source should have given by time t. */
static uint64_t due(const struct source *source, double t)
{
    const double on = fmin(t, source->to) - source->from;
    if (!(on > 0)) return 0;
    const double given = floor(source->rate * on);
    const double most = source->count ? source->count : 0x1p53;
    return (uint64_t)fmin(given, most);
}

void lga_fill_sources(struct lga *lga)
{
    enum { RINGS_NODES = 19 };          /* the node itself and two rings around it */
    const double t = lga_step_time(lga);
    for (uint32_t k = 0; k < lga->scene->source_count; k++) {
        const struct source *source = &lga->scene->sources[k];
        while (lga->entered[k] < due(source, t)) {
            const uint64_t word = rng_keyed(lga->seed, UINT64_MAX, k, lga->entered[k]);
            const double x = source->position[0] + source->width * (rng_unit(word) - 0.5);
            const uint32_t home = lga_lattice_home(&lga->lattice, lga->scene, t, lga->kind, x,
                                                   source->position[1]);
            const uint32_t site = home == LGA_NONE ? home : find_room(lga, home, RINGS_NODES);
            if (site == LGA_NONE) break;        /* no room: it comes when there is */
            put(lga, site, source->velocity[0], source->velocity[1]);
            lga->entered[k]++;
            lga->grains_in++;
        }
    }
}

void lga_fill_release_trapped(struct lga *lga)
{
    lga->trapped = false;
    const double t = lga_step_time(lga);
    for (uint32_t n = 0; n < lga->sites; n++) {
        if (lga->kind[n] == LGA_FLUID) continue;
        uint32_t caught = load_of(lga, n);
        if (caught == 0) continue;
        if (lga->kind[n] == LGA_SINK) {
            lga->grains_out += caught;
            lga->rest[n] = lga->moving[n] = 0;
            continue;
        }
        double x, y;
        lga_lattice_position(&lga->lattice, n, &x, &y);
        const uint32_t home = lga_lattice_home(&lga->lattice, lga->scene, t, lga->kind, x, y);
        for (; caught > 0 && home != LGA_NONE; caught--) {
            const uint32_t site = find_room(lga, home, lga->sites);
            if (site == LGA_NONE) break;
            if (lga->rest[n] > 0) lga->rest[n]--;
            else lga->moving[n] = (uint8_t)(lga->moving[n] & (lga->moving[n] - 1u));
            lga->rest[site]++;
        }
        lga->trapped |= caught > 0;
    }
}
