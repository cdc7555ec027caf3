/* shortage.h - did memory run out while a frame was drawn?
 *
 * What lays text and lines over a frame draws what it can and has no way to fail; so it tells
 * here, and painter_frame() asks once, at the end: a picture that lacks something is an error.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SHORTAGE_H
#define SHORTAGE_H

#include <stdbool.h>

/* Returns `block`, and remembers if it is NULL; of this thread. */
void *shortage_check(void *block);

/* Was there one since the last call? */
bool shortage_ended(void);

#endif
