/* shortage.c - see shortage.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/shortage.h"

#include <stddef.h>

static _Thread_local bool shortage;

void *shortage_check(void *block)
{
    shortage = shortage || block == NULL;
    return block;
}

bool shortage_ended(void)
{
    const bool was = shortage;
    shortage = false;
    return was;
}
