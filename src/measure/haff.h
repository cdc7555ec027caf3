/* haff.h - kinetic theory of a homogeneous gas of discs: how often they meet, how fast they cool.
 *
 * T = <v^2>/2 is the granular temperature of grains of mass 1, d their diameter, nu the area
 * fraction; n = 4 nu / (pi d^2).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef HAFF_H
#define HAFF_H

#include <math.h>

/* 1 / s*(nu): how much oftener discs meet than points of the same cross section (Henderson). */
static inline double haff_crowding(double nu)
{
    return (1 - 7 * nu / 16) / ((1 - nu) * (1 - nu));
}

/* Enskog's collision frequency of a grain, 2 sqrt(pi) n d chi sqrt(T). */
static inline double haff_frequency(double nu, double d, double temperature)
{
    const double n = 4 * nu / (M_PI * d * d);
    return 2 * sqrt(M_PI) * n * d * haff_crowding(nu) * sqrt(temperature);
}

/* The time t0 of simplified (5), with v = sqrt(2 T): sqrt(pi) d s* / (sqrt(2) (1 - r^2) nu v).  The
 * 2 (1 - r^2) of cooperative (19) is a misprint: sqrt(2) gives that paper's own 23.2/s. */
static inline double haff_time(double nu, double d, double temperature, double r)
{
    return sqrt(M_PI) * d
         / (haff_crowding(nu) * sqrt(2) * (1 - r * r) * nu * sqrt(2 * temperature));
}

/* E / E0 at t / t0, simplified (4). */
static inline double haff_energy(double t) { return 1 / ((1 + t) * (1 + t)); }

#endif
