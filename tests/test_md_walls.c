/* test_md_walls.c - soft discs at walls: rest, rolling, joints, gates, moving and turning walls.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes.h"

#define DISC "grains = ({ name = \"disc\"; radius = 0.5; density = 1.2732395447351628; %s });"
#define OPEN "left = \"open\"; right = \"open\"; top = \"open\"; bottom = \"open\"; " \
    "overlap_limit = 1.0;"
#define FLOOR "walls = ({ shape = \"segment\"; points = ((-50.0, 0.0), (50.0, 0.0)); });"

/* One disc at x = 0, its lowest point `height` above y = 0. */
static struct scenes_run *drop(const char *grains, const char *walls, double height,
                               const char *velocity, double spin, const char *rest)
{
    char text[3000], disc[400];
    snprintf(disc, sizeof disc, DISC, grains);
    snprintf(text, sizeof text, "until = 100.0; box = [-50.0, -50.0, 50.0, 50.0]; " OPEN "%s %s"
             "placements = ({ region = [-0.5, %.17g, 0.6, %.17g]; count = 1; velocity = %s;"
             " spin = %g; }); %s", disc, walls, height, height + 1.1, velocity, spin, rest);
    return scenes_begin(text, "md");
}

static void test_a_disc_comes_to_rest_on_a_plane_as_deep_as_its_weight_asks(void **unused)
{
    (void)unused;
    struct scenes_run *run = drop("stiffness = 1e4; restitution = 0.5;", FLOOR, 0.2, "(0.0, 0.0)",
                                  0,
                                  "gravity = (0.0, -1.0); md = { dt = 1e-3; };");
    scenes_advance(run, 20);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.y[0], 0.5 - 1 / 1e4, 1e-9);                    /* xi = m g / k */
    CHECK_NEAR(g.vy[0], 0, 1e-9);
    CHECK_NEAR(g.x[0], 0, 1e-12);
    grains_free(&g);
    scenes_end(run);
}

static void test_sliding_turns_into_rolling_at_two_thirds_of_the_speed(void **unused)
{
    (void)unused;
    const char *laws[] = {"tangential = \"spring\";",
                          "tangential = \"haff-werner\"; tangential_damping = 100.0;",
                          "tangential = \"spring\"; integrator = \"gear\";"};
    for (int k = 0; k < 3; k++) {
        char rest[200];
        snprintf(rest, sizeof rest, "gravity = (0.0, -1.0); md = { dt = 1e-3; %s };", laws[k]);
        struct scenes_run *run = drop("stiffness = 1e4; restitution = 0.3; friction = 0.3;", FLOOR,
                                      0, "(2.0, 0.0)", 0, rest);
        /* Sliding ends at t = v0 / (3 mu g) = 2.2 after mu g t = v0/3 (discs, q = 1/2). */
        scenes_advance(run, 10);
        struct grains g = scenes_look(run);
        /* The disc sinks in by 1e-4 of its radius and hops a little at first: 1e-3. */
        CHECK_NEAR(g.vx[0], 2 * 2.0 / 3, 2e-3);
        CHECK_NEAR(g.spin[0], -g.vx[0] / 0.5, 3e-3);            /* clockwise when rolling to +x */
        grains_free(&g);
        scenes_end(run);
    }
}

static void test_a_disc_stays_on_a_slope_below_the_angle_of_friction(void **unused)
{
    (void)unused;
    /* Gravity is turned instead of the floor; a disc would roll, so a wall keeps it: static
     * friction at two walls.  Here: tilt 0.2 < mu = 0.5 and two discs would be needed; a block is
     * made of a disc that cannot roll between floor and a back wall. */
    struct scenes_run *run = drop("stiffness = 1e4; restitution = 0.3; friction = 0.5;",
        "walls = ({ shape = \"polyline\"; points = ((-50.0, 0.0), (0.5, 0.0), (0.5, 5.0)); });", 0,
        "(0.0, 0.0)", 0, "gravity = (0.2, -1.0); md = { dt = 1e-3; };");
    scenes_advance(run, 20);
    struct grains g = scenes_look(run);
    CHECK_NEAR(hypot(g.vx[0], g.vy[0]), 0, 1e-8);
    CHECK_NEAR(g.spin[0], 0, 1e-8);
    CHECK_NEAR(g.x[0], 0, 1e-3);
    grains_free(&g);
    scenes_end(run);
}

static void test_joints_of_a_polyline_are_not_felt(void **unused)
{
    (void)unused;
    /* A floor of 40 pieces: a disc that rests on it and slides keeps its energy exactly, as it
     * would on one piece; each joint felt twice would kick it up. */
    char walls[2000] = "walls = ({ shape = \"polyline\"; points = (";
    for (int k = 0; k <= 40; k++) {
        char point[40];
        snprintf(point, sizeof point, "%s(%.3f, 0.0)", k ? ", " : "", -3.0 + 0.37 * k);
        strcat(walls, point);
    }
    strcat(walls, "); });");
    struct scenes_run *run = drop("stiffness = 1e3; restitution = 1.0;", walls, 0, "(1.0, 0.0)", 0,
                                  "gravity = (0.0, -1.0); md = { dt = 1e-3; };");
    run->scene->placed.y[0] -= 1e-3;                            /* m g / k: at rest */
    simulation_destroy(&run->sim);
    CHECK(simulation_create(&run->sim, model_find("md"), run->scene, NULL));
    for (int k = 1; k < 90; k++) {
        scenes_advance(run, 0.1 * k);
        struct grains g = scenes_look(run);
        CHECK_NEAR(g.y[0], 0.5 - 1e-3, 1e-12);
        CHECK_NEAR(g.vx[0], 1, 1e-12);
        grains_free(&g);
    }
    scenes_end(run);
}

static void test_a_bounce_off_a_joint_is_a_bounce_off_a_plane(void **unused)
{
    (void)unused;
    /* Straight down onto the joint of two collinear pieces. */
    struct scenes_run *run = drop("stiffness = 1e4; restitution = 1.0;",
        "walls = ({ shape = \"polyline\"; points = ((-5.0, 0.0), (0.0, 0.0), (5.0, 0.0)); });",
        1, "(0.0, -1.0)", 0, "md = { dt = 1e-4; };");
    scenes_advance(run, 2);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.vy[0], 1, 1e-5);
    CHECK_NEAR(g.vx[0], 0, 1e-12);
    CHECK(simulation_count(&run->sim).kinetic_energy < 0.5 + 1e-5);
    grains_free(&g);
    scenes_end(run);
}

static void test_a_moving_wall_gives_twice_its_speed(void **unused)
{
    (void)unused;
    struct scenes_run *run = drop("stiffness = 1e4; restitution = 1.0;",
        "walls = ({ shape = \"segment\"; points = ((-5.0, -1.0), (5.0, -1.0)); velocity = (0.0, "
        "1.0); });",
        0, "(0.0, 0.0)", 0, "md = { dt = 1e-4; };");
    scenes_advance(run, 2);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.vy[0], 2, 1e-4);
    grains_free(&g);
    scenes_end(run);
}

static void test_a_gate_holds_until_it_opens(void **unused)
{
    (void)unused;
    struct scenes_run *run = drop("stiffness = 1e4; restitution = 0.5;",
        "walls = ({ shape = \"segment\"; points = ((-5.0, 0.0), (5.0, 0.0)); opens = 10.0; "
        "closes = 20.0; });",
        0, "(0.0, 0.0)", 0, "gravity = (0.0, -1.0); md = { dt = 1e-3; };");
    scenes_advance(run, 10);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.y[0], 0.5, 1e-3);
    grains_free(&g);
    scenes_advance(run, 14);
    g = scenes_look(run);
    CHECK_NEAR(g.y[0], 0.5 - 0.5 * 16, 0.02);                   /* free fall for 4 */
    grains_free(&g);
    scenes_end(run);
}

static void test_a_conveyor_carries_along(void **unused)
{
    (void)unused;
    struct scenes_run *run = drop("stiffness = 1e4; restitution = 0.3; friction = 0.3;",
        "walls = ({ shape = \"segment\"; points = ((-50.0, 0.0), (50.0, 0.0)); "
        "surface_speed = 1.5; });",
        0, "(0.0, 0.0)", 0, "gravity = (0.0, -1.0); md = { dt = 1e-3; };");
    scenes_advance(run, 10);
    struct grains g = scenes_look(run);
    /* Rolls without slip on a floor that moves: v + R omega = u; from rest v = u/3 (q = 1/2). */
    CHECK_NEAR(g.vx[0], 1.5 / 3, 2e-3);
    CHECK_NEAR(g.vx[0] + 0.5 * g.spin[0], 1.5, 2e-3);
    grains_free(&g);
    scenes_end(run);
}

static void test_the_impulse_on_an_obstacle_is_that_lost_by_the_grain(void **unused)
{
    (void)unused;
    struct scenes_run *run = drop("stiffness = 1e4; restitution = 0.8; friction = 0.4;",
        "obstacles = ({ shape = \"disc\"; center = (3.0, 0.3); radius = 1.0; });", -0.2,
        "(1.0, 0.0)", 2, "md = { dt = 1e-4; };");
    struct grains before = scenes_look(run);
    scenes_advance(run, 4);
    struct grains after = scenes_look(run);
    const struct tally_body *body = &simulation_tally(&run->sim)->bodies[0];
    CHECK_NEAR(body->impulse_x, before.vx[0] - after.vx[0], 1e-10);
    CHECK_NEAR(body->impulse_y, before.vy[0] - after.vy[0], 1e-10);
    assert_int_equal(body->contacts, 1);
    CHECK(body->impulse_x > 1);
    /* Angular momentum about the obstacle's centre: what the disc lost it gained. */
    double l[2];
    const struct grains *look[2] = {&before, &after};
    for (int k = 0; k < 2; k++) {
        l[k] = (look[k]->x[0] - 3) * look[k]->vy[0] - (look[k]->y[0] - 0.3) * look[k]->vx[0]
             + 0.5 * 0.25 * look[k]->spin[0];
    }
    CHECK_NEAR(body->angular_impulse, l[0] - l[1], 1e-10);
    grains_free(&before);
    grains_free(&after);
    scenes_end(run);
}

static void test_overlap_beyond_the_limit_ends_the_run_with_the_grain_and_the_cure(void **unused)
{
    (void)unused;
    struct scenes_run *run = drop("stiffness = 1.0; restitution = 1.0;", FLOOR, 1, "(0.0, -3.0)", 0,
                                  "md = { dt = 1e-3; };");
    run->scene->overlap_limit = 0.3;
    simulation_destroy(&run->sim);
    struct error error = {0};
    CHECK(simulation_create(&run->sim, model_find("md"), run->scene, &error));
    CHECK(simulation_advance(&run->sim, 5, UINT64_MAX, &error) == ADVANCE_BROKEN);
    const struct fault *fault = run->sim.model->fault(run->sim.state);
    /* It touches at t = 1/3 and is 0.15 deep at once: overlap 0.3 R at t = 0.333 + 0.05. */
    CHECK_NEAR(fault->time, 1.0 / 3 + 0.05, 0.003);
    assert_int_equal(fault->grain, 0);
    CHECK(strstr(error.text, "a wall") && strstr(error.text, "stiffer"));
    CHECK(simulation_advance(&run->sim, 6, UINT64_MAX, &error) == ADVANCE_BROKEN);
    scenes_end(run);
}

static void test_what_is_no_number_ends_the_run(void **unused)
{
    (void)unused;
    struct scenes_run *run = drop("stiffness = 1e4; restitution = 1.0;", FLOOR, 1, "(0.0, -3.0)", 0,
                                  "md = { dt = 1e-3; };");
    run->scene->placed.vy[0] = NAN;
    simulation_destroy(&run->sim);
    struct error error = {0};
    CHECK(simulation_create(&run->sim, model_find("md"), run->scene, &error));
    CHECK(simulation_advance(&run->sim, 5, UINT64_MAX, &error) == ADVANCE_BROKEN);
    CHECK(strstr(error.text, "no number") && strstr(error.text, "grain 0"));
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_disc_comes_to_rest_on_a_plane_as_deep_as_its_weight_asks),
        cmocka_unit_test(test_sliding_turns_into_rolling_at_two_thirds_of_the_speed),
        cmocka_unit_test(test_a_disc_stays_on_a_slope_below_the_angle_of_friction),
        cmocka_unit_test(test_joints_of_a_polyline_are_not_felt),
        cmocka_unit_test(test_a_bounce_off_a_joint_is_a_bounce_off_a_plane),
        cmocka_unit_test(test_a_moving_wall_gives_twice_its_speed),
        cmocka_unit_test(test_a_gate_holds_until_it_opens),
        cmocka_unit_test(test_a_conveyor_carries_along),
        cmocka_unit_test(test_the_impulse_on_an_obstacle_is_that_lost_by_the_grain),
        cmocka_unit_test(test_overlap_beyond_the_limit_ends_the_run_with_the_grain_and_the_cure),
        cmocka_unit_test(test_what_is_no_number_ends_the_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
