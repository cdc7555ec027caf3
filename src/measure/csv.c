/* csv.c - see csv.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/csv.h"

#include "base/file.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

void csv_number(FILE *stream, double value)
{
    char text[40];
    if (isnan(value)) {                 /* without the sign that printf may add */
        fputs("nan", stream);
        return;
    }
    for (int digits = 6; digits <= 17; digits += digits < 15 ? 9 : 1) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    fputs(text, stream);
}

void csv_numbers(FILE *stream, char mark, const double *values, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        fputc(mark, stream);
        csv_number(stream, values[k]);
    }
}

/* A unit for the units line; pure numbers say 1. */
static const char *unit_or_one(const char *unit) { return *unit ? unit : "1"; }

bool csv_save_field(const char *path, const struct field *field, const struct scene *scene,
                    struct error *error)
{
    static const char axes[] = "xyz";
    const size_t cells = (size_t)field->nx * field->ny;
    const char *length = unit_or_one(scene_unit(scene, "length"));
    struct file file;
    assert(field->components <= 3);
    if (!file_begin(&file, path, error)) return false;
    fprintf(file.stream, "x,y");
    for (uint32_t c = 0; c < field->components; c++) {
        fprintf(file.stream, ",%s", field->name);
        if (field->components > 1) fprintf(file.stream, "_%c", axes[c]);
    }
    fprintf(file.stream, "\n# units: %s,%s", length, length);
    for (uint32_t c = 0; c < field->components; c++) {
        fprintf(file.stream, ",%s", unit_or_one(field->unit));
    }
    for (size_t k = 0; k < cells; k++) {
        fputc('\n', file.stream);
        csv_number(file.stream, field->x0 + ((double)(k % field->nx) + 0.5) * field->cell);
        fputc(',', file.stream);
        csv_number(file.stream, field->y0 + ((double)(k / field->nx) + 0.5) * field->cell);
        for (uint32_t c = 0; c < field->components; c++) {
            fputc(',', file.stream);
            csv_number(file.stream, field->values[c * cells + k]);
        }
    }
    fputc('\n', file.stream);
    return file_commit(&file, error);
}

bool csv_save_grains(const char *path, const struct grains *grains, const struct scene *scene,
                     struct error *error)
{
    const char *length = unit_or_one(scene_unit(scene, "length"));
    const char *speed = unit_or_one(scene_unit(scene, "speed"));
    const char *rate = unit_or_one(scene_unit(scene, "1/time"));
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    fprintf(file.stream, "id,x,y,vx,vy,spin,radius,collision_rate,species\n"
            "# units: 1,%s,%s,%s,%s,%s,%s,%s,1\n",
            length, length, speed, speed, rate, length, rate);
    for (uint32_t k = 0; k < grains->count; k++) {
        const double numbers[] = {grains->x[k], grains->y[k], grains->vx[k], grains->vy[k],
                                  grains->spin[k], grains->radius[k]};
        fprintf(file.stream, "%" PRIu32, grains->id[k]);
        csv_numbers(file.stream, ',', numbers, sizeof numbers / sizeof *numbers);
        fprintf(file.stream, ",%.9g,%u\n", (double)grains->collision_rate[k],
                (unsigned)grains->species[k]);
    }
    return file_commit(&file, error);
}

static bool print_peak(FILE *stream, const struct scatter *scatter, struct error *error)
{
    const double reach = 6;     /* of the parabola, degrees: the peak is skew, a wide one leans */
    struct scatter folded;
    if (!scatter_fold(scatter, &folded, error)) return false;
    const struct scatter_peak peak = scatter_peak(&folded, reach);
    fprintf(stream, "# mass at both sides together is largest at %.1f +- %.1f degrees\n",
            peak.angle,
            peak.angle_error);
    scatter_free(&folded);
    return true;
}

bool csv_save_scatter(const char *path, const struct scatter *scatter, const struct scene *scene,
                      struct error *error)
{
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    fprintf(file.stream, "angle,count,mass,mass_error,momentum,spin\n"
            "# units: degrees,1,1/rad,1/rad,%s,%s\n", unit_or_one(scene_unit(scene, "momentum")),
            unit_or_one(scene_unit(scene, "angular momentum")));
    if (!print_peak(file.stream, scatter, error)) {
        file_abandon(&file);
        return false;
    }
    for (uint32_t k = 0; k < scatter->bins; k++) {
        const double numbers[] = {scatter->count[k], scatter->mass[k], scatter->mass_error[k],
                                  scatter->momentum[k], scatter->spin[k]};
        csv_number(file.stream, scatter->angle[k]);
        csv_numbers(file.stream, ',', numbers, sizeof numbers / sizeof *numbers);
        fputc('\n', file.stream);
    }
    return file_commit(&file, error);
}
