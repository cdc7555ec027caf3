/* portrait.c - see portrait.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/portrait.h"

#include <math.h>

bool portrait_find(const struct grains *grains, uint64_t id, uint32_t *i)
{
    for (*i = 0; *i < grains->count; ++*i) if (grains->id[*i] == id) return true;
    return false;
}

bool portrait_nearest(const struct grains *grains, double x, double y, uint32_t *i)
{
    double least = INFINITY;
    for (uint32_t k = 0; k < grains->count; k++) {
        const double distance = hypot(grains->x[k] - x, grains->y[k] - y);
        if (distance >= least) continue;
        least = distance;
        *i = k;
    }
    return grains->count > 0;
}

/* The contacts of grain i, each with the force on i. */
static json_t *contacts_of(const struct grains *grains, uint32_t i)
{
    json_t *list = json_array();
    for (uint32_t k = 0; grains->contacts && k < grains->contact_count; k++) {
        const struct contact *c = &grains->contacts[k];
        if (c->i != i && c->j != i) continue;
        const double sign = c->i == i ? 1 : -1;
        json_t *with = c->j >= CONTACT_WALL ? json_sprintf("wall %u", c->j - CONTACT_WALL)
                     : json_sprintf("grain %u", grains->id[c->i == i ? c->j : c->i]);
        json_array_append_new(list, json_pack("{s:o, s:f, s:f, s:f, s:f, s:f}", "with", with,
            "x", (double)c->x, "y", (double)c->y, "fx", sign * (double)c->fx,
            "fy", sign * (double)c->fy, "overlap", (double)c->overlap));
    }
    return list;
}

json_t *portrait_grain(const struct grains *grains, uint32_t i)
{
    return json_pack("{s:f, s:I, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:i, s:f, s:o}",
        "time", grains->time, "id", (json_int_t)grains->id[i],
        "x", grains->x[i], "y", grains->y[i], "vx", grains->vx[i], "vy", grains->vy[i],
        "angle", grains->angle[i], "spin", grains->spin[i], "radius", grains->radius[i],
        "mass", grains->mass[i], "species", (int)grains->species[i],
        "collision_rate", (double)grains->collision_rate[i], "contacts", contacts_of(grains, i));
}
