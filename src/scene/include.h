/* include.h - looks at what a scene includes before libconfig does.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef INCLUDE_H
#define INCLUDE_H

#include "scene/findings.h"

#include <stdbool.h>

/* True if each file that `text` includes, and what that includes in turn, may be handed to
 * libconfig; else tells a finding about the line that includes it.  What is not there at all is
 * left to libconfig to tell.  `file` is how findings name the text, `folder` where the included
 * files are. */
bool include_check(const char *text, const char *file, const char *folder,
                   struct findings *findings);

/* Does the text include anything? */
bool include_used(const char *text);

#endif
