/* ed_cells.h - who is near: a grid of cells with room for eight grains each.
 *
 * A cell is a little wider than the largest grain, so that only grains of the 3 x 3 cells around
 * can touch.  The spare width is a margin by which a grain may stick out before it changes its
 * cell, so that it does not flicker between two.  A ring of empty cells surrounds the grid; with
 * periodic borders the kernel wraps instead.  A ninth grain goes into a block chained behind.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_CELLS_H
#define ED_CELLS_H

#include "base/arena.h"
#include "base/archive.h"

#include <stdbool.h>
#include <stdint.h>

enum { ED_CELL_ROOM = 8 };

#define ED_CELL_EMPTY UINT32_MAX

struct ed_cell { uint32_t id[ED_CELL_ROOM]; };          /* filled from the front */

struct ed_cells {
    uint32_t nx, ny, stride;    /* cells along x and y without the ring; with it */
    uint32_t count;             /* of cells, the ring included */
    double   x0, y0, width_x, width_y;
    bool     wraps_x, wraps_y;
    double  *west, *east, *south, *north;       /* by cx or cy: where a grain leaves the cell */
    struct ed_cell *cells;      /* the grid, then the blocks for overfull cells */
    uint32_t *chain;            /* by cell or block: the block behind it, 0 for none */
    uint32_t block_count, block_free;
};

/* How the grid lies: box, smallest width of a cell, number of cells at most, margin as a share of
 * the spare width, which sides are periodic, and which are shut so that nobody leaves there. */
struct ed_grid {
    double   box[4], reach, width, margin;
    double   beyond;            /* how far outside of an open side a grain is gone */
    uint32_t cells_max;
    bool     wraps_x, wraps_y, shut_west, shut_east, shut_south, shut_north;
};

bool ed_cells_create(struct ed_cells *cells, const struct ed_grid *grid, uint32_t count_max,
                     struct arena *arena);

void ed_cells_clear(struct ed_cells *cells);

/* The cell in which a position lies; outside the box: the nearest. */
void ed_cells_place(const struct ed_cells *cells, double x, double y, uint16_t *cx, uint16_t *cy);

void ed_cells_put_chained(struct ed_cells *cells, uint32_t cell, uint32_t id);
void ed_cells_remove_chained(struct ed_cells *cells, uint32_t cell, uint32_t id);

void ed_cells_archive(struct ed_cells *cells, struct archive *archive);

static inline uint32_t ed_cells_index(const struct ed_cells *cells, uint32_t cx, uint32_t cy)
{
    return cy * cells->stride + cx;
}

static inline void ed_cells_put(struct ed_cells *cells, uint32_t cell, uint32_t id)
{
    uint32_t *ids = cells->cells[cell].id;
    for (uint32_t k = 0; k < ED_CELL_ROOM; k++) {
        if (ids[k] != ED_CELL_EMPTY) continue;
        ids[k] = id;
        return;
    }
    ed_cells_put_chained(cells, cell, id);
}

static inline void ed_cells_remove(struct ed_cells *cells, uint32_t cell, uint32_t id)
{
    uint32_t *ids = cells->cells[cell].id;
    if (ids[ED_CELL_ROOM - 1] != ED_CELL_EMPTY && cells->chain[cell]) {
        ed_cells_remove_chained(cells, cell, id);
        return;
    }
    uint32_t at = ED_CELL_ROOM, last = 0;
    for (uint32_t k = 0; k < ED_CELL_ROOM && ids[k] != ED_CELL_EMPTY; k++) {
        if (ids[k] == id) at = k;
        last = k;
    }
    if (at == ED_CELL_ROOM) return;
    ids[at] = ids[last];
    ids[last] = ED_CELL_EMPTY;
}

#endif
