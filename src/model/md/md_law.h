/* md_law.h - the contact laws and what one collision under them looks like.
 *
 * Normal force (001 eqs. 10 and 11; 004 eq. 4), overlap xi, closing speed xi':
 *   linear   F = k xi + c xi'
 *   hertz    F = sqrt(R_eff) (2/3 alpha xi^(3/2) + beta sqrt(xi) xi')
 * clipped at zero, so that grains that part are never held back.
 *
 * Tangential force on the contact, slip speed v_t (001 eqs. 12 to 14; 004 eq. 7 with its sign
 * corrected), m the reduced mass:
 *   viscous      -g v_t
 *   coulomb      -min(g |v_t|, mu F) sign(v_t)
 *   spring       -(k_t s + g v_t), at most mu F; the spring s is kept at the limit.  Between steps
 *                it is kept as it will be half a step later, s + v_t dt/2: so it grows by v_t dt
 *                a step, and the force of each step is of second order.  With the whole step's
 *                growth in the force it would be that of half a step later and damp by k_t dt/2.
 *   haff-werner  -min(gamma m |v_t|, mu F) sign(v_t)
 *
 * The point of contact divides the line of centres as the radii do, so the lever of a tangential
 * force is R d / (R_i + R_j), d the distance: with R itself (004 eq. 10) a pair would not keep
 * its angular momentum while it overlaps.  Slip speeds use the same lever.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef MD_LAW_H
#define MD_LAW_H

#include "model/md/md_settings.h"

#include <stdbool.h>

/* Parameters of the contacts between two species. */
struct md_pair_law {
    double stiffness;           /* k or alpha */
    double damping, damping_mass;       /* c = damping + damping_mass sqrt(m); beta = damping */
    double friction;            /* mu */
    double tangent;             /* k_t as a share of the normal stiffness */
    double drag, drag_mass, drag_share; /* g = drag + drag_mass m + drag_share c */
};

struct md_law {
    bool   hertz, clip;
    bool   tangential, spring;  /* is there a tangential force, with a memory? */
};

/* Fills the table [species][species] from the resolved scene. */
void md_law_pairs(const struct scene *scene, const struct md_settings *settings,
                  struct md_pair_law *pairs);

/* Shortest duration of a contact in this scene at this impact speed. */
double md_law_contact_time(const struct scene *scene, const struct md_settings *settings,
                           double speed);

/* Force of one contact, in plain scalar form, for walls and for looking; the contact loop holds
 * the same law in a form for many contacts at once. */
struct md_touch {
    double overlap, closing;    /* xi and xi' */
    double slip;                /* v_t */
    double mass, radius;        /* reduced */
    double spring, dt;          /* s as the step before kept it */
};
struct md_force_out {
    double normal, tangential;
    double stretched, spring;   /* s now, and as it is kept for the next step */
};
struct md_force_out md_law_force(const struct md_law *law, const struct md_pair_law *pair,
                                 const struct md_touch *touch);

/* Elastic energy of a contact. */
double md_law_energy(const struct md_law *law, const struct md_pair_law *pair, double overlap,
                     double radius, double stretched);

#endif
