/* test_md_obstacle.c - the stream and the obstacle of paper 004 (Table I, discs): force at two
 * radii and on a flat obstacle, its linearity in density and radius, the angle of scattering.
 * References: MODELS section 5, found with independent programs.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/scatter.h"
#include "scenes.h"

/* R_ob = radius, rho = density; the flat obstacle is a row of touching discs as large as the mean
 * grain, of half length `radius` or up to half a disc more.  The mean is taken over `rows` columns
 * after the corona is there. */
struct outcome { double force, angle; };

/* Where the mass, of both sides together, is largest: a parabola over 6 degrees to both sides, as
 * the maximum is skew. */
static double brightest(const struct tally *tally)
{
    struct scatter all, folded;
    struct error error;
    CHECK(scatter_create(&tally->screens[0], tally->mass_in, &all, &error));
    CHECK(scatter_fold(&all, &folded, &error));
    const double angle = scatter_peak(&folded, 6).angle;
    scatter_free(&all);
    scatter_free(&folded);
    return angle;
}

static struct outcome measure(double radius, double density, bool flat, double rows)
{
    char text[3000], obstacle[400];
    const double reach = 0.08 * (ceil(radius / 0.08) - 1);      /* centres of the last discs */
    if (flat) {
        snprintf(obstacle, sizeof obstacle, "{ shape = \"row\"; radius = 0.08; center = (0.0, 0.0);"
                 " from = (0.0, %g); to = (0.0, %g); }", -reach, reach);
    } else {
        snprintf(obstacle, sizeof obstacle, "{ shape = \"disc\"; center = (0.0, 0.0); "
                                            "radius = %g; }",
                 radius);
    }
    const double column = 0.22 / sqrt(density) / 500, start = 0.1 / sqrt(density);
    const double end = start + rows * column;
    snprintf(text, sizeof text,
        "until = %g; box = [-19.0, -19.0, 19.0, 19.0]; units = \"cgs\"; seed = 3;"
        "left = \"open\"; right = \"open\"; top = \"open\"; bottom = \"open\"; count_max = 20000;"
        "overlap_limit = 0.5;"
        "grains = ({ radius = [0.05, 0.11]; stiffness = 1e10; damping = 1000.0; friction = 0.5; });"
        "sources = ({ kind = \"stream\"; position = (-14.0, 0.0); width = 16.0;"
        "             velocity = (500.0, 0.0); density = %g; });"
        "obstacles = (%s);"
        "screens = ({ kind = \"circle\"; radius = 18.0; bins = 180; from = %g; });"
        "md = { force = \"hertz\"; tangential = \"haff-werner\"; tangential_damping = 1000.0;"
        "       dt = 2.5e-6; skin = 0.5; };", end, density, obstacle, start);
    struct scenes_run *run = scenes_begin(text, "md");
    scenes_advance(run, start);
    const double before = simulation_tally(&run->sim)->bodies[0].impulse_x;
    scenes_advance(run, end);
    const struct tally *tally = simulation_tally(&run->sim);
    struct outcome outcome = {.force = (tally->bodies[0].impulse_x - before) / (end - start)};
    outcome.angle = brightest(tally);
    printf("R_ob = %g, rho = %g%s: F = %.4g dyn, maximum at %.1f degrees, %u grains\n", radius,
           density, flat ? ", flat" : "", outcome.force, outcome.angle,
           (unsigned)simulation_count(&run->sim).grains);
    fflush(stdout);
    scenes_end(run);
    return outcome;
}

static double rows_wanted = 500;

static void test_the_force_on_the_obstacle_is_that_of_the_reference(void **unused)
{
    (void)unused;
    /* The reference and one run of 500 rows are known to 1 % each: three times both together. */
    const struct outcome one = measure(1, 1, false, rows_wanted);
    CHECK_NEAR(one.force, 130.9e3, 5e3);
    const struct outcome wide = measure(1.5, 1, false, rows_wanted);
    CHECK_NEAR(wide.force, 182.9e3, 6e3);
    /* The reference is known to 1.5 degrees, the top of a broad maximum here to about 1. */
    CHECK_NEAR(wide.angle, 28.5, 2.5);
    /* F = a + b R_ob through these two gives the paper's slope of 111e3 within a tenth. */
    CHECK_NEAR((wide.force - one.force) / 0.5, 111e3, 15e3);
    const struct outcome thin = measure(1, 0.5, false, rows_wanted);
    /* Linear in rho: the paper's fit (15), F = 125000 rho + 1400, gives 0.5055.  Two forces known
     * to 1 % each: three times the error of their ratio. */
    CHECK_NEAR(thin.force / one.force, 0.5055, 0.022);
}

static void test_the_force_on_a_flat_obstacle_is_that_of_the_reference(void **unused)
{
    (void)unused;
    /* 2 R_ob holds 12.5 discs; here 13, and a half more or less counts 4 %.  Tolerance: twice
     * 2e3 of the reference and twice as much of one run. */
    CHECK_NEAR(measure(1, 1, true, rows_wanted).force, 179e3, 6e3);
}

int main(int argc, char **argv)
{
    if (argc > 1) rows_wanted = atof(argv[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_force_on_the_obstacle_is_that_of_the_reference),
        cmocka_unit_test(test_the_force_on_a_flat_obstacle_is_that_of_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
