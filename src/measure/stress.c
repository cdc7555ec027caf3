/* stress.c - see stress.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/stress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sums over the grains of a cell. */
struct moments { double m, mx, my, mxx, mxy, myy; };

struct stress {
    const struct scene *scene;
    double   cell;
    uint32_t nx, ny, snapshots;
    double   from;              /* time of stress_begin */
    double  *before;            /* the tally's sums then */
    struct moments *moments;
    struct arena arena;
};

static const struct kind { const char *name, *label; uint32_t components; } kinds[] = {
#define X(name, components, label) {#name, label, components},
    STRESS_FIELDS(X)
#undef X
};

static void moments_add(struct moments *sum, double m, double vx, double vy)
{
    sum->m += m;
    sum->mx += m * vx;
    sum->my += m * vy;
    sum->mxx += m * vx * vx;
    sum->mxy += m * vx * vy;
    sum->myy += m * vy * vy;
}

/* Minus the sum of m v'_a v'_b about the mean velocity. */
static void moments_stress(const struct moments *sum, double out[3])
{
    const double m = sum->m > 0 ? sum->m : 1;
    out[0] = sum->mx * sum->mx / m - sum->mxx;
    out[1] = sum->mx * sum->my / m - sum->mxy;
    out[2] = sum->my * sum->my / m - sum->myy;
}

void stress_kinetic(const struct grains *grains, const struct scene *scene, double out[3])
{
    const double *box = scene->box, area = (box[2] - box[0]) * (box[3] - box[1]);
    const double rate = scene->shear_rate, middle = 0.5 * (box[1] + box[3]);
    struct moments sum = {0};
    for (uint32_t i = 0; i < grains->count; i++) {
        const double imposed = rate * (grains->y[i] - middle);
        moments_add(&sum, grains->mass[i], grains->vx[i] - imposed, grains->vy[i]);
    }
    moments_stress(&sum, out);
    for (int k = 0; k < 3; k++) out[k] /= area;
}

struct stress *stress_create(const struct scene *scene, struct error *error)
{
    double nx, ny;
    const double cell = field_cells(scene, &scene->measure, &nx, &ny);
    struct stress *stress = calloc(1, sizeof *stress);
    if (!stress || nx * ny > FIELD_CELLS_MAX) {
        free(stress);
        error_set(error, "no memory for maps of the stress with %.0f x %.0f cells; make "
                  "measure.cell larger", nx, ny);
        return NULL;
    }
    *stress = (struct stress){.scene = scene, .cell = cell, .nx = (uint32_t)nx,
                              .ny = (uint32_t)ny};
    const size_t cells = (size_t)stress->nx * stress->ny;
    if (arena_array(&stress->arena, &stress->before, 4 * cells)
        && arena_array(&stress->arena, &stress->moments, cells)) return stress;
    stress_destroy(stress);
    error_set(error, "not enough memory for maps of the stress");
    return NULL;
}

void stress_destroy(struct stress *stress)
{
    if (!stress) return;
    arena_free(&stress->arena);
    free(stress);
}

static bool has_sums(const struct stress *stress, const struct tally *tally)
{
    return tally && tally->stress.cells && tally->stress.nx == stress->nx
        && tally->stress.ny == stress->ny;
}

void stress_begin(struct stress *stress, const struct tally *tally, double time)
{
    const size_t cells = (size_t)stress->nx * stress->ny;
    stress->from = time;
    stress->snapshots = 0;
    memset(stress->moments, 0, cells * sizeof *stress->moments);
    if (has_sums(stress, tally)) {
        memcpy(stress->before, tally->stress.cells, 4 * cells * sizeof *stress->before);
    } else {
        memset(stress->before, 0, 4 * cells * sizeof *stress->before);
    }
}

static uint32_t cell_of(double way, double cell, uint32_t count)
{
    const double place = way / cell;
    if (!(place > 0)) return 0;
    return place < count ? (uint32_t)place : count - 1;
}

void stress_add(struct stress *stress, const struct grains *grains)
{
    const double *box = stress->scene->box;
    for (uint32_t i = 0; i < grains->count; i++) {
        const uint32_t cx = cell_of(grains->x[i] - box[0], stress->cell, stress->nx),
                       cy = cell_of(grains->y[i] - box[1], stress->cell, stress->ny);
        moments_add(&stress->moments[(size_t)cy * stress->nx + cx], grains->mass[i],
                    grains->vx[i], grains->vy[i]);
    }
    stress->snapshots++;
}

/* The area of a cell; the last of a row or column may stick out of the box. */
static double cell_area(const struct stress *stress, uint32_t cx, uint32_t cy)
{
    const double *box = stress->scene->box, c = stress->cell;
    return fmin(c, box[2] - box[0] - cx * c) * fmin(c, box[3] - box[1] - cy * c);
}

bool stress_field(const struct stress *stress, enum stress_kind kind, const struct tally *tally,
                  double time, struct field *field, struct error *error)
{
    const uint32_t components = kinds[kind].components;
    const size_t cells = (size_t)stress->nx * stress->ny;
    if (!field_create(field, stress->scene->box[0], stress->scene->box[1], stress->cell,
                      stress->nx, stress->ny, components, error)) {
        return false;
    }
    const char *unit = scene_unit(stress->scene, "stress");
    snprintf(field->name, sizeof field->name, "%s", kinds[kind].name);
    snprintf(field->unit, sizeof field->unit, "%s", unit);
    snprintf(field->label, sizeof field->label, "%s%s%s%s, t = %.4g .. %.4g", kinds[kind].label,
             *unit ? " (" : "", unit, *unit ? ")" : "", stress->from, time);
    field->time = time;
    const double span = time - stress->from;
    for (size_t k = 0; k < cells; k++) {
        const double area = cell_area(stress, (uint32_t)(k % stress->nx),
                                      (uint32_t)(k / stress->nx));
        double carried[3] = {NAN, NAN, NAN}, flying[3];
        if (has_sums(stress, tally) && span > 0) {
            const double *now = tally->stress.cells + 4 * k, *then = stress->before + 4 * k;
            carried[0] = (now[0] - then[0]) / (span * area);
            carried[1] = 0.5 * (now[1] - then[1] + now[2] - then[2]) / (span * area);
            carried[2] = (now[3] - then[3]) / (span * area);
        }
        moments_stress(&stress->moments[k], flying);
        for (int c = 0; c < 3; c++) flying[c] /= area * fmax(stress->snapshots, 1);
        const double *values = kind == STRESS_stress_collisional ? carried : flying;
        for (uint32_t c = 0; c < components; c++) field->values[c * cells + k] = values[c];
        if (kind == STRESS_pressure) {
            field->values[k] = -0.5 * (carried[0] + carried[2] + flying[0] + flying[2]);
        }
    }
    return true;
}

void stress_archive(struct stress *stress, struct archive *archive)
{
    const size_t cells = (size_t)stress->nx * stress->ny;
    archive_value(archive, "stress.from", &stress->from);
    archive_value(archive, "stress.snapshots", &stress->snapshots);
    archive_array(archive, "stress.before", stress->before, 4 * cells);
    archive_array(archive, "stress.moments", stress->moments, cells);
}
