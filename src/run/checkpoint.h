/* checkpoint.h - a run that can go on: two files written in turn, each whole and verified.
 *
 * A file is a header (magic, version, hash of the scene, size and hash of what follows) and the
 * bytes of an archive that holds the simulation and the run's own place in its output.  The
 * older of the two is overwritten, so one good file is always there; loading takes the newer one
 * and falls back to the other when it is torn.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CHECKPOINT_H
#define CHECKPOINT_H

#include "base/archive.h"
#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* Writes the saved archive as `directory`/0.checkpoint or 1.checkpoint, whichever `turn` is. */
bool checkpoint_save(const char *directory, uint64_t turn, uint64_t scene_hash,
                     const struct archive *archive, struct error *error);

/* The same under a name of its own (a broken state). */
bool checkpoint_save_as(const char *path, uint64_t turn, uint64_t scene_hash,
                        const struct archive *archive, struct error *error);

/* Loads the newest whole checkpoint: *bytes is malloc'ed, the caller frees; *turn its number.
 * False if there is none, if all are torn, or if it belongs to another scene. */
bool checkpoint_load(const char *directory, uint64_t scene_hash, void **bytes, size_t *size,
                     uint64_t *turn, struct error *error);

#endif
