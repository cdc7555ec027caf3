/* impulse.h - a push: grains around a point gain a velocity, all at the same moment.
 *
 * It falls off smoothly to the rim, so that no grain is torn from its neighbour; a grain gains
 * velocity, not momentum, so that light and heavy ones move together as under a finger.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef IMPULSE_H
#define IMPULSE_H

struct impulse { double x, y, radius, vx, vy; };

/* The share of (vx, vy) that a grain at (x, y) gains: (1 - r^2 / R^2)^2, zero beyond R. */
static inline double impulse_share(const struct impulse *impulse, double x, double y)
{
    const double dx = x - impulse->x, dy = y - impulse->y;
    const double rest = 1 - (dx * dx + dy * dy) / (impulse->radius * impulse->radius);
    return rest > 0 ? rest * rest : 0;
}

#endif
