/* resolved.h - is a resolved scene the one that a run was made from, and if not, what differs?
 *
 * Works on the text that scene_write() leaves: one key a line.  Comments and `until` do not
 * count: a run may be continued to a later end.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef RESOLVED_H
#define RESOLVED_H

#include <stddef.h>
#include <stdint.h>

/* The same number for texts that say the same. */
uint64_t resolved_hash(const char *text);

/* "seed: 1 there, 7 here; ...": the first keys whose values differ between `there` and `here`, as
 * many as `size` bytes hold.  Returns text; "" if nothing differs. */
char *resolved_difference(const char *there, const char *here, char *text, size_t size);

#endif
