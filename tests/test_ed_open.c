/* test_ed_open.c - hard discs where grains come and go: sources, open borders, sinks, screens.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

#define OPEN "left = \"open\"; right = \"open\"; top = \"open\"; bottom = \"open\";"

static void test_a_stream_reaches_the_screen_as_it_set_out(void **unused)
{
    (void)unused;
    /* Columns in step never touch each other: all of the mass flies straight into the bins around
     * angle 0, with the momentum it came with. */
    struct scenes_run *run = scenes_begin(
        "until = 1.0; box = [-3.0, -3.0, 3.0, 3.0]; seed = 7;" OPEN
        "grains = ({ radius = [0.05, 0.11]; restitution = 0.9; });"
        "sources = ({ kind = \"stream\"; position = (-2.5, 0.0); width = 2.0;"
        "             velocity = (100.0, 0.0); density = 0.5; to = 0.02; });"
        "screens = ({ kind = \"circle\"; radius = 2.7; bins = 8; });", "ed");
    scenes_advance(run, 0.01);
    struct grains g = scenes_look(run);
    CHECK(g.count > 20);
    for (uint32_t k = 0; k < g.count; k++) CHECK(g.vx[k] == 100 && g.vy[k] == 0);
    grains_free(&g);
    scenes_advance(run, 0.09);
    const struct counters counters = simulation_count(&run->sim);
    const struct tally *tally = simulation_tally(&run->sim);
    assert_int_equal(counters.grains, 0);
    assert_int_equal(counters.collisions, 0);
    assert_int_equal(counters.grains_in, counters.grains_out);
    const struct tally_screen *screen = &tally->screens[0];
    CHECK_NEAR(tally->mass_in, tally->mass_out, 1e-12);
    CHECK_NEAR(screen->mass[3] + screen->mass[4], tally->mass_in, 1e-12);
    CHECK_NEAR(screen->momentum[3] + screen->momentum[4], 100 * tally->mass_in, 1e-10);
    scenes_end(run);
}

static void test_a_thrown_grain_is_recorded_at_the_angle_where_its_parabola_ends(void **unused)
{
    (void)unused;
    /* From (0, 0) with (3, 4) under g = 2 the screen x = 6 is reached at t = 2, at y = 4 with
     * v = (3, 0).  Seen from (0, 4 - 6 tan 50.5 degrees) that is the middle of the bin from 50 to
     * 51 degrees, the 230th from -180 on. */
    char text[600];
    const double center = 4 - 6 * tan(50.5 * M_PI / 180);
    snprintf(text, sizeof text, "until = 9.0; box = [-1.0, -40.0, 9.0, 40.0];"
        "gravity = (0.0, -2.0);" OPEN "grains = ({ radius = 0.1; restitution = 1.0; });"
        "placements = ({ region = [-0.1, -0.1, 0.1, 0.1]; kind = \"square\"; count = 1;"
        "                velocity = (3.0, 4.0); });"
        "screens = ({ kind = \"line\"; x = 6.0; center = (0.0, %.17g); bins = 360; });", center);
    struct scenes_run *run = scenes_begin(text, "ed");
    const double mass = 0.01 * M_PI;
    scenes_advance(run, 2 - 1e-9);
    assert_int_equal(simulation_count(&run->sim).grains, 1);
    scenes_advance(run, 2 + 1e-9);
    assert_int_equal(simulation_count(&run->sim).grains, 0);
    const struct tally_screen *screen = &simulation_tally(&run->sim)->screens[0];
    CHECK(screen->count[230] == 1);
    CHECK_NEAR(screen->momentum[230], 3 * mass, 1e-12);
    CHECK_NEAR(screen->energy[230], 4.5 * mass, 1e-12);
    scenes_end(run);
}

static void test_a_sink_takes_a_grain_when_its_centre_comes(void **unused)
{
    (void)unused;
    /* Thrown up at 2 under g = 1 into a sink from y = 1.5 on: 2 t - t^2 / 2 = 1.5 at t = 1; its
     * neighbour, slower, turns back below it and leaves through the open border at y = -4. */
    struct scenes_run *run = scenes_begin(
        "until = 20.0; box = [-4.0, -4.0, 8.0, 8.0]; gravity = (0.0, -1.0); bottom = \"open\";"
        "grains = ({ radius = 0.25; restitution = 1.0; });"
        "placements = ({ region = [-0.25, -0.25, 0.25, 0.25]; kind = \"square\"; count = 1;"
        "                velocity = (0.0, 2.0); },"
        "              { region = [3.75, -0.25, 4.25, 0.25]; kind = \"square\"; count = 1;"
        "                velocity = (0.0, 1.0); });"
        "sinks = ({ region = [-4.0, 1.5, 8.0, 3.0]; });", "ed");
    scenes_advance(run, 1 - 1e-9);
    assert_int_equal(simulation_count(&run->sim).grains, 2);
    scenes_advance(run, 1 + 1e-9);
    struct grains g = scenes_look(run);
    CHECK(g.count == 1 && g.id[0] == 1);
    grains_free(&g);
    /* t - t^2 / 2 = -4: t = 1 + 3; an open border may let it go up to a diameter later. */
    scenes_advance(run, 4 - 1e-9);
    assert_int_equal(simulation_count(&run->sim).grains, 1);
    scenes_advance(run, 1 + sqrt(11));
    assert_int_equal(simulation_count(&run->sim).grains, 0);
    scenes_end(run);
}

static void test_a_grain_without_room_waits(void **unused)
{
    (void)unused;
    /* Discs of diameter 1 at rest are born into the same place of a closed tube, much faster
     * than they fall out of the way. */
    struct scenes_run *run = scenes_begin(
        "until = 10.0; box = [0.0, 0.0, 1.2, 12.0]; gravity = (0.0, -1.0); count_max = 40;"
        "grains = ({ radius = 0.5; restitution = 0.5; });"
        "sources = ({ position = (0.6, 10.0); rate = 100.0; });"
        "ed = { t_c = 1e-2; };", "ed");
    scenes_advance(run, sqrt(2) - 0.01);
    /* A disc falls its diameter in sqrt(2): so far there is only one. */
    assert_int_equal(simulation_count(&run->sim).grains, 1);
    scenes_advance(run, 40);
    /* 0.5 .. 9.5, then full; discs in a tube that is wider than they are stand in zigzag, and ten
     * of them are 9 sqrt(1 - 0.2^2) + 0.5 = 9.3 high at least: no eleventh fits below 10.5. */
    assert_int_equal(simulation_count(&run->sim).grains, 10);
    scenes_end(run);
}

static void test_what_comes_in_and_goes_out_is_what_is_there(void **unused)
{
    (void)unused;
    /* A source at rate 5 above a ledge from which grains roll off: after a while as many leave as
     * come, and the books of grains and of mass agree at every look. */
    struct scenes_run *run = scenes_begin(
        "until = 100.0; box = [-8.0, 0.0, 8.0, 16.0]; gravity = (0.0, -1.0); seed = 3;"
        "bottom = \"open\"; count_max = 400;"
        "grains = ({ radius = [0.3, 0.5]; restitution = 0.5; density = 2.0; });"
        "sources = ({ position = (0.0, 14.0); width = 3.0; rate = 5.0; velocity = (0.0, -6.0); });"
        "walls = ({ shape = \"segment\"; points = ((-3.0, 6.0), (3.0, 5.0)); });"
        "ed = { t_c = 1e-3; };", "ed");
    for (int k = 1; k <= 20; k++) {
        scenes_advance(run, 3.0 * k);
        const struct counters c = simulation_count(&run->sim);
        const struct tally *tally = simulation_tally(&run->sim);
        struct grains g = scenes_look(run);
        double mass = 0;
        for (uint32_t i = 0; i < g.count; i++) {
            mass += g.mass[i];
            CHECK_NEAR(g.mass[i], 2 * M_PI * g.radius[i] * g.radius[i], 1e-12);
        }
        CHECK(c.grains_in - c.grains_out == g.count);
        CHECK_NEAR(tally->mass_in - tally->mass_out, mass, 1e-9);
        grains_free(&g);
    }
    const struct counters c = simulation_count(&run->sim);
    /* 300 births were due; who found no room came a little later. */
    CHECK(c.grains_in >= 290 && c.grains_in <= 301);
    CHECK(c.grains_out > 150 && c.grains < 100);
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_stream_reaches_the_screen_as_it_set_out),
        cmocka_unit_test(test_a_thrown_grain_is_recorded_at_the_angle_where_its_parabola_ends),
        cmocka_unit_test(test_a_sink_takes_a_grain_when_its_centre_comes),
        cmocka_unit_test(test_a_grain_without_room_waits),
        cmocka_unit_test(test_what_comes_in_and_goes_out_is_what_is_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
