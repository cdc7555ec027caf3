/* source.h - grains that enter while a model runs, the same for every model.
 *
 * A source gives batches: one grain of a point source, one column of a stream.  Batch k is a pure
 * function of the scene's seed, the source and k, so nothing but k needs to be remembered, and
 * the stream does not depend on when or how often somebody asks.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SOURCE_H
#define SOURCE_H

#include "base/archive.h"
#include "scene/scene.h"

#include <stdint.h>

struct source_grain {
    double   t, x, y, vx, vy, radius;   /* where and how fast at its time of birth t */
    uint16_t species;
};

struct source_cursor {          /* one for each source; kept and archived by the model */
    uint64_t next;              /* batch */
    uint64_t made;              /* grains so far */
};

/* When batch k is born; INFINITY if the source is over by then. */
double source_time(const struct scene *scene, uint32_t source, uint64_t k);

/* The grains of batch k; returns how many (never more than `room`). */
uint32_t source_batch(const struct scene *scene, uint32_t source, uint64_t k,
                      struct source_grain *out, uint32_t room);

/* Most grains that any batch of this scene can have. */
uint32_t source_batch_max(const struct scene *scene);

/* When the next batch of this source is due; INFINITY if it has given all. */
double source_due(const struct scene *scene, uint32_t source, const struct source_cursor *cursor);

/* Each source's cursor under a name of its own, so that a later phase may bring more of them. */
void source_archive(const struct scene *scene, struct source_cursor *cursors,
                    struct archive *archive);

/* Where the grain is at time t if it has flown freely since its birth. */
struct source_grain source_flown(const struct scene *scene, const struct source_grain *grain,
                                 double t);

#endif
