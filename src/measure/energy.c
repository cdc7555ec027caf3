/* energy.c - see energy.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/energy.h"

#include <math.h>

struct energy energy_of(const struct grains *grains)
{
    struct energy energy = {0};
    for (uint32_t i = 0; i < grains->count; i++) {
        energy.kx += 0.5 * grains->mass[i] * grains->vx[i] * grains->vx[i];
        energy.ky += 0.5 * grains->mass[i] * grains->vy[i] * grains->vy[i];
    }
    energy.kinetic = energy.kx + energy.ky;
    energy.anisotropy = (energy.kx - energy.ky) / energy.kinetic;
    return energy;
}

static bool holds(const double region[4], const struct grains *grains, uint32_t i)
{
    return grains->x[i] >= region[0] && grains->x[i] < region[2]
        && grains->y[i] >= region[1] && grains->y[i] < region[3];
}

/* The force f on grain i acts at the point of contact: r = point - centre. */
static void add_contact(const double region[4], const struct grains *grains,
                        const struct scene *scene, uint32_t i, const struct contact *c,
                        double sign, double sum[3])
{
    if (!holds(region, grains, i)) return;
    const double fx = sign * (double)c->fx, fy = sign * (double)c->fy;
    const double lx = scene->box[2] - scene->box[0], ly = scene->box[3] - scene->box[1];
    double rx = (double)c->x - grains->x[i], ry = (double)c->y - grains->y[i];
    if (scene->left == BORDER_PERIODIC) rx -= lx * rint(rx / lx);
    if (scene->bottom == BORDER_PERIODIC) ry -= ly * rint(ry / ly);
    sum[0] += rx * fx;
    sum[1] += ry * fy;
    sum[2] += 0.5 * (rx * fy + ry * fx);
}

static void add_kinetic(const double region[4], const struct grains *grains, double sum[3])
{
    double mass = 0, px = 0, py = 0;
    for (uint32_t i = 0; i < grains->count; i++) {
        if (!holds(region, grains, i)) continue;
        mass += grains->mass[i];
        px += grains->mass[i] * grains->vx[i];
        py += grains->mass[i] * grains->vy[i];
    }
    if (!(mass > 0)) return;
    for (uint32_t i = 0; i < grains->count; i++) {
        if (!holds(region, grains, i)) continue;
        const double vx = grains->vx[i] - px / mass, vy = grains->vy[i] - py / mass;
        sum[0] -= grains->mass[i] * vx * vx;
        sum[1] -= grains->mass[i] * vy * vy;
        sum[2] -= grains->mass[i] * vx * vy;
    }
}

void energy_principal(struct energy_stress *stress)
{
    const double mean = 0.5 * (stress->xx + stress->yy), half = 0.5 * (stress->xx - stress->yy);
    const double radius = hypot(half, stress->xy), sign = mean < 0 ? -1 : 1;
    stress->major = mean + sign * radius;
    stress->minor = mean - sign * radius;
    stress->angle = 0.5 * atan2(sign * stress->xy, sign * half);
}

struct energy_stress energy_stress(const struct grains *grains, const struct scene *scene,
                                   const double region[4])
{
    struct energy_stress stress = {0};
    for (uint32_t k = 0; grains->contacts && k < grains->contact_count; k++) {
        const struct contact *c = &grains->contacts[k];
        add_contact(region, grains, scene, c->i, c, 1, stress.contact);
        if (c->j >= CONTACT_WALL) continue;
        add_contact(region, grains, scene, c->j, c, -1, stress.contact);
    }
    add_kinetic(region, grains, stress.kinetic);
    const double area = (region[2] - region[0]) * (region[3] - region[1]);
    for (int k = 0; k < 3; k++) {
        stress.contact[k] /= area;
        stress.kinetic[k] /= area;
    }
    stress.xx = stress.contact[0] + stress.kinetic[0];
    stress.yy = stress.contact[1] + stress.kinetic[1];
    stress.xy = stress.contact[2] + stress.kinetic[2];
    energy_principal(&stress);
    return stress;
}
