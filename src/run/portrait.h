/* portrait.h - all there is to tell about one grain, as JSON.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PORTRAIT_H
#define PORTRAIT_H

#include "model/grains.h"

#include <jansson.h>

/* The entry of the grain with this id; false if it is not there. */
bool portrait_find(const struct grains *grains, uint64_t id, uint32_t *i);

/* The entry of the grain whose centre is nearest to a point; false if there is no grain. */
bool portrait_nearest(const struct grains *grains, double x, double y, uint32_t *i);

/* Its state and its contacts, each with the force on it; a new reference. */
json_t *portrait_grain(const struct grains *grains, uint32_t i);

#endif
