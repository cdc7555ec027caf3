/* base64.c - see base64.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/base64.h"

#include <string.h>

void base64_flush(struct base64 *letters)
{
    static const char alphabet[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *b = letters->waiting;
    char text[4];
    if (letters->count == 0) return;
    memset(letters->waiting + letters->count, 0, (size_t)(3 - letters->count));
    text[0] = alphabet[b[0] >> 2];
    text[1] = alphabet[(b[0] & 3) << 4 | b[1] >> 4];
    text[2] = letters->count > 1 ? alphabet[(b[1] & 15) << 2 | b[2] >> 6] : '=';
    text[3] = letters->count > 2 ? alphabet[b[2] & 63] : '=';
    fwrite(text, 1, sizeof text, letters->stream);
    letters->count = 0;
}

void base64_add(struct base64 *letters, const void *bytes, size_t size)
{
    const unsigned char *from = bytes;
    for (size_t k = 0; k < size; k++) {
        letters->waiting[letters->count++] = from[k];
        if (letters->count == 3) base64_flush(letters);
    }
}
