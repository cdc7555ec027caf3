/* manifest.h - manifest.json: what a run was made of and with, and what it cost.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MANIFEST_H
#define MANIFEST_H

#include "run/run.h"

#include <jansson.h>

struct manifest {
    const struct scene *scene;
    const struct model *model;
    const char *status;         /* "running", "done", "interrupted", "stopped", "broken", ... */
    uint64_t scene_hash;
    const struct run_result *result;    /* NULL while it runs */
    const double *range;        /* of the colours; NULL, or NANs: not known */
};

bool manifest_save(const struct manifest *manifest, const char *directory, struct error *error);

/* Text of any bytes (a file's name, what a user typed) as a JSON string: if it is not UTF-8, with
 * a question mark for each strange byte.  NULL: no memory. */
json_t *manifest_text(const char *text);

#endif
