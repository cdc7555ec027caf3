/* contact.h - one head-on collision under the force laws of soft discs: how long, how deep, and
 * with what restitution, so that hard discs can be given the same.
 *
 *   linear   F = k xi + c xi'                                     (cooperative, eqs. 10 and 11)
 *   hertz    F = sqrt(R_eff) (2/3 alpha xi^(3/2) + beta sqrt(xi) xi')         (stream, eq. 4)
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CONTACT_H
#define CONTACT_H

#include <stdbool.h>

/* One head-on collision.  linear: lengths in units of v / omega0, times in 1 / omega0 with
 * omega0^2 = k / m; hertz: lengths in L = (m v^2 / (alpha sqrt(R)))^(2/5), times in L / v. */
struct contact_blow { double restitution, time, overlap; };

/* `damping` is eta / omega0 with eta = c / (2 m). */
struct contact_blow contact_linear(double damping, bool clip);

/* `damping` is beta v / (alpha L). */
struct contact_blow contact_hertz(double damping, bool clip);

/* The damping that gives this restitution (clipped into 0.01 .. 1). */
double contact_linear_damping(double restitution, bool clip);
double contact_hertz_damping(double restitution, bool clip);

/* Length L of a Hertz collision. */
double contact_hertz_length(double stiffness, double mass, double radius, double speed);

#endif
