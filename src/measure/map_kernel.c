/* map_kernel.c - see map_kernel.h.
 *
 * Lengths are in cells here, measured from the corner of the box.  A periodic box is unrolled:
 * cell k stands for cell k mod nx, shifted by whole boxes.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "measure/map_kernel.h"

#include "measure/overlap.h"

#include <assert.h>
#include <math.h>

#define FORCE_INLINE static inline __attribute__((always_inline))

/* A Gaussian is cut at three standard deviations along each axis: 0.5 % of it lies beyond. */
static const double gauss_cut = 3;

/* Lucy's kernel (1 + 3 q) (1 - q)^3, q = r / c, has the variance 5 c^2 / 56 along each axis. */
static const double lucy_cut = 3.3466401061363023;      /* sqrt(56 / 5) */

/* Discs beyond this many cells are not physical: a broken state must not loop for ever. */
static const double radius_max = 1e5, place_max = 1e9;

/* One axis of the grid. */
struct line { double length; uint32_t count; bool periodic; };

static struct line line_x(const struct map_grid *g)
{
    return (struct line){g->columns, g->nx, g->periodic_x};
}

static struct line line_y(const struct map_grid *g)
{
    return (struct line){g->rows, g->ny, g->periodic_y};
}

double map_kernel_reach(int kernel, double width)
{
    if (kernel == KERNEL_GAUSS) return gauss_cut * width;
    return kernel == KERNEL_LUCY ? lucy_cut * width : 0;
}

static double line_share(struct line line, uint32_t i)
{
    return i + 1 < line.count ? 1 : line.length - (line.count - 1);
}

double map_kernel_share(const struct map_grid *grid, uint32_t ix, uint32_t iy)
{
    return line_share(line_x(grid), ix) * line_share(line_y(grid), iy);
}

/* Where the lower edge of the unrolled cell k lies. */
static double line_edge(struct line line, int64_t k)
{
    if (!line.periodic) return fmin((double)k, line.length);
    const int64_t n = line.count, box = (k >= 0 ? k : k - n + 1) / n;
    return (double)box * line.length + (double)(k - box * n);
}

/* The unrolled cell that holds the place f. */
static int64_t line_cell(struct line line, double f)
{
    if (!line.periodic) return (int64_t)floor(f);
    const double box = floor(f / line.length);
    const int64_t inside = (int64_t)(f - box * line.length);
    return (int64_t)box * line.count + (inside < line.count ? inside : line.count - 1);
}

static uint32_t line_wrap(struct line line, int64_t k)
{
    const int64_t rest = k % line.count;
    return (uint32_t)(rest < 0 ? rest + line.count : rest);
}

/* The place in the box of a grain at f; false if it is outside (or not a number). */
FORCE_INLINE bool line_inside(struct line line, double *f)
{
    if (line.periodic && !(*f >= 0 && *f < line.length)) {
        *f -= line.length * floor(*f / line.length);
        if (*f >= line.length) *f = 0;
    }
    return *f >= 0 && *f <= line.length;
}

/* The cell that holds the place f inside the box; its far border belongs to the last cell. */
FORCE_INLINE uint32_t line_own(struct line line, double f)
{
    return (uint32_t)f < line.count ? (uint32_t)f : line.count - 1;
}

struct grain { double mass, vx, vy, inertia, spin, rate; };

FORCE_INLINE void deposit(struct map_cell *cell, const struct grain *grain, double w,
                          unsigned gather)
{
    if (cell->count == 0) {
        cell->first_vx = grain->vx;
        cell->first_vy = grain->vy;
        if (gather & MAP_GATHER_SPIN) cell->first_spin = grain->spin;
    }
    const double m = w * grain->mass;
    const double ux = grain->vx - cell->first_vx, uy = grain->vy - cell->first_vy;
    cell->count += w;
    cell->mass += m;
    cell->momentum_x += m * ux;
    cell->momentum_y += m * uy;
    cell->energy += m * (ux * ux + uy * uy);
    if (gather & MAP_GATHER_SPIN) {
        const double inertia = w * grain->inertia, turn = grain->spin - cell->first_spin;
        cell->inertia += inertia;
        cell->angular += inertia * turn;
        cell->angular_energy += inertia * turn * turn;
    }
    if (gather & MAP_GATHER_RATE) cell->rate += w * grain->rate;
}

/* Shares the area of a disc out among the cells that it really covers. */
static void cover(const struct map_grid *grid, struct map_cell *cells, double fx, double fy,
                  double r)
{
    const double size = r * r * grid->cell * grid->cell;
    const struct line along = line_x(grid), up = line_y(grid);
    if (!(r > 0 && r < radius_max && fabs(fx) < place_max && fabs(fy) < place_max)) return;
    int64_t i0 = line_cell(along, fx - r), i1 = line_cell(along, fx + r);
    int64_t j0 = line_cell(up, fy - r), j1 = line_cell(up, fy + r);
    if (i0 == i1 && j0 == j1 && i0 >= 0 && j0 >= 0 && i0 + 1 < grid->nx && j0 + 1 < grid->ny) {
        cells[j0 * grid->nx + i0].area += M_PI * size;
        return;
    }
    if (!along.periodic) i0 = i0 < 0 ? 0 : i0, i1 = i1 < grid->nx ? i1 : grid->nx - 1;
    if (!up.periodic) j0 = j0 < 0 ? 0 : j0, j1 = j1 < grid->ny ? j1 : grid->ny - 1;
    for (int64_t i = i0; i <= i1; i++) {
        const double a0 = (line_edge(along, i) - fx) / r, a1 = (line_edge(along, i + 1) - fx) / r;
        const double b0 = (line_edge(up, j0) - fy) / r;
        double below = overlap_corner(a1, b0) - overlap_corner(a0, b0);
        for (int64_t j = j0; j <= j1; j++) {
            const double b1 = (line_edge(up, j + 1) - fy) / r;
            const double upto = overlap_corner(a1, b1) - overlap_corner(a0, b1);
            cells[(size_t)line_wrap(up, j) * grid->nx + line_wrap(along, i)].area
                += size * fmax(0, upto - below);
            below = upto;
        }
    }
}

/* The cells within reach of the place f, their distances and, until a kernel multiplies it, their
 * share of a whole cell as weight. */
static void axis_fill(struct map_axis *axis, struct line line, double f, double reach,
                      uint32_t span)
{
    int64_t k0 = line_cell(line, f - reach), k1 = line_cell(line, f + reach);
    if (!line.periodic) {
        k0 = k0 < 0 ? 0 : k0;
        k1 = k1 < line.count ? k1 : line.count - 1;
    }
    assert(k1 - k0 < span);
    (void)span;
    axis->count = 0;
    for (int64_t k = k0; k <= k1; k++, axis->count++) {
        const uint32_t i = line_wrap(line, k);
        const double share = line_share(line, i);
        axis->index[axis->count] = i;
        axis->distance[axis->count] = line_edge(line, k) + 0.5 * share - f;
        axis->weight[axis->count] = share;
    }
}

/* Multiplies the weights by a Gaussian and makes their sum one; all in the grain's own cell if the
 * kernel is so narrow that it reaches no centre. */
static void axis_gauss(struct map_axis *axis, struct line line, double f, double width)
{
    double sum = 0;
    for (uint32_t k = 0; k < axis->count; k++) {
        const double q = axis->distance[k] / width;
        axis->weight[k] *= exp(-0.5 * q * q);
        sum += axis->weight[k];
    }
    const uint32_t own = line_own(line, f);
    for (uint32_t k = 0; k < axis->count; k++) {
        axis->weight[k] = sum > 1e-300 ? axis->weight[k] / sum : axis->index[k] == own;
    }
}

FORCE_INLINE void add_gauss(const struct map_grid *grid, struct map_part *part, double fx,
                            double fy, const struct grain *grain, double area, unsigned gather)
{
    struct map_axis *x = &part->x, *y = &part->y;
    const double reach = gauss_cut * grid->width;
    axis_fill(x, line_x(grid), fx, reach, grid->span);
    axis_fill(y, line_y(grid), fy, reach, grid->span);
    axis_gauss(x, line_x(grid), fx, grid->width);
    axis_gauss(y, line_y(grid), fy, grid->width);
    for (uint32_t j = 0; j < y->count; j++) {
        struct map_cell *row = part->cells + (size_t)y->index[j] * grid->nx;
        for (uint32_t i = 0; i < x->count; i++) {
            const double w = y->weight[j] * x->weight[i];
            deposit(&row[x->index[i]], grain, w, gather);
            if (gather & MAP_GATHER_AREA) row[x->index[i]].area += w * area;
        }
    }
}

static double lucy(double q) { return q < 1 ? (1 + 3 * q) * (1 - q) * (1 - q) * (1 - q) : 0; }

FORCE_INLINE void add_lucy(const struct map_grid *grid, struct map_part *part, double fx,
                           double fy, const struct grain *grain, double area, unsigned gather)
{
    struct map_axis *x = &part->x, *y = &part->y;
    const double range = lucy_cut * grid->width;
    axis_fill(x, line_x(grid), fx, range, grid->span);
    axis_fill(y, line_y(grid), fy, range, grid->span);
    double sum = 0, *weight = part->weights;
    for (uint32_t j = 0; j < y->count; j++) {
        for (uint32_t i = 0; i < x->count; i++, weight++) {
            const double dx = x->distance[i], dy = y->distance[j];
            *weight = lucy(sqrt(dx * dx + dy * dy) / range) * x->weight[i] * y->weight[j];
            sum += *weight;
        }
    }
    if (!(sum > 1e-300)) {              /* narrower than a cell: as a box */
        struct map_cell *own = part->cells + (size_t)line_own(line_y(grid), fy) * grid->nx
                             + line_own(line_x(grid), fx);
        deposit(own, grain, 1, gather);
        if (gather & MAP_GATHER_AREA) own->area += area;
        return;
    }
    weight = part->weights;
    for (uint32_t j = 0; j < y->count; j++) {
        struct map_cell *row = part->cells + (size_t)y->index[j] * grid->nx;
        for (uint32_t i = 0; i < x->count; i++, weight++) {
            if (*weight == 0) continue;
            const double w = *weight / sum;
            deposit(&row[x->index[i]], grain, w, gather);
            if (gather & MAP_GATHER_AREA) row[x->index[i]].area += w * area;
        }
    }
}

FORCE_INLINE void add_all(const struct map_grid *grid, struct map_part *part,
                          const struct grains *grains, uint32_t from, uint32_t to, int kernel,
                          unsigned gather)
{
    const struct line along = line_x(grid), up = line_y(grid);
    const double cell = grid->cell;
    for (uint32_t k = from; k < to; k++) {
        /* Divided, as the sides of the box were: a grain on the border must not fall outside. */
        double fx = (grains->x[k] - grid->x0) / cell, fy = (grains->y[k] - grid->y0) / cell;
        struct grain grain = {.mass = grains->mass[k], .vx = grains->vx[k], .vy = grains->vy[k]};
        const double r = gather & (MAP_GATHER_AREA | MAP_GATHER_SPIN) ? grains->radius[k] : 0;
        if (gather & MAP_GATHER_SPIN) {
            grain.inertia = grain.mass * r * r;
            grain.spin = grains->spin[k];
        }
        if (gather & MAP_GATHER_RATE) grain.rate = grains->collision_rate[k];
        if ((gather & MAP_GATHER_AREA) && kernel == KERNEL_BOX) {
            cover(grid, part->cells, fx, fy, r / cell);
        }
        if (!line_inside(along, &fx) || !line_inside(up, &fy)) continue;
        if (kernel == KERNEL_GAUSS) add_gauss(grid, part, fx, fy, &grain, M_PI * r * r, gather);
        if (kernel == KERNEL_LUCY) add_lucy(grid, part, fx, fy, &grain, M_PI * r * r, gather);
        if (kernel == KERNEL_BOX) {
            const size_t own = (size_t)line_own(up, fy) * grid->nx + line_own(along, fx);
            deposit(&part->cells[own], &grain, 1, gather);
        }
    }
}

void map_kernel_add(const struct map_grid *grid, struct map_part *part,
                    const struct grains *grains, uint32_t from, uint32_t to, unsigned gather)
{
    assert(gather <= MAP_GATHER_ALL);
    /* Smooth kernels spend their time on cells, so they gather by run-time bits; the box has one
     * loop for each set of sums. */
    if (grid->kernel == KERNEL_GAUSS) {
        add_all(grid, part, grains, from, to, KERNEL_GAUSS, gather);
        return;
    }
    if (grid->kernel == KERNEL_LUCY) {
        add_all(grid, part, grains, from, to, KERNEL_LUCY, gather);
        return;
    }
    switch (gather) {
#define CASE(bits) case bits: add_all(grid, part, grains, from, to, KERNEL_BOX, bits); break;
    CASE(0) CASE(1) CASE(2) CASE(3) CASE(4) CASE(5) CASE(6) CASE(7)
#undef CASE
    }
}

/* The share of cell k of the sample's axis that lies in cell i of the grid's. */
static double shared(double from, double size, uint32_t i)
{
    return fmax(0, fmin(from + size, i + 1.0) - fmax(from, (double)i)) / size;
}

static void add_sampled(const struct map_grid *grid, struct map_cell *cells,
                        const struct field *sample, uint32_t kx, uint32_t ky)
{
    const size_t all = (size_t)sample->nx * sample->ny, k = (size_t)ky * sample->nx + kx;
    const double *v = sample->values + k, count = v[SAMPLE_COUNT * all];
    if (!(count > 0)) return;
    const double size = sample->cell / grid->cell, mass = v[SAMPLE_MASS * all];
    const double x = (sample->x0 - grid->x0) / grid->cell + kx * size;
    const double y = (sample->y0 - grid->y0) / grid->cell + ky * size;
    const struct grain mean = {.mass = mass / count, .vx = v[SAMPLE_MOMENTUM_X * all] / mass,
                               .vy = v[SAMPLE_MOMENTUM_Y * all] / mass};
    const double own = v[SAMPLE_ENERGY * all] - mass * (mean.vx * mean.vx + mean.vy * mean.vy);
    for (uint32_t j = (uint32_t)fmax(0, y); j < grid->ny && j < y + size; j++) {
        for (uint32_t i = (uint32_t)fmax(0, x); i < grid->nx && i < x + size; i++) {
            const double share = shared(x, size, i) * shared(y, size, j);
            struct map_cell *cell = &cells[(size_t)j * grid->nx + i];
            if (!(share > 0)) continue;
            deposit(cell, &mean, share * count, 0);
            cell->energy += share * fmax(0, own);
            cell->area += share * v[SAMPLE_AREA * all];
        }
    }
}

void map_kernel_add_sample(const struct map_grid *grid, struct map_cell *cells,
                           const struct field *sample)
{
    for (uint32_t ky = 0; ky < sample->ny; ky++) {
        for (uint32_t kx = 0; kx < sample->nx; kx++) add_sampled(grid, cells, sample, kx, ky);
    }
}
