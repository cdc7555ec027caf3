/* place_file.h - grains that lie as a file says.  SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PLACE_FILE_H
#define PLACE_FILE_H

#include "scene/placer.h"

/* Where the file of a placement lies: beside its scene, unless its path is absolute. */
void place_file_path(const struct scene *scene, const struct placement *placement, char *path,
                     size_t size);

/* Places the grains of the file of placement `number`, with their velocities; tells what does not
 * fit the scene.  Without a column for it a grain is of species `species_index`, and its radius is
 * drawn.  False: not enough memory. */
bool place_file(struct placer *placer, const struct placement *placement, uint32_t number,
                uint32_t species_index);

#endif
