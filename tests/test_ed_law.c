/* test_ed_law.c - restitution of hard discs: constant, falling with impact speed, or derived from
 * the dashpots of soft ones.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

/* Two discs, d = m = 1, meet head on with velocities +-v; returns the restitution. */
static double restitution(const char *grains, const char *ed, double v)
{
    char text[900];
    snprintf(text, sizeof text, "until = 1000.0; box = [-20.0, -2.0, 20.0, 2.0];"
        "grains = ({ radius = 0.5; density = 1.2732395447351628; %s });"
        "placements = ({ region = [-3.5, -0.5, -2.5, 0.5]; kind = \"square\"; count = 1;"
        "                velocity = (%.15g, 0.0); },"
        "              { region = [2.5, -0.5, 3.5, 0.5]; kind = \"square\"; count = 1;"
        "                velocity = (%.15g, 0.0); });"
        "ed = { t_c = 0.0; %s };", grains, v, -v, ed);
    struct scenes_run *run = scenes_begin(text, "ed");
    scenes_advance(run, 3 / v);
    CHECK(simulation_count(&run->sim).collisions == 1);
    struct grains g = scenes_look(run);
    const double r = (g.vx[1] - g.vx[0]) / (2 * v);
    grains_free(&g);
    scenes_end(run);
    return r;
}

static void test_a_constant_restitution_holds_at_every_speed(void **unused)
{
    (void)unused;
    CHECK_NEAR(restitution("restitution = 0.6;", "", 1e-3), 0.6, 1e-12);
    CHECK_NEAR(restitution("restitution = 0.6;", "", 1e3), 0.6, 1e-12);
}

static void test_a_viscoelastic_restitution_falls_with_impact_speed(void **unused)
{
    (void)unused;
    /* 1 - r = 0.1 (2 v / 4)^0.2: 0.1 at 2 v = 4, 0.2 at 128, 0.05 at 0.125. */
    const char *ed = "exponent = 0.2; reference_speed = 4.0;";
    CHECK_NEAR(restitution("restitution = 0.9;", ed, 2), 0.9, 1e-12);
    CHECK_NEAR(restitution("restitution = 0.9;", ed, 64), 0.8, 1e-12);
    CHECK_NEAR(restitution("restitution = 0.9;", ed, 0.0625), 0.95, 1e-12);
}

static void test_a_linear_dashpot_gives_its_restitution_to_hard_discs(void **unused)
{
    (void)unused;
    /* Reduced mass 1/2, k = 2: omega0 = 2, eta = c / (2 m) = 0.2, eta / omega0 = 0.1.  MODELS
     * section 4: r = 0.74408 (clipped at zero force), at every speed. */
    const char *grains = "stiffness = 2.0; damping = 0.2;";
    CHECK_NEAR(restitution(grains, "", 1), 0.74408, 5e-6);
    CHECK_NEAR(restitution(grains, "", 10), 0.74408, 5e-6);
    /* What ed.restitution says goes before. */
    CHECK_NEAR(restitution(grains, "restitution = 0.5;", 1), 0.5, 1e-12);
}

static void test_a_hertz_dashpot_gives_its_restitution_to_hard_discs(void **unused)
{
    (void)unused;
    /* Reduced mass 1/2 and radius 1/4, alpha = 1, v = 1: length (m v^2 / alpha sqrt R)^0.4 = 1, so
     * beta is the reduced damping.  MODELS section 4: r = 0.70849 at 0.25, to 5e-4. */
    const char *grains = "stiffness = 1.0; damping = 0.25;",
               *ed = "force = \"hertz\"; reference_speed = 1.0;";
    CHECK_NEAR(restitution(grains, ed, 0.5), 0.70849, 5e-4);
    CHECK_NEAR(restitution(grains, ed, 0.5 / 32), 1 - 0.29151 / 2, 5e-4);
}

static void test_what_is_derived_is_told(void **unused)
{
    (void)unused;
    struct findings findings;
    struct scene *scene = scenes_load("until = 1.0; box = [0.0, 0.0, 9.0, 9.0];"
        "grains = ({ radius = 0.5; density = 1.2732395447351628; stiffness = 2.0;"
        "            damping = 0.2; }); placements = ({ count = 4; });", "ed", &findings);
    CHECK(scene && findings.errors == 0 && findings.count == 1);
    CHECK(findings.list[0].kind == FINDING_WARNING);
    CHECK(strstr(findings.list[0].text, "0.7441 between grains"));
    scene_free(scene);
}

static void test_a_cut_off_long_for_falling_grains_is_warned_of(void **unused)
{
    (void)unused;
    /* d = 1 and g = 4: a grain falls through its diameter in about 1/2. */
    static const struct { const char *ed; uint32_t warnings; } trials[] = {
        {"ed = { t_c = 0.014; };", 0}, {"ed = { t_c = 0.016; };", 1}, {"", 0},
    };
    for (size_t k = 0; k < sizeof trials / sizeof *trials; k++) {
        char text[300];
        struct findings findings;
        snprintf(text, sizeof text, "until = 1.0; box = [0.0, 0.0, 9.0, 9.0];"
            "gravity = (0.0, -4.0); grains = ({ radius = 0.5; restitution = 0.9; });"
            "placements = ({ count = 4; }); %s", trials[k].ed);
        struct scene *scene = scenes_load(text, "ed", &findings);
        CHECK(scene && findings.errors == 0 && findings.count == trials[k].warnings);
        if (trials[k].warnings) CHECK(strstr(findings.list[0].text, "at most 0.015"));
        scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_constant_restitution_holds_at_every_speed),
        cmocka_unit_test(test_a_viscoelastic_restitution_falls_with_impact_speed),
        cmocka_unit_test(test_a_linear_dashpot_gives_its_restitution_to_hard_discs),
        cmocka_unit_test(test_a_hertz_dashpot_gives_its_restitution_to_hard_discs),
        cmocka_unit_test(test_what_is_derived_is_told),
        cmocka_unit_test(test_a_cut_off_long_for_falling_grains_is_warned_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
