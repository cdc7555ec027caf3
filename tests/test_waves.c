/* test_waves.c - densities made by hand have the contrast and the spectrum they were made with.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/waves.h"

static struct waves series(uint32_t slabs, uint32_t looks, double interval)
{
    struct waves waves;
    struct error error;
    if (!waves_create(&waves, 0, 40, slabs, looks, interval, &error)) fail_msg("%s", error.text);
    return waves;
}

static void test_grains_are_counted_in_their_slabs(void **unused)
{
    (void)unused;
    struct waves waves = series(4, 2, 1);
    struct grains grains;
    struct error error;
    CHECK(grains_create(&grains, 5, 0, &error));
    grains.count = 5;
    const double y[] = {0, 9.99, 10, 35, 41};
    memcpy(grains.y, y, sizeof y);
    for (int k = 0; k < 3; k++) waves_add(&waves, &grains);     /* one too many */
    CHECK(waves.count == 2);
    CHECK_NEAR(waves.density[4], 2, 0);
    CHECK_NEAR(waves.density[5], 1, 0);
    CHECK_NEAR(waves.density[6], 0, 0);
    CHECK_NEAR(waves.density[7], 1, 0);
    /* 2 1 0 1: mean 1, variance 1/2. */
    CHECK_NEAR(waves_contrast(&waves, 1), sqrt(0.5), 1e-12);
    grains_free(&grains);
    waves_free(&waves);
}

/* 46 rows in 20 slabs: 14 have two, 6 three, so the contrast of a lattice at rest is
 * sqrt(0.21)/2.3.  By waves: with x = 2.3 pi n the n-th of the rows shows with sqrt(2) sin(x)/x,
 * 0.16 and 0.09 for n = 1 and 2, and with the square of sin(x)/x where grains are shared: 0.019
 * in all. */
static void test_rows_of_a_lattice_make_no_stripes_in_shared_slabs(void **unused)
{
    (void)unused;
    enum { ROWS = 46 };
    struct waves waves = series(20, 2, 1);
    struct grains grains;
    struct error error;
    CHECK(grains_create(&grains, ROWS, 0, &error));
    grains.count = ROWS;
    for (uint32_t i = 0; i < ROWS; i++) grains.y[i] = (i + 0.5) * 40 / ROWS;
    waves_add(&waves, &grains);
    CHECK_NEAR(waves_contrast(&waves, 0), sqrt(0.21) / 2.3, 1e-12);
    waves.count = 0;
    memset(waves.density, 0, 40 * sizeof *waves.density);
    waves.shared = true;
    waves_add(&waves, &grains);
    double sum = 0;
    for (uint32_t s = 0; s < 20; s++) sum += waves.density[s];
    CHECK_NEAR(sum, ROWS, 1e-9);
    CHECK_NEAR(waves_contrast(&waves, 0), 0.019, 0.002);
    /* Half-way between two middles: to both alike; before the first, all to it. */
    waves.count = 1;
    grains.count = 2;
    grains.y[0] = 4;
    grains.y[1] = 0.1;
    waves_add(&waves, &grains);
    CHECK_NEAR(waves.density[20], 1, 1e-12);
    CHECK_NEAR(waves.density[21], 0.5, 1e-12);
    CHECK_NEAR(waves.density[22], 0.5, 1e-12);
    grains_free(&grains);
    waves_free(&waves);
}

static void test_a_wave_shows_at_its_frequency_alone(void **unused)
{
    (void)unused;
    enum { LOOKS = 1024 };
    struct waves waves = series(3, LOOKS, 0.5);
    for (uint32_t k = 0; k < LOOKS; k++) {
        for (uint32_t s = 0; s < 3; s++) {
            waves.density[3 * k + s] = 10 + 2 * sin(2 * M_PI * (64.0 * k / LOOKS - s / 3.0));
        }
    }
    waves.count = LOOKS;
    double *power, step;
    uint32_t bins;
    struct error error;
    CHECK(waves_spectrum(&waves, 0, &power, &bins, &step, &error));
    CHECK(bins == LOOKS / 2);
    CHECK_NEAR(step, 1 / 512.0, 1e-15);
    for (uint32_t k = 1; k <= bins; k++) {
        /* The window lets a line leak into its two neighbours, nowhere else; in the middle its
         * power is (amplitude * count / 2)^2 / count. */
        if (k == 64) CHECK_NEAR(power[k - 1], LOOKS, 1e-6 * LOOKS);
        else if (k < 62 || k > 66) CHECK(power[k - 1] < 1e-12 * LOOKS);
    }
    free(power);
    waves_free(&waves);
}

static void test_a_random_walk_has_exponent_two_and_noise_none(void **unused)
{
    (void)unused;
    enum { LOOKS = 8192, SLABS = 16 };
    struct waves walk = series(SLABS, LOOKS, 1), noise = series(SLABS, LOOKS, 1);
    struct rng rng = {5};
    for (uint32_t s = 0; s < SLABS; s++) {
        double at = 0;
        for (uint32_t k = 0; k < LOOKS; k++) {
            const double kick = rng_normal(&rng);
            noise.density[SLABS * k + s] = kick;
            walk.density[SLABS * k + s] = at += kick;
        }
    }
    walk.count = noise.count = LOOKS;
    struct waves *const both[] = {&noise, &walk};
    for (int k = 0; k < 2; k++) {
        double *power, step;
        uint32_t bins;
        struct error error;
        CHECK(waves_spectrum(both[k], 0, &power, &bins, &step, &error));
        const struct stats_line line = waves_exponent(power, bins, step, 2.4e-3, 5e-2);
        /* A walk: 1 / (4 sin^2(pi f)), to 1 % of 1/f^2 in this band.  16 series: the mean power of
         * a bin of 2 modes or more scatters by 18 %, the slope over 32 bins by about 0.03. */
        CHECK_NEAR(line.slope, -2.0 * k, 0.12);
        CHECK(line.slope_error < 0.06);
        free(power);
    }
    waves_free(&walk);
    waves_free(&noise);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_grains_are_counted_in_their_slabs),
        cmocka_unit_test(test_rows_of_a_lattice_make_no_stripes_in_shared_slabs),
        cmocka_unit_test(test_a_wave_shows_at_its_frequency_alone),
        cmocka_unit_test(test_a_random_walk_has_exponent_two_and_noise_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
