/* heap.h - how much memory is taken now, to weigh what a model takes at create.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef HEAP_H
#define HEAP_H

#include <malloc.h>

static inline double heap_bytes(void)
{
    const struct mallinfo2 now = mallinfo2();
    return (double)now.uordblks + (double)now.hblkhd;
}

#endif
