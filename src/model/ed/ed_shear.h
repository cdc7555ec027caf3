/* ed_shear.h - Lees-Edwards borders: the images of the box above and below slide along it.
 *
 * The image above flies with U = shear rate * height.  In the epoch's terms (x(t) = x + vx t) a
 * grain that leaves above comes back below with x - D, y - height, vx - U, where D is how far the
 * image is ahead at the epoch: a constant until the epoch moves up, when U t is added to it and
 * whole periods are taken out.  So the place of the image never loses digits.
 *
 * Cells: the rows along the seam see four columns of the other side instead of three, so that all
 * who may come within reach while the image slides by one cell are among them.  When it has, the
 * grains of both rows are predicted anew.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_SHEAR_H
#define ED_SHEAR_H

#include "model/ed/ed.h"

#include <math.h>

/* How far the image above is ahead now. */
static inline double ed_shear_ahead(const struct ed *ed, double t)
{
    return ed->clock.ahead + ed->clock.shear_speed * t;
}

/* The first of the four columns of the row across the seam that grains in column cx must look at;
 * `above`: that row is the image above. */
static inline uint32_t ed_shear_column(const struct ed *ed, uint32_t cx, bool above)
{
    const int64_t n = ed->cells.nx, m = ed->clock.ahead_cells;
    const int64_t first = above ? (int64_t)cx - 1 - 2 - m : (int64_t)cx - 1 - 1 + m;
    return (uint32_t)((first % n + n) % n) + 1;
}

/* Does a step to row cy touch the rows along the seam? */
static inline bool ed_shear_concerns(const struct ed *ed, uint32_t cy)
{
    return cy <= 1 || cy >= ed->cells.ny;
}

/* Where the grain is shown at time t since the epoch, velocity included: within the box. */
struct ed_path ed_shear_place(const struct ed *ed, uint32_t i, double t);

/* Sets what follows from the scene and from `ahead`, at the present. */
void ed_shear_begin(struct ed *ed);

/* Tells `ahead` from an epoch that is t later. */
void ed_shear_shift(struct ed *ed, double t);

/* Moves grain i into cell (cx, cy), which may lie across a border. */
void ed_shear_cross(struct ed *ed, uint32_t i, uint32_t cx, uint32_t cy);

/* Scene time at which the image has slid by a cell; INFINITY if it stands still. */
double ed_shear_due(const struct ed *ed);

/* Carries that out. */
void ed_shear_slide(struct ed *ed);

#endif
