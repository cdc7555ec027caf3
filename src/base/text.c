/* text.c - see text.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "base/text.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static ssize_t add(void *context, const char *bytes, size_t size)
{
    struct text *text = context;
    if (text->capacity - text->size <= size) {
        const size_t capacity = 2 * (text->size + size) + 256;
        char *grown = text->failed ? NULL : realloc(text->bytes, capacity);
        if (!grown) {
            text->failed = true;
            errno = ENOMEM;
            return 0;
        }
        text->bytes = grown;
        text->capacity = capacity;
    }
    memcpy(text->bytes + text->size, bytes, size);
    text->size += size;
    text->bytes[text->size] = 0;
    return (ssize_t)size;
}

bool text_begin(struct text *text)
{
    *text = (struct text){0};
    text->stream = fopencookie(text, "w", (cookie_io_functions_t){.write = add});
    return text->stream && add(text, "", 0) == 0 && !text->failed;
}

char *text_end(struct text *text, size_t *size)
{
    const bool written = text->stream && !ferror(text->stream);
    const bool whole = text->stream && fclose(text->stream) == 0 && written && !text->failed;
    char *bytes = text->bytes;
    if (size) *size = text->size;
    *text = (struct text){0};
    if (whole) return bytes;
    free(bytes);
    return NULL;
}
