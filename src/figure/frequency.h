/* frequency.h - how many collisions each grain had in a window of time, as curves, laws and verdicts
 * (cooperative 12 and 14).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FREQUENCY_H
#define FREQUENCY_H

#include "figure/lab.h"
#include "measure/distribution.h"

/* Collisions of each grain (by id) since the last call, into `counts`; `last` remembers.  Both have
 * room for so many ids; false if one is larger. */
bool frequency_since(const struct lab *lab, uint32_t *last, uint32_t *counts, uint32_t room);

/* P(Nc) as points of the present curve, counts divided by `span`, in bins that widen with the count
 * so that each holds enough. */
void frequency_curve(struct chart *chart, const struct distribution *d, double span);

/* A new curve: the law that fits. */
void frequency_law(struct chart *chart, const struct distribution *d, double span,
                   enum distribution_law law);

/* Holds that `wanted` fits best. */
void frequency_tell(struct figure_job *job, const char *when, const struct distribution *d,
                    enum distribution_law wanted);

#endif
