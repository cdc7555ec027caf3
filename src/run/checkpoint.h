/* checkpoint.h - a run that can go on: two files written in turn, each whole and verified.
 *
 * A file is a header (magic, versions, sizes and hashes of what follows), the resolved scene, and
 * the bytes of an archive that holds the simulation and the run's own place in its output.  The
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

/* Writes the saved archive as `directory`/0.checkpoint or 1.checkpoint, whichever `turn` is.
 * `scene` is the resolved scene's text. */
bool checkpoint_save(const char *directory, uint64_t turn, const char *scene,
                     const struct archive *archive, struct error *error);

/* The same under a name of its own (a broken state). */
bool checkpoint_save_as(const char *path, uint64_t turn, const char *scene,
                        const struct archive *archive, struct error *error);

/* Loads the newest whole checkpoint: *bytes is malloc'ed, the caller frees; *turn its number.
 * False if there is none, if all are torn, or if it belongs to another version of sandreel or to
 * another scene (EXIT_USAGE); then the error tells what differs. */
bool checkpoint_load(const char *directory, const char *scene, void **bytes, size_t *size,
                     uint64_t *turn, struct error *error);

/* Is there a checkpoint, whole or not? */
bool checkpoint_exists(const char *directory);

#endif
