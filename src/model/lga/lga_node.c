/* lga_node.c - nodes one at a time, in either form of the lattice: for filling, looking and walls,
 * not for the rules.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/lga/lga_bits.h"

#include <math.h>

struct lga_node lga_node_get(const struct lga *lga, uint32_t site)
{
    if (lga->bits) return lga_bits_node(lga, site);
    return (struct lga_node){lga->moving[site], lga->rest[site], lga->kind[site]};
}

void lga_node_set(struct lga *lga, uint32_t site, unsigned moving, unsigned rest)
{
    if (lga->bits) {
        lga_bits_set(lga, site, moving, rest);
        return;
    }
    lga->moving[site] = (uint8_t)moving;
    lga->rest[site] = (uint8_t)rest;
}

uint32_t lga_node_load(const struct lga *lga, uint32_t site)
{
    const struct lga_node node = lga_node_get(lga, site);
    return node.rest + (uint32_t)__builtin_popcount(node.moving);
}

uint32_t lga_node_beside(const struct lga *lga, uint32_t site, int direction)
{
    if (lga->beside) return lga->beside[site][direction];
    return lga_lattice_beside(&lga->lattice, site, direction);
}

void lga_node_set_kinds(struct lga *lga, double t)
{
    const struct lga_lattice *lattice = &lga->lattice;
    if (lga->bits) {
        lga_bits_rasterise(lga, t);
        return;
    }
    #pragma omp parallel for if (lga->sites >= LGA_LOOP_MIN)
    for (uint32_t row = 0; row < lattice->rows; row++) {
        lga_lattice_rasterise(lattice, lga->scene, t, row,
                              lga->kind + (size_t)row * lattice->columns);
    }
}

/* Column (row) number -> one that exists: around the torus. */
static uint32_t wrapped(int64_t number, uint32_t count)
{
    const int64_t rest = number % count;
    return (uint32_t)(rest < 0 ? rest + count : rest);
}

uint32_t lga_node_home(const struct lga *lga, double t, double x, double y)
{
    enum { RANGE = 3 };                         /* rows and columns to each side that are tried */
    const struct lga_lattice *lattice = &lga->lattice;
    const uint32_t centre = lga_lattice_nearest(lattice, x, y);
    if (lga_node_get(lga, centre).kind == LGA_FLUID
        && lga_lattice_same_side(lattice, lga->scene, t, centre, x, y)) return centre;
    const int64_t row0 = centre / lattice->columns, column0 = centre % lattice->columns;
    uint32_t best = LGA_NONE;
    double least = INFINITY;
    for (int j = -RANGE; j <= RANGE; j++) {
        for (int i = -RANGE; i <= RANGE; i++) {
            const uint32_t site = wrapped(row0 + j, lattice->rows) * lattice->columns
                                + wrapped(column0 + i, lattice->columns);
            const double distance = lga_lattice_distance(lattice, site, x, y);
            if (lga_node_get(lga, site).kind != LGA_FLUID || distance >= least) continue;
            if (!lga_lattice_same_side(lattice, lga->scene, t, site, x, y)) continue;
            best = site;
            least = distance;
        }
    }
    return best;
}
