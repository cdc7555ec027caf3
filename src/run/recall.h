/* recall.h - what an earlier run remembers in its manifest.json.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef RECALL_H
#define RECALL_H

#include "scene/scene.h"

#include <jansson.h>

/* The manifest as JSON, a new reference; NULL with the cause. */
json_t *recall_manifest(const char *run, struct error *error);

/* *done: is there a manifest, and does it say that this run came to its end?  False if it cannot be
 * read: what may be done is not to be begun anew. */
bool recall_done(const char *run, bool *done, struct error *error);
bool recall_says_done(const json_t *manifest);

/* If `run` is a run whose grains were coloured as `view` wants it, and view->range is open: takes
 * the range of that run.  False if its manifest cannot be read. */
bool recall_range(const char *run, const struct scene *scene, struct view *view,
                  struct error *error);

#endif
