/* ed_epoch.h - moving the epoch up to the present, and grains to where their neighbours are.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_EPOCH_H
#define ED_EPOCH_H

#include <stdint.h>

struct ed;

/* Makes `now` the epoch: positions and events are told from it, grains are sorted in space, the
 * measures of time and speed are taken anew, and the calendar is rebuilt. */
void ed_epoch_begin(struct ed *ed);

/* The first part of it: tells positions, velocities and events from the present. */
void ed_epoch_shift(struct ed *ed);

/* Puts every grain into the cell where it is now. */
void ed_epoch_file(struct ed *ed);

/* Makes every event anew. */
void ed_epoch_predict(struct ed *ed);

/* Copies all that belongs to one grain. */
void ed_epoch_copy(struct ed *ed, uint32_t to, uint32_t from);

#endif
