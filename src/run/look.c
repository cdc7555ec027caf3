/* look.c - see look.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/look.h"

static bool make_room(struct grains *grains, uint32_t count, uint32_t contacts,
                      struct error *error)
{
    if (grains->capacity >= count && grains->contact_capacity >= contacts) return true;
    grains_free(grains);
    return grains_create(grains, count, contacts, error);
}

bool look_at(const struct simulation *sim, struct grains *grains, bool contacts,
             struct error *error)
{
    const uint64_t now = simulation_count(sim).grains;
    uint32_t count = now < UINT32_MAX / 2 ? (uint32_t)now + 16 : UINT32_MAX / 2;
    /* A disc packing has two contacts a grain at rest (isostatic with friction: 1.5); room for
     * three a grain is nearly always enough, and doubles when it is not. */
    uint32_t wanted = contacts ? 3 * count : 0;
    for (;;) {
        if (!make_room(grains, count, wanted, error)) return false;
        simulation_observe(sim, grains);
        if (grains->missed == 0) return true;
        if (count > UINT32_MAX / 4) return error_set(error, "more grains than a picture can hold");
        const bool grains_full = grains->count == grains->capacity;
        if (grains_full || !contacts) count = grains->capacity * 2;
        if (contacts) wanted = grains->contact_capacity * 2;
    }
}
