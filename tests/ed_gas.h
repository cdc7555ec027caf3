/* ed_gas.h - a gas of hard discs that has forgotten its lattice, and how it cools; shared by the
 * quick test and the slow one, which has the paper's size.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_GAS_H
#define ED_GAS_H

#include "scenes.h"

/* d = m = 1 (density 4/pi), T = 1: square lattice at area fraction `fraction`. */
static inline struct scenes_run *ed_gas_by(const char *model, uint32_t side, double fraction,
                                           double restitution, double time, uint64_t seed,
                                           double t_c)
{
    const double spacing = sqrt(M_PI / 4 / fraction), length = side * spacing;
    char text[800];
    snprintf(text, sizeof text, "until = 1e6; seed = %lluL; box = [0.0, 0.0, %.15g, %.15g];"
        "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
        "grains = ({ radius = 0.5; restitution = 1.0; density = %.15g; });"
        "placements = ({ kind = \"square\"; spacing = %.15g; count = %u; temperature = 1.0; });"
        "ed = { t_c = %.15g; };"
        "phases = ({ time = %.15g; set = [\"grains.[0].restitution=%.15g\"]; });",
        (unsigned long long)seed, length, length, 4 / M_PI, spacing * (1 - 1e-9), side * side, t_c,
        time,
        restitution);
    struct scenes_run *run = scenes_begin(text, model);
    CHECK(run->scene->placed.count == side * side);
    return run;
}

static inline struct scenes_run *ed_gas_begin(uint32_t side, double fraction, double restitution,
                                              double time, uint64_t seed, double t_c)
{
    return ed_gas_by("ed", side, fraction, restitution, time, seed, t_c);
}

/* Enskog's collision frequency of a grain: 2 sqrt(pi) n d chi sqrt(T/m), T = <v^2>/2 a grain. */
static inline double ed_gas_enskog(double fraction, double temperature)
{
    const double chi = (1 - 7 * fraction / 16) / ((1 - fraction) * (1 - fraction));
    return 2 * sqrt(M_PI) * 4 * fraction / M_PI * chi * sqrt(temperature);
}

/* t0 of Haff's law, 4 / (omega (1 - r^2)): a collision costs (1 - r^2) T on average. */
static inline double ed_gas_cooling_time(double fraction, double temperature, double r)
{
    return 4 / (ed_gas_enskog(fraction, temperature) * (1 - r * r));
}

/* The smallest distance of two centres, by every pair, in a periodic square. */
static inline double ed_gas_nearest(const struct scenes_run *run)
{
    struct grains g = scenes_look(run);
    const double length = run->scene->box[2];
    double nearest2 = INFINITY;
    for (uint32_t i = 0; i < g.count; i++) {
        for (uint32_t j = 0; j < i; j++) {
            double dx = g.x[i] - g.x[j], dy = g.y[i] - g.y[j];
            dx -= length * rint(dx / length);
            dy -= length * rint(dy / length);
            nearest2 = fmin(nearest2, dx * dx + dy * dy);
        }
    }
    grains_free(&g);
    return sqrt(nearest2);
}

#endif
