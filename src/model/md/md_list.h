/* md_list.h - who may touch whom: the neighbour list, made anew when grains have moved enough.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MD_LIST_H
#define MD_LIST_H

#include "model/md/md.h"

bool md_list_create(struct md *md);

/* Sorts the grains in space and lists all pairs and walls within the skin; contacts keep their
 * springs.  Grains of zero inverse mass have left and are dropped.  False: a bound was passed,
 * md->fault says which. */
bool md_list_rebuild(struct md *md);

/* The cells of the last rebuild, for finding the grains near a wall. */
struct md_cells { double x0, y0, per_x, per_y; uint32_t nx, ny; };
struct md_cells md_list_cells(const struct md *md);
void md_list_cell(const struct md *md, uint32_t cx, uint32_t cy, uint32_t *first, uint32_t *last);

#endif
