/* md_settings.c - the keys of `md`, and how a stiffness and a time step are chosen and judged.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/md/md_settings.h"

#include "model/md/md_law.h"
#include "model/speed.h"
#include "scene/resolve.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

#define AT(field) offsetof(struct md_settings, field)

static const struct key keys[] = {
    {"force", KEY_CHOICE, AT(force), "linear", NAN, NAN, NULL, "linear|hertz",
     "normal force: linear spring and dashpot, or viscoelastic Hertz"},
    {"tangential", KEY_CHOICE, AT(tangential), "spring", NAN, NAN, NULL,
     "none|viscous|coulomb|spring|haff-werner",
     "tangential force of contacts with friction; spring: with memory, so heaps stand still"},
    {"integrator", KEY_CHOICE, AT(integrator), "verlet", NAN, NAN, NULL, "verlet|gear",
     "velocity Verlet, or the Gear predictor-corrector of 6th order (4th in rotation)"},
    {"clip", KEY_BOOL, AT(clip), "true", NAN, NAN, NULL, NULL,
     "grains that part are never held back by the dashpot"},
    {"dt", KEY_REAL, AT(dt), "nan", 1e-300, NAN, "time", NULL,
     "time step; chosen from the contact time when absent"},
    {"overlap", KEY_REAL, AT(overlap), "0.01", 1e-6, 0.5, "1", NULL,
     "overlap that a chosen stiffness allows at most, as a share of a radius"},
    {"skin", KEY_REAL, AT(skin), "nan", 0.01, 4, "1", NULL,
     "margin of the neighbour list as a share of the largest radius; changes the speed only"},
    {"tangential_stiffness", KEY_REAL, AT(tangential_stiffness), "0.2857142857142857", 1e-6, 10,
     "1", NULL, "stiffness of the tangential spring as a share of the normal stiffness"},
    {"tangential_damping", KEY_REAL, AT(tangential_damping), "nan", 0, NAN, "", NULL,
     "viscous, coulomb, spring: force per slip speed; haff-werner: 1/time, per reduced mass"},
    {"speed", KEY_REAL, AT(speed), "nan", 1e-300, NAN, "speed", NULL,
     "greatest speed to expect, for choosing stiffness and time step; estimated when absent"},
};

const struct key_group md_settings_group = {
    "md", "soft discs: molecular dynamics", keys, sizeof keys / sizeof *keys,
    sizeof(struct md_settings)
};

/* Steps that a contact should last (MODELS section 4): chosen, warned below, refused below. */
static const struct { double chosen, safe, least; } steps_per_contact[] = {
    [MD_VERLET] = {25, 8, 4},
    [MD_GEAR]   = {50, 20, 10},
};

/* Weight of the column that rests on one grain, as if all grains lay at the bottom. */
static double static_load(const struct scene *scene, const struct species *s, double radius)
{
    const double g = hypot(scene->gravity[0], scene->gravity[1]);
    const bool upright = fabs(scene->gravity[1]) >= fabs(scene->gravity[0]);
    const double width = upright ? scene->box[2] - scene->box[0] : scene->box[3] - scene->box[1];
    const double room = upright ? scene->box[3] - scene->box[1] : scene->box[2] - scene->box[0];
    double area = 0;
    for (uint32_t k = 0; k < scene->placed.count; k++) {
        area += M_PI * scene->placed.radius[k] * scene->placed.radius[k];
    }
    /* Before placing, or with sources, the box may fill up: 0.9 is the densest of discs. */
    const bool known = scene->placed.count > 0 && scene->source_count == 0;
    const double height = known ? fmin(room, area / (0.8 * width)) : room;
    return g * scene_mass(s, 1) / M_PI * 0.9 * 2 * radius * height;
}

/* The stiffness at which neither the greatest impact nor the load at the bottom overlaps more
 * than asked for.  Impact on a wall: the whole mass, m v^2 = k xi^2 (linear) or
 * m v^2 / 2 = 4/15 alpha sqrt(R) xi^(5/2) (Hertz). */
static double stiffness_for(const struct scene *scene, const struct md_settings *settings,
                            const struct species *s, double speed)
{
    const double radius = resolve_radius_max(s), xi = settings->overlap * radius;
    const double mass = scene_mass(s, radius), load = static_load(scene, s, radius);
    if (settings->force == MD_LINEAR) return fmax(mass * speed * speed / (xi * xi), load / xi);
    const double impact = 15.0 / 8.0 * mass * speed * speed / (sqrt(radius) * pow(xi, 2.5));
    return fmax(impact, 1.5 * load / (sqrt(0.5 * radius) * pow(xi, 1.5)));
}

static void complete_species(struct scene *scene, struct md_settings *settings,
                            struct findings *findings)
{
    for (uint32_t k = 0; k < scene->species_count; k++) {
        struct species *s = &scene->species[k];
        char place[64];
        snprintf(place, sizeof place, "grains.[%u].stiffness", k);
        if (isnan(s->stiffness)) {
            if (isfinite(s->damping) && isnan(s->restitution)) {
                findings_tell(findings, scene, FINDING_ERROR, place, "damping is given without "
                    "stiffness; give both, or a restitution instead");
            }
            s->stiffness = stiffness_for(scene, settings, s, settings->speed);
            /* Without motion or gravity any stiffness will do. */
            if (!(s->stiffness > 0)) s->stiffness = scene_mass(s, resolve_radius_max(s));
        }
        if (!(s->stiffness > 0)) {
            findings_tell(findings, scene, FINDING_ERROR, place, "a stiffness must be positive; "
                "delete the line and sandreel chooses");
            s->stiffness = 1;
        }
        if (isnan(s->damping) && isnan(s->restitution)) s->restitution = 1;
    }
}

static void complete_tangential(struct scene *scene, struct md_settings *settings,
                               struct findings *findings)
{
    double friction = 0;
    for (uint32_t k = 0; k < scene->species_count; k++) {
        friction = fmax(friction, scene->species[k].friction);
    }
    const effects_t spins = EFFECT_FRICTION | EFFECT_ROTATION;
    const bool viscous = settings->tangential == MD_VISCOUS && settings->tangential_damping > 0;
    if (viscous) scene->effects |= spins;
    else if (friction > 0 && settings->tangential != MD_NONE) scene->effects |= spins;
    else scene->effects &= ~(spins | EFFECT_STATIC_FRICTION);
    if (settings->tangential == MD_SPRING && friction > 0) {
        scene->effects |= EFFECT_STATIC_FRICTION;
    }
    const bool needs = settings->tangential == MD_VISCOUS || settings->tangential == MD_COULOMB
                    || settings->tangential == MD_HAFF_WERNER;
    if (!needs || !isnan(settings->tangential_damping)) return;
    if (friction > 0 && settings->tangential == MD_COULOMB) {
        /* So steep that sliding sets in at a small share of the impact speed, yet soft enough
         * for the time step: critical for the tangential motion of a pair. */
        const struct species *s = &scene->species[0];
        const double mass = 0.5 * scene_mass(s, resolve_radius_max(s));
        settings->tangential_damping = settings->force == MD_LINEAR ? sqrt(s->stiffness * mass)
            : mass * M_PI / md_law_contact_time(scene, settings, settings->speed);
    } else if (friction > 0) {
        findings_tell(findings, scene, FINDING_ERROR, "md.tangential", "this law needs a damping; "
            "set md.tangential_damping, or use tangential = \"spring\"");
    }
}

static void complete_step(struct scene *scene, struct md_settings *settings,
                         struct findings *findings)
{
    const double contact = md_law_contact_time(scene, settings, settings->speed);
    const double chosen = contact / steps_per_contact[settings->integrator].chosen;
    if (isnan(settings->dt)) {
        settings->dt = isfinite(chosen) ? chosen : 1;
        return;
    }
    const double steps = contact / settings->dt;
    const bool least = steps < steps_per_contact[settings->integrator].least;
    if (!least && steps >= steps_per_contact[settings->integrator].safe) return;
    findings_tell(findings, scene, least ? FINDING_ERROR : FINDING_WARNING, "md.dt",
        "md.dt = %g is %.2g of the shortest contact time %.3g; at fewer than %g steps a contact "
        "the integrator %s; use at most %.2g, or delete the line and sandreel chooses",
        settings->dt, settings->dt / contact, contact,
        least ? steps_per_contact[settings->integrator].least
              : steps_per_contact[settings->integrator].safe,
        least ? "blows up" : "gains or loses energy", chosen);
}

void md_settings_resolve(struct scene *scene, struct findings *findings)
{
    struct md_settings *settings = scene_settings(scene, "md");
    if (!settings || scene->species_count == 0) return;
    if (isnan(settings->speed)) settings->speed = speed_greatest(scene);
    if (!(settings->speed > 0)) settings->speed = scene->radius_max > 0 ? scene->radius_max : 1;
    complete_species(scene, settings, findings);
    complete_tangential(scene, settings, findings);
    complete_step(scene, settings, findings);
}
