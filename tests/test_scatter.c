/* test_scatter.c - a stream scattered in a known way shows its distribution and its maximum.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/scatter.h"

enum { BINS = 180, GRAINS = 200000 };

static double count[BINS], mass[BINS], momentum[BINS], spin[BINS], energy[BINS];
static struct tally_screen screen = {BINS, count, mass, momentum, spin, energy};

static const double grain_mass = 0.02, wide = 15, tilt = 28.5;

/* Two normal peaks at +-28.5 degrees; speed 300, and a spin that grows with the angle. */
static void scatter_stream(uint64_t seed)
{
    struct rng rng = {seed};
    for (int k = 0; k < BINS; k++) count[k] = mass[k] = momentum[k] = spin[k] = energy[k] = 0;
    for (int k = 0; k < GRAINS; k++) {
        const double side = rng_uniform(&rng) < 0.5 ? -1 : 1;
        const double angle = side * (tilt + wide * rng_normal(&rng));
        const int bin = (int)floor((angle + 180) * BINS / 360);
        count[bin] += 1;
        mass[bin] += grain_mass;
        momentum[bin] += grain_mass * 300;
        spin[bin] += 1e-3 * angle;
    }
}

static struct scatter result(double mass_in, struct scatter *folded)
{
    struct scatter scatter;
    struct error error;
    if (!scatter_create(&screen, mass_in, &scatter, &error)) fail_msg("%s", error.text);
    if (!scatter_fold(&scatter, folded, &error)) fail_msg("%s", error.text);
    return scatter;
}

static double density(double angle)     /* of the two peaks, per radian */
{
    const double a = (angle - tilt) / wide, b = (angle + tilt) / wide;
    return (exp(-a * a / 2) + exp(-b * b / 2)) / 2 / (sqrt(2 * M_PI) * wide * M_PI / 180);
}

static void test_the_distributions_are_those_of_the_stream(void **unused)
{
    (void)unused;
    struct scatter folded;
    scatter_stream(1);
    struct scatter scatter = result(2 * GRAINS * grain_mass, &folded);  /* half never arrived */
    double share = 0;
    for (int k = 0; k < BINS; k++) {
        const double bin = 2 * M_PI / BINS;
        share += scatter.mass[k] * bin;
        CHECK_NEAR(scatter.angle[k], -179 + 2 * k, 1e-12);
        /* Poisson: five deviations, and the curvature of the peak within a bin. */
        const double truth = 0.5 * density(scatter.angle[k]);
        const double slack = sqrt(truth / bin / (2 * GRAINS)) + 1.0 / (2 * GRAINS) / bin;
        CHECK_NEAR(scatter.mass[k], truth, 5 * slack + 0.002 * truth);
        if (count[k] == 0) {
            CHECK(isnan(scatter.momentum[k]) && isnan(scatter.spin[k]));
            continue;
        }
        CHECK_NEAR(scatter.momentum[k], grain_mass * 300, 1e-9);
        CHECK_NEAR(scatter.spin[k], 1e-3 * scatter.angle[k], 1e-3);     /* half a bin */
    }
    CHECK_NEAR(share, 0.5, 1e-9);
    scatter_free(&folded);
    scatter_free(&scatter);
}

static void test_folding_adds_both_sides(void **unused)
{
    (void)unused;
    struct scatter folded;
    scatter_stream(2);
    struct scatter scatter = result(GRAINS * grain_mass, &folded);
    CHECK(folded.bins == BINS / 2 && folded.angle[0] == 1);
    for (uint32_t k = 0; k < folded.bins; k++) {
        const uint32_t up = BINS / 2 + k, down = BINS / 2 - 1 - k;
        CHECK_NEAR(folded.mass[k], scatter.mass[up] + scatter.mass[down], 1e-12);
        if (count[up] + count[down] == 0) continue;
        /* The spin is odd in the angle: folded, it keeps the sign of the upper side. */
        CHECK_NEAR(folded.spin[k], (spin[up] - spin[down]) / (count[up] + count[down]), 1e-12);
        CHECK_NEAR(folded.momentum[k], grain_mass * 300, 1e-9);
    }
    scatter_free(&folded);
    scatter_free(&scatter);
}

static void test_the_maximum_is_found_within_its_error(void **unused)
{
    (void)unused;
    /* The folded density is the two peaks' sum, whose top lies where the tails of the other peak
     * shift it by less than 0.1 degrees. */
    double pulls = 0;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        struct scatter folded;
        scatter_stream(seed);
        struct scatter scatter = result(GRAINS * grain_mass, &folded);
        const struct scatter_peak peak = scatter_peak(&folded, 10);
        CHECK_NEAR(peak.angle, tilt, 1);
        CHECK(peak.angle_error > 0.05 && peak.angle_error < 0.5);
        CHECK_NEAR(peak.height, 2 * density(tilt), 0.05 * density(tilt));
        pulls += pow((peak.angle - tilt) / peak.angle_error, 2) / 20;
        scatter_free(&folded);
        scatter_free(&scatter);
    }
    /* Twenty pulls: 1 +- 0.16, and errors are raised where chi2 is above 1: so a little below. */
    CHECK_NEAR(sqrt(pulls), 0.95, 0.5);
}

static void test_an_empty_screen_is_no_peak(void **unused)
{
    (void)unused;
    struct scatter folded, scatter;
    struct error error;
    for (int k = 0; k < BINS; k++) count[k] = mass[k] = momentum[k] = spin[k] = 0;
    scatter = result(1, &folded);
    CHECK(isnan(scatter_peak(&folded, 10).angle));
    scatter_free(&folded);
    scatter_free(&scatter);
    CHECK(!scatter_create(&screen, 0, &scatter, &error) && strstr(error.text, "no mass"));
    screen.bins = 7;                    /* odd: the middle bin is its own mirror image */
    mass[3] = count[3] = 4;
    scatter = result(1, &folded);
    CHECK(folded.bins == 4 && fabs(folded.angle[0]) < 1e-12 && folded.count[0] == 8);
    CHECK_NEAR(folded.mass[0], 2 * scatter.mass[3], 1e-12);
    screen.bins = BINS;
    scatter_free(&folded);
    scatter_free(&scatter);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_distributions_are_those_of_the_stream),
        cmocka_unit_test(test_folding_adds_both_sides),
        cmocka_unit_test(test_the_maximum_is_found_within_its_error),
        cmocka_unit_test(test_an_empty_screen_is_no_peak),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
