/* md_law.c - see md_law.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/md/md_law.h"

#include "model/speed.h"
#include "scene/resolve.h"

#include <math.h>

/* With clipping the contact ends when the force is zero: x + 2 z x' = 0 for
 * x = exp(-z t) sin(w t) / w, w^2 = 1 - z^2 (sinh beyond z = 1), so w t = pi - atan2(2 z w,
 * w^2 - z^2), and there r = -x' = x / (2 z), which is exp(-z t) again. */
struct md_collision md_law_linear_collision(double damping, bool clip)
{
    const double z = damping, w = sqrt(fabs(1 - z * z));
    struct md_collision c = {0, INFINITY, 0};
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
struct md_collision md_law_hertz_collision(double damping, bool clip)
{
    const double h = 1e-3, time_max = 200;      /* errors of 1e-6: the start has x ~ t, x^1.5 */
    struct md_collision c = {0, 0, 0};
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
                          struct md_collision (*collision)(double, bool))
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

double md_law_linear_damping(double restitution, bool clip)
{
    return damping_for(restitution, clip, md_law_linear_collision);
}

double md_law_hertz_damping(double restitution, bool clip)
{
    return damping_for(restitution, clip, md_law_hertz_collision);
}

double md_law_hertz_length(double stiffness, double mass, double radius, double speed)
{
    return pow(mass * speed * speed / (stiffness * sqrt(radius)), 0.4);
}

/* Springs in series; equal species keep their own value. */
static double in_series(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0; }

static double restitution_of(const struct species *a, const struct species *b)
{
    return sqrt(a->restitution * b->restitution);
}

/* Normal damping: from the restitution if both have one, else the dashpots as given. */
static void set_damping(struct md_pair_law *pair, const struct md_settings *settings,
                        const struct species *a, const struct species *b, double speed)
{
    const double restitution = restitution_of(a, b);
    const bool given = isfinite(a->damping) && isfinite(b->damping);
    if (given) {
        pair->damping = sqrt(a->damping * b->damping);
    } else if (settings->force == MD_LINEAR) {
        const double eta = md_law_linear_damping(isfinite(restitution) ? restitution : 1,
                                                 settings->clip);
        pair->damping_mass = 2 * eta * sqrt(pair->stiffness);
    } else {
        /* A viscoelastic contact has no one restitution: it holds at the speed estimated. */
        const double ra = resolve_radius_mean(a);
        const double rb = resolve_radius_mean(b);
        const double ma = scene_mass(a, ra), mb = scene_mass(b, rb);
        const double length = md_law_hertz_length(pair->stiffness, ma * mb / (ma + mb),
                                                  ra * rb / (ra + rb), speed);
        pair->damping = md_law_hertz_damping(isfinite(restitution) ? restitution : 1,
                                             settings->clip) * pair->stiffness * length / speed;
    }
}

static void set_tangential(struct md_pair_law *pair, const struct md_settings *settings,
                           double friction)
{
    const bool given = isfinite(settings->tangential_damping);
    const double damping = given ? settings->tangential_damping : 0;
    pair->friction = friction;
    switch (settings->tangential) {
    case MD_NONE:
        pair->friction = 0;
        break;
    case MD_VISCOUS:
        pair->friction = 1e200;                                 /* no limit */
        pair->drag = damping;
        break;
    case MD_COULOMB:
        pair->drag = damping;
        break;
    case MD_SPRING:
        pair->tangent = settings->tangential_stiffness;
        pair->drag = damping;
        pair->drag_share = given ? 0 : 0.5;
        break;
    case MD_HAFF_WERNER:
        pair->drag_mass = damping;
        break;
    }
}

void md_law_pairs(const struct scene *scene, const struct md_settings *settings,
                  struct md_pair_law *pairs)
{
    const double speed = isfinite(settings->speed) ? settings->speed : speed_greatest(scene);
    for (uint32_t a = 0; a < scene->species_count; a++) {
        for (uint32_t b = 0; b < scene->species_count; b++) {
            const struct species *first = &scene->species[a], *second = &scene->species[b];
            struct md_pair_law *pair = &pairs[a * scene->species_count + b];
            *pair = (struct md_pair_law){.stiffness = in_series(first->stiffness,
                                                                second->stiffness)};
            set_damping(pair, settings, first, second, speed);
            set_tangential(pair, settings, sqrt(first->friction * second->friction));
        }
    }
}

double md_law_contact_time(const struct scene *scene, const struct md_settings *settings,
                           double speed)
{
    double shortest = INFINITY;
    for (uint32_t k = 0; k < scene->species_count; k++) {
        const struct species *s = &scene->species[k];
        const double radius = resolve_radius_min(s);
        const double mass = 0.5 * scene_mass(s, radius);        /* of a pair of the smallest */
        double time;
        if (settings->force == MD_LINEAR) {
            time = M_PI * sqrt(mass / s->stiffness);
        } else {
            time = md_law_hertz_collision(0, true).time / speed
                 * md_law_hertz_length(s->stiffness, mass, 0.5 * radius, speed);
        }
        shortest = fmin(shortest, time);
    }
    return shortest;
}

struct md_force_out md_law_force(const struct md_law *law, const struct md_pair_law *pair,
                                 const struct md_touch *touch)
{
    struct md_force_out out = {0, 0, touch->spring};
    double stiffness = pair->stiffness;
    double damping = pair->damping + pair->damping_mass * sqrt(touch->mass);
    if (law->hertz) {
        const double root = sqrt(touch->radius * touch->overlap);
        stiffness *= root;                                      /* dF/dxi */
        damping *= root;
        out.normal = 2.0 / 3.0 * stiffness * touch->overlap + damping * touch->closing;
    } else {
        out.normal = stiffness * touch->overlap + damping * touch->closing;
    }
    if (law->clip && out.normal < 0) out.normal = 0;
    if (!law->tangential) return out;

    const double limit = pair->friction * fmax(out.normal, 0);
    const double drag = pair->drag + pair->drag_mass * touch->mass + pair->drag_share * damping;
    const double tangent = stiffness * pair->tangent;
    const double stretched = touch->spring + touch->slip * touch->dt;
    const double pull = -(tangent * stretched + drag * touch->slip);
    out.tangential = fmin(fmax(pull, -limit), limit);
    if (law->spring) {
        /* Sliding: the spring is kept at mu F / k_t. */
        out.spring = out.tangential == pull ? stretched : -out.tangential / tangent;
    }
    return out;
}

double md_law_energy(const struct md_law *law, const struct md_pair_law *pair, double overlap,
                     double radius, double spring)
{
    const double root = law->hertz ? sqrt(radius * overlap) : 1;
    const double normal = law->hertz ? 4.0 / 15.0 * pair->stiffness * root * overlap * overlap
                                     : 0.5 * pair->stiffness * overlap * overlap;
    return normal + 0.5 * pair->tangent * pair->stiffness * root * spring * spring;
}
