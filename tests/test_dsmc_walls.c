/* test_dsmc_walls.c - single grains of dsmc meet walls, and a stream goes through its box.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Single precision: 6e-8 of a value, some tens of steps, so 1e-5 is far more than rounding.
 */
#include "scenes.h"

static const char *const methods[] = {"plain", "dense", "hsmc"};

enum { METHODS = 3 };

/* One disc (radius 1/2, mass 1) at (10, 10), with velocity (vx, vy); its state at t. */
static void fly_one(const char *method, const char *species, const char *velocity,
                    const char *wall, double t, struct grains *seen)
{
    char text[900];
    snprintf(text, sizeof text,
        "until = 1e6; box = [0.0, 0.0, 20.0, 20.0]; left = \"open\"; right = \"open\";"
        "top = \"open\"; bottom = \"open\";"
        "grains = ({ radius = 0.5; density = 1.2732395447351628; %s });"
        "placements = ({ kind = \"square\"; region = [9.5, 9.5, 10.5, 10.5]; count = 1;"
        "                velocity = %s; });"
        "walls = (%s); dsmc = { method = \"%s\"; cell = 2.0; dt = 0.05; };",
        species, velocity, wall, method);
    struct scenes_run *run = scenes_begin(text, "dsmc");
    scenes_advance(run, t);
    *seen = scenes_look(run);
    CHECK(seen->count == 1);
    scenes_end(run);
}

static void test_a_wall_that_comes_nearer_gives_twice_its_speed(void **unused)
{
    (void)unused;
    static const char *const piston =
        "{ shape = \"segment\"; points = ((5.0, 2.0), (5.0, 18.0)); velocity = (0.5, 0.0); }";
    for (int k = 0; k < METHODS; k++) {
        struct grains seen;
        /* Relative to the wall the grain comes with 1.5 and leaves with 1.5 r. */
        fly_one(methods[k], "restitution = 1.0;", "(-1.0, 0.25)",
                piston, 6, &seen);
        CHECK_NEAR(seen.vx[0], 2, 1e-5);
        CHECK_NEAR(seen.vy[0], 0.25, 1e-5);
        grains_free(&seen);
        fly_one(methods[k], "restitution = 0.6;", "(-1.0, 0.25)",
                piston, 6, &seen);
        CHECK_NEAR(seen.vx[0], 0.5 + 0.6 * 1.5, 1e-5);
        grains_free(&seen);
    }
}

static void test_a_disc_rolls_off_a_rough_wall(void **unused)
{
    (void)unused;
    for (int k = 0; k < METHODS; k++) {
        struct grains seen;
        /* It sticks for an instant: the angular momentum about the contact, m v R, is shared by
         * translation and spin, so v' (1 + 1/2) = v for a disc, and v' = spin R. */
        fly_one(methods[k], "restitution = 1.0; friction = 100.0;", "(0.6, -1.0)",
                "{ shape = \"segment\"; points = ((1.0, 7.0), (19.0, 7.0)); }", 6, &seen);
        CHECK_NEAR(seen.vy[0], 1, 1e-5);
        CHECK_NEAR(seen.vx[0], 0.4, 1e-5);
        CHECK_NEAR(seen.spin[0], -0.4 / 0.5, 1e-5);             /* clockwise, to the right */
        grains_free(&seen);
        /* Coulomb: the blow along the wall is mu times that across, 0.1 * 2. */
        fly_one(methods[k], "restitution = 1.0; friction = 0.1;", "(2.0, -1.0)",
                "{ shape = \"segment\"; points = ((1.0, 7.0), (19.0, 7.0)); }", 3.5, &seen);
        CHECK_NEAR(seen.vx[0], 2 - 0.2, 1e-5);
        CHECK_NEAR(seen.spin[0], -0.2 / (0.5 * 0.5), 1e-5);     /* J R / I = J / (m R / 2) */
        grains_free(&seen);
    }
}

static void test_a_stream_comes_in_and_is_recorded_where_it_leaves(void **unused)
{
    (void)unused;
    for (int k = 0; k < METHODS; k++) {
        char text[800];
        snprintf(text, sizeof text,
            "until = 10.0; box = [-30.0, -30.0, 30.0, 30.0]; seed = 7;"
            "left = \"open\"; right = \"open\"; top = \"open\"; bottom = \"open\";"
            "grains = ({ radius = 0.5; restitution = 0.9; });"
            "sources = ({ kind = \"stream\"; position = (-25.0, 0.0); width = 20.0;"
            "             velocity = (10.0, 0.0); density = 0.5; to = 2.0; });"
            "screens = ({ kind = \"circle\"; radius = 28.0; bins = 8; });"
            "dsmc = { method = \"%s\"; };", methods[k]);
        struct scenes_run *run = scenes_begin(text, "dsmc");
        scenes_advance(run, 10);
        const struct counters counters = simulation_count(&run->sim);
        const struct tally *tally = simulation_tally(&run->sim);
        CHECK(counters.grains_in > 200);
        assert_int_equal(counters.grains, 0);
        assert_int_equal(counters.grains_in, counters.grains_out);
        CHECK_NEAR(tally->mass_in, tally->mass_out, 1e-9 * tally->mass_in);
        /* All alike in speed: nothing collides, and it flies straight into the bins about 0. */
        const struct tally_screen *screen = &tally->screens[0];
        CHECK_NEAR(screen->mass[3] + screen->mass[4], tally->mass_in, 1e-9 * tally->mass_in);
        CHECK_NEAR(screen->momentum[3] + screen->momentum[4], 10 * tally->mass_in,
                   1e-5 * tally->mass_in);
        scenes_end(run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_wall_that_comes_nearer_gives_twice_its_speed),
        cmocka_unit_test(test_a_disc_rolls_off_a_rough_wall),
        cmocka_unit_test(test_a_stream_comes_in_and_is_recorded_where_it_leaves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
