/* ed_settings.h - the keys of `ed` in a scene file.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_SETTINGS_H
#define ED_SETTINGS_H

#include "scene/scene.h"

enum ed_force { ED_LINEAR, ED_HERTZ };
enum ed_elastic { ED_ELASTIC_NORMAL, ED_ELASTIC_REST };
enum ed_vectors { ED_VECTORS_AUTO, ED_VECTORS_NONE };

struct ed_settings {
    double t_c;                 /* TC rule: after a contact a grain stays elastic for so long */
    int    elastic;             /* enum ed_elastic: what a contact within t_c keeps */
    double restitution;         /* of species that have none of their own; NAN: derived */
    int    force;               /* enum ed_force: what their stiffness and damping mean */
    double tangential;          /* beta0, largest tangential restitution */
    double wall_restitution, wall_friction, wall_tangential;    /* NAN: from the species */
    double exponent;            /* 1 - r grows with impact speed to this power; 0: constant r */
    double reference_speed;     /* at which r is the species' restitution; never NAN once resolved,
                                 * nor is the exponent */
    double cell;                /* width of a cell in largest diameters; NAN: chosen */
    int    vectors;             /* enum ed_vectors */
    double margin;              /* how far a grain may leave its cell, share of the spare width */
};

extern const struct key_group ed_settings_group;

/* As struct model's resolve. */
void ed_settings_resolve(struct scene *scene, struct findings *findings);

/* The scene's, or the defaults if the scene has none. */
struct ed_settings ed_settings_of(const struct scene *scene);

#endif
