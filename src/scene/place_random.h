/* place_random.h - grains that lie anyhow.  SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PLACE_RANDOM_H
#define PLACE_RANDOM_H

#include "scene/placer.h"

/* Packs the region of placement `number` at random; tells if the grains jam.  False: not enough
 * memory. */
bool place_random(struct placer *placer, const struct placement *placement, uint32_t number,
                  uint32_t species_index);

#endif
