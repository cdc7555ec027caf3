/* cost_cache.h - runs of a reference are kept, for they take longest and never change.
 *
 * A run is known by the hash of its resolved scene (every key with its value, the seed and what
 * the model chose among them), of the grains, and of the program itself: a program that was built
 * anew measures anew.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef COST_CACHE_H
#define COST_CACHE_H

#include "base/file.h"
#include "bench/cost_row.h"

/* Of the scene with these overrides, as it stands in its file: model, seed, how it looks and what
 * a run writes is left out.  0 if it cannot be read. */
uint64_t cost_cache_hash(const char *path, const char *const *overrides, uint32_t count);

/* $XDG_CACHE_HOME/sandreel or ~/.cache/sandreel; NULL if there is neither. */
const char *cost_cache_directory(char directory[FILE_PATH_MAX]);

/* False if the run is not there, or not whole. */
bool cost_cache_load(const char *directory, const struct scene *scene, unsigned observables,
                     struct cost_rows *rows);

/* Keeps a run.  A directory that cannot be written only means that nothing is kept. */
void cost_cache_save(const char *directory, const struct scene *scene, unsigned observables,
                     const struct cost_rows *rows);

#endif
