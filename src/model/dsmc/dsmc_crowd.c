/* dsmc_crowd.c - how crowded the cells are: what the number of candidate pairs is multiplied by.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The local form (dense, hsmc) takes chi from the 5 x 5 cells around, and scales the number of
 * pairs so that those cells have as many together as a uniform gas of their density would: with one
 * grain a cell the pairs met would otherwise be too many or too few wherever grains keep apart or
 * cluster.
 */
#include "model/dsmc/dsmc_crowd.h"

#include <math.h>
#include <string.h>

static float volume(const struct dsmc_axis *axis, uint32_t k)
{
    return k == 0 ? axis->first : k == axis->cells - 1 ? axis->last : 1;
}

/* ---- how crowded ---------------------------------------------------------------------------- */

enum { WIDTH = DSMC_BLOCK + 2 * DSMC_HOOD };

struct hood { float grains[WIDTH], pairs[WIDTH], volume[WIDTH]; };      /* by column of cells */

static int reach_of(const struct dsmc_axis *axis)
{
    return axis->cells >= 2 * DSMC_HOOD + 1 ? DSMC_HOOD : ((int)axis->cells - 1) / 2;
}

/* The cell `step` beyond k; false if the grid ends before. */
static bool neighbour(const struct dsmc_axis *axis, uint32_t k, int step, uint32_t *out)
{
    const int64_t at = (int64_t)k + step, cells = axis->cells;
    if (!axis->wraps && (at < 0 || at >= cells)) return false;
    *out = (uint32_t)(at < 0 ? at + cells : at >= cells ? at - cells : at);
    return true;
}

/* Adds the cells of one row of that height; column 0 is `reach` cells before the block. */
FORCE_INLINE void add_row(const struct dsmc_crowd *crowd, uint32_t y, float height,
                          struct hood *sum)
{
    const struct dsmc_axis *ax = &crowd->dsmc->ax;
    const uint32_t *restrict row = &crowd->dsmc->first[(size_t)y * ax->cells];
    const int reach = reach_of(ax), columns = (int)(crowd->x1 - crowd->x0) + 2 * reach;
    const int begin = (int)crowd->x0 - reach, inner = begin < 0 ? -begin : 0;
    const int end = begin + columns > (int)ax->cells ? (int)ax->cells - begin : columns;
    const float weight = 1 / height;
    for (int k = inner; k < end; k++) {
        const float n = (float)(int32_t)(row[begin + k + 1] - row[begin + k]);
        sum->grains[k] += n;
        sum->pairs[k] += weight * n * (n - 1);
        sum->volume[k] += height;
    }
    for (int k = 0; k < columns; k++) {
        if (k == inner) k = end;                                /* beyond the grid's sides */
        uint32_t x;
        if (k >= columns || !neighbour(ax, crowd->x0, k - reach, &x)) continue;
        const float n = (float)(int32_t)(row[x + 1] - row[x]);
        sum->grains[k] += n;
        sum->pairs[k] += weight * n * (n - 1);
        sum->volume[k] += height;
    }
}

/* Border cells of a grid that does not wrap are wider or narrower than the others. */
static void scale_borders(const struct dsmc_crowd *crowd, struct hood *sum)
{
    const struct dsmc_axis *ax = &crowd->dsmc->ax;
    const int64_t at[2] = {0, ax->cells - 1}, begin = (int64_t)crowd->x0 - reach_of(ax);
    if (ax->wraps) return;
    for (int side = 0; side < 2; side++) {
        const int64_t k = at[side] - begin;
        if (k < 0 || k >= WIDTH || (side == 1 && at[1] == at[0])) continue;
        const float width = volume(ax, (uint32_t)at[side]);
        sum->pairs[k] /= width;
        sum->volume[k] *= width;
    }
}

CLONES void dsmc_crowd_local(struct dsmc_crowd *crowd)
{
    const struct dsmc *dsmc = crowd->dsmc;
    const int reach = reach_of(&dsmc->ax), rows = reach_of(&dsmc->ay);
    const int count = (int)(crowd->x1 - crowd->x0);
    struct hood columns, sums;
    memset(&columns, 0, sizeof columns);
    memset(&sums, 0, sizeof sums);
    for (int step = -rows; step <= rows; step++) {
        uint32_t y;
        if (!neighbour(&dsmc->ay, crowd->row, step, &y)) continue;
        add_row(crowd, y, volume(&dsmc->ay, y), &columns);
    }
    scale_borders(crowd, &columns);
    for (int o = 0; o <= 2 * reach; o++) {
        for (int k = 0; k < count; k++) {
            sums.grains[k] += columns.grains[k + o];
            sums.pairs[k] += columns.pairs[k + o];
            sums.volume[k] += columns.volume[k + o];
        }
    }
    const float area = (float)(M_PI * dsmc->radius * dsmc->radius / dsmc->settings.weight)
                     * dsmc->ax.per * dsmc->ay.per;             /* of a particle, in cells */
    const float height = volume(&dsmc->ay, crowd->row);
    const int kind = dsmc->settings.chi;
    for (int k = 0; k < count; k++) {
        const float q = sums.grains[k], v = sums.volume[k], pairs = sums.pairs[k];
        const float chi = dsmc_chi(kind, q * area / v);
        crowd->factor[k] = pairs > 0 ? chi * q * (q - 1) / (v * pairs * height) : 0;
    }
    if (dsmc->ax.wraps) return;
    if (crowd->x0 == 0) crowd->factor[0] /= volume(&dsmc->ax, 0);
    const uint32_t last = dsmc->ax.cells - 1;
    if (crowd->x1 != last + 1 || last == 0) return;
    crowd->factor[last - crowd->x0] /= volume(&dsmc->ax, last);
}

/* Without neighbours: the whole box is as crowded on average. */
void dsmc_crowd_global(struct dsmc_crowd *crowd)
{
    const struct dsmc *dsmc = crowd->dsmc;
    const double area = M_PI * dsmc->radius * dsmc->radius / dsmc->settings.weight * dsmc->count;
    const float nu = (float)(area / ((double)dsmc->ax.length * (double)dsmc->ay.length));
    const float chi = dsmc_chi(dsmc->settings.chi, nu);
    const float fy = volume(&dsmc->ay, crowd->row);
    const uint32_t cells = crowd->x1 - crowd->x0;
    for (uint32_t k = 0; k < cells; k++) crowd->factor[k] = chi / fy;
    crowd->factor[0] = chi / (fy * volume(&dsmc->ax, crowd->x0));       /* perhaps at a border */
    crowd->factor[cells - 1] = chi / (fy * volume(&dsmc->ax, crowd->x1 - 1));
}
