/* test_scene_runs.c - what a scene file can call for, run to its end: bowls, drums, shakers, rough
 * plates, pouring, phases, streams.  No grain is lost and the physics is what it should be.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes.h"

#define OPEN "left = \"open\"; right = \"open\"; top = \"open\"; bottom = \"open\";"
#define HEAVY "gravity = (0.0, -1.0);"

static void test_a_disc_in_a_smooth_bowl_swings_like_a_pendulum(void **unused)
{
    (void)unused;
    /* Its centre moves on a circle of R - r = 10 - 0.5.  Released at rest at theta_0 = 0.1, it is
     * back after T = 2 pi sqrt((R - r)/g) (1 + theta_0^2/16) = 19.377, and passes the middle after
     * a quarter of that.  It begins 0.01 above the wall: 1e-3 of T. */
    struct scenes_run *run = scenes_begin("until = 100.0; box = [-12.0, -12.0, 12.0, 12.0];" HEAVY
        "grains = ({ radius = 0.5; restitution = 0.2; stiffness = 1e4; });"
        "placements = ({ kind = \"square\"; count = 1;"
        "                region = [0.4474, -9.9426, 1.4484, -8.9416]; });"
        "walls = ({ shape = \"arc\"; center = (0.0, 0.0); radius = 10.0; angles = (180, 360); });",
        "md");
    struct grains start = scenes_look(run);
    const double distance = hypot(start.x[0], start.y[0]);
    CHECK_NEAR(distance, 9.49, 1e-3);
    const double angle = atan2(start.x[0], -start.y[0]);
    const double period = 2 * M_PI * sqrt(9.5) * (1 + angle * angle / 16);
    double before = 0, crossing = 0, x = start.x[0];
    for (double t = 0.01; t < period && crossing == 0; t += 0.01) {
        scenes_advance(run, t);
        struct grains g = scenes_look(run);
        if (g.x[0] < 0) crossing = before + 0.01 * x / (x - g.x[0]);
        x = g.x[0];
        before = t;
        grains_free(&g);
    }
    CHECK_NEAR(crossing, period / 4, 1e-3 * period);
    scenes_advance(run, period);
    struct grains end = scenes_look(run);
    CHECK_NEAR(atan2(end.x[0], -end.y[0]), angle, 0.01 * angle);
    grains_free(&start);
    grains_free(&end);
    scenes_end(run);
}

/* Where the centre of all grains is seen from the axis of a drum, in degrees from straight down. */
static double lean_in_drum(const char *surface)
{
    char text[2000];
    snprintf(text, sizeof text, "until = 100.0; box = [-11.0, -11.0, 11.0, 11.0];" HEAVY
        "grains = ({ radius = [0.4, 0.5]; restitution = 0.5; friction = 0.5; stiffness = 3e4; });"
        "placements = ({ kind = \"triangular\"; region = [-7.0, -7.0, 7.0, -0.5];"
        "                spacing = 1.05; });"
        "walls = ({ shape = \"arc\"; center = (0.0, 0.0); radius = 10.0; angles = (0, 360); %s });"
        "md = { tangential = \"spring\"; };", surface);
    struct scenes_run *run = scenes_begin(text, "md");
    const uint64_t grains = simulation_count(&run->sim).grains;
    CHECK(grains > 60);
    double x = 0, y = 0;
    for (int k = 0; k < 40; k++) {
        scenes_advance(run, 30 + k);
        struct grains g = scenes_look(run);
        CHECK(g.count == grains);
        for (uint32_t i = 0; i < g.count; i++) {
            CHECK(hypot(g.x[i], g.y[i]) < 10);
            x += g.x[i];
            y += g.y[i];
        }
        grains_free(&g);
    }
    scenes_end(run);
    return atan2(x, -y) * 180 / M_PI;
}

static void test_the_grains_in_a_turning_drum_lean_to_the_side_that_rises(void **unused)
{
    (void)unused;
    /* The wall carries the bed up until it slips: its centre is then seen under the angle of
     * repose of discs, 10 to 40 degrees.  Turned the other way it leans the other way, and at rest
     * it leans by no more than a heap can that was not stirred. */
    const double one = lean_in_drum("surface_speed = 0.5;");
    const double other = lean_in_drum("surface_speed = -0.5;");
    CHECK(fabs(one) > 10 && fabs(one) < 40);
    CHECK(one * other < 0);
    CHECK_NEAR(fabs(one), fabs(other), 5);
    CHECK_NEAR(lean_in_drum(""), 0, 4);
}

/* The widest gap between a disc and the shaking floor in the last of thirty periods. */
static double gap_above_floor(double acceleration)
{
    const double frequency = 0.5, omega = 2 * M_PI * frequency;
    const double amplitude = acceleration / (omega * omega);
    char text[1000];
    snprintf(text, sizeof text, "until = 100.0; box = [-5.0, -2.0, 5.0, 20.0];" HEAVY
        "grains = ({ radius = 0.5; restitution = 0.3; stiffness = 1e5; });"
        "placements = ({ region = [0.0, 0.0, 1.0, 1.1]; count = 1; });"
        "walls = ({ shape = \"segment\"; points = ((-5.0, 0.0), (5.0, 0.0));"
        "           amplitude = (0.0, %.17g); frequency = %.17g; });", amplitude, frequency);
    struct scenes_run *run = scenes_begin(text, "md");
    double widest = -INFINITY;
    for (int k = 0; k <= 60; k++) {
        const double t = (30 + k / 60.0) / frequency;
        scenes_advance(run, t);
        struct grains g = scenes_look(run);
        widest = fmax(widest, g.y[0] - 0.5 - amplitude * sin(omega * g.time));
        grains_free(&g);
    }
    scenes_end(run);
    return widest;
}

static void test_a_disc_leaves_a_shaking_floor_if_that_falls_faster_than_it(void **unused)
{
    (void)unused;
    /* Below A omega^2 = g it stays: at most as deep in the floor as its weight asks, m g / k =
     * 1e-5, so the gap is below that.  At 2 g it takes off at the latest where A omega^2 sin = g
     * with A omega cos(30 degrees) = 0.55, and rises by a tenth above the floor. */
    CHECK(gap_above_floor(0.6) < 1e-5);
    CHECK(gap_above_floor(0.9) < 1e-5);
    CHECK(gap_above_floor(2) > 0.05);
}

/* How high the heap on a plate is that is a row of discs. */
static double heap_height(double friction, struct counters *counters)
{
    char text[1500];
    snprintf(text, sizeof text, "until = 100.0; box = [-20.0, -4.0, 20.0, 20.0];" OPEN HEAVY
        "grains = ({ radius = [0.4, 0.5]; restitution = 0.4; friction = %g; stiffness = 3e4; });"
        "sources = ({ position = (0.0, 9.0); width = 2.0; velocity = (0.0, -3.0);"
        "            rate = 2.0; count = 150; });"
        "walls = ({ shape = \"row\"; from = (-8.0, 0.0); to = (8.0, 0.0); radius = 0.5; });%s",
        friction, friction > 0 ? "md = { tangential = \"spring\"; };" : "");
    struct scenes_run *run = scenes_begin(text, "md");
    scenes_advance(run, 100);
    *counters = simulation_count(&run->sim);
    struct grains g = scenes_look(run);
    double height = 0;
    for (uint32_t i = 0; i < g.count; i++) height = fmax(height, g.y[i]);
    grains_free(&g);
    scenes_end(run);
    return height;
}

static void test_what_is_poured_on_a_rough_plate_makes_a_heap_by_friction_only(void **unused)
{
    (void)unused;
    struct counters rough, smooth;
    /* Without friction nothing holds more than the grains that lie in the gaps of the row, one
     * layer or two; with it a triangle on 16 diameters stands at 15 degrees or more. */
    const double heap = heap_height(0.8, &rough), none = heap_height(0, &smooth);
    CHECK(rough.grains_in == 150);
    CHECK(smooth.grains_in == 150);
    CHECK(rough.grains + rough.grains_out == 150);
    CHECK(smooth.grains + smooth.grains_out == 150);
    CHECK(heap > 8 * tan(15 * M_PI / 180));
    CHECK(none < heap - 1);
    CHECK(smooth.grains < rough.grains);
}

static void test_energy_is_constant_once_gravity_is_off(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 40.0; box = [0.0, 0.0, 20.0, 20.0];" HEAVY
        "grains = ({ radius = 0.5; restitution = 1.0; stiffness = 1e5; });"
        "placements = ({ kind = \"square\"; region = [2.0, 8.0, 18.0, 18.0]; spacing = 1.5;"
        "                temperature = 0.5; });"
        "phases = ({ time = 10.0; set = [\"gravity=(0, 0)\"]; });", "md");
    const struct counters start = simulation_count(&run->sim);
    scenes_advance(run, 9.99);
    const struct counters fallen = simulation_count(&run->sim);
    scenes_advance(run, 10.01);
    const struct counters light = simulation_count(&run->sim);
    scenes_advance(run, 40);
    const struct counters end = simulation_count(&run->sim);
    CHECK(end.grains == start.grains);
    CHECK(end.collisions > light.collisions + 100);
    /* At twenty steps a contact each loses or gains 1e-3 of the energy that it holds. */
    const double before = start.kinetic_energy + start.potential_energy;
    CHECK_NEAR(fallen.kinetic_energy + fallen.potential_energy, before, 0.01 * before);
    /* What is left is kinetic energy and that of the few contacts: no weight any more. */
    CHECK_NEAR(light.kinetic_energy, fallen.kinetic_energy, 0.02 * fallen.kinetic_energy);
    const double left = light.kinetic_energy + light.potential_energy;
    CHECK(left < 0.9 * before);
    CHECK_NEAR(end.kinetic_energy + end.potential_energy, left, 0.01 * left);
    scenes_end(run);
}

static void test_a_stream_goes_on_where_grains_come_back_to_its_source(void **unused)
{
    (void)unused;
    /* The source stands 1 cm before the disc: what is thrown back fills the place where the next
     * column should start.  Such grains are left out, none is put into another. */
    struct scenes_run *run = scenes_begin("units = \"cgs\"; until = 0.03;"
        "box = [-5.0, -5.0, 5.0, 5.0];" OPEN
        "grains = ({ radius = [0.05, 0.11]; stiffness = 1e10; damping = 1000.0; friction = 0.5; });"
        "sources = ({ kind = \"stream\"; position = (-2.0, 0.0); width = 4.0;"
        "             velocity = (500.0, 0.0); density = 1.0; });"
        "obstacles = ({ shape = \"disc\"; center = (0.0, 0.0); radius = 1.0; });"
        "md = { force = \"hertz\"; tangential = \"haff-werner\"; tangential_damping = 1000.0; };",
        "md");
    double overlap = 0;
    for (int k = 1; k <= 60; k++) {
        scenes_advance(run, 0.0005 * k);
        overlap = fmax(overlap, simulation_count(&run->sim).overlap_max);
    }
    const struct counters end = simulation_count(&run->sim);
    CHECK(end.rejected > 0);
    CHECK(end.grains_in > end.rejected);
    CHECK(end.grains_in == end.grains + end.grains_out);
    /* The smallest grain against the largest (reduced mass 0.0065 g, radius 0.034 cm) at 2 v gives
     * xi = (15/8 m v^2 / (alpha sqrt(R)))^0.4 = 0.0085 cm, a sixth of the small radius. */
    CHECK(overlap < 0.18);
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_disc_in_a_smooth_bowl_swings_like_a_pendulum),
        cmocka_unit_test(test_the_grains_in_a_turning_drum_lean_to_the_side_that_rises),
        cmocka_unit_test(test_a_disc_leaves_a_shaking_floor_if_that_falls_faster_than_it),
        cmocka_unit_test(test_what_is_poured_on_a_rough_plate_makes_a_heap_by_friction_only),
        cmocka_unit_test(test_energy_is_constant_once_gravity_is_off),
        cmocka_unit_test(test_a_stream_goes_on_where_grains_come_back_to_its_source),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
