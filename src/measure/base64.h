/* base64.h - bytes as letters, for numbers inside XML.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BASE64_H
#define BASE64_H

#include <stddef.h>
#include <stdio.h>

/* Bytes on their way: three make four letters, so up to two wait. */
struct base64 {
    FILE *stream;
    unsigned char waiting[3];
    int count;
};

void base64_add(struct base64 *letters, const void *bytes, size_t size);

/* Writes what waits, padded with '='. */
void base64_flush(struct base64 *letters);

#endif
