/* build.h - what this program is made of: its version and those of its libraries.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef BUILD_H
#define BUILD_H

#include <jansson.h>

extern const char *const build_version;

/* {"sandreel": "0.1.0", "libpng": "1.6.39", ...}; a new reference. */
json_t *build_versions(void);

#endif
