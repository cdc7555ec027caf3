/* test_ed_rest.c - nothing hangs: stuck clocks, events at one time, books of energy, and beds that
 * rest.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

#include "model/ed/ed.h"

static double energy(const struct scenes_run *run)
{
    const struct counters c = simulation_count(&run->sim);
    return c.kinetic_energy + c.rotational_energy + c.potential_energy;
}

/* A rough bed of some 40 grains that is poured and comes to rest. */
#define BED(elastic)                                                                    \
    "until = 60.0; box = [0.0, 0.0, 8.0, 20.0]; gravity = (0.0, -1.0);"                 \
    "grains = ({ radius = 0.5; restitution = 0.6; friction = 0.5; });"                  \
    "placements = ({ region = [0.5, 1.0, 7.5, 9.0]; spacing = 1.1; temperature = 0.2; });" \
    "ed = { t_c = 1e-2; elastic = \"" elastic "\"; };"

static void test_a_rough_bed_rests_with_fewer_events_if_contacts_keep_their_energy(void **unused)
{
    (void)unused;
    const char *const scenes[2] = {BED("normal"), BED("rest")};
    double events[2], height[2];
    for (int k = 0; k < 2; k++) {
        struct scenes_run *run = scenes_begin(scenes[k], "ed");
        scenes_advance(run, 20);
        const struct counters a = simulation_count(&run->sim);
        scenes_advance(run, 25);
        const struct counters b = simulation_count(&run->sim);
        events[k] = (double)(b.steps - a.steps) / (double)b.grains;
        height[k] = b.potential_energy;
        /* Agitation of a bed ten grains deep: 10 g t_c at most, (0.1)^2 / 2 a grain of mass 0.8. */
        CHECK(b.kinetic_energy / (double)b.grains < 4e-3);
        scenes_end(run);
    }
    print_message("events a grain in 500 t_c: %.0f and %.0f\n", events[0], events[1]);
    CHECK(events[1] < 0.5 * events[0]);
    CHECK_NEAR(height[1] / height[0], 1, 0.05);
}

/* Energy as seen by who falls with the grains. */
static double inner_energy(const struct scenes_run *run)
{
    const struct counters c = simulation_count(&run->sim);
    const double mass = scene_mass(&run->scene->species[0], 0.5) * (double)c.grains;
    return c.kinetic_energy + c.rotational_energy
         - (c.momentum_x * c.momentum_x + c.momentum_y * c.momentum_y) / (2 * mass);
}

/* What share of its energy a rough gas, T = 1, keeps from t = 20 to 100 while it falls under g.
 * The cut-off is longer than the run: every contact but each grain's first is within it. */
static double kept_in_the_cut_off(double g)
{
    char text[600];
    snprintf(text, sizeof text, "until = 1e3; box = [0.0, 0.0, 12.0, 12.0]; gravity = (0.0, %g);"
        "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
        "grains = ({ radius = 0.5; restitution = 0.7; friction = 0.4; });"
        "placements = ({ spacing = 1.3; temperature = 1.0; });"
        "ed = { t_c = 1e6; elastic = \"rest\"; };", -g);
    struct scenes_run *run = scenes_begin(text, "ed");
    scenes_advance(run, 20);
    const double e = inner_energy(run), px = simulation_count(&run->sim).momentum_x;
    scenes_advance(run, 100);
    CHECK(simulation_count(&run->sim).collisions_elastic > 1000);
    /* 1e5 collisions that round by 1e-16 each, at random. */
    CHECK_NEAR(simulation_count(&run->sim).momentum_x, px, 1e-11);
    const double kept = inner_energy(run) / e;
    scenes_end(run);
    return kept;
}

static void test_rough_contacts_keep_the_energy_of_a_bed_but_not_that_of_a_flow(void **unused)
{
    (void)unused;
    /* Speeds are about 1.  Friction gives back up to 10 g t_c: far above them ... */
    CHECK_NEAR(kept_in_the_cut_off(1e-4), 1, 1e-12);
    /* ... and far below. */
    CHECK(kept_in_the_cut_off(1e-9) < 0.7);
}

static void test_energy_lost_is_what_the_collisions_took(void **unused)
{
    (void)unused;
    /* Two discs, one blow: m12 (1 - r^2) v_n^2 / 2 is lost, v_n = v cos(asin b/d). */
    struct scenes_run *run = scenes_begin("until = 20.0; box = [-10.0, -10.0, 10.0, 10.0];"
        "grains = ({ radius = 0.5; restitution = 0.7; });"
        "placements = ({ region = [-5.5, -0.5, -4.5, 0.5]; kind = \"square\"; count = 1;"
        "                velocity = (1.0, 0.0); },"
        "              { region = [-0.5, 0.1, 0.5, 1.1]; kind = \"square\"; count = 1; });", "ed");
    const double before = energy(run), m = 2 * before;
    scenes_advance(run, 6);
    CHECK_NEAR(before - energy(run), 0.25 * m * (1 - 0.49) * 0.64, 1e-13);
    scenes_end(run);
}

static void test_many_events_at_one_time_are_all_carried_out(void **unused)
{
    (void)unused;
    /* Rows of a perfect lattice fly against each other: all blows fall on one instant. */
    struct scenes_run *run = scenes_begin("until = 100.0; box = [0.0, 0.0, 30.0, 8.0];"
        "grains = ({ radius = 0.5; restitution = 1.0; });"
        "placements = ({ region = [0.0, 0.0, 30.0, 1.25]; kind = \"square\"; spacing = 1.25;"
        "                velocity = (0.0, 1.0); },"
        "              { region = [0.0, 6.75, 30.0, 8.0]; kind = \"square\"; spacing = 1.25;"
        "                velocity = (0.0, -1.0); });", "ed");
    const uint32_t n = run->scene->placed.count / 2;
    CHECK(n >= 20);
    /* Rows meet when their centres are 1 apart, come back from the walls, and meet again: 8 - 2
     * diameters of free height, there and back. */
    const struct placed *placed = &run->scene->placed;
    const double meet = 0.5 * (placed->y[n] - placed->y[0] - 1), again = meet + 6;
    scenes_advance(run, meet - 1e-9);
    CHECK(simulation_count(&run->sim).collisions == 0);
    scenes_advance(run, meet + 1e-9);
    CHECK(simulation_count(&run->sim).collisions == n);
    scenes_advance(run, again + 1e-9);
    CHECK(simulation_count(&run->sim).collisions == 2 * n);
    scenes_end(run);
}

static void test_a_clock_that_stands_still_is_noticed_and_named(void **unused)
{
    (void)unused;
    /* Plain ED, a lossy ball on a floor: infinitely many bounces before t = 3 t_fall. */
    struct scenes_run *run = scenes_begin("until = 100.0; box = [0.0, 0.0, 9.0, 20.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.5; });"
        "placements = ({ region = [4.0, 8.0, 5.0, 9.0]; kind = \"square\"; count = 1; });"
        "ed = { t_c = 0.0; };", "ed");
    struct error error = {.text = ""};
    CHECK(simulation_advance(&run->sim, 100, 50000000, &error) == ADVANCE_BROKEN);
    CHECK(strstr(error.text, "time stopped at 12") && strstr(error.text, "ed.t_c"));
    scenes_end(run);
}

static void test_a_late_clock_moves_no_grain_otherwise(void **unused)
{
    (void)unused;
    /* A ball that hits a wall in every 5 units of time has a thousand million events behind it at
     * 5e9.  A box of grains is set to a little before that, where a double has steps of 1e-6;
     * it must go on as it does from zero. */
    const double late = 4294967296;
    struct scenes_run *runs[2];
    for (int k = 0; k < 2; k++) {
        runs[k] = scenes_begin("until = 1e10; box = [0.0, 0.0, 12.0, 12.0]; gravity = (0.0, -0.1);"
            "grains = ({ radius = 0.5; restitution = 1.0; });"
            "placements = ({ spacing = 1.5; temperature = 1.0; }); ed = { t_c = 1e-4; };", "ed");
        struct ed *ed = runs[k]->sim.state;
        ed->clock.epoch += k * late;
        ed->clock.present += k * late;
    }
    for (int turn = 1; turn <= 40; turn++) {
        struct grains g[2];
        for (int k = 0; k < 2; k++) {
            scenes_advance(runs[k], 5 * turn + k * late);
            g[k] = scenes_look(runs[k]);
        }
        CHECK(simulation_count(&runs[0]->sim).steps == simulation_count(&runs[1]->sim).steps);
        /* To the rounding of one flight; a clock with steps of 1e-6 would show in the eighth digit
         * after the first collision, and in the first one after fifteen. */
        for (uint32_t i = 0; i < g[0].count; i++) {
            CHECK_NEAR(g[1].x[i], g[0].x[i], 1e-13);
            CHECK_NEAR(g[1].y[i], g[0].y[i], 1e-13);
            CHECK_NEAR(g[1].vy[i], g[0].vy[i], 1e-14);
        }
        grains_free(&g[0]);
        grains_free(&g[1]);
    }
    const struct counters c = simulation_count(&runs[1]->sim);
    print_message("%llu epochs, %llu collisions\n", (unsigned long long)c.rebuilds,
                  (unsigned long long)c.collisions);
    CHECK(c.rebuilds >= 5 && c.collisions > 30 * c.grains);
    for (int k = 0; k < 2; k++) scenes_end(runs[k]);
}

/* Two grains in a channel that just lets them through, and a wall that comes at speed 1 from
 * x = 9 and stops at `ends`; at x = 2 it leaves no room. */
static struct scenes_run *squeeze(double ends)
{
    char text[800];
    snprintf(text, sizeof text, "until = 100.0; box = [0.0, 0.0, 10.0, 1.001];"
        "grains = ({ radius = 0.5; restitution = 0.9; });"
        "placements = ({ region = [3.0, 0.0, 4.0, 1.0]; kind = \"square\"; count = 1;"
        "                velocity = (1.0, 0.0); },"
        "              { region = [6.0, 0.0, 7.0, 1.0]; kind = \"square\"; count = 1;"
        "                velocity = (-0.5, 0.0); });"
        "walls = ({ shape = \"segment\"; points = ((9.0, 0.0), (9.0, 1.001));"
        "           velocity = (-1.0, 0.0); moves = (0.0, %.17g); });"
        "ed = { t_c = 1e3; };", 9 - ends);
    return scenes_begin(text, "ed");
}

static void test_a_blow_that_runs_through_a_thousand_discs_is_no_end_of_time(void **unused)
{
    (void)unused;
    /* A column that touches is let go: blows run up and down it at one and the same moment, at most
     * N (N - 1) / 2 of them, and then time goes on. */
    struct scenes_run *run = scenes_begin("until = 2.0; box = [0.0, 0.0, 1.0, 1000.0];"
        "top = \"open\"; gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.2; });"
        "placements = ({ kind = \"square\"; region = [0.0, 0.0, 1.0, 1000.0]; count = 1000; });"
        "ed = { t_c = 0.03; };", "ed");
    scenes_advance(run, 1e-3);
    const struct counters c = simulation_count(&run->sim);
    CHECK(c.time >= 1e-3);
    CHECK(c.steps > 120000);            /* or it was no such blow */
    scenes_end(run);
}

static void test_a_wall_that_leaves_no_room_stops_the_clock_and_is_named(void **unused)
{
    (void)unused;
    /* t_c is longer than the run: blows lose nothing, and speeds go as one over the room left. */
    struct scenes_run *run = squeeze(1);
    struct error error = {.text = ""};
    CHECK(simulation_advance(&run->sim, 100, 20000000, &error) == ADVANCE_BROKEN);
    CHECK(strstr(error.text, "time stopped at") && strstr(error.text, "no room left"));
    CHECK(strstr(error.text, "walls.moves"));
    /* 1e5 events that bring time on by next to nothing are due where the room left is some 1e-5. */
    CHECK_NEAR(simulation_count(&run->sim).time, 7, 1e-4);
    scenes_end(run);
}

static void test_a_wall_that_leaves_a_thousandth_of_room_stops_nothing(void **unused)
{
    (void)unused;
    struct scenes_run *run = squeeze(2.001);
    scenes_advance(run, 7);
    const struct counters a = simulation_count(&run->sim);
    scenes_advance(run, 7.2);
    const struct counters b = simulation_count(&run->sim);
    /* Compression heated them by far, and no blow takes that away. */
    CHECK(a.kinetic_energy > 1e4);
    CHECK_NEAR(b.kinetic_energy / a.kinetic_energy, 1, 1e-6);
    CHECK(b.steps - a.steps > 100000);
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_rough_bed_rests_with_fewer_events_if_contacts_keep_their_energy),
        cmocka_unit_test(test_rough_contacts_keep_the_energy_of_a_bed_but_not_that_of_a_flow),
        cmocka_unit_test(test_energy_lost_is_what_the_collisions_took),
        cmocka_unit_test(test_many_events_at_one_time_are_all_carried_out),
        cmocka_unit_test(test_a_late_clock_moves_no_grain_otherwise),
        cmocka_unit_test(test_a_clock_that_stands_still_is_noticed_and_named),
        cmocka_unit_test(test_a_blow_that_runs_through_a_thousand_discs_is_no_end_of_time),
        cmocka_unit_test(test_a_wall_that_leaves_no_room_stops_the_clock_and_is_named),
        cmocka_unit_test(test_a_wall_that_leaves_a_thousandth_of_room_stops_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
