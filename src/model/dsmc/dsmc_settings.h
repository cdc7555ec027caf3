/* dsmc_settings.h - what a scene file may set under `dsmc`.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_SETTINGS_H
#define DSMC_SETTINGS_H

#include "scene/scene.h"

enum dsmc_method { DSMC_DENSE, DSMC_PLAIN, DSMC_HSMC };
enum dsmc_chi { DSMC_ENSKOG, DSMC_FREE_VOLUME };

struct dsmc_settings {
    int      method;            /* enum dsmc_method */
    int      chi;               /* enum dsmc_chi */
    double   cell;              /* NAN: chosen */
    double   dt;                /* NAN: chosen */
    double   speed;             /* NAN: estimated */
    uint32_t weight;            /* simulated particles for each grain */
    double   restitution;       /* of species that have none of their own; NAN: 0.8 */
    double   tangential;        /* beta0 of grains with friction */
    double   reach[2];          /* hsmc: columns within which a grain can roll down */
};

extern const struct key_group dsmc_settings_group;

void dsmc_settings_resolve(struct scene *scene, struct findings *findings);

/* The settings with everything filled in that the scene left open. */
struct dsmc_settings dsmc_settings_completed(const struct scene *scene);

/* Area fraction of the grains placed, in the box. */
double dsmc_settings_fraction(const struct scene *scene);

#endif
