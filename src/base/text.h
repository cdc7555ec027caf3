/* text.h - a text that is put together with fprintf() and kept in memory, or not at all.
 *
 * open_memstream() does not tell that memory ran short in the middle of a text: what is missing is
 * just missing.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef TEXT_H
#define TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct text {
    FILE  *stream;              /* for fprintf and friends */
    char  *bytes;
    size_t size, capacity;
    bool   failed;
};

/* False if memory is short. */
bool text_begin(struct text *text);

/* The whole text with a zero byte behind it; the caller frees.  NULL if memory ran short anywhere.
 * `size` (may be NULL) gets its length. */
char *text_end(struct text *text, size_t *size);

#endif
