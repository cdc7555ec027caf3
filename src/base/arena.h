/* arena.h - memory that is taken at create, owned once, and freed in one place.
 *
 * Every array is zeroed and begins on a cache line (64 bytes), so that SIMD loads never
 * straddle one.  An arena that is all zero is empty and ready.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ARENA_H
#define ARENA_H

#include <stdbool.h>
#include <stddef.h>

enum { ARENA_ALIGNMENT = 64 };

struct arena {
    void **blocks;              /* every block, in order of allocation */
    size_t block_count, block_capacity;
    size_t bytes;               /* handed out in all, for the memory report */
    bool failed;                /* sticks once an allocation failed */
};

/* A zeroed, aligned block of count * width bytes.  NULL if count or width is 0 (not a failure)
 * or if there is no memory (arena->failed is then set). */
void *arena_take(struct arena *arena, size_t count, size_t width);

/* Frees every block; the arena is empty and ready again. */
void arena_free(struct arena *arena);

/* Points *array to `count` zeroed elements (NULL when count is 0); false if there is no memory. */
#define arena_array(arena, array, count) \
    (*(array) = arena_take((arena), (size_t)(count), sizeof **(array)), !(arena)->failed)

#endif
