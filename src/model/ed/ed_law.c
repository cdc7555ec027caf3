/* ed_law.c - see ed_law.h: the parameters of every pair of species.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_law.h"

#include "model/contact.h"
#include "model/ed/ed.h"
#include "scene/resolve.h"

double ed_law_derived(const struct species *a, const struct species *b,
                      const struct ed_settings *settings, bool wall)
{
    /* Springs in series and the mean of dashpots, as soft discs have them (md_law.c). */
    const double stiffness = 2 * a->stiffness * b->stiffness / (a->stiffness + b->stiffness),
                 damping = sqrt(a->damping * b->damping);
    const double ra = resolve_radius_mean(a), rb = resolve_radius_mean(b);
    const double ma = scene_mass(a, ra), mb = scene_mass(b, rb);
    const double mass = wall ? ma : ma * mb / (ma + mb), radius = wall ? ra : ra * rb / (ra + rb);
    if (settings->force == ED_LINEAR) {
        return contact_linear(damping / (2 * sqrt(stiffness * mass)), true).restitution;
    }
    const double speed = settings->reference_speed;
    const double length = contact_hertz_length(stiffness, mass, radius, speed);
    return contact_hertz(damping * speed / (stiffness * length), true).restitution;
}

static bool is_damped(const struct species *species)
{
    return !isnan(species->damping) && !isnan(species->stiffness);
}

/* A species that leaves its restitution open keeps its energy, if nothing damps it. */
static double restitution_of(const struct species *species, const struct ed_settings *settings)
{
    if (!isnan(species->restitution)) return species->restitution;
    return isnan(settings->restitution) ? 1 : settings->restitution;
}

static struct ed_pair mixed(const struct species *a, const struct species *b,
                            const struct ed_settings *settings, bool wall)
{
    const bool derives = isnan(a->restitution) && isnan(b->restitution)
                      && isnan(settings->restitution) && is_damped(a) && is_damped(b);
    /* Geometric means, as for soft discs. */
    const double r = derives ? ed_law_derived(a, b, settings, wall)
                             : sqrt(restitution_of(a, settings) * restitution_of(b, settings));
    return (struct ed_pair){r, sqrt(a->friction * b->friction), settings->tangential};
}

/* Greatest speed, in g t_c, that friction gives back (`elastic = "rest"`).  A grain that carries
 * N others and is hit with v has N g / v contacts in a unit of time, whatever the law: a bed that
 * hardly stirs costs many events, one that stirs creeps about as fast as it stirs.  With ten, beds
 * up to ten grains deep rest at about one contact in t_c.  More lets sand that flows slip without
 * loss: without a bound the small hourglass ran out 5 % sooner than with 1, with 16 by 3 %, with 4
 * by 1 %, at a fourteenth, a seventh and a third of the cost; and its heap went on sloshing. */
static const double rest_speed = 10;

bool ed_law_create(struct ed_law *law, const struct scene *scene,
                   const struct ed_settings *settings, struct arena *arena)
{
    const uint32_t n = scene->species_count;
    *law = (struct ed_law){.species_count = n, .t_c = settings->t_c,
                           .return_max = settings->elastic == ED_ELASTIC_REST
                               ? rest_speed * hypot(scene->gravity[0], scene->gravity[1])
                                            * settings->t_c : 0,
                           .exponent = settings->exponent,
                           .per_speed = 1 / settings->reference_speed};
    if (!arena_array(arena, &law->pairs, (size_t)n * n)
        || !arena_array(arena, &law->walls, (size_t)n * n)
        || !arena_array(arena, &law->inertia_factor, n)) return false;
    for (uint32_t a = 0; a < n; a++) {
        law->inertia_factor[a] = scene->species[a].inertia == INERTIA_SPHERE ? 0.4 : 0.5;
        for (uint32_t b = 0; b < n; b++) {
            struct ed_pair *pair = &law->pairs[a * n + b], *wall = &law->walls[a * n + b];
            *pair = mixed(&scene->species[a], &scene->species[b], settings, false);
            *wall = mixed(&scene->species[a], &scene->species[b], settings, true);
            if (!isnan(settings->wall_restitution)) wall->restitution = settings->wall_restitution;
            if (!isnan(settings->wall_friction)) wall->friction = settings->wall_friction;
            if (!isnan(settings->wall_tangential)) wall->tangential = settings->wall_tangential;
            law->spins = law->spins || pair->friction > 0 || wall->friction > 0;
        }
    }
    return true;
}
