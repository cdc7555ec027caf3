/* field.c - see field.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/field.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Number of cells along a side; the last may stick out and is then cut short. */
static double side_cells(double length, double cell) { return ceil(length / cell - 1e-9); }

double field_cells(const struct scene *scene, const struct measure *measure, double *nx,
                   double *ny)
{
    const double *box = scene->box, lx = box[2] - box[0], ly = box[3] - box[1];
    assert(lx > 0);
    assert(ly > 0);
    double cell = measure->cell;
    if (isnan(cell)) cell = 4 * scene->radius_mean;     /* two mean diameters */
    if (!(cell > 0)) cell = fmax(lx, ly) / 64;
    /* A box of a billion nodes has a map too; 1 % is for the rounding of sides. */
    if (isnan(measure->cell)) cell = fmax(cell, 1.01 * sqrt(lx * ly / FIELD_CELLS_MAX));
    cell = fmin(cell, fmin(lx, ly));
    if (scene->left == BORDER_PERIODIC) cell = lx / fmax(1, round(lx / cell));
    else if (scene->bottom == BORDER_PERIODIC) cell = ly / fmax(1, round(ly / cell));
    *nx = side_cells(lx, cell);
    *ny = side_cells(ly, cell);
    return cell;
}

bool field_create(struct field *field, double x0, double y0, double cell, uint32_t nx,
                  uint32_t ny, uint32_t components, struct error *error)
{
    *field = (struct field){.x0 = x0, .y0 = y0, .cell = cell, .nx = nx, .ny = ny,
                            .components = components};
    field->values = calloc((size_t)nx * ny * components, sizeof *field->values);
    return field->values
        || error_set(error, "not enough memory for a map of %u x %u cells", nx, ny);
}

void field_free(struct field *field)
{
    free(field->values);
    *field = (struct field){0};
}
