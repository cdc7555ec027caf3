/* md_sort.c - see md_sort.h: a counting sort by cell.
 *
 * Cells are at least as wide as the largest reach, so partners sit in the nine cells around; the
 * shorter side of the box runs fastest.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_sort.h"

#include <math.h>
#include <string.h>

/* Brings grains back into a periodic box. */
static void wrap(struct md *md)
{
    const double *box = md->scene->box;
    const double width = box[2] - box[0], height = box[3] - box[1];
    const bool along_x = md->scene->left == BORDER_PERIODIC;
    const bool along_y = md->scene->bottom == BORDER_PERIODIC;
    SHARED_LOOP
    for (uint32_t i = 0; i < md->count; i++) {
        struct grain *g = &md->grains[i];
        const bool out_x = g->x < box[0] || g->x >= box[2];
        const bool out_y = g->y < box[1] || g->y >= box[3];
        if (along_x && out_x) g->x -= width * floor((g->x - box[0]) / width);
        if (along_y && out_y) g->y -= height * floor((g->y - box[1]) / height);
    }
}

/* Lays the cells over all grains; over the box along periodic axes. */
static void lay_cells(struct md *md)
{
    struct md_scratch *s = md->scratch;
    const double *box = md->scene->box;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    const bool periodic[2] = {md->scene->left == BORDER_PERIODIC,
                              md->scene->bottom == BORDER_PERIODIC};
    const bool spread = !periodic[0] || !periodic[1];
    for (uint32_t i = 0; spread && i < md->count; i++) {
        const double x = md->grains[i].x, y = md->grains[i].y;
        low[0] = x < low[0] ? x : low[0];
        high[0] = x > high[0] ? x : high[0];
        low[1] = y < low[1] ? y : low[1];
        high[1] = y > high[1] ? y : high[1];
    }
    double size = md->reach_max + md->skin;
    uint32_t cells[2];
    for (;; size *= 1.25) {
        double product = 1;
        for (int axis = 0; axis < 2; axis++) {
            if (periodic[axis]) {
                low[axis] = box[axis];
                high[axis] = box[axis + 2];
            }
            const double span = fmax(high[axis] - low[axis], 0) / size;
            product *= fmax(1, floor(span) + !periodic[axis]);
        }
        if (product <= s->cell_max) break;
    }
    for (int axis = 0; axis < 2; axis++) {
        const double span = fmax(high[axis] - low[axis], 0);
        cells[axis] = (uint32_t)fmax(1, floor(span / size) + !periodic[axis]);
        const double width = periodic[axis] ? span / cells[axis] : size;
        if (axis == 0) s->per_x = 1 / width;
        else s->per_y = 1 / width;
    }
    s->x0 = low[0];
    s->y0 = low[1];
    s->nx = cells[0];
    s->ny = cells[1];
    s->x_is_fast = cells[0] < cells[1];
    s->fast = s->x_is_fast ? s->nx : s->ny;
    s->slow = s->x_is_fast ? s->ny : s->nx;
}

static uint32_t cell_along(double place, double per, uint32_t cells)
{
    const double c = place * per;
    return c < 0 ? 0 : c >= cells ? cells - 1 : (uint32_t)c;
}

/* Counting sort by cell, stable; grains that have left come to no place. */
static void sort_grains(struct md *md)
{
    struct md_scratch *s = md->scratch;
    const uint32_t cells = s->nx * s->ny, old_count = md->count;
    SHARED_LOOP
    for (uint32_t i = 0; i < old_count; i++) {
        const struct grain *g = &md->grains[i];
        s->cell_of[i] = md->tags[i].gone ? NONE
                      : md_sort_cell(s, cell_along(g->x - s->x0, s->per_x, s->nx),
                                   cell_along(g->y - s->y0, s->per_y, s->ny));
    }
    memset(s->cell_first, 0, (cells + 1) * sizeof *s->cell_first);
    for (uint32_t i = 0; i < old_count; i++) {
        if (s->cell_of[i] != NONE) s->cell_first[s->cell_of[i] + 1]++;
    }
    for (uint32_t c = 0; c < cells; c++) s->cell_first[c + 1] += s->cell_first[c];
    md->count = s->cell_first[cells];
    for (uint32_t i = 0; i < old_count; i++) {
        s->place[i] = NONE;
        if (s->cell_of[i] == NONE) continue;
        s->place[i] = s->cell_first[s->cell_of[i]]++;
        s->order[s->place[i]] = i;
    }
    for (uint32_t c = cells; c > 0; c--) s->cell_first[c] = s->cell_first[c - 1];
    s->cell_first[0] = 0;
}

void md_sort_find(struct md *md)
{
    wrap(md);
    lay_cells(md);
    sort_grains(md);
}

#define SWAP(a, b) do { void *swap_ = (a); (a) = (b); (b) = swap_; } while (0)

#define PERMUTE(array)                                                                     \
    do {                                                                                   \
        if (!md->array) break;                                                             \
        SHARED_LOOP                                                                        \
        for (uint32_t i = 0; i < md->count; i++) s->array[i] = md->array[s->order[i]];     \
        SWAP(md->array, s->array);                                                         \
    } while (0)

void md_sort_permute(struct md *md)
{
    struct md_scratch *s = md->scratch;
    PERMUTE(grains);
    PERMUTE(halves);
    PERMUTE(tags);
    PERMUTE(traits);
    PERMUTE(turns);
    PERMUTE(gears);
    PERMUTE(collisions);
    PERMUTE(collision_rate);
}
