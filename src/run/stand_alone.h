/* stand_alone.h - a scene in a run's directory, with the files that it reads.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STAND_ALONE_H
#define STAND_ALONE_H

#include "scene/scene.h"

/* Writes the resolved scene to `path`.  Files that placements read are copied into `directory` as
 * placement0.txt, ... (a run that is resumed has them already), and the scene names those. */
bool stand_alone_write(const struct scene *scene, const char *directory, bool resume,
                       const char *path, struct error *error);

#endif
