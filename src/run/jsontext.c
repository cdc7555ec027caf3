/* jsontext.c - see jsontext.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/jsontext.h"

#include <stdlib.h>

static _Thread_local bool failed;

static void *take(size_t size)
{
    void *block = malloc(size);
    failed = failed || !block;
    return block;
}

void jsontext_guard(void)
{
    json_set_alloc_funcs(take, free);
}

char *jsontext_dump(const json_t *root, size_t flags)
{
    char *text = root ? json_dumps(root, flags) : NULL;
    const bool whole = !failed;
    failed = false;
    if (whole) return text;
    free(text);
    return NULL;
}

bool jsontext_failed(void)
{
    return failed;
}
