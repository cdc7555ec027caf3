/* cost_settings.c - see cost_settings.h.
 *
 * Time step, integrator, force law and stiffness of soft discs; the cut-off time of hard ones;
 * method, cell, step and weight of DSMC; rules and resolution of the lattice.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/cost_settings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* From fast to slow, more or less, so that a table shows early what is cheap. */
const char *const cost_settings_list[] = {
    "lga",
    "lga lga.method=sandpile",
    "lga lga.spacing=*0.5",
    "lga lga.spacing=*2",
    "dsmc",
    "dsmc dsmc.method=plain",
    "dsmc dsmc.method=dense",
    "dsmc dsmc.method=hsmc",
    "dsmc dsmc.cell=*2",
    "dsmc dsmc.cell=*4",
    "dsmc dsmc.dt=*4",
    "dsmc dsmc.dt=*0.25",
    "dsmc dsmc.weight=4",
    "ed",
    "ed ed.t_c=*0.1",
    "ed ed.t_c=*10",
    "ed ed.t_c=*100",
    "ed ed.t_c=*1000",
    "md md.dt=*4",
    "md md.dt=*2",
    "md",
    "md md.dt=*0.5",
    "md md.integrator=gear md.dt=*2",
    "md md.integrator=gear",
    "md grains.[0].stiffness=*0.01",
    "md grains.[0].stiffness=*0.1",
    "md grains.[0].stiffness=*10",
    "md md.force=hertz grains.[0].stiffness=hertz",
    "md md.force=linear grains.[0].stiffness=linear",
    NULL
};

const char *cost_settings_model(const char *setting, char *name, size_t size)
{
    snprintf(name, size, "%.*s", (int)strcspn(setting, " "), setting);
    return name;
}

/* The key after the point, "dt" of "md.dt", in the model's settings; NULL if there is none. */
static const void *find_value(const struct setup *chosen, const char *path, enum key_type type)
{
    const struct key_group *group = chosen->model->settings;
    const char *dot = strchr(path, '.');
    const struct key *key = group && dot ? key_find(group, dot + 1) : NULL;
    if (!key || key->type != type) return NULL;
    const char *settings = scene_settings(chosen->scene, group->name);
    return settings + key->offset;
}

static double real_value(const struct setup *chosen, const char *path)
{
    const double *value = find_value(chosen, path, KEY_REAL);
    return value ? *value : NAN;
}

static const char stiffness_path[] = "grains.[0].stiffness";

/* Stiffness of the other force law: the same greatest overlap xi = s R in the same impact, which
 * makes alpha sqrt(R xi) = 15/8 k (m v^2 / 2 = k xi^2 / 2 = 4/15 alpha sqrt(R) xi^(5/2), for the
 * impact on a wall). */
static double other_stiffness(const struct setup *chosen, bool to_hertz)
{
    const int *force = find_value(chosen, "md.force", KEY_CHOICE);
    const struct species *s = &chosen->scene->species[0];
    const double radius = chosen->scene->radius_max;
    const double factor = 15.0 / 8 / (radius * sqrt(real_value(chosen, "md.overlap")));
    if (!force || (*force == 0) != to_hertz) return NAN;
    return to_hertz ? s->stiffness * factor : s->stiffness / factor;
}

/* The number that `text` ("*2", "hertz") means for this path; NAN: none. */
static double number_of(const struct setup *chosen, const char *path, const char *text)
{
    const bool stiffness = strcmp(path, stiffness_path) == 0;
    if (*text != '*') return stiffness ? other_stiffness(chosen, *text == 'h') : NAN;
    const double now = stiffness ? chosen->scene->species[0].stiffness : real_value(chosen, path);
    return now * strtod(text + 1, NULL);
}

/* Does this key say what the model chooses anyway? */
static bool is_chosen(const struct setup *chosen, const char *path, const char *word)
{
    const int *choice = find_value(chosen, path, KEY_CHOICE);
    const char *dot = strchr(path, '.');
    const struct key *key = choice ? key_find(chosen->model->settings, dot + 1) : NULL;
    return key && key_choice(key->choices, word) == *choice;
}

bool cost_settings_key(const char *word, const struct setup *chosen, char text[COST_KEY])
{
    const char *value = strchr(word, '=');
    const bool computed = value && (value[1] == '*' || strcmp(value, "=hertz") == 0
                                    || strcmp(value, "=linear") == 0)
                       && strncmp(word, "md.force", 8) != 0;
    snprintf(text, COST_KEY, "%s", word);
    char path[COST_KEY - 30];           /* leaves room for the number */
    snprintf(path, sizeof path, "%.*s", (int)strcspn(word, "="), word);
    if (!computed) return !value || !is_chosen(chosen, path, value + 1);
    const double number = number_of(chosen, path, value + 1);
    if (!isfinite(number) || number == 0) return false;
    snprintf(text, COST_KEY, "%s=%.17g", path, number);
    return true;
}

double cost_settings_step(const struct setup *setup) { return real_value(setup, "model.dt"); }

bool cost_settings_keys(const char *setting, const struct setup *chosen, struct cost_point *point)
{
    char words[COST_KEY], *save = NULL;
    snprintf(words, sizeof words, "%s", setting);
    snprintf(point->label, sizeof point->label, "%s", setting);
    point->key_count = 0;
    for (char *word = strtok_r(words, " ", &save); word; word = strtok_r(NULL, " ", &save)) {
        if (point->key_count == COST_KEYS) return false;
        if (point->key_count > 0) {
            if (!cost_settings_key(word, chosen, point->keys[point->key_count++])) return false;
        } else {
            snprintf(point->keys[point->key_count++], COST_KEY, "model=%s", word);
        }
    }
    return point->key_count > 0;
}
