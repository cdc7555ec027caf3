/* place_lattice.h - grains in rows.  SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PLACE_LATTICE_H
#define PLACE_LATTICE_H

#include "scene/placer.h"

/* Fills the region of placement `number` from the bottom row upwards; false if memory is short. */
bool place_lattice(struct placer *placer, const struct placement *placement, uint32_t number,
                   uint32_t species_index);

#endif
