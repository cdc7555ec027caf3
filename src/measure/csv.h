/* csv.h - maps and grains as tables: a header line, a line "# units: ...", then numbers that read
 * back to the same bits.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CSV_H
#define CSV_H

#include "base/error.h"
#include "measure/scatter.h"
#include "model/field.h"
#include "model/grains.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* x,y of each cell's centre and its value(s): "x,y,density" or "x,y,velocity_x,velocity_y";
 * cells without a value say nan. */
bool csv_save_field(const char *path, const struct field *field, const struct scene *scene,
                    struct error *error);

/* id,x,y,vx,vy,spin,radius,collision_rate,species */
bool csv_save_grains(const char *path, const struct grains *grains, const struct scene *scene,
                     struct error *error);

/* angle,count,mass,mass_error,momentum,spin of what crossed a screen, as scatter.h says; a third
 * line says at which angle the mass, of both sides together, is largest. */
bool csv_save_scatter(const char *path, const struct scatter *scatter, const struct scene *scene,
                      struct error *error);

/* The shortest digits that read back to the same value; "nan" and "inf" as such. */
void csv_number(FILE *stream, double value);

/* Several, each with `mark` before it. */
void csv_numbers(FILE *stream, char mark, const double *values, size_t count);

#endif
