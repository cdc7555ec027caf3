/* look.c - see look.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/look.h"

#include <math.h>
#include <string.h>

enum { SAMPLE_SIDE = 1024 };            /* cells along the longer side of the box */

bool look_samples(const struct simulation *sim)
{
    return sim->model->sample && simulation_count(sim).grains > LOOK_LIST_MAX;
}

static bool take_sample(const struct simulation *sim, struct grains *grains, struct error *error)
{
    struct field *sample = &grains->sample;
    if (!sample->values) {
        const double *box = sim->scene->box;
        const double width = box[2] - box[0], height = box[3] - box[1];
        const double cell = fmax(width, height) / SAMPLE_SIDE;
        grains_free(grains);
        const uint32_t nx = (uint32_t)ceil(width / cell - 1e-9);
        const uint32_t ny = (uint32_t)ceil(height / cell - 1e-9);
        if (!field_create(sample, box[0], box[1], cell, nx, ny, SAMPLE_COMPONENTS, error)) {
            return false;
        }
    }
    memset(sample->values, 0, sizeof *sample->values * SAMPLE_COMPONENTS * sample->nx * sample->ny);
    grains->time = sample->time = simulation_count(sim).time;
    return sim->model->sample(sim->state, sample)
        || error_set(error, "not enough memory for a look at the lattice");
}

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
    if (look_samples(sim)) return take_sample(sim, grains, error);
    if (grains->sample.values) grains_free(grains);     /* there were more of them before */
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
