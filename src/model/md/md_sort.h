/* md_sort.h - grains sorted by cell, and what a rebuild of the list works with.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MD_SORT_H
#define MD_SORT_H

#include "model/md/md.h"

#define NONE UINT32_MAX

/* A loop over grains, or over their links, in which each turn writes only its own. */
#define SHARED_LOOP                                                                        \
    _Pragma("omp parallel for num_threads(md->thread_count) if (md->count > STRIP_GRAINS)")

struct md_scratch {
    uint32_t cell_max, fast, slow;      /* cells along the fast and the slow axis */
    bool     x_is_fast;
    double   x0, y0, per_x, per_y;      /* origin and cells per length */
    uint32_t nx, ny;
    uint32_t *cell_first;       /* [cells + 1] */
    uint32_t *cell_of;          /* by old index */
    uint32_t *order;            /* old index by new */
    uint32_t *place;            /* new index by old; NONE: has left */
    struct grain *grains;
    struct half  *halves;
    struct tag   *tags;
    struct trait *traits;
    struct turn  *turns;
    struct gear  *gears;
    uint32_t *collisions;
    float    *collision_rate;
    uint32_t *kept_first;       /* contacts that go on: the first of those whose new first grain */
    uint32_t *kept_next;        /* this is, the next of them by link, NONE at the end */
    uint32_t *kept_partner;     /* by link */
    struct link *links;         /* stretches of the strips: inner from below, cross from above */
    double   *springs;
    uint32_t *inner, *cross;    /* by strip: how many */
    uint32_t links_per_grain;
};

/* Brings the grains back into a periodic box, lays cells over them and gives each its place:
 * `cell_first`, `cell_of`, `order`, `place`, and the count of those that have not left. */
void md_sort_find(struct md *md);

/* Brings all that is held by grain to those places. */
void md_sort_permute(struct md *md);

/* Number of the cell in that column and row. */
static inline uint32_t md_sort_cell(const struct md_scratch *s, uint32_t cx, uint32_t cy)
{
    return s->x_is_fast ? cy * s->fast + cx : cx * s->fast + cy;
}

#endif
