/* arena.c - see arena.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/arena.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Room for one more entry in the list of blocks. */
static bool reserve_entry(struct arena *arena)
{
    if (arena->block_count < arena->block_capacity) return true;
    const size_t capacity = arena->block_capacity ? 2 * arena->block_capacity : 16;
    void **blocks = realloc(arena->blocks, capacity * sizeof *blocks);
    if (!blocks) return false;
    arena->blocks = blocks;
    arena->block_capacity = capacity;
    return true;
}

void *arena_take(struct arena *arena, size_t count, size_t width)
{
    if (count == 0 || width == 0 || arena->failed) return NULL;
    const bool overflows = count > (SIZE_MAX - ARENA_ALIGNMENT) / width;
    if (overflows || !reserve_entry(arena)) {
        arena->failed = true;
        return NULL;
    }
    const size_t size = (count * width + ARENA_ALIGNMENT - 1) / ARENA_ALIGNMENT * ARENA_ALIGNMENT;
    void *block = aligned_alloc(ARENA_ALIGNMENT, size);
    if (!block) {
        arena->failed = true;
        return NULL;
    }
    memset(block, 0, size);
    arena->blocks[arena->block_count++] = block;
    arena->bytes += size;
    return block;
}

void arena_free(struct arena *arena)
{
    while (arena->block_count > 0) free(arena->blocks[--arena->block_count]);
    free(arena->blocks);
    *arena = (struct arena){0};
}
