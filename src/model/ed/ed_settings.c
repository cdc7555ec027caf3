/* ed_settings.c - see ed_settings.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_settings.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

#define AT(field) offsetof(struct ed_settings, field)

static const struct key keys[] = {
    {"t_c", KEY_REAL, AT(t_c), "nan", 0, NAN, "time", NULL,
     "cut-off time: a grain whose last contact is younger collides elastically; 0: plain ED, which "
     "stops where inelastic collapse begins; absent: 1e-2 sqrt(d/g), or 1e-5 d/v without gravity"},
    {"restitution", KEY_REAL, AT(restitution), "nan", 0, 1, "1", NULL,
     "restitution of grains that tell only a stiffness and a damping, for soft discs"},
    {"tangential", KEY_REAL, AT(tangential), "0", -1, 1, "1", NULL,
     "beta0: greatest tangential restitution of grains with friction, 1: rough and elastic"},
    {"wall_restitution", KEY_REAL, AT(wall_restitution), "nan", 0, 1, "1", NULL,
     "restitution at walls; from the species of grain and wall when absent"},
    {"wall_friction", KEY_REAL, AT(wall_friction), "nan", 0, NAN, "1", NULL,
     "friction at walls; from the species of grain and wall when absent"},
    {"wall_tangential", KEY_REAL, AT(wall_tangential), "nan", -1, 1, "1", NULL,
     "beta0 at walls; ed.tangential when absent"},
    {"exponent", KEY_REAL, AT(exponent), "0", 0, 1, "1", NULL,
     "1 - restitution grows with impact speed to this power (viscoelastic spheres: 0.2); 0: the "
     "restitution is constant"},
    {"reference_speed", KEY_REAL, AT(reference_speed), "1", KEY_POSITIVE, NAN, "speed", NULL,
     "impact speed at which the restitution is that of the species, if exponent is not 0"},
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

/* A speed that grains of this scene have at the start, or when they enter. */
static double speed_at_start(const struct scene *scene)
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
    const double speed = speed_at_start(scene);
    return speed > 0 ? 1e-5 * d / speed : 0;
}

struct ed_settings ed_settings_of(const struct scene *scene)
{
    const struct ed_settings *given = scene_settings(scene, ed_settings_group.name);
    struct ed_settings settings = {
        .t_c = NAN, .restitution = NAN, .wall_restitution = NAN, .wall_friction = NAN,
        .wall_tangential = NAN,
        .reference_speed = 1, .cell = NAN, .margin = 1
    };
    if (given) settings = *given;
    if (isnan(settings.t_c)) settings.t_c = chosen_cut_off(scene);
    return settings;
}

void ed_settings_resolve(struct scene *scene, struct findings *findings)
{
    for (uint32_t k = 0; k < scene->species_count; k++) {
        struct species *species = &scene->species[k];
        if (!isnan(species->restitution) || !isnan(ed_settings_of(scene).restitution)) continue;
        char key[64];
        snprintf(key, sizeof key, "grains.[%u].restitution", k);
        if (isnan(species->damping) || species->damping == 0) {
            species->restitution = 1;
            continue;
        }
        findings_tell(findings, scene, FINDING_ERROR, key, "hard discs need a restitution; this "
            "species has only a damping, which belongs to soft discs; give ed.restitution");
    }
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        const struct wall *wall = &scene->walls[w];
        if (wall->frequency == 0 || (wall->amplitude_x == 0 && wall->amplitude_y == 0)) continue;
        findings_tell(findings, scene, FINDING_ERROR, "walls", "wall %u shakes; the event-driven "
            "model moves walls at constant velocity only; use 'velocity', or another model", w);
        break;
    }
    struct ed_settings *given = scene_settings(scene, ed_settings_group.name);
    if (given) given->t_c = ed_settings_of(scene).t_c;
    const double need = 4 * 2 * scene->radius_max * 1.001;      /* four cells: ed_cells.c */
    const bool narrow_x = scene->left == BORDER_PERIODIC && scene->box[2] - scene->box[0] < need,
               narrow_y = scene->bottom == BORDER_PERIODIC && scene->box[3] - scene->box[1] < need;
    if (narrow_x || narrow_y) {
        findings_tell(findings, scene, FINDING_ERROR, "box", "a periodic box must be wider than "
            "four of the largest grains (%g) for the event-driven model", need);
    }
}
