/* test_spectrum.c - gases, lattices and waves have the structure factor of the textbook.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/spectrum.h"

static struct grains some(uint32_t capacity)
{
    struct grains grains;
    struct error error;
    if (!grains_create(&grains, capacity, 0, &error)) fail_msg("%s", error.text);
    return grains;
}

static struct spectrum factor(const struct grains *grains, double lx, double ly, double diameter)
{
    const double region[4] = {0, 0, lx, ly};
    struct spectrum spectrum;
    struct error error;
    if (!spectrum_structure_factor(grains, region, diameter, &spectrum, &error)) {
        fail_msg("%s", error.text);
    }
    return spectrum;
}

static void test_an_ideal_gas_has_none(void **unused)
{
    (void)unused;
    struct grains grains = some(20000);
    struct rng rng = {3};
    for (grains.count = 0; grains.count < 20000; grains.count++) {
        grains.x[grains.count] = 130 * rng_uniform(&rng);
        grains.y[grains.count] = 64 * rng_uniform(&rng);
    }
    struct spectrum s = factor(&grains, 130, 64, 1);
    CHECK(s.mx == 128 && s.my == 64 && s.count == 20000 && s.shells == 65);
    CHECK(s.modes[0] == 0 && isnan(s.shell[0]));
    double mean = 0;
    uint32_t modes = 0;
    for (uint32_t k = 1; k < s.shells; k++) {
        /* S of a mode is exponential with mean 1; modes k and -k are the same number. */
        if (s.modes[k] > 0) CHECK_NEAR(s.shell[k], 1, 5 / sqrt(s.modes[k] / 2.0) + 0.05);
        CHECK_NEAR(s.wave_number[k], k, 0.5);
        mean += s.modes[k] * s.shell[k];
        modes += s.modes[k];
    }
    CHECK_NEAR(mean / modes, 1, 4 / sqrt(modes / 2.0));
    CHECK_NEAR(spectrum_at(&s, 0, 0), 20000, 1e-6);     /* |N|^2 / N */
    CHECK(spectrum_at(&s, 5, -9) == spectrum_at(&s, -5, 9));
    spectrum_free(&s);
    grains_free(&grains);
}

static void test_a_square_lattice_has_bragg_peaks_and_nothing_else(void **unused)
{
    (void)unused;
    /* 16 x 16 grains on a period of 4 boxes: peaks of height N at multiples of 16 along each axis,
     * exactly 0 between them. */
    struct grains grains = some(256);
    for (grains.count = 0; grains.count < 256; grains.count++) {
        grains.x[grains.count] = 4 * (grains.count % 16) + 1.5;
        grains.y[grains.count] = 4 * (grains.count / 16) + 2.5;
    }
    struct spectrum s = factor(&grains, 64, 64, 1);
    for (int qy = -32; qy <= 32; qy++) {
        for (int qx = -32; qx <= 32; qx++) {
            const double peak = qx % 16 == 0 && qy % 16 == 0 ? 256 : 0;
            CHECK_NEAR(spectrum_at(&s, qx, qy), peak, 1e-9);
        }
    }
    CHECK(s.shell[16] > 1 && s.shell[15] < 1e-9 && s.shell[17] < 1e-9);
    spectrum_free(&s);
    grains_free(&grains);
}

static void test_it_agrees_with_the_sum_over_all_grains(void **unused)
{
    (void)unused;
    /* Clustered grains: the definition itself, without a grid, at long waves.  A grain is moved to
     * its box by up to half a box a = 1, which shifts its phase by delta with <delta^2> = k^2 / 12.
     * That takes the share k^2 / 12 of the power, and adds N random arrows of length delta to one
     * of length sqrt(N S): S scatters by sqrt(2 S <delta^2>); four of these are allowed. */
    struct grains grains = some(3000);
    struct rng rng = {8};
    for (grains.count = 0; grains.count < 3000; grains.count++) {
        const uint32_t k = grains.count;
        const double cx = 20 * (k % 5) + 10, cy = 30 * (k % 3) + 30;
        grains.x[k] = fmod(cx + 5 * rng_normal(&rng) + 256, 128);
        grains.y[k] = fmod(cy + 5 * rng_normal(&rng) + 256, 128);
    }
    struct spectrum s = factor(&grains, 128, 128, 1);
    for (int qy = -6; qy <= 6; qy++) {
        for (int qx = -6; qx <= 6; qx++) {
            double re = 0, im = 0;
            for (uint32_t k = 0; k < grains.count; k++) {
                const double phase = 2 * M_PI / 128 * (qx * grains.x[k] + qy * grains.y[k]);
                re += cos(phase);
                im += sin(phase);
            }
            const double truth = (re * re + im * im) / grains.count;
            const double shift2 = (qx * qx + qy * qy) * pow(2 * M_PI / 128, 2) / 12;
            CHECK_NEAR(spectrum_at(&s, qx, qy), truth,
                       shift2 * truth + 4 * sqrt(2 * truth * shift2) + 4 * shift2 + 1e-9);
        }
    }
    spectrum_free(&s);
    grains_free(&grains);
}

static void test_the_grid_is_the_power_of_two_nearest_to_a_diameter(void **unused)
{
    (void)unused;
    struct grains grains = some(1);
    grains.count = 1;
    grains.x[0] = 200;                  /* outside */
    struct spectrum s = factor(&grains, 100, 90, 1);
    CHECK(s.mx == 128 && s.my == 64 && s.count == 0 && spectrum_at(&s, 0, 0) == 0);
    spectrum_free(&s);
    s = factor(&grains, 1e9, 0.1, 1);
    CHECK(s.mx == 4096 && s.my == 2);
    spectrum_free(&s);
    grains_free(&grains);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_ideal_gas_has_none),
        cmocka_unit_test(test_a_square_lattice_has_bragg_peaks_and_nothing_else),
        cmocka_unit_test(test_it_agrees_with_the_sum_over_all_grains),
        cmocka_unit_test(test_the_grid_is_the_power_of_two_nearest_to_a_diameter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
