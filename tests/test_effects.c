/* test_effects.c - an effect that a scene does not call for costs nothing, one that is neutral
 * changes nothing, and one that a model lacks is refused.
 *
 * Each test goes through the list of models.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

#include <malloc.h>

/* A gas; what calls for an effect is put in by %s: keys, then members of the species. */
#define GAS "until = 100.0; box = [0.0, 0.0, 24.0, 24.0]; count_max = 200; %s "                 \
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"     \
    "grains = ({ name = \"a\"; radius = 0.5; restitution = %s; stiffness = 1e4; %s });"         \
    "placements = ({ kind = \"square\"; spacing = 1.5; temperature = 1.0; %s });"

static const struct asks { effects_t effect; const char *keys, *restitution, *species; } asks[] = {
    {EFFECT_GRAVITY, "gravity = (0.0, -1.0);", "1.0", ""},
    {EFFECT_DISSIPATION, "", "0.9", ""},
    {EFFECT_FRICTION, "", "1.0", "friction = 0.5;"},
    {EFFECT_MOVING_WALLS, "walls = ({ shape = \"segment\"; points = ((1.0, 23.0), (2.0, 23.0));"
                          " velocity = (0.1, 0.0); });", "1.0", ""},
    {EFFECT_GATES, "walls = ({ shape = \"segment\"; points = ((1.0, 23.0), (2.0, 23.0));"
                   " opens = 1.0; });", "1.0", ""},
    {EFFECT_OBSTACLE, "obstacles = ({ shape = \"disc\"; center = (12.0, 12.0); radius = 2.0; });",
     "1.0", ""},
    {EFFECT_INFLOW, "sources = ({ position = (12.0, 12.0); rate = 0.01; });", "1.0", ""},
    {EFFECT_OUTFLOW, "sinks = ({ region = [12.0, 12.0, 12.1, 12.1]; });", "1.0", ""},
    {EFFECT_SCREEN, "screens = ({ center = (12.0, 12.0); radius = 90.0; });", "1.0", ""},
    {EFFECT_COLLISION_RATE, "measure = { collisions = true; };", "1.0", ""},
    {EFFECT_COLLISION_COUNT, "measure = { collision_counts = true; };", "1.0", ""},
    {EFFECT_IMPACT, "measure = { impact_parameters = true; };", "1.0", ""},
    {EFFECT_STRESS, "measure = { stress = true; };", "1.0", ""},
};

enum { ASKS = sizeof asks / sizeof *asks };

static char text[2000];

static const char *gas(const char *keys, const char *restitution, const char *species)
{
    snprintf(text, sizeof text, GAS, keys, restitution, species, "");
    return text;
}

static double heap(void)
{
    const struct mallinfo2 now = mallinfo2();
    return (double)now.uordblks + (double)now.hblkhd;
}

/* Bytes of the state of one gas. */
static double state_bytes(const struct model *model, const char *scene_text)
{
    struct findings *findings = calloc(1, sizeof *findings);
    struct scene *scene = scenes_load(scene_text, model->name, findings);
    CHECK(scene && findings->errors == 0);
    struct simulation sim;
    struct error error = {0};
    const double before = heap();
    if (!simulation_create(&sim, model, scene, &error)) fail_msg("%s", error.text);
    const double bytes = heap() - before;
    simulation_destroy(&sim);
    scene_free(scene);
    free(findings);
    return bytes;
}

static void test_what_a_model_lacks_is_refused_and_the_models_that_have_it_are_named(void **unused)
{
    (void)unused;
    uint32_t refused = 0;
    for (const struct model *const *m = model_list; *m; m++) {
        for (int k = 0; k < ASKS; k++) {
            if (asks[k].effect & (*m)->effects) continue;
            struct findings *findings = calloc(1, sizeof *findings);
            struct scene *scene = scenes_load(gas(asks[k].keys, asks[k].restitution,
                                                  asks[k].species), (*m)->name, findings);
            CHECK(scene != NULL);
            CHECK(scene->effects & asks[k].effect);
            struct simulation sim;
            struct error error = {0};
            CHECK(!simulation_create(&sim, *m, scene, &error));
            CHECK(error.code == EXIT_SCENE);
            CHECK(strstr(error.text, effect_word(scene->effects & ~(*m)->effects)));
            char able[200];
            model_names(scene->effects, able, sizeof able);
            CHECK(strstr(error.text, able));
            CHECK(!strstr(able, (*m)->name));
            scene_free(scene);
            free(findings);
            refused++;
        }
    }
    CHECK(refused > 5);         /* the lattice alone lacks as many */
}

/* The sanitizers' own allocator does not tell how much it has given. */
static void need_the_usual_allocator(void)
{
#ifdef __SANITIZE_ADDRESS__
    skip();
#endif
}

static void test_an_array_is_there_only_where_a_measurement_is_asked_for(void **unused)
{
    (void)unused;
    need_the_usual_allocator();
    /* 256 grains, and at least two bytes for each; the state without is the same twice. */
    for (const struct model *const *m = model_list; *m; m++) {
        state_bytes(*m, gas("", "1.0", ""));    /* what is allocated once in a process */
        const double none = state_bytes(*m, gas("", "1.0", ""));
        CHECK_NEAR(state_bytes(*m, gas("", "1.0", "")), none, 256);     /* how blocks are aligned */
        const effects_t per_grain = EFFECT_COLLISION_RATE | EFFECT_COLLISION_COUNT;
        for (int k = 0; k < ASKS; k++) {
            if (!(asks[k].effect & per_grain & (*m)->effects)) continue;
            const double with = state_bytes(*m, gas(asks[k].keys, "1.0", ""));
            if (!(with - none >= 2 * 256)) fail_msg("%s, %s: %g bytes with, %g without",
                (*m)->name, effect_word(asks[k].effect), with, none);
        }
    }
}

static void test_spins_and_springs_take_memory_only_with_friction(void **unused)
{
    (void)unused;
    need_the_usual_allocator();
    for (const struct model *const *m = model_list; *m; m++) {
        if (!((*m)->effects & EFFECT_ROTATION)) continue;
        const double without = state_bytes(*m, gas("", "0.9", "")),
                     with = state_bytes(*m, gas("", "0.9", "friction = 0.5;"));
        /* A float for each grain, less what blocks are aligned to. */
        if (!(with - without >= 4 * 256 - 64)) fail_msg("%s: %g bytes with friction, %g without",
                                                   (*m)->name, with, without);
    }
}

static void test_without_friction_no_tangential_force_is_ever_evaluated(void **unused)
{
    (void)unused;
    for (const struct model *const *m = model_list; *m; m++) {
        if (!((*m)->effects & EFFECT_ROTATION)) continue;
        for (int on = 0; on < 2; on++) {
            struct scenes_run *run = scenes_begin(gas("", "0.9", on ? "friction = 0.5;" : ""),
                                                  (*m)->name);
            scenes_advance(run, 3);
            const struct counters c = simulation_count(&run->sim);
            CHECK(c.collisions > 50);
            if ((c.tangential > 0) != (on == 1)) {
                fail_msg("%s: %llu tangential forces with friction %s", (*m)->name,
                         (unsigned long long)c.tangential, on ? "on" : "off");
            }
            if (!on) CHECK(c.rotational_energy == 0);
            scenes_end(run);
        }
    }
}

/* DSMC draws its collisions by lot, and with walls or sheared borders it draws others: the two runs
 * are two samples of one gas, whose collisions may differ by four times the scatter. */
static bool takes_other_lots(const struct model *model, effects_t effect)
{
    return strcmp(model->name, "dsmc") == 0 && effect & (EFFECT_WALLS | EFFECT_SHEAR);
}

static void compare_samples(const struct scenes_run *a, const struct scenes_run *b,
                            const char *what)
{
    const struct counters x = simulation_count(&a->sim), y = simulation_count(&b->sim);
    const double n = (double)y.collisions, off = fabs((double)x.collisions - n);
    if (!(off <= 4 * sqrt(2 * n))) fail_msg("%s: %g collisions more or fewer of %g", what, off, n);
    /* Elastic; single precision keeps energies to 1e-6. */
    CHECK_NEAR(x.kinetic_energy / y.kinetic_energy, 1, 1e-5);
}

/* Where all grains are after a while, under both texts; they must agree to rounding. */
static void compare_runs(const struct model *model, const char *with, const char *without,
                         effects_t effect, const char *what)
{
    struct scenes_run *a = scenes_begin(with, model->name), *b = scenes_begin(without, model->name);
    CHECK(a->scene->effects & effect);
    CHECK(!(b->scene->effects & effect));
    scenes_advance(a, 2);
    scenes_advance(b, 2);
    CHECK(simulation_count(&a->sim).collisions > 20);
    if (takes_other_lots(model, effect)) {
        compare_samples(a, b, what);
        scenes_end(a);
        scenes_end(b);
        return;
    }
    struct grains x = scenes_look(a), y = scenes_look(b);
    CHECK(x.count == y.count);
    for (uint32_t k = 0; k < x.count; k++) {
        /* Another loop may add in another order, 1e-16; each of the two or three collisions that
         * a grain has makes that some ten times more (the mean way over a radius), so 1e-12, and
         * a thousand times that for the unlucky ones. */
        const double apart = hypot(x.x[k] - y.x[k], x.y[k] - y.y[k]);
        if (!(apart <= 1e-9)) fail_msg("%s: %s moves grain %u by %g", model->name, what, k, apart);
    }
    grains_free(&x);
    grains_free(&y);
    scenes_end(a);
    scenes_end(b);
}

static void test_gravity_of_nothing_changes_nothing(void **unused)
{
    (void)unused;
    char none[2000];
    for (const struct model *const *m = model_list; *m; m++) {
        if (strcmp((*m)->work, "ticks") == 0) continue;         /* knows only that it falls */
        /* The cut-off time would be chosen from gravity. */
        snprintf(none, sizeof none, "%s", gas("ed = { t_c = 0.0; };", "0.9", ""));
        compare_runs(*m, gas("ed = { t_c = 0.0; }; gravity = (0.0, -1e-300);", "0.9", ""), none,
                     EFFECT_GRAVITY, "gravity of 1e-300");
    }
}

static void test_friction_of_nothing_changes_nothing(void **unused)
{
    (void)unused;
    char none[2000];
    for (const struct model *const *m = model_list; *m; m++) {
        if (!((*m)->effects & EFFECT_ROTATION)) continue;
        snprintf(none, sizeof none, "%s", gas("", "0.9", ""));
        compare_runs(*m, gas("", "0.9", "friction = 1e-300;"), none, EFFECT_FRICTION,
                     "friction of 1e-300");
    }
}

/* Each effect called for, but so that it does nothing: keys, restitution, members of the species;
 * and the same without it.  Effects are left out here that have a test of their own. */
static const struct neutral {
    effects_t effect;
    const char *keys, *restitution, *species, *plain_keys, *plain_restitution;
} neutrals[] = {
    {EFFECT_DISSIPATION, "ed = { t_c = 0.0; };", "0.9999999999999999", "",
     "ed = { t_c = 0.0; };", "1.0"},
    /* A wall that is open from the start, and would move. */
    {EFFECT_WALLS | EFFECT_MOVING_WALLS | EFFECT_GATES, "walls = ({ shape = \"segment\"; points = "
     "((1.0, 23.0), (2.0, 23.0)); velocity = (0.1, 0.0); opens = -1.0; });", "1.0", "", "", "1.0"},
    /* The force on a body is summed up, or not; the body is there. */
    {EFFECT_OBSTACLE, "obstacles = ({ shape = \"disc\"; center = (23.2, 23.2); radius = 0.2; });",
     "1.0", "", "walls = ({ shape = \"disc\"; center = (23.2, 23.2); radius = 0.2; });", "1.0"},
    {EFFECT_INFLOW, "sources = ({ position = (12.0, 12.0); rate = 1e-9; });", "1.0", "", "", "1.0"},
    /* A sink that no centre ever meets. */
    {EFFECT_OUTFLOW, "sinks = ({ region = [23.3, 23.3, 23.300000001, 23.300000001]; });", "1.0", "",
     "", "1.0"},
    /* Nobody comes out of a circle that holds all. */
    {EFFECT_SCREEN, "screens = ({ center = (12.0, 12.0); radius = 90.0; });", "1.0", "", "", "1.0"},
    {EFFECT_COLLISION_RATE, "measure = { collisions = true; };", "1.0", "", "", "1.0"},
    {EFFECT_COLLISION_COUNT, "measure = { collision_counts = true; };", "1.0", "", "", "1.0"},
    {EFFECT_IMPACT, "measure = { impact_parameters = true; };", "1.0", "", "", "1.0"},
    {EFFECT_STRESS, "measure = { stress = true; };", "1.0", "", "", "1.0"},
    {EFFECT_SHEAR, "shear_rate = 1e-300;", "1.0", "", "", "1.0"},
};

static void test_an_effect_at_its_neutral_value_changes_nothing(void **unused)
{
    (void)unused;
    char none[2000];
    uint32_t compared = 0;
    for (const struct model *const *m = model_list; *m; m++) {
        for (size_t k = 0; k < sizeof neutrals / sizeof *neutrals; k++) {
            const struct neutral *n = &neutrals[k];
            if (n->effect & ~(*m)->effects) continue;
            snprintf(none, sizeof none, "%s", gas(n->plain_keys, n->plain_restitution, ""));
            compare_runs(*m, gas(n->keys, n->restitution, n->species), none, n->effect,
                         effect_word(n->effect));
            compared++;
        }
    }
    CHECK(compared > 20);
}

/* Sizes that differ by rounding, and two species that are one but for that. */
static void test_a_spread_of_nothing_changes_nothing(void **unused)
{
    (void)unused;
    static const char twins[] =
        "until = 100.0; box = [0.0, 0.0, 24.0, 24.0]; left = \"periodic\"; right = \"periodic\"; "
        "bottom = \"periodic\"; top = \"periodic\"; "
        "grains = ({ name = \"a\"; radius = %s; restitution = 1.0; stiffness = 1e4; }%s); "
        "placements = ({ kind = \"square\"; spacing = 1.5; temperature = 1.0; "
        "region = [0.0, 0.0, 24.0, 12.0]; }, { kind = \"square\"; spacing = 1.5; "
        "temperature = 1.0; region = [0.0, 12.0, 24.0, 24.0]; %s });";
    char plain[2000], other[2000];
    for (const struct model *const *m = model_list; *m; m++) {
        snprintf(plain, sizeof plain, twins, "0.5", "", "");
        if ((*m)->effects & EFFECT_MIXTURE) {
            snprintf(other, sizeof other, twins, "0.5", ", { name = \"b\"; radius = 0.5; "
                     "restitution = 0.9999999999999999; stiffness = 1e4; }", "grains = \"b\"; ");
            compare_runs(*m, other, plain, EFFECT_MIXTURE, "a second species like the first");
        }
        if ((*m)->effects & EFFECT_POLYDISPERSE) {
            snprintf(other, sizeof other, twins, "[0.5, 0.500000000000001]", "", "");
            compare_runs(*m, other, plain, EFFECT_POLYDISPERSE, "a spread of 1e-15");
        }
    }
}

static void test_what_is_off_counts_nothing(void **unused)
{
    (void)unused;
    for (const struct model *const *m = model_list; *m; m++) {
        struct scenes_run *run = scenes_begin(gas("", "1.0", ""), (*m)->name);
        scenes_advance(run, 3);
        const struct counters c = simulation_count(&run->sim);
        const struct tally *tally = simulation_tally(&run->sim);
        CHECK(c.collisions > 20);
        CHECK(c.grains_in == c.grains || c.grains_in == 0);
        CHECK(c.grains_out == 0);
        CHECK(c.collisions_elastic == 0);
        CHECK(c.tangential == 0);
        if (tally) {
            CHECK(tally->body_count == 0 && !tally->bodies);
            CHECK(tally->screen_count == 0 && !tally->screens);
            CHECK(tally->impact.bins == 0 && !tally->impact.count);
            CHECK(tally->stress.nx == 0 && !tally->stress.cells);
            CHECK(tally->mass_in == 0 && tally->mass_out == 0);
        }
        struct grains grains = scenes_look(run);
        for (uint32_t k = 0; k < grains.count; k++) {
            CHECK(grains.collision_rate[k] == 0);
            CHECK(grains.spin[k] == 0);
        }
        grains_free(&grains);
        scenes_end(run);
    }
}

static void test_a_cut_off_time_of_nothing_changes_nothing(void **unused)
{
    (void)unused;
    struct grains ends[2];
    for (int k = 0; k < 2; k++) {
        struct scenes_run *run = scenes_begin(gas(k ? "ed = { t_c = 1e-300; };"
                                                    : "ed = { t_c = 0.0; };", "0.9", ""), "ed");
        scenes_advance(run, 3);
        CHECK(simulation_count(&run->sim).collisions_elastic == 0);
        ends[k] = scenes_look(run);
        scenes_end(run);
    }
    for (uint32_t i = 0; i < ends[0].count; i++) CHECK(ends[0].x[i] == ends[1].x[i]);
    grains_free(&ends[0]);
    grains_free(&ends[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_a_model_lacks_is_refused_and_the_models_that_have_it_are_named),
        cmocka_unit_test(test_an_array_is_there_only_where_a_measurement_is_asked_for),
        cmocka_unit_test(test_spins_and_springs_take_memory_only_with_friction),
        cmocka_unit_test(test_without_friction_no_tangential_force_is_ever_evaluated),
        cmocka_unit_test(test_gravity_of_nothing_changes_nothing),
        cmocka_unit_test(test_friction_of_nothing_changes_nothing),
        cmocka_unit_test(test_an_effect_at_its_neutral_value_changes_nothing),
        cmocka_unit_test(test_a_spread_of_nothing_changes_nothing),
        cmocka_unit_test(test_what_is_off_counts_nothing),
        cmocka_unit_test(test_a_cut_off_time_of_nothing_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
