/* ed_law.h - what a collision does: Walton and Braun's law with the TC rule (cooperative,
 * eqs. 1 to 7).
 *
 * The normal impulse is (1 + r) m12 |v_n|.  The tangential one would make the contact points
 * rebound with -beta0 of their slip, but at most mu times the normal impulse: beta = min(beta0,
 * beta1).  With inertia q m R^2 the factor of eq. (6) is q / (1 + q), so 2/7 for spheres and 1/3
 * for discs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_LAW_H
#define ED_LAW_H

#include "base/arena.h"
#include "scene/scene.h"

#include <math.h>

struct ed_settings;

/* Contact parameters of two species, or of a species and a wall. */
struct ed_pair { double restitution, friction, tangential; };

struct ed_law {
    uint32_t species_count;
    struct ed_pair *pairs;      /* [a][b] */
    struct ed_pair *walls;      /* [species][species of the wall] */
    double *inertia_factor;     /* q by species: I = q m R^2 */
    double t_c;
    double exponent, per_speed; /* viscoelastic: 1 - r ~ (v / reference)^exponent; 0: constant */
    bool   spins;               /* someone has friction */
    double return_max;          /* contacts under the TC rule give back what friction took until
                                 * they separate with this speed; 0: never */
};

bool ed_law_create(struct ed_law *law, const struct scene *scene,
                   const struct ed_settings *settings, struct arena *arena);

/* The restitution that the dashpots of two species make at the reference speed, for grains of mean
 * size; at a wall made of species b if `wall`.  Stiffness and damping must be given. */
double ed_law_derived(const struct species *a, const struct species *b,
                      const struct ed_settings *settings, bool wall);

/* Coefficient of restitution at normal speed v. */
static inline double ed_law_restitution(const struct ed_law *law, double r, double v)
{
    if (law->exponent == 0) return r;
    return fmin(fmax(1 - (1 - r) * pow(v * law->per_speed, law->exponent), 0), 1);
}

/* Speed of separation with which a contact of reduced mass m12 keeps the energy that the tangential
 * impulse takes from its slip, as far as `return_max` allows: w = J s + J^2 / 2 m_t is added to
 * m12 v^2 / 2. */
static inline double ed_law_return(const struct ed_law *law, double closing, double slip,
                                   double mobility, double impulse, double m12)
{
    const double gain = impulse * (slip + 0.5 * mobility * impulse);            /* <= 0 */
    return fmin(sqrt(fmax(closing * closing - 2 * gain / m12, 0)), law->return_max);
}

/* Tangential impulse on body 1 along t, for a slip of the contact points along t and the normal
 * impulse.  `mobility` is 1/m_t = (1 + 1/q1)/m1 + (1 + 1/q2)/m2. */
static inline double ed_law_tangential(const struct ed_pair *pair, double slip, double mobility,
                                       double normal)
{
    const double sticking = (1 + pair->tangential) * fabs(slip) / mobility;
    return -copysign(fmin(sticking, pair->friction * normal), slip);
}

#endif
