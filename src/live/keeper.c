/* keeper.c - see keeper.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/keeper.h"

#include <stdlib.h>

static const size_t bytes_max = (size_t)256 << 20;

static bool append(struct keeper *keeper, const struct simulation *sim, uint64_t turn,
                   struct error *error)
{
    if (keeper->count == keeper->capacity) {
        const uint32_t capacity = 2 * keeper->capacity + 16;
        struct keeper_state *grown = realloc(keeper->states, capacity * sizeof *grown);
        if (!grown) return error_set(error, "not enough memory to keep a state");
        keeper->states = grown;
        keeper->capacity = capacity;
    }
    struct keeper_state *state = &keeper->states[keeper->count];
    *state = (struct keeper_state){.time = simulation_count(sim).time, .phase = sim->phase,
                                   .turn = turn};
    archive_begin_save(&state->archive);
    if (!simulation_save(sim, &state->archive, error)) {
        archive_end(&state->archive);
        return false;
    }
    logging_archive(keeper->logging, &state->archive);
    keeper->bytes += state->archive.size;
    keeper->count++;
    return true;
}

bool keeper_open(struct keeper *keeper, const struct simulation *sim, struct logging *logging,
                 double interval, struct error *error)
{
    *keeper = (struct keeper){.interval = interval, .start = simulation_count(sim).time,
                              .next = 1, .logging = logging};
    return append(keeper, sim, 0, error);
}

static void drop(struct keeper *keeper, uint32_t k)
{
    keeper->bytes -= keeper->states[k].archive.size;
    archive_end(&keeper->states[k].archive);
}

void keeper_close(struct keeper *keeper)
{
    for (uint32_t k = 0; k < keeper->count; k++) drop(keeper, k);
    free(keeper->states);
    *keeper = (struct keeper){0};
}

double keeper_due(const struct keeper *keeper)
{
    return keeper->start + (double)keeper->next * keeper->interval;
}

static void thin_out(struct keeper *keeper)
{
    uint32_t kept = 0;
    for (uint32_t k = 0; k < keeper->count; k++) {
        if (keeper->states[k].turn % 2) {
            drop(keeper, k);
            continue;
        }
        keeper->states[kept] = keeper->states[k];
        keeper->states[kept++].turn /= 2;
    }
    keeper->count = kept;
    keeper->interval *= 2;
    keeper->next = keeper->states[kept - 1].turn + 1;
}

bool keeper_keep(struct keeper *keeper, const struct simulation *sim, struct error *error)
{
    if (!append(keeper, sim, keeper->next++, error)) return false;
    while (keeper->bytes > bytes_max && keeper->count > 2) thin_out(keeper);
    return true;
}

const struct keeper_state *keeper_before(const struct keeper *keeper, double time)
{
    uint32_t k = keeper->count - 1;
    while (k > 0 && keeper->states[k].time >= time) k--;
    return &keeper->states[k];
}

void keeper_rewind(struct keeper *keeper, const struct keeper_state *state)
{
    const uint32_t kept = (uint32_t)(state - keeper->states) + 1;
    for (uint32_t k = kept; k < keeper->count; k++) drop(keeper, k);
    keeper->count = kept;
    keeper->next = state->turn + 1;
}
