/* md_law.c - see md_law.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/md/md_law.h"

#include "model/contact.h"
#include "model/speed.h"
#include "scene/resolve.h"

#include <math.h>

/* Springs in series; equal species keep their own value. */
static double in_series(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0; }

static double restitution_of(const struct species *a, const struct species *b)
{
    return sqrt(a->restitution * b->restitution);
}

/* Normal damping: from the restitution if both have one, else the dashpots as given. */
static void set_damping(struct md_pair_law *pair, const struct md_settings *settings,
                        const struct species *a, const struct species *b, double speed)
{
    const double restitution = restitution_of(a, b);
    const bool given = isfinite(a->damping) && isfinite(b->damping);
    if (given) {
        pair->damping = sqrt(a->damping * b->damping);
    } else if (settings->force == MD_LINEAR) {
        const double eta = contact_linear_damping(isfinite(restitution) ? restitution : 1,
                                                 settings->clip);
        pair->damping_mass = 2 * eta * sqrt(pair->stiffness);
    } else {
        /* A viscoelastic contact has no one restitution: it holds at the speed estimated. */
        const double ra = resolve_radius_mean(a);
        const double rb = resolve_radius_mean(b);
        const double ma = scene_mass(a, ra), mb = scene_mass(b, rb);
        const double length = contact_hertz_length(pair->stiffness, ma * mb / (ma + mb),
                                                  ra * rb / (ra + rb), speed);
        pair->damping = contact_hertz_damping(isfinite(restitution) ? restitution : 1,
                                             settings->clip) * pair->stiffness * length / speed;
    }
}

static void set_tangential(struct md_pair_law *pair, const struct md_settings *settings,
                           double friction)
{
    const bool given = isfinite(settings->tangential_damping);
    const double damping = given ? settings->tangential_damping : 0;
    pair->friction = friction;
    switch (settings->tangential) {
    case MD_NONE:
        pair->friction = 0;
        break;
    case MD_VISCOUS:
        pair->friction = 1e200;                                 /* no limit */
        pair->drag = damping;
        break;
    case MD_COULOMB:
        pair->drag = damping;
        break;
    case MD_SPRING:
        pair->tangent = settings->tangential_stiffness;
        pair->drag = damping;
        pair->drag_share = given ? 0 : 0.5;
        break;
    case MD_HAFF_WERNER:
        pair->drag_mass = damping;
        break;
    }
}

void md_law_pairs(const struct scene *scene, const struct md_settings *settings,
                  struct md_pair_law *pairs)
{
    const double speed = isfinite(settings->speed) ? settings->speed : speed_greatest(scene);
    for (uint32_t a = 0; a < scene->species_count; a++) {
        for (uint32_t b = 0; b < scene->species_count; b++) {
            const struct species *first = &scene->species[a], *second = &scene->species[b];
            struct md_pair_law *pair = &pairs[a * scene->species_count + b];
            *pair = (struct md_pair_law){.stiffness = in_series(first->stiffness,
                                                                second->stiffness)};
            set_damping(pair, settings, first, second, speed);
            set_tangential(pair, settings, sqrt(first->friction * second->friction));
        }
    }
}

double md_law_contact_time(const struct scene *scene, const struct md_settings *settings,
                           double speed)
{
    double shortest = INFINITY;
    for (uint32_t k = 0; k < scene->species_count; k++) {
        const struct species *s = &scene->species[k];
        const double radius = resolve_radius_min(s);
        const double mass = 0.5 * scene_mass(s, radius);        /* of a pair of the smallest */
        double time;
        if (settings->force == MD_LINEAR) {
            time = M_PI * sqrt(mass / s->stiffness);
        } else {
            time = contact_hertz(0, true).time / speed
                 * contact_hertz_length(s->stiffness, mass, 0.5 * radius, speed);
        }
        shortest = fmin(shortest, time);
    }
    return shortest;
}

struct md_force_out md_law_force(const struct md_law *law, const struct md_pair_law *pair,
                                 const struct md_touch *touch)
{
    struct md_force_out out = {0, 0, 0, 0};
    double stiffness = pair->stiffness;
    double damping = pair->damping + pair->damping_mass * sqrt(touch->mass);
    if (law->hertz) {
        const double root = sqrt(touch->radius * touch->overlap);
        stiffness *= root;                                      /* dF/dxi */
        damping *= root;
        out.normal = 2.0 / 3.0 * stiffness * touch->overlap + damping * touch->closing;
    } else {
        out.normal = stiffness * touch->overlap + damping * touch->closing;
    }
    if (law->clip && out.normal < 0) out.normal = 0;
    if (!law->tangential) return out;

    const double limit = pair->friction * fmax(out.normal, 0);
    const double drag = pair->drag + pair->drag_mass * touch->mass + pair->drag_share * damping;
    const double tangent = stiffness * pair->tangent;
    const double half = 0.5 * touch->slip * touch->dt, stretched = touch->spring + half;
    const double pull = -(tangent * stretched + drag * touch->slip);
    out.tangential = fmin(fmax(pull, -limit), limit);
    if (!law->spring) return out;
    const bool slides = out.tangential != pull;                 /* the spring stays at mu F / k_t */
    out.stretched = slides ? -out.tangential / tangent : stretched;
    out.spring = slides ? out.stretched : stretched + half;
    return out;
}

double md_law_energy(const struct md_law *law, const struct md_pair_law *pair, double overlap,
                     double radius, double stretched)
{
    const double root = law->hertz ? sqrt(radius * overlap) : 1;
    const double normal = law->hertz ? 4.0 / 15.0 * pair->stiffness * root * overlap * overlap
                                     : 0.5 * pair->stiffness * overlap * overlap;
    return normal + 0.5 * pair->tangent * pair->stiffness * root * stretched * stretched;
}
