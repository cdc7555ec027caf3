/* field.h - numbers on a rectangular grid: what maps are made of.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef FIELD_H
#define FIELD_H

#include "base/error.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

struct field {
    char     name[32];          /* "density" */
    char     label[96];         /* with unit and "snapshot" or "mean t = 1 .. 2" for pictures */
    char     unit[24];
    double   time;
    double   x0, y0, cell;      /* corner of the grid and its constant */
    uint32_t nx, ny, components;        /* 1 scalar, 2 vector */
    double  *values;            /* [component][iy][ix]; row 0 is the lowest; NAN: no grains there */
};

enum {
    FIELD_CELLS_MAX = 16777216, /* of a map: 4096 x 4096 */
    FIELD_CELLS_CHOSEN = 1048576        /* if nobody says how many: about as many as pixels (each
                                           takes some hundred bytes while fields are gathered) */
};

/* The grid of maps over the scene's box: cells of measure.cell (absent: two mean diameters, in a
 * huge box more); along a periodic side the size is changed a little so that a whole number of them
 * fits (x first: with two periodic sides the last row may be cut short).  Returns the size of a
 * cell. */
double field_cells(const struct scene *scene, const struct measure *measure, double *nx,
                   double *ny);

/* The components of a sample: what stands in each cell of a grid, in sums over its grains. */
enum field_sample {
    SAMPLE_COUNT, SAMPLE_MASS, SAMPLE_AREA, SAMPLE_MOMENTUM_X, SAMPLE_MOMENTUM_Y,
    SAMPLE_ENERGY,              /* m v^2 */
    SAMPLE_SPEED,               /* |v| */
    SAMPLE_COMPONENTS
};

bool field_create(struct field *field, double x0, double y0, double cell, uint32_t nx,
                  uint32_t ny, uint32_t components, struct error *error);
void field_free(struct field *field);

#endif
