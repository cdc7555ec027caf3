/* override.h - "KEY=VALUE" laid over the tree of a scene: -s, quick_set and phases.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef OVERRIDE_H
#define OVERRIDE_H

#include "scene/tree.h"

/* Sets (or adds) one key.  `file` and `line` are where the override itself was given: "-s", or
 * the line of quick_set or of the phase.  Tells what is wrong with it. */
void override_apply(struct tree *root, struct arena *arena, const char *text, const char *file,
                    int line, struct findings *findings);

#endif
