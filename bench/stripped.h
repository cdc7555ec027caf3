/* stripped.h - soft discs by hand, to see what effects that are off still cost.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STRIPPED_H
#define STRIPPED_H

#include "base/error.h"

#include <stdbool.h>

struct stripped_result {
    double model, by_hand;      /* processor seconds of a step: the model's, with nothing on */
    double model_bytes, by_hand_bytes;  /* of the state, for a grain */
    double apart;               /* largest distance of a grain in one from itself in the other */
};

/* Lets md and the kernel by hand run the same elastic gas from the same state, by turns. */
bool stripped_measure(struct stripped_result *result, struct error *error);

#endif
