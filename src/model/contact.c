/* contact.c - see contact.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/contact.h"

#include <math.h>

/* With clipping the contact ends when the force is zero: x + 2 z x' = 0 for
 * x = exp(-z t) sin(w t) / w, w^2 = 1 - z^2 (sinh beyond z = 1), so w t = pi - atan2(2 z w,
 * w^2 - z^2), and there r = -x' = x / (2 z), which is exp(-z t) again. */
struct contact_blow contact_linear(double damping, bool clip)
{
    const double z = damping, w = sqrt(fabs(1 - z * z));
    struct contact_blow c = {0, INFINITY, 0};
    const bool swings = z < 1;
    if (w < 1e-6) {                                             /* critical: both forms are 0/0 */
        c.time = clip ? 2 : INFINITY;
        c.restitution = clip ? exp(-2) : 0;
    } else if (swings) {
        const double w2 = 1 - z * z;
        c.time = clip ? (M_PI - atan2(2 * z * w, w2 - z * z)) / w : M_PI / w;
        c.restitution = exp(-z * c.time);
    } else if (clip) {
        c.time = atanh(2 * z * w / (z * z + w * w)) / w;
        c.restitution = exp(-z * c.time) * sinh(w * c.time) / (2 * z * w);
    }
    const double peak = w < 1e-6 ? 1 : swings ? atan2(w, z) / w : atanh(w / z) / w;
    c.overlap = exp(-z * peak) * (w < 1e-6 ? peak : (swings ? sin(w * peak) : sinh(w * peak)) / w);
    return c;
}

struct reduced { double x, v; };

static double reduced_force(struct reduced s, double damping, bool clip)
{
    const double root = sqrt(fmax(s.x, 0));
    const double force = root * (2.0 / 3.0 * s.x + damping * s.v);
    return clip && force < 0 ? 0 : force;
}

static struct reduced reduced_step(struct reduced s, double damping, bool clip, double h)
{
    const struct reduced k1 = {s.v, -reduced_force(s, damping, clip)};
    const struct reduced s2 = {s.x + 0.5 * h * k1.x, s.v + 0.5 * h * k1.v};
    const struct reduced k2 = {s2.v, -reduced_force(s2, damping, clip)};
    const struct reduced s3 = {s.x + 0.5 * h * k2.x, s.v + 0.5 * h * k2.v};
    const struct reduced k3 = {s3.v, -reduced_force(s3, damping, clip)};
    const struct reduced s4 = {s.x + h * k3.x, s.v + h * k3.v};
    const struct reduced k4 = {s4.v, -reduced_force(s4, damping, clip)};
    return (struct reduced){s.x + h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x),
                            s.v + h / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v)};
}

/* Runge-Kutta, 4th order.  Clipped, the contact lasts until the force is gone; the rest of the
 * way out is free flight, so the restitution is the speed there. */
struct contact_blow contact_hertz(double damping, bool clip)
{
    const double h = 1e-3, time_max = 200;      /* errors of 1e-6: the start has x ~ t, x^1.5 */
    struct contact_blow c = {0, 0, 0};
    struct reduced s = {0, 1};
    while (c.time < time_max) {
        s = reduced_step(s, damping, clip, h);
        c.time += h;
        c.overlap = fmax(c.overlap, s.x);
        const bool free = clip && s.v < 0 && 2.0 / 3.0 * s.x + damping * s.v <= 0;
        if (s.x <= 0 || free) break;
    }
    if (s.x <= 0 && s.v < 0) c.time -= s.x / s.v;
    c.restitution = fmax(-s.v, 0);
    return c;
}

static double damping_for(double restitution, bool clip,
                          struct contact_blow (*collision)(double, bool))
{
    if (restitution >= 1) return 0;
    const double wanted = fmax(restitution, 0.01);
    double low = 0, high = 1;
    while (high < 1e3 && collision(high, clip).restitution > wanted) high *= 2;
    for (int k = 0; k < 50; k++) {
        const double middle = 0.5 * (low + high);
        if (collision(middle, clip).restitution > wanted) low = middle;
        else high = middle;
    }
    return 0.5 * (low + high);
}

double contact_linear_damping(double restitution, bool clip)
{
    return damping_for(restitution, clip, contact_linear);
}

double contact_hertz_damping(double restitution, bool clip)
{
    return damping_for(restitution, clip, contact_hertz);
}

double contact_hertz_length(double stiffness, double mass, double radius, double speed)
{
    return pow(mass * speed * speed / (stiffness * sqrt(radius)), 0.4);
}
