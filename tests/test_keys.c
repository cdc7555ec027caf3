/* test_keys.c - every numeric key of every group at 0, -1, the smallest and the largest number,
 * nan and inf: refused with a finding, or a run that begins and stays finite or says why not; and
 * in the scene itself as on the command line.
 *
 * Walks the key tables, so a key that is added tomorrow is tried too.  Grains of md, ed, dsmc and
 * lga are advanced by a few hundred units of work after each accepted value.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "check.h"
#include "model/simulation.h"
#include "run/setup.h"
#include "scene/scene_key.h"

#include <sys/resource.h>

static const char *const values[] = {"0", "-1", "1e308", "-1e308", "5e-324", "nan", "inf", "-inf"};

enum { VALUES = sizeof values / sizeof *values, BUDGET = 300 };

/* One entry in each list that the model can do. */
static const char basic[] =
    "seed = 3; until = 1.0; box = (0.0, 0.0, 20.0, 20.0); gravity = (0.0, -1.0);\n"
    "grains = ( { radius = 0.5; restitution = 0.9; } );\n"
    "placements = ( { count = 9; spacing = 1.5; temperature = 1.0; } );\n"
    "phases = ( { time = 0.5; set = (\"grains.restitution=0.8\"); } );\n";
/* One of each list; a model that cannot do one is tried without it. */
static const char *const rich[] = {
    "sources = ( { position = (10.0, 18.0); rate = 1.0; velocity = (0.0, -1.0); } );\n",
    "walls = ( { shape = \"segment\"; from = (1.0, 15.0); to = (5.0, 15.0); } );\n",
    "obstacles = ( { shape = \"disc\"; center = (15.0, 10.0); radius = 1.0; } );\n",
    "screens = ( { radius = 100.0; } );\n",
    "sinks = ( { region = (0.0, 19.0, 20.0, 20.0); } );\n",
};

enum { RICH = sizeof rich / sizeof *rich };

static char text[2000];
static char variant[100];       /* a word of the model's settings, as an override; "" for none */
static unsigned tried, refused, ran, tried_in_scene, sections_tried[SCENE_SECTIONS];

static bool is_numeric(enum key_type type)
{
    return type == KEY_REAL || type == KEY_COUNT || type == KEY_WORD64 || type == KEY_VECTOR
        || type == KEY_BOX || type == KEY_RANGE || type == KEY_REALS || type == KEY_POINTS;
}

static void write_value(char *out, size_t size, enum key_type type, const char *value)
{
    const char *v = value;
    if (type == KEY_VECTOR) snprintf(out, size, "(%s, %s)", v, v);
    else if (type == KEY_BOX) snprintf(out, size, "(%s, %s, %s, %s)", v, v, v, v);
    else if (type == KEY_REALS) snprintf(out, size, "(%s)", v);
    else if (type == KEY_POINTS) snprintf(out, size, "((%s, %s), (1, 2), (3, 1))", v, v);
    else snprintf(out, size, "%s", v);
}

static bool counters_are_finite(const struct simulation *sim)
{
    const struct counters now = simulation_count(sim);
    return isfinite(now.time) && isfinite(now.kinetic_energy) && isfinite(now.rotational_energy)
        && isfinite(now.potential_energy) && isfinite(now.momentum_x) && isfinite(now.momentum_y);
}

/* Begins the run; it may be refused or break, but never silently leave the finite numbers. */
static void run_briefly(const struct setup *setup, const char *override)
{
    struct simulation sim = {0};
    struct error error = {.text = ""};
    if (!simulation_create(&sim, setup->model, setup->scene, &error)) {
        if (!error.text[0]) fail_msg("%s: refused without a reason", override);
        simulation_destroy(&sim);
        return;
    }
    const double t = fmin(setup->scene->until, 1);
    const enum advance outcome = simulation_advance(&sim, t, BUDGET, &error);
    if (outcome == ADVANCE_BROKEN) {
        if (!error.text[0]) fail_msg("%s: broke without a reason", override);
    } else if (!counters_are_finite(&sim)) {
        fail_msg("%s with %s: counters are not finite", override, setup->model->name);
    }
    ran++;
    simulation_destroy(&sim);
}

/* ---- in the scene itself ------------------------------------------------------------------- */

/* `text` with KEY = VALUE; in this group (in the first entry, if it is a list), in place of what it
 * says of that key. */
static void write_scene(char *out, size_t size, const struct key_group *group, bool list,
                        const char *key, const char *value)
{
    char head[100], wanted[100];
    const char *at = text;
    snprintf(wanted, sizeof wanted, "%s = ", key);
    if (group->name[0]) {
        snprintf(head, sizeof head, list ? "%s = ( { " : "%s = { ", group->name);
        at = strstr(text, head);
        if (!at) {
            snprintf(out, size, "%s%s%s%s; }%s;\n", text, head, wanted, value, list ? " )" : "");
            return;
        }
        at += strlen(head);
    }
    /* Of the top group every key stands before the first list, of another before its bracket. */
    const size_t room = strcspn(at, "}");
    const char *old = strstr(at, wanted), *rest = at;
    const bool said = old && old < at + room && (old == at || old[-1] == ' ' || old[-1] == '\n');
    if (said) rest = old + strcspn(old, ";") + 1;
    snprintf(out, size, "%.*s%s%s; %s", (int)((said ? old : at) - text), text, wanted, value, rest);
}

/* Is it refused as the override is?  What is no number is none in a file either. */
static void try_in_scene(const struct key_group *group, bool list, const struct key *key,
                         const char *words, const char *model_words, bool accepted)
{
    char scene[2400];
    write_scene(scene, sizeof scene, group, list, key->name, words);
    const char *const overrides[] = {model_words, variant};
    const struct setup_request request = {.path = "keys.cfg", .text = scene, .overrides = overrides,
                                          .override_count = *variant ? 2 : 1, .place = true};
    struct setup setup;
    struct error error = {.text = ""};
    const bool loaded = setup_load(&setup, &request, &error);
    if (loaded != accepted) {
        const struct findings *found = setup.findings;
        fail_msg("%s.%s = %s: %s in a scene, and %s by -s: %s", group->name, key->name, words,
                 loaded ? "right" : "refused", accepted ? "right" : "refused",
                 found && found->count ? found->list[0].text : error.text);
    }
    setup_free(&setup);
    tried_in_scene++;
}

static void try_value(const char *model, const struct key_group *group, bool list,
                      const struct key *key, const char *value)
{
    char path[200], override[500], words[200], model_words[60];
    if (group->name[0]) {
        snprintf(path, sizeof path, "%s.%s%s", group->name, list ? "[0]." : "", key->name);
    } else {
        snprintf(path, sizeof path, "%s", key->name);
    }
    write_value(words, sizeof words, key->type, value);
    snprintf(override, sizeof override, "%s=%s", path, words);
    snprintf(model_words, sizeof model_words, "model=\"%s\"", model);
    const char *const overrides[] = {model_words, override, variant};
    const struct setup_request request = {.path = "keys.cfg", .text = text, .overrides = overrides,
                                          .override_count = *variant ? 3 : 2, .place = true};
    struct setup setup;
    struct error error = {.text = ""};
    tried++;
    const bool accepted = setup_load(&setup, &request, &error);
    if (accepted) {
        run_briefly(&setup, override);
    } else {
        refused++;
        if (setup.findings && setup.findings->errors == 0) fail_msg("%s: no finding", override);
    }
    setup_free(&setup);
    try_in_scene(group, list, key, words, model_words, accepted);
}

static void try_group(const char *model, const struct key_group *group, bool list)
{
    for (uint32_t k = 0; k < group->count; k++) {
        if (!is_numeric(group->keys[k].type)) continue;
        for (int v = 0; v < VALUES; v++) {
            try_value(model, group, list, &group->keys[k], values[v]);
        }
    }
}

static bool fits(const char *model)
{
    char words[60];
    struct setup setup;
    struct error error;
    snprintf(words, sizeof words, "model=\"%s\"", model);
    const char *const overrides[] = {words, variant};
    const struct setup_request request = {.path = "keys.cfg", .text = text, .overrides = overrides,
                                          .override_count = *variant ? 2 : 1};
    const bool loaded = setup_load(&setup, &request, &error);
    setup_free(&setup);
    return loaded;
}

/* All that the model can do. */
static void choose_text(const char *model)
{
    size_t used = (size_t)snprintf(text, sizeof text, "%s", basic);
    for (int k = 0; k < RICH; k++) {
        snprintf(text + used, sizeof text - used, "%s", rich[k]);
        if (fits(model)) used += strlen(rich[k]);
        else text[used] = 0;
    }
}

/* The model's own numbers matter in one of its methods and not in another: each word of its
 * settings in turn. */
static void try_settings(const struct model *model)
{
    const struct key_group *group = model->settings;
    try_group(model->name, group, false);
    for (uint32_t k = 0; k < group->count; k++) {
        const struct key *key = &group->keys[k];
        char word[60];
        if (key->type != KEY_CHOICE) continue;
        for (int c = 0; *key_choice_word(key->choices, c, word, sizeof word); c++) {
            if (key->fallback && strcmp(word, key->fallback) == 0) continue;
            snprintf(variant, sizeof variant, "%s.%s=%s", group->name, key->name, word);
            choose_text(model->name);
            if (fits(model->name)) try_group(model->name, group, false);
        }
    }
    *variant = 0;
}

static void test_every_number_of_a_scene_is_refused_or_runs(void **unused)
{
    (void)unused;
    for (const struct model *const *m = model_list; *m; m++) {
        choose_text((*m)->name);
        try_group((*m)->name, &scene_key_top, false);
        for (uint32_t s = 0; s < SCENE_SECTIONS; s++) {
            const struct scene_section *section = &scene_key_sections[s];
            const bool there = strstr(text, section->group->name) != NULL;
            if (section->list && !there) continue;
            try_group((*m)->name, section->group, section->list);
            sections_tried[s]++;
        }
        if ((*m)->settings) try_settings(*m);
    }
    print_message("%u values tried, %u refused, %u ran\n", tried, refused, ran);
    CHECK(tried_in_scene == tried);
    CHECK(refused > 0 && ran > 0);
    for (uint32_t s = 0; s < SCENE_SECTIONS; s++) {
        if (sections_tried[s] > 0) continue;
        fail_msg("no model tried %s", scene_key_sections[s].group->name);
    }
}

int main(void)
{
    /* What asks for a billion grains is to be told that there is no memory for them. */
    const struct rlimit limit = {(rlim_t)2 << 30, (rlim_t)2 << 30};
#ifndef __SANITIZE_ADDRESS__
    setrlimit(RLIMIT_AS, &limit);
#else
    (void)limit;
#endif
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_number_of_a_scene_is_refused_or_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
