/* grains.c - see grains.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/grains.h"

bool grains_create(struct grains *grains, uint32_t capacity, uint32_t contact_capacity,
                   struct error *error)
{
    *grains = (struct grains){.capacity = capacity, .contact_capacity = contact_capacity,
                              .window = {1, 0, 0, 0}};
    struct arena *arena = &grains->arena;
    const bool done = arena_array(arena, &grains->id, capacity)
        && arena_array(arena, &grains->x, capacity) && arena_array(arena, &grains->y, capacity)
        && arena_array(arena, &grains->vx, capacity) && arena_array(arena, &grains->vy, capacity)
        && arena_array(arena, &grains->angle, capacity)
        && arena_array(arena, &grains->spin, capacity)
        && arena_array(arena, &grains->radius, capacity)
        && arena_array(arena, &grains->mass, capacity)
        && arena_array(arena, &grains->collision_rate, capacity)
        && arena_array(arena, &grains->collisions, capacity)
        && arena_array(arena, &grains->collisions_elastic, capacity)
        && arena_array(arena, &grains->species, capacity)
        && arena_array(arena, &grains->contacts, contact_capacity);
    if (done) return true;
    grains_free(grains);
    return error_set(error, "not enough memory for the picture of %u grains", capacity);
}

void grains_free(struct grains *grains)
{
    struct arena arena = grains->arena;
    *grains = (struct grains){0};
    arena_free(&arena);
}
