/* md_settings.h - the keys of `md` in a scene file, and what resolve() makes of them.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MD_SETTINGS_H
#define MD_SETTINGS_H

#include "scene/scene.h"

#include <stdbool.h>

enum md_force { MD_LINEAR, MD_HERTZ };
enum md_tangential { MD_NONE, MD_VISCOUS, MD_COULOMB, MD_SPRING, MD_HAFF_WERNER };
enum md_integrator { MD_VERLET, MD_GEAR };

struct md_settings {
    int    force;               /* enum md_force */
    int    tangential;          /* enum md_tangential */
    int    integrator;          /* enum md_integrator */
    bool   clip;                /* no attraction at the end of a contact */
    double dt;                  /* NAN until resolved */
    double overlap;             /* that a chosen stiffness aims at, as a share of a radius */
    double skin;                /* of the neighbour list, as a share of the largest radius; NAN */
    double tangential_stiffness;        /* as a share of the normal one */
    double tangential_damping;  /* NAN: from the law; its meaning is the law's */
    double speed;               /* greatest speed expected; NAN: estimated */
};

extern const struct key_group md_settings_group;

/* As struct model's resolve. */
void md_settings_resolve(struct scene *scene, struct findings *findings);

#endif
