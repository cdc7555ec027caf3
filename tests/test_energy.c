/* test_energy.c - anisotropy, the stress of contacts, and the gap before an obstacle, of grains
 * placed by hand.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "check.h"
#include "measure/energy.h"
#include "measure/gap.h"
#include "measure/haff.h"

static struct grains some(uint32_t capacity, uint32_t contacts)
{
    struct grains grains;
    struct error error;
    if (!grains_create(&grains, capacity, contacts, &error)) fail_msg("%s", error.text);
    for (uint32_t i = 0; i < capacity; i++) {
        grains.mass[i] = 2;
        grains.radius[i] = 0.5;
    }
    return grains;
}

static void test_a_gas_in_shearing_mode_has_anisotropy_one(void **unused)
{
    (void)unused;
    struct grains grains = some(4, 0);
    grains.count = 4;
    grains.vx[0] = grains.vx[1] = 3;
    grains.vx[2] = grains.vx[3] = -3;
    CHECK_NEAR(energy_of(&grains).anisotropy, 1, 0);
    CHECK_NEAR(energy_of(&grains).kinetic, 4 * 0.5 * 2 * 9, 1e-12);
    grains.vy[0] = grains.vy[1] = grains.vy[2] = grains.vy[3] = 3;
    CHECK_NEAR(energy_of(&grains).anisotropy, 0, 1e-15);
    memset(grains.vx, 0, 4 * sizeof *grains.vx);
    CHECK_NEAR(energy_of(&grains).anisotropy, -1, 0);
    grains_free(&grains);
}

static void test_two_discs_pressed_together_carry_their_force_as_stress(void **unused)
{
    (void)unused;
    /* Force 6 along the line of centres, a diameter 1: sum of r f = -6 * 1 over both ends; over an
     * area of 12: -0.5 along that line, 0 across it, whatever its direction. */
    for (int degrees = 0; degrees < 180; degrees += 15) {
        const double angle = degrees * M_PI / 180, cx = cos(angle), cy = sin(angle);
        struct grains grains = some(2, 1);
        struct scene scene = {.box = {0, 0, 4, 3}};
        grains.count = 2;
        grains.x[0] = 2 - cx / 2, grains.y[0] = 1.5 - cy / 2;
        grains.x[1] = 2 + cx / 2, grains.y[1] = 1.5 + cy / 2;
        grains.contact_count = 1;
        grains.contacts[0] = (struct contact){.i = 0, .j = 1, .x = 2, .y = 1.5F,
                                              .fx = (float)(-6 * cx), .fy = (float)(-6 * cy)};
        const struct energy_stress s = energy_stress(&grains, &scene, scene.box);
        CHECK_NEAR(s.major, -0.5, 1e-6);        /* contacts are floats */
        CHECK_NEAR(s.minor, 0, 1e-6);
        CHECK_NEAR(fabs(cos(s.angle - angle)), 1, 1e-6);
        grains_free(&grains);
    }
}

static void test_a_contact_across_a_periodic_border_counts_whole(void **unused)
{
    (void)unused;
    struct grains grains = some(2, 1);
    struct scene scene = {.box = {0, 0, 4, 3}};
    scene.left = scene.right = BORDER_PERIODIC;
    grains.count = 2;
    grains.x[0] = 0.3, grains.x[1] = 3.3;       /* a diameter apart, through the border */
    grains.y[0] = grains.y[1] = 1;
    grains.contact_count = 1;
    grains.contacts[0] = (struct contact){.i = 0, .j = 1, .x = 3.8F, .y = 1, .fx = 6};
    CHECK_NEAR(energy_stress(&grains, &scene, scene.box).xx, -0.5, 1e-6);
    grains_free(&grains);
}

static void test_flying_grains_press_by_their_momentum_about_the_mean(void **unused)
{
    (void)unused;
    struct grains grains = some(2, 0);
    struct scene scene = {.box = {0, 0, 4, 3}};
    grains.count = 2;
    grains.x[0] = 1, grains.x[1] = 3;
    grains.y[0] = grains.y[1] = 1;
    grains.vx[0] = 11, grains.vx[1] = 9;        /* +-1 about 10 */
    const struct energy_stress s = energy_stress(&grains, &scene, scene.box);
    CHECK_NEAR(s.xx, -2.0 * 2 / 12, 1e-12);
    CHECK_NEAR(s.yy, 0, 1e-15);
    grains_free(&grains);
}

static void test_a_ring_of_grains_leaves_the_gap_it_was_built_with(void **unused)
{
    (void)unused;
    /* Discs of radius 0.05 whose centres lie from 1 + 0.45 on around an obstacle of radius 1: the gap
     * is 0.4; with centres from 1.05 on there is none. */
    static const double from[] = {0.45, 0.05}, wanted[] = {0.4, 0};
    for (int k = 0; k < 2; k++) {
        struct grains grains = some(20000, 0);
        struct gap gap;
        struct error error;
        for (double r = 1 + from[k] + 0.001; r < 2.5; r += 0.02) {
            for (double a = -0.6; a < 0.6; a += 0.02) {
                CHECK(grains.count < grains.capacity);
                grains.x[grains.count] = -r * cos(a);
                grains.y[grains.count] = r * sin(a);
                grains.radius[grains.count++] = 0.05;
            }
        }
        CHECK(gap_create(&gap, (double[2]){0, 0}, 1, 1, 20, &error));
        gap_add(&gap, &grains);
        gap_add(&gap, &grains);
        /* Half a bin either way. */
        CHECK_NEAR(gap_width(&gap), wanted[k], 0.025);
        gap_free(&gap);
        grains_free(&grains);
    }
}

static void test_the_papers_gas_cools_at_its_rate(void **unused)
{
    (void)unused;
    /* cooperative, section 3.1: d = 1 mm, v = 0.2047 m/s, nu = 0.25, r = 0.8 give 23.24/s, where its
     * misprinted 2 (1 - r^2) would give 32.9; the paper's own rounding is worth 0.2 %. */
    CHECK_NEAR(1 / haff_time(0.25, 0.001, 0.2047 * 0.2047 / 2, 0.8), 23.24, 0.05);
    /* And t0 = 4 / (omega (1 - r^2)), since a collision costs (1 - r^2) T on the average. */
    CHECK_NEAR(haff_time(0.3, 1, 2, 0.7) * haff_frequency(0.3, 1, 2) * (1 - 0.49), 4, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_gas_in_shearing_mode_has_anisotropy_one),
        cmocka_unit_test(test_two_discs_pressed_together_carry_their_force_as_stress),
        cmocka_unit_test(test_a_contact_across_a_periodic_border_counts_whole),
        cmocka_unit_test(test_flying_grains_press_by_their_momentum_about_the_mean),
        cmocka_unit_test(test_a_ring_of_grains_leaves_the_gap_it_was_built_with),
        cmocka_unit_test(test_the_papers_gas_cools_at_its_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
