/* test_scene.c - a scene as a whole: round trip, built-in scenes, effects, phases, quick forms.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/asset.h"
#include "base/file.h"
#include "check.h"
#include "model/model.h"
#include "scene/scene.h"

#include <unistd.h>

static struct findings findings;

static struct scene *try_load(const char *path, const char *text, const char *override, bool place)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = path, .text = text, .groups = groups,
        .group_count = model_settings(groups), .overrides = &override,
        .override_count = override ? 1 : 0, .place = place};
    memset(&findings, 0, sizeof findings);
    return scene_load(&request, &findings);
}

static struct scene *load(const char *path, const char *text, const char *override)
{
    struct scene *scene = try_load(path, text, override, true);
    char told[1000];
    if (!scene) fail_msg("%s: %s", path, findings_line(&findings.list[0], told, sizeof told));
    return scene;
}

/* ---- the same scene? ----------------------------------------------------------------------- */

static bool same_key(const struct key *key, const void *a, const void *b)
{
    const struct key_reals *ra = a, *rb = b;
    const struct key_texts *ta = a, *tb = b;
    const double *da = a, *db = b;
    uint32_t numbers = 0;
    switch (key->type) {
    case KEY_REALS:
    case KEY_POINTS:
        return ra->count == rb->count
            && (!ra->count || memcmp(ra->values, rb->values, ra->count * sizeof(double)) == 0);
    case KEY_TEXTS:
        if (ta->count != tb->count) return false;
        for (uint32_t k = 0; k < ta->count; k++) if (strcmp(ta->texts[k],
                                                            tb->texts[k])) return false;
        return true;
    case KEY_TEXT:   return strcmp(a, b) == 0;
    case KEY_BOOL:   return *(const bool *)a == *(const bool *)b;
    case KEY_WORD64: return *(const uint64_t *)a == *(const uint64_t *)b;
    case KEY_COUNT:
    case KEY_CHOICE: return *(const uint32_t *)a == *(const uint32_t *)b;
    case KEY_REAL:   numbers = 1; break;
    case KEY_VECTOR:
    case KEY_RANGE:  numbers = 2; break;
    case KEY_BOX:    numbers = 4; break;
    }
    for (uint32_t k = 0; k < numbers; k++) {
        if (da[k] != db[k] && !(isnan(da[k]) && isnan(db[k]))) return false;
    }
    return true;
}

static void check_same_group(const struct key_group *group, const void *a, const void *b)
{
    for (uint32_t k = 0; k < group->count; k++) {
        const size_t at = group->keys[k].offset;
        if (!same_key(&group->keys[k], (const char *)a + at, (const char *)b + at)) {
            fail_msg("%s.%s differs after the round trip", group->name, group->keys[k].name);
        }
    }
}

static const struct key_group *group_called(const char *name)
{
    const struct key_group *group;
    uint32_t index = 0;
    while ((group = scene_key_group(index)) && strcmp(group->name, name) != 0) index++;
    CHECK(group != NULL);
    return group;
}

#define SAME_LIST(word, array, counter)                                                 \
    CHECK(a->counter == b->counter);                                                    \
    for (uint32_t k = 0; k < a->counter; k++) {                                         \
        check_same_group(group_called(word), &a->array[k], &b->array[k]);               \
    }

static void check_same_scene(const struct scene *a, const struct scene *b)
{
    check_same_group(group_called(""), a, b);
    check_same_group(group_called("view"), &a->view, &b->view);
    check_same_group(group_called("measure"), &a->measure, &b->measure);
    check_same_group(group_called("output"), &a->output, &b->output);
    SAME_LIST("grains", species, species_count)
    SAME_LIST("placements", placements, placement_count)
    SAME_LIST("sources", sources, source_count)
    SAME_LIST("walls", wall_entries, wall_entry_count)
    SAME_LIST("obstacles", obstacles, obstacle_count)
    SAME_LIST("screens", screens, screen_count)
    SAME_LIST("sinks", sinks, sink_count)
    SAME_LIST("phases", phase_entries, phase_entry_count)
    for (uint32_t k = 0; k < a->settings_count; k++) {
        check_same_group(a->settings_groups[k], a->settings[k], b->settings[k]);
    }
    CHECK(a->effects == b->effects && a->wall_count == b->wall_count);
    CHECK(a->placed.count == b->placed.count && a->phase_count == b->phase_count);
    const size_t size = a->placed.count * sizeof(double);
    if (size == 0) return;
    CHECK(memcmp(a->placed.x, b->placed.x, size) == 0);
    CHECK(memcmp(a->placed.vy, b->placed.vy, size) == 0);
    CHECK(memcmp(a->placed.radius, b->placed.radius, size) == 0);
}

/* Writes the scene, loads what was written, and compares. */
static void check_round_trip(const struct scene *scene)
{
    char folder[] = "/tmp/sandreel-scene-XXXXXX", path[100];
    CHECK(mkdtemp(folder) != NULL);
    snprintf(path, sizeof path, "%s/%.60s.cfg", folder, scene->name);
    struct error error;
    CHECK(scene_write(scene, path, &error));
    struct scene *again = load(path, NULL, NULL);
    unlink(path);
    rmdir(folder);
    check_same_scene(scene, again);
    scene_free(again);
}

static const char everything[] =
    "title = \"a \\\"quoted\\\" \\\\ title\"; units = \"si\"; seed = 0xfedcba9876543210L;\n"
    "until = 0.1; box = [-1.5, 0, 3, 2]; gravity = (0.1, -9.81); left = \"periodic\";\n"
    "right = \"periodic\"; top = \"open\";\n"
    "grains = ( { name = \"a\"; radius = [0.01, 0.013]; restitution = 0.3; friction = 0.5; },\n"
    "           { name = \"b\"; radii = [0.02, 0.03]; stiffness = 1e5; damping = 0.1;\n"
    "             inertia = \"sphere\"; density = 7.77; } );\n"
    "placements = ( { grains = \"b\"; region = [0, 0.5, 1, 1.5]; count = 50; spacing = 1.3;\n"
    "                 jitter = 0.7; temperature = 0.123456789012345678; velocity = (1, 2); },\n"
    "               { kind = \"random\"; fraction = 0.4;\n"
    "                 outline = ((-1, 1), (-0.1, 1), (0, 2)); } );\n"
    "sources = ( { position = (1, 1.9); rate = 7; from = 0.01; to = 0.05; grains = \"a\"; } );\n"
    "walls = ( { shape = \"segment\"; from = (1, 0.2); to = (2, 0.2); opens = 0.1;\n"
    "            closes = 0.2; },\n"
    "          { shape = \"arc\"; center = (2.5, 1); radius = 0.3; angles = (-30, 60);\n"
    "            amplitude = (0, 0.01); frequency = 50; } );\n"
    "obstacles = ( { shape = \"row\"; from = (2, 1); to = (2, 1.5); radius = 0.02; } );\n"
    "screens = ( { kind = \"line\"; x = 2.9; bins = 36; } );\n"
    "sinks = ( { region = [2, 0, 3, 0.1]; } );\n"
    "phases = ( { time = 0.05; set = [\"gravity=(0, -1)\"]; } );\n"
    "view = { size = [640, 480]; scale = \"log\"; range = (0.1, 2); };\n"
    "measure = { fields = [\"density\", \"velocity\"]; average = (0.02, 0.04); };\n";

static void test_a_written_scene_loads_as_the_same_scene(void **unused)
{
    (void)unused;
    struct scene *scene = load("everything.cfg", everything, NULL);
    CHECK(strcmp(scene->title, "a \"quoted\" \\ title") == 0);
    CHECK(scene->seed == 0xfedcba9876543210u);
    check_round_trip(scene);
    scene_free(scene);
}

static void test_every_builtin_scene_loads_in_both_forms_and_survives_the_round_trip(void **unused)
{
    (void)unused;
    uint32_t count = 0;
    for (const struct asset *asset = asset_list; asset->name; asset++) {
        const char *end = strstr(asset->name, ".cfg");
        if (strncmp(asset->name, "scenes/", 7) != 0 || strchr(asset->name + 7, '/')) continue;
        char name[64];
        snprintf(name, sizeof name, "%.*s", (int)(end - asset->name - 7), asset->name + 7);
        struct scene *full = try_load(name, NULL, NULL, false);
        CHECK(full != NULL && full->quick_set.count > 0);
        struct scene *quick = load(name, NULL, "quick=true");
        CHECK(quick->quick);
        CHECK(quick->until < full->until);
        check_round_trip(quick);
        scene_free(full);
        scene_free(quick);
        count++;
    }
    CHECK(count >= 5);
}

static void test_the_example_of_the_guide_is_a_scene(void **unused)
{
    (void)unused;
    char path[1024];
    const char *root = getenv("SOURCE_ROOT");
    struct error error;
    size_t size;
    snprintf(path, sizeof path, "%s/docs/scenes.md", root ? root : ".");
    char *text = file_load(path, 1 << 20, &size, &error);
    CHECK(text != NULL);
    char *begin = strstr(strstr(text, "<!-- example"), "```\n") + 4;
    *strstr(begin, "```") = 0;
    for (int quick = 0; quick < 2; quick++) {
        struct scene *scene = load("guide.cfg", begin, quick ? "quick=true" : NULL);
        CHECK(scene->placed.count > (quick ? 400 : 1000) && scene->phase_count == 2);
        CHECK(findings.warnings == 0);
        check_round_trip(scene);
        scene_free(scene);
    }
    free(text);
}

static void test_one_override_sets_the_number_of_grains_in_the_hourglass(void **unused)
{
    (void)unused;
    struct scene *scene = load("hourglass", NULL, NULL);
    CHECK(scene->placed.count > 3800 && scene->placed.count < 4200);
    scene_free(scene);
    scene = load("hourglass", NULL, "grains.[0].radius=[0.0566,0.0849]");
    CHECK(scene->placed.count > 1900 && scene->placed.count < 2100);
    scene_free(scene);
}

static void test_phases_accumulate_and_share_the_grains(void **unused)
{
    (void)unused;
    struct scene *scene = load("phases.cfg",
        "until = 4; box = [0, 0, 10, 10];\n"
        "grains = ( { radius = 0.5; restitution = 1; } ); placements = ( { count = 20; } );\n"
        "phases = ( { time = 1; set = [\"gravity=(0, -1)\"]; },\n"
        "           { time = 2; set = [\"grains.[0].restitution=0.5\", \"bottom=open\"]; } );",
        NULL);
    CHECK(scene->phase_count == 3 && scene->phases[0] == scene);
    CHECK(scene->phase_times[0] == 0 && scene->phase_times[1] == 1 && scene->phase_times[2] == 2);
    CHECK(scene->phases[0]->gravity[1] == 0 && scene->phases[1]->gravity[1] == -1);
    CHECK(scene->phases[2]->gravity[1] == -1 && scene->phases[2]->species[0].restitution == 0.5);
    CHECK(scene->phases[1]->species[0].restitution == 1);
    CHECK(scene->phases[2]->wall_count == 3 && scene->wall_count == 4);
    CHECK(scene->phases[2]->effects == (EFFECT_GRAVITY | EFFECT_DISSIPATION | EFFECT_WALLS
                                        | EFFECT_OUTFLOW));
    CHECK(scene->phases[2]->placed.count == 20 && scene->phases[2]->placed.x == scene->placed.x);
    CHECK(scene->phases[1]->count_max == scene->count_max);
    CHECK(scene_at(scene, 0.5) == scene && scene_at(scene, 1) == scene->phases[1]);
    CHECK(scene_at(scene, 99) == scene->phases[2]);
    check_round_trip(scene);
    scene_free(scene);
}

static void test_what_a_model_chose_for_a_phase_is_written_with_it(void **unused)
{
    (void)unused;
    struct scene *scene = load("phases.cfg",
        "until = 4; box = [0, 0, 10, 10];\n"
        "grains = ( { radius = 0.5; restitution = 1; } ); placements = ( { count = 20; } );\n"
        "phases = ( { time = 1; set = [\"gravity=(0, -1)\"]; },\n"
        "           { time = 2; set = [\"grains.[0].stiffness=7\"]; } );", NULL);
    scene->species[0].stiffness = 100;                  /* as a model's resolve would */
    scene->phases[1]->species[0].stiffness = 300;
    char folder[] = "/tmp/sandreel-scene-XXXXXX", path[100];
    CHECK(mkdtemp(folder) != NULL);
    snprintf(path, sizeof path, "%s/phases.cfg", folder);
    struct error error;
    CHECK(scene_write(scene, path, &error));
    struct scene *again = load(path, NULL, NULL);
    unlink(path);
    rmdir(folder);
    CHECK(again->species[0].stiffness == 100);
    CHECK(again->phases[1]->species[0].stiffness == 300 && again->phases[1]->gravity[1] == -1);
    CHECK(again->phases[2]->species[0].stiffness == 7);
    scene_free(scene);
    scene_free(again);
}

/* The word and the reason of an effect, as check --explain tells them. */
static bool explains(const struct scene *scene, effects_t effect, bool on, const char *fragment)
{
    struct scene_reason reason;
    for (uint32_t k = 0; scene_explain(scene, k, &reason); k++) {
        if (reason.effect != effect) continue;
        if (reason.on != on || !strstr(reason.why, fragment)) print_error("%s\n", reason.why);
        return reason.on == on && strstr(reason.why, fragment);
    }
    return false;
}

static void test_effects_follow_from_keys_and_name_them(void **unused)
{
    (void)unused;
    struct scene *scene = load("effects.cfg",
        "until = 4; box = [0, 0, 10, 10]; left = \"open\";\n"
        "grains = (\n"
        "    { radius = 0.5; restitution = 1; friction = 0.25; }\n"
        "); placements = ( { count = 20; } );", NULL);
    CHECK(scene->effects == (EFFECT_FRICTION | EFFECT_DISSIPATION | EFFECT_WALLS
                             | EFFECT_OUTFLOW));
    CHECK(explains(scene, EFFECT_FRICTION, true, "grains.[0].friction = 0.25 (effects.cfg:3)"));
    CHECK(explains(scene, EFFECT_OUTFLOW, true, "effects.cfg:1"));
    CHECK(explains(scene, EFFECT_GRAVITY, false, "gravity is zero"));
    CHECK(explains(scene, EFFECT_SHEAR, false, "shear_rate is zero"));
    scene->effects |= EFFECT_STATIC_FRICTION;           /* as a model's resolve would */
    CHECK(explains(scene, EFFECT_STATIC_FRICTION, true, "md"));
    scene_free(scene);
    /* What a scene does not mention does not exist. */
    scene = load("bare.cfg", "until = 4; box = [0, 0, 10, 10]; left = \"periodic\";\n"
        "right = \"periodic\"; top = \"periodic\"; bottom = \"periodic\";\n"
        "grains = ( { radius = 0.5; restitution = 1; } ); placements = ( { count = 20; } );", NULL);
    CHECK(scene->effects == EFFECT_PERIODIC);
    scene_free(scene);
    scene = load("sheared.cfg", "until = 4; box = [0, 0, 10, 10]; left = \"periodic\";\n"
        "right = \"periodic\"; top = \"periodic\"; bottom = \"periodic\";\n"
        "shear_rate = -0.5;\n"
        "grains = ( { radius = 0.5; restitution = 1; } ); placements = ( { count = 20; } );", NULL);
    CHECK(scene->effects == (EFFECT_PERIODIC | EFFECT_SHEAR));
    CHECK(explains(scene, EFFECT_SHEAR, true, "shear_rate = -0.5 (sheared.cfg:3)"));
    scene_free(scene);
}

static void test_walls_come_down_to_joined_pieces(void **unused)
{
    (void)unused;
    struct scene *scene = load("walls.cfg",
        "until = 4; box = [0, 0, 10, 10]; top = \"open\";\n"
        "grains = ( { radius = 0.2; restitution = 1; } ); placements = ( { count = 20; } );\n"
        "walls = ( { shape = \"polyline\"; points = ((2, 5), (3, 4), (4, 5)); },\n"
        "          { shape = \"arc\"; center = (5, 5); radius = 1; angles = (0, 180); } );\n"
        "obstacles = ( { shape = \"disc\"; center = (8, 8); radius = 1; },\n"
        "              { shape = \"row\"; from = (1, 9); to = (2, 9); radius = 0.1; } );", NULL);
    const struct wall *w = scene->walls;
    /* left, bottom, right, then two segments, an arc, a disc and 1 / 0.2 + 1 = 6 discs. */
    CHECK(scene->wall_count == 3 + 2 + 1 + 1 + 6);
    CHECK(w[0].border && w[0].joined1 == 1 && w[0].joined0 == WALL_NONE && w[1].joined1 == 2);
    CHECK(w[3].joined0 == WALL_NONE && w[3].joined1 == 4 && w[4].joined0 == 3);
    CHECK(w[4].joined1 == 5 && w[5].joined1 == 4);      /* the arc ends where the polyline does */
    CHECK(w[5].body == WALL_NONE && w[6].body == 0 && w[7].body == 1 && w[12].body == 1);
    CHECK_NEAR(w[12].cx, 2, 1e-15);
    scene_free(scene);
}

static void test_mass_inertia_and_units_are_those_of_discs_and_spheres(void **unused)
{
    (void)unused;
    const struct species disc = {.density = 2}, sphere = {.density = 2, .inertia = INERTIA_SPHERE};
    CHECK_NEAR(scene_mass(&disc, 0.5), M_PI / 2, 1e-15);
    CHECK_NEAR(scene_inertia(&disc, 0.5), M_PI / 2 * 0.25 / 2, 1e-15);
    CHECK_NEAR(scene_inertia(&sphere, 0.5), M_PI / 2 * 0.25 * 0.4, 1e-15);
    const struct scene cgs = {.units = UNITS_CGS}, reduced = {.units = UNITS_REDUCED};
    CHECK(strcmp(scene_unit(&cgs, "force"), "dyn") == 0);
    CHECK(strcmp(scene_unit(&reduced, "force"), "") == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_written_scene_loads_as_the_same_scene),
        cmocka_unit_test(test_every_builtin_scene_loads_in_both_forms_and_survives_the_round_trip),
        cmocka_unit_test(test_the_example_of_the_guide_is_a_scene),
        cmocka_unit_test(test_one_override_sets_the_number_of_grains_in_the_hourglass),
        cmocka_unit_test(test_phases_accumulate_and_share_the_grains),
        cmocka_unit_test(test_what_a_model_chose_for_a_phase_is_written_with_it),
        cmocka_unit_test(test_effects_follow_from_keys_and_name_them),
        cmocka_unit_test(test_walls_come_down_to_joined_pieces),
        cmocka_unit_test(test_mass_inertia_and_units_are_those_of_discs_and_spheres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
