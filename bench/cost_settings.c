/* cost_settings.c - the settings that `cost` tries, and factors on what a model chooses itself.
 *
 * Time step, integrator, force law and stiffness of soft discs; the cut-off time of hard ones;
 * method, cell, step and weight of DSMC; rules and resolution of the lattice.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/cost.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct cost_setting cost_settings[] = {
    {"md", ""},
    {"md", "md.dt=*4"},
    {"md", "md.dt=*2"},
    {"md", "md.dt=*0.5"},
    {"md", "md.integrator=gear"},
    {"md", "md.force=hertz"},
    {"md", "grains.[0].stiffness=*0.1"},
    {"md", "grains.[0].stiffness=*10"},
    {"ed", ""},
    {"ed", "ed.t_c=*10"},
    {"ed", "ed.t_c=*100"},
    {"ed", "ed.t_c=*1000"},
    {"dsmc", ""},
    {"dsmc", "dsmc.method=plain"},
    {"dsmc", "dsmc.method=hsmc"},
    {"dsmc", "dsmc.cell=*2"},
    {"dsmc", "dsmc.dt=*4"},
    {"dsmc", "dsmc.weight=4"},
    {"lga", ""},
    {"lga", "lga.method=sandpile"},
    {"lga", "lga.spacing=*2"},
    {NULL, NULL}
};

/* What the model chose for "md.dt" or "grains.[0].stiffness"; NAN if there is no such number. */
static double chosen_value(const struct setup *chosen, const char *path)
{
    const struct scene *scene = chosen->scene;
    if (strcmp(path, "grains.[0].stiffness") == 0) return scene->species[0].stiffness;
    const struct key_group *group = chosen->model->settings;
    const char *dot = strchr(path, '.');
    const struct key *key = group && dot ? key_find(group, dot + 1) : NULL;
    if (!key || key->type != KEY_REAL) return NAN;
    const char *settings = scene_settings(scene, group->name);
    return *(const double *)(settings + key->offset);
}

bool cost_keys(const struct cost_setting *setting, const struct setup *chosen,
               struct cost_point *point)
{
    snprintf(point->label, sizeof point->label, "%s%s%s", setting->model,
             setting->keys[0] ? " " : "", setting->keys);
    snprintf(point->keys[0], COST_KEY, "model=%s", setting->model);
    point->key_count = 1;
    if (!setting->keys[0]) return true;
    const char *star = strstr(setting->keys, "=*");
    char *text = point->keys[point->key_count++];
    if (!star) {
        snprintf(text, COST_KEY, "%s", setting->keys);
        return true;
    }
    char path[COST_KEY - 30];           /* leaves room for the number */
    snprintf(path, sizeof path, "%.*s", (int)(star - setting->keys), setting->keys);
    const double value = chosen_value(chosen, path) * strtod(star + 2, NULL);
    if (!isfinite(value) || value == 0) return false;
    snprintf(text, COST_KEY, "%s=%.17g", path, value);
    return true;
}
