/* map.c - see map.h.
 *
 * The grains of a snapshot are split into a number of parts that depends on the grid alone, and
 * each part adds into cells of its own for the whole life of the map; the parts meet, in order,
 * when a field is asked for.  So the bytes of a map do not depend on the number of threads.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "measure/map.h"

#include "measure/map_kernel.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PART_MAX = 8 };

static const double parts_bytes_max = 64e6;     /* more memory than this is not worth a thread */
static const double width_max = 64;             /* cells; wider kernels cost 1e5 cells a grain */
static const uint32_t worth_threads = 20000;    /* grains */

struct map {
    const struct scene *scene;          /* for units */
    struct map_grid grid;
    unsigned gather;
    uint32_t part_count;
    struct map_part parts[PART_MAX];
    uint32_t snapshots;
    double   from, to;                  /* times of the first and the last snapshot */
    struct arena arena;
};

static const struct kind { const char *name, *dimension, *label; uint32_t components; } kinds[] = {
#define X(name, components, dimension, label) {#name, dimension, label, components},
    MAPS(X)
#undef X
};

int map_find(const char *name)
{
    for (int k = 0; k < MAP_KINDS; k++) if (strcmp(kinds[k].name, name) == 0) return k;
    return -1;
}

static unsigned kind_gather(int kind)
{
    if (kind == MAP_area_fraction) return MAP_GATHER_AREA;
    if (kind == MAP_spin_temperature) return MAP_GATHER_SPIN;
    return kind == MAP_collisions ? MAP_GATHER_RATE : 0;
}

/* The sums that the fields named need; no names: all. */
static bool find_gather(const struct measure *measure, const char *path, unsigned *gather,
                        struct error *error)
{
    *gather = measure->fields.count > 0 ? 0 : MAP_GATHER_ALL;
    for (uint32_t k = 0; k < measure->fields.count; k++) {
        const int kind = map_find(measure->fields.texts[k]);
        if (kind < 0) {
            char names[200];
            size_t used = 0;
            for (int n = 0; n < MAP_KINDS && used < sizeof names; n++) {
                used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", n ? ", " : "",
                                         kinds[n].name);
            }
            return error_set_code(error, EXIT_SCENE, "%s: there is no field '%s' to measure; use "
                                  "one of %s", path, measure->fields.texts[k], names);
        }
        *gather |= kind_gather(kind);
    }
    return true;
}

static bool grid_set(struct map_grid *grid, const struct scene *scene,
                     const struct measure *measure, struct error *error)
{
    const double *box = scene->box, lx = box[2] - box[0], ly = box[3] - box[1];
    const bool periodic_x = scene->left == BORDER_PERIODIC;
    const bool periodic_y = scene->bottom == BORDER_PERIODIC;
    double nx, ny;
    const double cell = field_cells(scene, measure, &nx, &ny);
    if (nx * ny > FIELD_CELLS_MAX) {
        return error_set_code(error, EXIT_SCENE, "%s: a map of %.0f x %.0f cells is too large; "
            "make measure.cell at least %.3g", scene->path, nx, ny,
            sqrt(lx * ly / FIELD_CELLS_MAX));
    }
    const double width = isnan(measure->width) ? 1 : measure->width / cell;
    if (measure->kernel != KERNEL_BOX && !(width > 0 && width <= width_max)) {
        return error_set_code(error, EXIT_SCENE, "%s: measure.width is %.3g cells of the map; it "
            "must be above 0 and at most %.0f: change it or measure.cell", scene->path, width,
            width_max);
    }
    *grid = (struct map_grid){
        .x0 = box[0], .y0 = box[1], .cell = cell, .nx = (uint32_t)nx, .ny = (uint32_t)ny,
        .columns = fmin(lx / cell, nx), .rows = fmin(ly / cell, ny),
        .periodic_x = periodic_x, .periodic_y = periodic_y,
        .kernel = measure->kernel, .width = width};
    if (periodic_x) grid->columns = nx;
    else if (periodic_y) grid->rows = ny;
    /* Cut cells at a periodic seam may put two more cells within reach, twice at most a box. */
    const double reach = map_kernel_reach(grid->kernel, width);
    const double seams = 2 * reach / fmin(grid->columns, grid->rows) + 2;
    grid->span = (uint32_t)(2 * reach + seams) + 2;
    return true;
}

static bool axis_create(struct map_axis *axis, uint32_t span, struct arena *arena)
{
    return arena_array(arena, &axis->index, span) && arena_array(arena, &axis->distance, span)
        && arena_array(arena, &axis->weight, span);
}

static bool part_create(struct map_part *part, const struct map_grid *grid, struct arena *arena)
{
    const bool smooth = grid->kernel != KERNEL_BOX, lucy = grid->kernel == KERNEL_LUCY;
    const size_t span = smooth ? grid->span : 0;
    return arena_array(arena, &part->cells, (size_t)grid->nx * grid->ny)
        && axis_create(&part->x, (uint32_t)span, arena)
        && axis_create(&part->y, (uint32_t)span, arena)
        && arena_array(arena, &part->weights, lucy ? span * span : 0);
}

struct map *map_create(const struct scene *scene, const struct measure *measure,
                       struct error *error)
{
    struct map_grid grid;
    unsigned gather;
    if (!find_gather(measure, scene->path, &gather, error)) return NULL;
    if (!grid_set(&grid, scene, measure, error)) return NULL;
    struct map *map = calloc(1, sizeof *map);
    bool done = map != NULL;
    if (done) {
        const double bytes = (double)grid.nx * grid.ny * sizeof(struct map_cell);
        *map = (struct map){.scene = scene, .grid = grid, .gather = gather};
        map->part_count = (uint32_t)fmax(1, fmin(PART_MAX, parts_bytes_max / bytes));
        for (uint32_t p = 0; done && p < map->part_count; p++) {
            done = part_create(&map->parts[p], &map->grid, &map->arena);
        }
    }
    if (done) return map;
    map_destroy(map);
    error_set(error, "not enough memory for a map of %u x %u cells; make measure.cell larger",
              grid.nx, grid.ny);
    return NULL;
}

void map_destroy(struct map *map)
{
    if (!map) return;
    arena_free(&map->arena);
    free(map);
}

void map_clear(struct map *map)
{
    const size_t size = (size_t)map->grid.nx * map->grid.ny * sizeof(struct map_cell);
    for (uint32_t p = 0; p < map->part_count; p++) memset(map->parts[p].cells, 0, size);
    map->snapshots = 0;
}

void map_add(struct map *map, const struct grains *grains)
{
    if (map->snapshots++ == 0) map->from = grains->time;
    map->to = grains->time;
    if (grains->sample.values) {
        map_kernel_add_sample(&map->grid, map->parts[0].cells, &grains->sample);
        return;
    }
    unsigned gather = map->gather;              /* what the picture does not show adds nothing */
    if (!grains->radius) gather &= ~(unsigned)(MAP_GATHER_AREA | MAP_GATHER_SPIN);
    if (!grains->spin) gather &= ~(unsigned)MAP_GATHER_SPIN;
    if (!grains->collision_rate) gather &= ~(unsigned)MAP_GATHER_RATE;
    const uint64_t count = grains->count, parts = map->part_count;
#pragma omp parallel for schedule(static, 1) if (count > worth_threads && parts > 1)
    for (uint64_t p = 0; p < parts; p++) {
        map_kernel_add(&map->grid, &map->parts[p], grains, (uint32_t)(p * count / parts),
                       (uint32_t)((p + 1) * count / parts), gather);
    }
}

void map_archive(struct map *map, struct archive *archive)
{
    const size_t cells = (size_t)map->grid.nx * map->grid.ny;
    archive_value(archive, "map.snapshots", &map->snapshots);
    archive_value(archive, "map.from", &map->from);
    archive_value(archive, "map.to", &map->to);
    for (uint32_t p = 0; p < map->part_count; p++) {
        char name[32];
        snprintf(name, sizeof name, "map.part.%u", p);
        archive_array(archive, name, map->parts[p].cells, cells);
    }
}

/* A cell with the parts put together: means, and sums of squares about the means. */
struct total {
    double count, mass, vx, vy, energy, inertia, spin, angular_energy, rate, area;
};

/* Joins two samples of weight a, b and mean difference d: the sum of squares about the common mean
 * exceeds those about their own by d^2 a b / (a + b) (Chan, Golub and LeVeque 1979). */
static void total_join(struct total *total, const struct map_cell *cell)
{
    const double m = total->mass + cell->mass, i = total->inertia + cell->inertia;
    if (cell->mass > 0) {
        const double ux = cell->momentum_x / cell->mass, uy = cell->momentum_y / cell->mass;
        const double dx = cell->first_vx + ux - total->vx, dy = cell->first_vy + uy - total->vy;
        const double own = fmax(0, cell->energy - cell->mass * (ux * ux + uy * uy));
        total->energy += own + (dx * dx + dy * dy) * total->mass * (cell->mass / m);
        total->vx += dx * (cell->mass / m);
        total->vy += dy * (cell->mass / m);
    }
    if (cell->inertia > 0) {
        const double turn = cell->angular / cell->inertia;
        const double d = cell->first_spin + turn - total->spin;
        const double own = fmax(0, cell->angular_energy - cell->inertia * turn * turn);
        total->angular_energy += own + d * d * total->inertia * (cell->inertia / i);
        total->spin += d * (cell->inertia / i);
    }
    total->count += cell->count;
    total->mass = m;
    total->inertia = i;
    total->rate += cell->rate;
    total->area += cell->area;
}

/* A smooth kernel reaches cells where there is nothing to tell: two widths from the only grain of
 * a Gauss kernel one cell wide its weight is exp(-2) / (2 pi); farther out means are left open. */
static const double weight_least = 0.0215;

static double ratio(double sum, double weight) { return weight > 0 ? sum / weight : NAN; }

/* The values of a cell; `size` is its area times the number of snapshots. */
static void cell_values(const struct total *whole, enum map_kind kind, double size, bool smooth,
                        double values[static 2])
{
    static const struct total nothing;
    const bool sums = kind == MAP_density || kind == MAP_area_fraction;
    const struct total *total = !sums && smooth && whole->count < weight_least ? &nothing : whole;
    values[1] = 0;
    switch (kind) {
    case MAP_density: values[0] = size > 0 ? total->count / size : 0; break;
    case MAP_area_fraction: values[0] = size > 0 ? total->area / size : 0; break;
    case MAP_velocity:
        values[0] = total->mass > 0 ? total->vx : NAN;
        values[1] = total->mass > 0 ? total->vy : NAN;
        break;
    case MAP_speed: values[0] = total->mass > 0 ? hypot(total->vx, total->vy) : NAN; break;
    case MAP_temperature: values[0] = ratio(0.5 * total->energy, total->mass); break;
    case MAP_spin_temperature: values[0] = ratio(total->angular_energy, total->inertia); break;
    case MAP_collisions: values[0] = ratio(total->rate, total->count); break;
    case MAP_KINDS: assert(!"a kind of map"); break;
    }
}

/* "granular temperature (cm^2/s^2), mean t = 1 .. 2 s" */
static void set_label(const struct map *map, enum map_kind kind, struct field *field)
{
    const char *unit = scene_unit(map->scene, kinds[kind].dimension);
    const char *second = scene_unit(map->scene, "time");
    char when[64] = "empty";
    if (map->snapshots == 1) {
        snprintf(when, sizeof when, "snapshot at t = %.4g", map->to);
    } else if (map->snapshots > 1) {
        snprintf(when, sizeof when, "mean t = %.4g .. %.4g", map->from, map->to);
    }
    snprintf(field->name, sizeof field->name, "%s", kinds[kind].name);
    snprintf(field->unit, sizeof field->unit, "%s", unit);
    snprintf(field->label, sizeof field->label, "%s%s%s%s, %s%s%s", kinds[kind].label,
             *unit ? " (" : "", unit, *unit ? ")" : "", when, *second ? " " : "", second);
    field->time = map->to;
}

bool map_field(const struct map *map, enum map_kind kind, struct field *field,
               struct error *error)
{
    const struct map_grid *grid = &map->grid;
    if (kind_gather((int)kind) & ~map->gather) {
        *field = (struct field){0};
        return error_set(error, "the field %s was not gathered; add it to measure.fields",
                         kinds[kind].name);
    }
    if (!field_create(field, grid->x0, grid->y0, grid->cell, grid->nx, grid->ny,
                      kinds[kind].components, error)) {
        return false;
    }
    set_label(map, kind, field);
    const size_t cells = (size_t)grid->nx * grid->ny;
    for (size_t k = 0; k < cells; k++) {
        struct total total = {0};
        for (uint32_t p = 0; p < map->part_count; p++) total_join(&total, &map->parts[p].cells[k]);
        const double share = map_kernel_share(grid, (uint32_t)(k % grid->nx),
                                              (uint32_t)(k / grid->nx));
        double values[2];
        cell_values(&total, kind, share * grid->cell * grid->cell * map->snapshots,
                    grid->kernel != KERNEL_BOX, values);
        for (uint32_t c = 0; c < field->components; c++) field->values[c * cells + k] = values[c];
    }
    return true;
}
