/* pair.h - the pair correlation g(r): how much oftener grains lie at a distance r than if they
 * were strewn at random (cooperative, section 3.3).
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PAIR_H
#define PAIR_H

#include "base/error.h"
#include "model/grains.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

struct pair {
    uint32_t bins;
    double   width;             /* of a bin; bin k covers k .. k + 1 widths */
    double  *g, *error;         /* of each bin, and its error of counting */
    uint64_t *pairs;
    uint32_t grains;            /* that were counted as centres */
};

/* g up to `reach` in `bins` bins, over all grains of the scene's box.  Distances go around through
 * periodic borders; at other borders a centre counts only with the circles that lie wholly
 * inside, so that no edge bends g.  False: `reach` exceeds half of a periodic side, or no memory.
 * The caller frees. */
bool pair_create(const struct grains *grains, const struct scene *scene, double reach,
                 uint32_t bins, struct pair *pair, struct error *error);
void pair_free(struct pair *pair);

#endif
