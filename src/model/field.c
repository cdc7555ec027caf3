/* field.c - see field.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/field.h"

#include <stdlib.h>

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
