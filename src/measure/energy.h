/* energy.h - kinetic energy by direction, and the stress tensor of a region (cooperative 8, eq. 9).
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ENERGY_H
#define ENERGY_H

#include "model/grains.h"
#include "scene/scene.h"

struct energy {
    double kx, ky;              /* sum of m vx^2 / 2, m vy^2 / 2 */
    double kinetic;             /* their sum */
    double anisotropy;          /* (Kx - Ky) / K: 0 in a gas, near +-1 in the shearing mode; NAN
                                 * without energy */
};

struct energy energy_of(const struct grains *grains);

/* sigma of eq. 9 over a region x0 y0 x1 y1: contacts minus streaming, tension positive. */
struct energy_stress {
    double contact[3];          /* xx, yy, xy: sum of r_a f_b / V */
    double kinetic[3];          /* -sum of m v'_a v'_b / V, v' about the region's mean velocity */
    double xx, yy, xy;          /* both together */
    double major, minor;        /* eigenvalues, the larger in size first */
    double angle;               /* of the major axis, radians from +x, -pi/2 .. pi/2 */
};

/* Contacts count in the region that holds the centre of the grain they act on, each side for
 * itself, also across the scene's periodic borders; grains without contacts (hard discs, points)
 * have the streaming part only. */
struct energy_stress energy_stress(const struct grains *grains, const struct scene *scene,
                                   const double region[4]);

/* Eigenvalues and angle from xx, yy and xy. */
void energy_principal(struct energy_stress *stress);

#endif
