/* dsmc_settings.c - the keys of `dsmc`, and how cell and time step are chosen and judged.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/dsmc/dsmc_settings.h"

#include "model/speed.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define AT(field) offsetof(struct dsmc_settings, field)

static const struct key keys[] = {
    {"method", KEY_CHOICE, AT(method), "dense", NAN, NAN, NULL, "dense|plain|hsmc",
     "dense: local density and displacement after Enskog; plain: Bird's; hsmc: cells can be full, "
     "so that heaps stand"},
    {"chi", KEY_CHOICE, AT(chi), "enskog", NAN, NAN, NULL, "enskog|free-volume",
     "how crowding raises the collision rate; free-volume is too low (0.91 of Enskog's rate)"},
    {"cell", KEY_REAL, AT(cell), "nan", KEY_POSITIVE, NAN, "length", NULL,
     "width of a cell; absent: half a mean free path, but two diameters or more; hsmc: two"},
    {"dt", KEY_REAL, AT(dt), "nan", 1e-300, NAN, "time", NULL,
     "time step; absent: the fastest grain needs ten to cross a cell (hsmc: 0.1 sqrt(d/g))"},
    {"speed", KEY_REAL, AT(speed), "nan", 1e-300, NAN, "speed", NULL,
     "greatest speed to expect, for choosing the time step; estimated when absent"},
    {"weight", KEY_COUNT, AT(weight), "1", 1, 1000, "1", NULL,
     "simulated particles for each grain: more of them, more accurate dissipation"},
    {"restitution", KEY_REAL, AT(restitution), "nan", 0, 1, "1", NULL,
     "of grains for which the scene has stiffness and damping instead; absent: 0.8"},
    {"tangential", KEY_REAL, AT(tangential), "0", -1, 1, "1", NULL,
     "beta0: greatest tangential restitution of grains with friction, 1: rough and elastic"},
    {"reach", KEY_RANGE, AT(reach), "2", 1, 16, "1", NULL,
     "hsmc: a grain rolls if it gets lower within so many columns (drawn for each grain); the "
     "slope of a heap is about 0.9 / reach"},
};

const struct key_group dsmc_settings_group = {
    "dsmc", "direct simulation Monte Carlo", keys, sizeof keys / sizeof *keys,
    sizeof(struct dsmc_settings)
};

static const double restitution_default = 0.8;  /* where only stiffness and damping are given */
static const double cells_per_step = 0.1;       /* that the fastest grain goes */
static const double cells_per_step_high = 0.5;  /* more than this is told */

/* Grains that a heap of hsmc carries off in sqrt(d/g).  On each of two flanks one layer of cells
 * goes, two grains abreast a diameter long, at one diameter in that time at most: four.  The heap
 * of scenes/heap.cfg, once it is as high as its source, takes 3.2. */
static const double shed_max = 3;

static double box_width(const struct scene *s) { return s->box[2] - s->box[0]; }
static double box_height(const struct scene *s) { return s->box[3] - s->box[1]; }

double dsmc_settings_fraction(const struct scene *scene)
{
    const double area = M_PI * scene->radius_mean * scene->radius_mean * scene->placed.count;
    return area / (box_width(scene) * box_height(scene));
}

/* Half of a mean free path, 1 / (2 sqrt(2) n d chi), but two diameters or more (001 2.4). */
static double cell_to_choose(const struct scene *scene, const struct dsmc_settings *settings)
{
    const double d = 2 * scene->radius_mean, nu = dsmc_settings_fraction(scene);
    if (settings->method == DSMC_HSMC || scene->source_count > 0 || !(nu > 0)) return 2 * d;
    const double dense = fmin(nu, 0.8);
    const double chi = (1 - 7 * dense / 16) / ((1 - dense) * (1 - dense));
    const double n = scene->placed.count / (box_width(scene) * box_height(scene));
    const double half = 0.5 / (2 * sqrt(2) * n * d * chi);
    const double side = fmin(box_width(scene), box_height(scene));
    return fmin(fmax(2 * d, half), fmax(2 * d, 0.1 * side));
}

struct dsmc_settings dsmc_settings_completed(const struct scene *scene)
{
    struct dsmc_settings s = {.cell = NAN, .dt = NAN, .speed = NAN, .weight = 1, .restitution = NAN,
                              .reach = {2, 2}};
    const struct dsmc_settings *given = scene_settings(scene, "dsmc");
    if (given) s = *given;
    if (scene->shear_rate != 0 && s.method == DSMC_DENSE) s.method = DSMC_PLAIN;
    if (isnan(s.speed)) s.speed = speed_greatest(scene);
    if (!(s.speed > 0)) s.speed = scene->radius_mean > 0 ? scene->radius_mean : 1;
    if (isnan(s.cell)) s.cell = cell_to_choose(scene, &s);
    if (isnan(s.dt)) {
        const double g = hypot(scene->gravity[0], scene->gravity[1]);
        const bool falls = s.method == DSMC_HSMC && g > 0;
        s.dt = falls ? 0.1 * sqrt(2 * scene->radius_mean / g) : cells_per_step * s.cell / s.speed;
    }
    return s;
}

/* Can grains come to rest on something?  A floor, or a wall that is not upright. */
static bool can_pile_up(const struct scene *scene)
{
    if (scene->gravity[0] == 0 && scene->gravity[1] == 0) return false;
    for (uint32_t w = 0; w < scene->wall_count; w++) {
        const struct wall *wall = &scene->walls[w];
        if (wall->shape != WALL_SEGMENT) return true;
        const double sx = wall->x1 - wall->x0, sy = wall->y1 - wall->y0, s = hypot(sx, sy);
        const double g = hypot(scene->gravity[0], scene->gravity[1]);
        const double across = fabs(sx * scene->gravity[1] - sy * scene->gravity[0]);
        if (across > 0.1 * s * g) return true;
    }
    return false;
}

/* Every phase is judged; what holds for all of them is told once. */
static void warn_once(struct findings *findings, const struct scene *scene, const char *text)
{
    for (uint32_t k = 0; k < findings->count && k < FINDINGS_MAX; k++) {
        if (strstr(findings->list[k].text, text)) return;
    }
    findings_tell(findings, scene, FINDING_WARNING, "dsmc.method", "%s", text);
}

/* What piles up faster than it can roll down: the heap grows steep, and in the end up to the
 * source, which then waits. */
static void judge_pour(struct scene *scene, struct findings *findings)
{
    const double fall = sqrt(hypot(scene->gravity[0], scene->gravity[1])
                             / (2 * scene->radius_mean));
    for (uint32_t k = 0; fall > 0 && k < scene->source_count; k++) {
        const struct source *source = &scene->sources[k];
        if (source->kind != SOURCE_POINT || source->rate <= shed_max * fall) continue;
        char place[64];
        snprintf(place, sizeof place, "sources.[%u].rate", k);
        findings_tell(findings, scene, FINDING_WARNING, place, "%g grains a time unit: of a heap "
            "of hsmc only the topmost cells roll, and carry off %.3g; it grows steep, up to the "
            "source, which then waits; use at most that and a longer run, or md", source->rate,
            shed_max * fall);
    }
}

static void judge_heap(struct scene *scene, const struct dsmc_settings *settings,
                       struct findings *findings)
{
    const double *g = scene->gravity;
    if (settings->method == DSMC_HSMC && fabs(g[0]) > 0.5 * fabs(g[1])) {
        findings_tell(findings, scene, FINDING_WARNING, "dsmc.method", "gravity = (%g, %g): hsmc "
            "lets grains rest on cells below them along y only; turn the scene", g[0], g[1]);
    }
    if (settings->method == DSMC_HSMC && scene->effects & EFFECT_GATES) {
        warn_once(findings, scene, "where a gate opens below grains at rest, hsmc lets them go row "
            "by row, as there is room below: a block falls half as far as freely, and a neck lets "
            "out less; md and ed know better");
    }
    if (settings->method == DSMC_HSMC) {
        if (can_pile_up(scene)) judge_pour(scene, findings);
        return;
    }
    for (uint32_t s = 0; s < scene->source_count; s++) {
        if (scene->sources[s].above == 0) continue;
        char place[64];
        snprintf(place, sizeof place, "sources.[%u].above", s);
        findings_tell(findings, scene, FINDING_ERROR, place, "grains come to rest by hsmc only, so "
            "no heap lifts this source; set dsmc.method = \"hsmc\", or delete 'above'");
    }
    if (!can_pile_up(scene) || !(scene->effects & EFFECT_DISSIPATION)) return;
    warn_once(findings, scene, "grains that lose energy fall onto walls here, and nothing keeps "
        "points apart: once they are slow the density at the bottom runs away; use dsmc.method = "
        "\"hsmc\", or md, where the grains come to rest");
}

static void judge_cell(struct scene *scene, const struct dsmc_settings *settings,
                       struct findings *findings)
{
    const double d = 2 * scene->radius_mean;
    const double cells = box_width(scene) / settings->cell * (box_height(scene) / settings->cell);
    if (cells > 1e8) {
        findings_tell(findings, scene, FINDING_ERROR, "dsmc.cell", "dsmc.cell = %g gives %.3g "
            "cells, more than 1e8; use a larger one", settings->cell, cells);
    }
    if (settings->cell < 0.99 * d) {
        findings_tell(findings, scene, FINDING_WARNING, "dsmc.cell", "dsmc.cell = %g is less than "
            "a diameter, %g: most cells hold one grain and nothing collides; use two diameters",
            settings->cell, d);
    }
    if (settings->method == DSMC_HSMC && fabs(settings->cell - 2 * d) > 0.01 * d) {
        findings_tell(findings, scene, FINDING_WARNING, "dsmc.cell", "dsmc.cell = %g: hsmc lets "
            "four grains into a cell, which suits two diameters, %g", settings->cell, 2 * d);
    }
    const double side = fmin(box_width(scene), box_height(scene));
    if (settings->cell > 0.2 * side) {
        findings_tell(findings, scene, FINDING_WARNING, "dsmc.cell", "dsmc.cell = %g leaves fewer "
            "than five cells across the box; use %g or less", settings->cell, 0.1 * side);
    }
    const double share = settings->dt * settings->speed / settings->cell;
    const bool falls = settings->method == DSMC_HSMC;           /* it has its own rule and a cap */
    if (!falls && share > cells_per_step_high) {
        findings_tell(findings, scene, FINDING_WARNING, "dsmc.dt", "dsmc.dt = %g lets the fastest "
            "grains (%.3g) cross %.2g of a cell in a step; use at most %.2g, or delete the line "
            "and sandreel chooses", settings->dt, settings->speed, share,
            cells_per_step * settings->cell / settings->speed);
    }
}

static void fill_restitution(struct scene *scene, const struct dsmc_settings *settings,
                             struct findings *findings)
{
    for (uint32_t k = 0; k < scene->species_count; k++) {
        struct species *species = &scene->species[k];
        if (!isnan(species->restitution)) continue;
        species->restitution = settings->restitution;
        if (!isnan(species->restitution)) continue;
        char place[64];
        snprintf(place, sizeof place, "grains.[%u]", k);
        findings_tell(findings, scene, FINDING_WARNING, place, "dsmc needs a restitution, and "
            "stiffness and damping do not give one that holds for every speed; %g is taken: set "
            "dsmc.restitution", restitution_default);
        species->restitution = restitution_default;
    }
}

/* One time step for all phases, the shortest that any of them asks for. */
static void share_step(struct scene *scene)
{
    double dt = INFINITY;
    for (uint32_t p = 0; p < scene->phase_count; p++) {
        dt = fmin(dt, dsmc_settings_completed(scene->phases[p]).dt);
    }
    for (uint32_t p = 1; p < scene->phase_count; p++) {
        struct dsmc_settings *settings = scene_settings(scene->phases[p], "dsmc");
        if (settings && isnan(settings->dt)) settings->dt = dt;
    }
    struct dsmc_settings *settings = scene_settings(scene, "dsmc");
    if (isnan(settings->dt)) settings->dt = dt;
}

/* Displaced grains keep their velocity where the flow has another one, and that counts as heat:
 * T/gamma^2 is 12.4 instead of 7.4 at an area fraction of 0.25 and r = 0.9. */
static void judge_shear(struct scene *scene, struct dsmc_settings *settings,
                        struct findings *findings)
{
    if (scene->shear_rate == 0 || settings->method != DSMC_DENSE) return;
    settings->method = DSMC_PLAIN;
    findings_tell(findings, scene, FINDING_WARNING, "dsmc.method", "the dense form heats a gas "
        "between sheared borders (shear_rate = %g) by two thirds too much, so plain is taken; set "
        "dsmc.method = \"plain\", with cells of two diameters", scene->shear_rate);
}

void dsmc_settings_resolve(struct scene *scene, struct findings *findings)
{
    struct dsmc_settings *settings = scene_settings(scene, "dsmc");
    if (!settings || scene->species_count == 0) return;
    if (scene->phase_count > 1) share_step(scene);
    judge_shear(scene, settings, findings);
    const struct dsmc_settings s = dsmc_settings_completed(scene);
    settings->speed = s.speed;
    if (scene->placed.count > 0 || scene->source_count > 0) {   /* else the density is not known */
        settings->cell = s.cell;
        settings->dt = s.dt;
    }
    fill_restitution(scene, &s, findings);
    if (scene->effects & EFFECT_FRICTION) scene->effects |= EFFECT_ROTATION;
    judge_cell(scene, &s, findings);
    judge_heap(scene, &s, findings);
    if (scene->effects & EFFECT_POLYDISPERSE) {
        findings_tell(findings, scene, FINDING_WARNING, "grains", "the grains of dsmc are all "
            "alike; the mean radius %g stands for all", scene->radius_mean);
    }
}
