/* grains.c - see grains.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/grains.h"

#include <stdlib.h>
#include <string.h>

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
    field_free(&grains->sample);
    *grains = (struct grains){0};
    arena_free(&arena);
}

double grains_number(const struct grains *grains)
{
    const struct field *sample = &grains->sample;
    if (!sample->values) return grains->count;
    const size_t cells = (size_t)sample->nx * sample->ny;
    double sum = 0;
    for (size_t k = 0; k < cells; k++) sum += sample->values[SAMPLE_COUNT * cells + k];
    return sum;
}

struct rank { uint32_t id, row; };

static int rank_compare(const void *a, const void *b)
{
    const struct rank *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

/* values[k] becomes what was values[ranks[k].row]. */
static void permute(void *values, size_t width, const struct rank *ranks, uint32_t count,
                    unsigned char *scratch)
{
    unsigned char *bytes = values;
    if (!bytes) return;
    for (size_t k = 0; k < count; k++) {
        memcpy(scratch + k * width, bytes + ranks[k].row * width, width);
    }
    memcpy(bytes, scratch, count * width);
}

bool grains_sort(struct grains *grains, struct error *error)
{
    const uint32_t count = grains->count;
    uint32_t sorted = 1;
    grains->contact_count = 0;
    while (sorted < count && grains->id[sorted - 1] < grains->id[sorted]) sorted++;
    if (sorted >= count) return true;
    struct rank *ranks = malloc(count * sizeof *ranks);
    unsigned char *scratch = malloc(count * sizeof(double));
    if (ranks && scratch) {
        for (uint32_t k = 0; k < count; k++) ranks[k] = (struct rank){grains->id[k], k};
        qsort(ranks, count, sizeof *ranks, rank_compare);
        double *const numbers[] = {grains->x, grains->y, grains->vx, grains->vy, grains->angle,
                                   grains->spin, grains->radius, grains->mass};
        for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) {
            permute(numbers[n], sizeof(double), ranks, count, scratch);
        }
        permute(grains->id, sizeof *grains->id, ranks, count, scratch);
        permute(grains->collision_rate, sizeof *grains->collision_rate, ranks, count, scratch);
        permute(grains->species, sizeof *grains->species, ranks, count, scratch);
    }
    const bool done = ranks && scratch;
    free(scratch);
    free(ranks);
    return done || error_set(error, "not enough memory to sort %u grains", count);
}
