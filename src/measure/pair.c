/* pair.c - see pair.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/pair.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Grains sorted into cells no narrower than the reach: pairs are found in nine of them. */
struct grid {
    uint32_t nx, ny;
    uint32_t *first, *next;     /* 1 + index; 0: none */
    double x0, y0, lx, ly;
    bool wraps_x, wraps_y;
};

static uint32_t cell_along(double at, double length, uint32_t cells)
{
    const double cell = floor(at / length * cells);
    return cell < 0 ? 0 : cell >= cells ? cells - 1 : (uint32_t)cell;
}

static bool fill(struct grid *grid, const struct grains *grains, const struct scene *scene,
                 double reach)
{
    const double *box = scene->box;
    *grid = (struct grid){.x0 = box[0], .y0 = box[1], .lx = box[2] - box[0], .ly = box[3] - box[1],
                          .wraps_x = scene->left == BORDER_PERIODIC,
                          .wraps_y = scene->bottom == BORDER_PERIODIC};
    const double most = fmax(1, sqrt(grains->count));   /* no more cells than grains */
    grid->nx = (uint32_t)fmax(1, fmin(most, floor(grid->lx / reach)));
    grid->ny = (uint32_t)fmax(1, fmin(most, floor(grid->ly / reach)));
    grid->first = calloc((size_t)grid->nx * grid->ny, sizeof *grid->first);
    grid->next = calloc((size_t)grains->count + 1, sizeof *grid->next);
    if (!grid->first || !grid->next) return false;
    for (uint32_t i = 0; i < grains->count; i++) {
        const uint32_t c = cell_along(grains->x[i] - grid->x0, grid->lx, grid->nx)
                         + cell_along(grains->y[i] - grid->y0, grid->ly, grid->ny) * grid->nx;
        grid->next[i] = grid->first[c];
        grid->first[c] = i + 1;
    }
    return true;
}

/* The cells beside `at` along one side, itself included, each once. */
static uint32_t around(uint32_t at, uint32_t cells, bool wraps, uint32_t out[3])
{
    uint32_t count = 0;
    for (int step = -1; step <= 1; step++) {
        int64_t cell = (int64_t)at + step;
        if (wraps) cell = (cell + cells) % cells;
        if (cell < 0 || cell >= cells) continue;
        bool known = false;
        for (uint32_t k = 0; k < count; k++) known = known || out[k] == (uint32_t)cell;
        if (!known) out[count++] = (uint32_t)cell;
    }
    return count;
}

static void count_around(const struct grid *grid, const struct grains *grains, uint32_t i,
                         double clear, struct pair *pair)
{
    uint32_t xs[3], ys[3];
    const double x = grains->x[i], y = grains->y[i], reach2 = clear * clear;
    const uint32_t nx = around(cell_along(x - grid->x0, grid->lx, grid->nx), grid->nx,
                               grid->wraps_x, xs);
    const uint32_t ny = around(cell_along(y - grid->y0, grid->ly, grid->ny), grid->ny,
                               grid->wraps_y, ys);
    for (uint32_t a = 0; a < ny; a++) {
        for (uint32_t b = 0; b < nx; b++) {
            for (uint32_t at = grid->first[ys[a] * grid->nx + xs[b]]; at; at = grid->next[at - 1]) {
                const uint32_t j = at - 1;
                double dx = grains->x[j] - x, dy = grains->y[j] - y;
                if (grid->wraps_x) dx -= grid->lx * rint(dx / grid->lx);
                if (grid->wraps_y) dy -= grid->ly * rint(dy / grid->ly);
                const double r2 = dx * dx + dy * dy;
                if (j == i || r2 >= reach2) continue;
                const uint32_t bin = (uint32_t)(sqrt(r2) / pair->width);
                if (bin < pair->bins) pair->pairs[bin]++;
            }
        }
    }
}

/* How far the circle around (x, y) stays inside. */
static double clearance(const struct grid *grid, double x, double y, double reach)
{
    double clear = reach;
    if (!grid->wraps_x) clear = fmin(clear, fmin(x - grid->x0, grid->x0 + grid->lx - x));
    if (!grid->wraps_y) clear = fmin(clear, fmin(y - grid->y0, grid->y0 + grid->ly - y));
    return clear;
}

bool pair_create(const struct grains *grains, const struct scene *scene, double reach,
                 uint32_t bins, struct pair *pair, struct error *error)
{
    assert(bins > 0);
    assert(reach > 0);
    struct grid grid = {0};
    *pair = (struct pair){.bins = bins, .width = reach / bins};
    pair->g = calloc(bins, sizeof *pair->g);
    pair->error = calloc(bins, sizeof *pair->error);
    pair->pairs = calloc(bins, sizeof *pair->pairs);
    double *centres = calloc(bins, sizeof *centres);    /* whose circle holds the bin */
    bool done = pair->g && pair->error && pair->pairs && centres
             && fill(&grid, grains, scene, reach);
    if (!done) error_set(error, "not enough memory for a pair correlation");
    if (done && ((grid.wraps_x && 2 * reach > grid.lx) || (grid.wraps_y && 2 * reach > grid.ly))) {
        done = error_set(error, "the pair correlation reaches to %g, more than half of the "
                         "periodic box; choose a smaller reach", reach);
    }
    for (uint32_t i = 0; done && i < grains->count; i++) {
        const double clear = clearance(&grid, grains->x[i], grains->y[i], reach);
        const double whole = floor(clear / pair->width * (1 + 1e-12));
        if (whole < 1) continue;
        count_around(&grid, grains, i, whole * pair->width, pair);
        for (uint32_t b = 0; b < whole; b++) centres[b]++;
        pair->grains++;
    }
    const double density = grains->count / (grid.lx * grid.ly);
    for (uint32_t b = 0; done && b < bins; b++) {
        const double ring = M_PI * pair->width * pair->width * (2.0 * b + 1);
        const double expected = centres[b] * density * ring;
        pair->g[b] = (double)pair->pairs[b] / expected;         /* 0 / 0 is NAN: nothing known */
        /* A pair is found from both its ends: half as many counts are independent. */
        pair->error[b] = sqrt(2.0 * fmax(1, (double)pair->pairs[b])) / expected;
    }
    free(centres);
    free(grid.first);
    free(grid.next);
    if (!done) pair_free(pair);
    return done;
}

void pair_free(struct pair *pair)
{
    free(pair->g);
    free(pair->error);
    free(pair->pairs);
    *pair = (struct pair){0};
}
