/* map_kernel.h - how a grain is shared out among the cells of a map (internal to maps).
 *
 * Every kernel hands out weights that sum to one over the cells of the box, near walls too, so
 * number, mass, momentum and energy on the grid are those of the grains.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MAP_KERNEL_H
#define MAP_KERNEL_H

#include "model/grains.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

/* Sums that cost time and that only some fields need. */
enum { MAP_GATHER_AREA = 1, MAP_GATHER_SPIN = 2, MAP_GATHER_RATE = 4, MAP_GATHER_ALL = 7 };

/* What a cell has received.  Velocities are summed relative to that of the first grain, so the
 * variance of a fast uniform stream does not drown in the square of its mean.  What most fields
 * need fills the first cache line. */
struct map_cell {
    _Alignas(64) double count;          /* sum of w */
    double mass;                        /* m w */
    double first_vx, first_vy;
    double momentum_x, momentum_y;      /* m w (v - first) */
    double energy;                      /* m w |v - first|^2 */
    double area;                        /* of the discs in the cell */

    double first_spin;
    double inertia;                     /* m R^2 w: the moment of inertia but for its factor */
    double angular, angular_energy;     /* inertia * (spin - first), ... squared */
    double rate;                        /* w * collision rate */
};

struct map_grid {
    double   x0, y0, cell;
    double   columns, rows;             /* sides of the box in cells; the last may be cut short */
    uint32_t nx, ny;
    bool     periodic_x, periodic_y;
    int      kernel;                    /* enum kernel */
    double   width;                     /* standard deviation along each axis, in cells */
    uint32_t span;                      /* most cells along an axis that a grain reaches */
};

/* Cells along one axis that a grain reaches, with its distance from their centres. */
struct map_axis {
    uint32_t  count;
    uint32_t *index;
    double   *distance, *weight;
};

/* A part of the grains adds into cells of its own, so the sums do not depend on threads. */
struct map_part {
    struct map_cell *cells;             /* [ny][nx] */
    struct map_axis  x, y;              /* room for grid->span each, unless the kernel is a box */
    double          *weights;           /* Lucy: span * span */
};

/* Cells beyond which the kernel of this width (in cells) is cut. */
double map_kernel_reach(int kernel, double width);

/* Area of a cell inside the box, in units of a whole cell. */
double map_kernel_share(const struct map_grid *grid, uint32_t ix, uint32_t iy);

/* Adds grains from .. to-1; gathers what the bits of `gather` name. */
void map_kernel_add(const struct map_grid *grid, struct map_part *part,
                    const struct grains *grains, uint32_t from, uint32_t to, unsigned gather);


/* Shares a sample (enum field_sample) out among the cells that its cells cover. */
void map_kernel_add_sample(const struct map_grid *grid, struct map_cell *cells,
                           const struct field *sample);

#endif
