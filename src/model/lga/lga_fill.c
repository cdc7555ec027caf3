/* lga_fill.c - grains that come to the lattice from outside: those placed by the scene, those of
 * its sources, and those that a closing gate has caught.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/lga/lga.h"

#include "base/rng.h"

#include <math.h>

/* A grain at rest, or one that flies. */
enum { AT_REST = -1 };

/* Room for a grain that flies in direction d, or rests. */
static bool has_room(const struct lga *lga, uint32_t site, int d)
{
    const struct lga_node node = lga_node_get(lga, site);
    if (lga->rule.method == LGA_GMLG) return lga_node_load(lga, site) < LGA_ROOM;
    return node.rest == 0 || (d != AT_REST && !(node.moving >> d & 1));
}

static bool mark_seen(struct lga *lga, uint32_t site)
{
    const uint64_t bit = 1ull << site % 64;
    if (lga->seen[site / 64] & bit) return false;
    lga->seen[site / 64] |= bit;
    return true;
}

/* The first node with room, ring by ring from `home` through fluid nodes; LGA_NONE if the first
 * `limit` of them are full. */
static uint32_t find_room(struct lga *lga, uint32_t home, int direction, uint32_t limit)
{
    uint32_t head = 0, tail = 0, found = LGA_NONE;
    mark_seen(lga, home);
    lga->queue[tail++] = home;
    while (head < tail && head < limit) {
        const uint32_t site = lga->queue[head++];
        if (has_room(lga, site, direction)) {
            found = site;
            break;
        }
        for (int d = 0; d < LGA_DIRECTIONS && tail < lga->queue_length; d++) {
            const uint32_t next = lga_node_beside(lga, site, d);
            if (lga_node_get(lga, next).kind != LGA_FLUID || !mark_seen(lga, next)) continue;
            lga->queue[tail++] = next;
        }
    }
    for (uint32_t k = 0; k < tail; k++) lga->seen[lga->queue[k] / 64] = 0;
    return found;
}

/* The direction in which a grain of this velocity flies: it does if it is faster than half of the
 * lattice's one speed. */
static int direction_of(const struct lga *lga, double vx, double vy)
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
    return hypot(vx, vy) * lga->tick > 0.5 * lga->lattice.spacing ? best : AT_REST;
}

/* Puts a grain onto a node with room; it rests if its slot is taken. */
static void put(struct lga *lga, uint32_t site, int d)
{
    struct lga_node node = lga_node_get(lga, site);
    if (d != AT_REST && !(node.moving >> d & 1)) node.moving |= (uint8_t)(1u << d);
    else node.rest++;
    lga_node_set(lga, site, node.moving, node.rest);
}

/* Movers in a share of all slots, and nothing else: for lattices too large to list. */
static void fill_at_random(struct lga *lga, double share)
{
    const uint32_t columns = lga->lattice.columns;
    #pragma omp parallel for if (lga->sites >= LGA_LOOP_MIN)
    for (uint32_t row = 0; row < lga->lattice.rows; row++) {
        for (uint32_t n = row * columns; n < (row + 1) * columns; n++) {
            if (lga_node_get(lga, n).kind != LGA_FLUID) continue;
            unsigned moving = 0;
            for (uint64_t d = 0; d < LGA_DIRECTIONS; d++) {
                const uint64_t word = rng_keyed(lga->seed, UINT64_MAX - 1, n, d);
                moving |= (unsigned)(rng_unit(word) < share) << d;
            }
            lga_node_set(lga, n, moving, 0);
        }
    }
}

bool lga_fill_placed(struct lga *lga, struct error *error)
{
    const struct placed *placed = &lga->scene->placed;
    if (lga->fill > 0) fill_at_random(lga, lga->fill);
    for (uint32_t i = 0; i < placed->count; i++) {
        const double x = placed->x[i], y = placed->y[i];
        const uint32_t home = lga_node_home(lga, 0, x, y);
        if (home == LGA_NONE) {
            return error_set_code(error, EXIT_SCENE, "%s: the grain at (%g, %g) lies where walls "
                "leave the lattice no node; give lga.spacing a smaller value than %g",
                lga->scene->path, x, y, lga->lattice.spacing);
        }
        const int direction = direction_of(lga, placed->vx[i], placed->vy[i]);
        const uint32_t site = find_room(lga, home, direction, lga->sites);
        if (site == LGA_NONE) {
            return error_set_code(error, EXIT_SCENE, "%s: the lattice is full after %u of %u "
                "grains; give lga.spacing a smaller value than %g, or place "
                "fewer grains", lga->scene->path, i, placed->count, lga->lattice.spacing);
        }
        put(lga, site, direction);
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
        const int direction = direction_of(lga, source->velocity[0], source->velocity[1]);
        while (lga->entered[k] < due(source, t)) {
            const uint64_t word = rng_keyed(lga->seed, UINT64_MAX, k, lga->entered[k]);
            const double x = source->position[0] + source->width * (rng_unit(word) - 0.5);
            const uint32_t home = lga_node_home(lga, t, x, source->position[1]);
            const uint32_t site = home == LGA_NONE ? home
                                                   : find_room(lga, home, direction, RINGS_NODES);
            if (site == LGA_NONE) break;        /* no room: it comes when there is */
            put(lga, site, direction);
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
        struct lga_node node = lga_node_get(lga, n);
        if (node.kind == LGA_FLUID) continue;
        uint32_t caught = lga_node_load(lga, n);
        if (caught == 0) continue;
        if (node.kind == LGA_SINK) {
            lga->grains_out += caught;
            lga_node_set(lga, n, 0, 0);
            continue;
        }
        double x, y;
        lga_lattice_position(&lga->lattice, n, &x, &y);
        const uint32_t home = lga_node_home(lga, t, x, y);
        for (; caught > 0 && home != LGA_NONE; caught--) {
            const uint32_t site = find_room(lga, home, AT_REST, lga->sites);
            if (site == LGA_NONE) break;
            if (node.rest > 0) node.rest--;
            else node.moving = (uint8_t)(node.moving & (node.moving - 1u));
            lga_node_set(lga, n, node.moving, node.rest);
            put(lga, site, AT_REST);
        }
        lga->trapped |= caught > 0;
    }
}
