/* ed_cells.c - see ed_cells.h: laying out the grid, and the rare overfull cells.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_cells.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Cell indices are 16 bits wide in a grain's event, the ring included. */
enum { AXIS_MAX = 65000 };

static uint32_t axis_count(double length, double width)
{
    return (uint32_t)fmin(fmax(floor(length / width), 1), AXIS_MAX);
}

/* Where a grain leaves each cell of an axis: the edges, pushed out by the margin, the outermost
 * ones by their own. */
static void lay_faces(double *low, double *high, uint32_t n, double origin, double width,
                      double margin, double low_end, double high_end)
{
    for (uint32_t c = 0; c < n + 2; c++) {
        low[c] = origin + (c - 1.0) * width - margin;
        high[c] = origin + c * width + margin;
    }
    if (isfinite(low_end)) low[1] = origin - low_end;
    else low[1] = -INFINITY;
    if (isfinite(high_end)) high[n] = origin + n * width + high_end;
    else high[n] = INFINITY;
}

/* With margins two neighbours are less than half a period apart still. */
static double margin_max(uint32_t n, double length, bool wraps)
{
    return wraps ? 0.5 * fmax(0.5 * length - 2 * length / n, 0) : INFINITY;
}

bool ed_cells_create(struct ed_cells *cells, const struct ed_grid *grid, uint32_t count_max,
                     struct arena *arena)
{
    const double lx = grid->box[2] - grid->box[0], ly = grid->box[3] - grid->box[1];
    double width = grid->width;
    while (ceil(lx / width) * ceil(ly / width) > grid->cells_max) width *= 1.1;
    *cells = (struct ed_cells){.x0 = grid->box[0], .y0 = grid->box[1],
                               .wraps_x = grid->wraps_x, .wraps_y = grid->wraps_y};
    /* Grains in neighbouring cells may be two cells apart, and are taken to be nearest neighbours
     * through the period: so a period needs four cells, and none of them a wide margin. */
    cells->nx = axis_count(lx, grid->wraps_x ? fmin(width, lx / 4) : width);
    cells->ny = axis_count(ly, grid->wraps_y ? fmin(width, ly / 4) : width);
    cells->width_x = lx / cells->nx;
    cells->width_y = ly / cells->ny;
    cells->stride = cells->nx + 2;
    cells->count = cells->stride * (cells->ny + 2);
    cells->block_count = count_max / ED_CELL_ROOM + 2;
    const uint32_t room = cells->count + cells->block_count;
    if (!arena_array(arena, &cells->cells, room) || !arena_array(arena, &cells->chain, room)
        || !arena_array(arena, &cells->west, cells->nx + 2)
        || !arena_array(arena, &cells->east, cells->nx + 2)
        || !arena_array(arena, &cells->south, cells->ny + 2)
        || !arena_array(arena, &cells->north, cells->ny + 2)) return false;
    const double spare_x = fmax(cells->width_x - grid->reach, 0),
                 spare_y = fmax(cells->width_y - grid->reach, 0);
    const double mx = fmin(0.5 * grid->margin * spare_x, margin_max(cells->nx, lx, grid->wraps_x)),
                 my = fmin(0.5 * grid->margin * spare_y, margin_max(cells->ny, ly, grid->wraps_y));
    const double open_x = grid->wraps_x ? mx : grid->beyond,
                 open_y = grid->wraps_y ? my : grid->beyond;
    lay_faces(cells->west, cells->east, cells->nx, cells->x0, cells->width_x, mx,
              grid->shut_west ? INFINITY : open_x, grid->shut_east ? INFINITY : open_x);
    lay_faces(cells->south, cells->north, cells->ny, cells->y0, cells->width_y, my,
              grid->shut_south ? INFINITY : open_y, grid->shut_north ? INFINITY : open_y);
    ed_cells_clear(cells);
    return true;
}

/* Free blocks form a list through `chain`, headed by block_free. */
void ed_cells_clear(struct ed_cells *cells)
{
    const uint32_t room = cells->count + cells->block_count;
    memset(cells->cells, 0xff, room * sizeof *cells->cells);
    memset(cells->chain, 0, cells->count * sizeof *cells->chain);
    for (uint32_t b = cells->count; b < room; b++) cells->chain[b] = b + 1 < room ? b + 1 : 0;
    cells->block_free = cells->count;
}

void ed_cells_place(const struct ed_cells *cells, double x, double y, uint16_t *cx, uint16_t *cy)
{
    const double fx = floor((x - cells->x0) / cells->width_x) + 1,
                 fy = floor((y - cells->y0) / cells->width_y) + 1;
    *cx = (uint16_t)fmin(fmax(fx, 1), cells->nx);
    *cy = (uint16_t)fmin(fmax(fy, 1), cells->ny);
}

/* Every block of a chain but the last is full, so that a chain is as short as can be: with
 * count_max grains at most count_max / 8 blocks are ever needed. */
void ed_cells_put_chained(struct ed_cells *cells, uint32_t cell, uint32_t id)
{
    uint32_t at = cell;
    while (cells->chain[at]) at = cells->chain[at];
    if (at == cell || cells->cells[at].id[ED_CELL_ROOM - 1] != ED_CELL_EMPTY) {
        const uint32_t block = cells->block_free;
        assert(block != 0);
        cells->block_free = cells->chain[block];
        cells->chain[at] = block;
        cells->chain[block] = 0;
        at = block;
    }
    uint32_t *ids = cells->cells[at].id, k = 0;
    while (ids[k] != ED_CELL_EMPTY) k++;
    ids[k] = id;
}

void ed_cells_remove_chained(struct ed_cells *cells, uint32_t cell, uint32_t id)
{
    uint32_t *hole = NULL, *last = NULL, before = cell, at = cell;
    for (uint32_t b = cell; ; b = cells->chain[b]) {
        for (uint32_t k = 0; k < ED_CELL_ROOM && cells->cells[b].id[k] != ED_CELL_EMPTY; k++) {
            last = &cells->cells[b].id[k];
            if (*last == id) hole = last;
        }
        at = b;
        if (!cells->chain[b]) break;
        before = b;
    }
    if (!hole) return;
    *hole = *last;
    *last = ED_CELL_EMPTY;
    if (at != cell && cells->cells[at].id[0] == ED_CELL_EMPTY) {
        cells->chain[before] = 0;
        cells->chain[at] = cells->block_free;
        cells->block_free = at;
    }
}

void ed_cells_archive(struct ed_cells *cells, struct archive *archive)
{
    const uint32_t room = cells->count + cells->block_count;
    archive_array(archive, "ed.cells", cells->cells, room);
    archive_array(archive, "ed.chain", cells->chain, room);
    archive_value(archive, "ed.block_free", &cells->block_free);
}
