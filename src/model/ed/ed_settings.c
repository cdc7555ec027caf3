/* ed_settings.c - see ed_settings.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_settings.h"

#include "model/ed/ed_law.h"
#include "model/speed.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

#define AT(field) offsetof(struct ed_settings, field)

static const struct key keys[] = {
    {"t_c", KEY_REAL, AT(t_c), "nan", 0, NAN, "time", NULL,
     "cut-off time: a grain whose last contact is younger collides elastically; 0: plain ED, which "
     "stops where inelastic collapse begins; absent: 1e-2 sqrt(d/g), or 1e-5 d/v without gravity"},
    {"elastic", KEY_CHOICE, AT(elastic), "normal", NAN, NAN, NULL, "normal|rest",
     "what a contact within t_c keeps: normal, the normal speed, while friction goes on losing "
     "energy (cooperative, eq. 7), so that rough beds at rest collide ever faster; rest, an "
     "agitation as well: of what friction takes, as much is given back along the normal as makes a "
     "speed of 10 g t_c, which costs beds far fewer events and lets them creep at less than that"},
    {"restitution", KEY_REAL, AT(restitution), "nan", 0, 1, "1", NULL,
     "of grains that tell only a stiffness and a damping, as soft discs do; absent: derived from "
     "them"},
    {"force", KEY_CHOICE, AT(force), "linear", NAN, NAN, NULL, "linear|hertz",
     "the law for which that stiffness and damping are meant: linear, its restitution is constant; "
     "hertz, viscoelastic: it falls with impact speed"},
    {"tangential", KEY_REAL, AT(tangential), "0", -1, 1, "1", NULL,
     "beta0: greatest tangential restitution of grains with friction, 1: rough and elastic"},
    {"wall_restitution", KEY_REAL, AT(wall_restitution), "nan", 0, 1, "1", NULL,
     "restitution at walls; from the species of grain and wall when absent"},
    {"wall_friction", KEY_REAL, AT(wall_friction), "nan", 0, NAN, "1", NULL,
     "friction at walls; from the species of grain and wall when absent"},
    {"wall_tangential", KEY_REAL, AT(wall_tangential), "nan", -1, 1, "1", NULL,
     "beta0 at walls; ed.tangential when absent"},
    {"exponent", KEY_REAL, AT(exponent), "nan", 0, 1, "1", NULL,
     "1 - restitution grows with impact speed to this power; 0: the restitution is constant; "
     "absent: 0, or 0.2 if it is derived from a hertz force"},
    {"reference_speed", KEY_REAL, AT(reference_speed), "nan", KEY_POSITIVE, NAN, "speed", NULL,
     "impact speed at which the restitution is that of the species, if exponent is not 0; absent: "
     "1, or the greatest speed expected if it is derived"},
    {"cell", KEY_REAL, AT(cell), "nan", 1, 100, "1", NULL,
     "width of a cell in diameters of the largest grain; changes the speed only"},
    {"margin", KEY_REAL, AT(margin), "1", 0, 1, "1", NULL,
     "how far a grain may leave its cell, as a share of what the cell is wider than a grain; "
     "changes the speed only"},
    {"vectors", KEY_CHOICE, AT(vectors), "auto", NAN, NAN, NULL, "auto|none",
     "auto: the processor's vector instructions if it has them; changes the speed only"},
};

const struct key_group ed_settings_group = {
    "ed", "hard discs: event-driven, with or without the TC rule", keys, sizeof keys / sizeof *keys,
    sizeof(struct ed_settings)
};

/* 1 - r of viscoelastic spheres grows as v^(1/5) to leading order (stream, eq. 4). */
static const double viscoelastic = 0.2;

/* A speed that grains of this scene have at the start, or when they enter. */
static double typical_speed(const struct scene *scene)
{
    double sum2 = 0;
    for (uint32_t i = 0; i < scene->placed.count; i++) {
        const double vx = scene->placed.vx[i], vy = scene->placed.vy[i];
        sum2 += vx * vx + vy * vy;
    }
    double speed = scene->placed.count ? sqrt(sum2 / scene->placed.count) : 0;
    for (uint32_t s = 0; s < scene->source_count; s++) {
        speed = fmax(speed, hypot(scene->sources[s].velocity[0], scene->sources[s].velocity[1]));
    }
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        speed = fmax(speed, hypot(scene->walls[w].vx, scene->walls[w].vy));
    }
    return speed;
}

/* Long enough for dense beds to run (their events come at a rate of about 1/t_c), short enough to
 * change little that is measured: bounces on a floor end when they are 1e-5 d high; a freely
 * cooling gas keeps its energy within 1 %. */
static double chosen_cut_off(const struct scene *scene)
{
    const double g = hypot(scene->gravity[0], scene->gravity[1]), d = 2 * scene->radius_mean;
    if (g > 0) return 1e-2 * sqrt(d / g);
    const double speed = typical_speed(scene);
    return speed > 0 ? 1e-5 * d / speed : 0;
}

struct ed_settings ed_settings_of(const struct scene *scene)
{
    const struct ed_settings *given = scene_settings(scene, ed_settings_group.name);
    struct ed_settings settings = {
        .t_c = NAN, .restitution = NAN, .wall_restitution = NAN, .wall_friction = NAN,
        .wall_tangential = NAN, .exponent = NAN, .reference_speed = NAN, .cell = NAN, .margin = 1
    };
    if (given) settings = *given;
    if (isnan(settings.t_c)) settings.t_c = chosen_cut_off(scene);
    const bool derives = settings.force == ED_HERTZ && isnan(settings.restitution);
    if (isnan(settings.exponent)) settings.exponent = derives ? viscoelastic : 0;
    if (isnan(settings.reference_speed)) {
        const double speed = derives ? speed_greatest(scene) : 1;
        settings.reference_speed = speed > 0 ? speed : 1;
    }
    return settings;
}

/* Species without a restitution: 1 where nothing is damped, else what their dashpot makes. */
static void complete_restitution(struct scene *scene, const struct ed_settings *settings,
                                 struct findings *findings)
{
    for (uint32_t k = 0; k < scene->species_count; k++) {
        struct species *species = &scene->species[k];
        if (!isnan(species->restitution) || !isnan(settings->restitution)) continue;
        char key[64], speed[100] = "";
        snprintf(key, sizeof key, "grains.[%u].damping", k);
        if (isnan(species->damping) || species->damping == 0) {
            species->restitution = 1;
            continue;
        }
        if (settings->exponent > 0) {
            snprintf(speed, sizeof speed, " at %.4g %s", settings->reference_speed,
                     scene_unit(scene, "speed"));
        }
        findings_tell(findings, scene, FINDING_WARNING, key, "hard discs take their restitution "
            "from stiffness and damping, as of a %s force: %.4g between grains, %.4g at walls%s; "
            "ed.restitution sets another", settings->force == ED_HERTZ ? "hertz" : "linear",
            ed_law_derived(species, species, settings, false),
            ed_law_derived(species, species, settings, true), speed);
    }
}

/* Cut-off as a share of a grain's fall through itself, sqrt(d/g).  Beds at rest stir at up to
 * 10 g t_c (ed_law.c), which lifts a grain by 50 share^2 d: by a twentieth of d at this one. */
static const double cut_off_share_max = 0.03;

static void warn_of_cut_off(const struct scene *scene, const struct ed_settings *settings,
                            struct findings *findings)
{
    const double g = hypot(scene->gravity[0], scene->gravity[1]), d = 2 * scene->radius_mean;
    const double fall = g > 0 ? sqrt(d / g) : INFINITY;
    if (!(settings->t_c > cut_off_share_max * fall)) return;
    findings_tell(findings, scene, FINDING_WARNING, "ed.t_c", "ed.t_c = %.3g is %.2g of the time "
        "in which a grain falls through its diameter, so that grains at rest on each other stir "
        "and heaps creep; use at most %.2g, or delete the line and sandreel chooses",
        settings->t_c, settings->t_c / fall, cut_off_share_max * fall);
}

void ed_settings_resolve(struct scene *scene, struct findings *findings)
{
    const struct ed_settings settings = ed_settings_of(scene);
    complete_restitution(scene, &settings, findings);
    warn_of_cut_off(scene, &settings, findings);
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        const struct wall *wall = &scene->walls[w];
        if (wall->frequency == 0 || (wall->amplitude_x == 0 && wall->amplitude_y == 0)) continue;
        findings_tell(findings, scene, FINDING_ERROR, "walls", "wall %u shakes; the event-driven "
            "model moves walls at constant velocity only; use 'velocity', or another model", w);
        break;
    }
    struct ed_settings *given = scene_settings(scene, ed_settings_group.name);
    if (given) {
        given->t_c = settings.t_c;
        given->exponent = settings.exponent;
        given->reference_speed = settings.reference_speed;
    }
    const double need = 4 * 2 * scene->radius_max * 1.001;      /* four cells: ed_cells.c */
    const bool narrow_x = scene->left == BORDER_PERIODIC && scene->box[2] - scene->box[0] < need,
               narrow_y = scene->bottom == BORDER_PERIODIC && scene->box[3] - scene->box[1] < need;
    if (narrow_x || narrow_y) {
        findings_tell(findings, scene, FINDING_ERROR, "box", "a periodic box must be wider than "
            "four of the largest grains (%g) for the event-driven model", need);
    }
}
