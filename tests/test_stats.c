/* test_stats.c - errors of correlated series, of lines and of parabolas are those of theory.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/stats.h"

enum { LENGTH = 1 << 17 };

static double series[LENGTH];

/* x' = memory * x + normal: deviation 1/sqrt(1 - memory^2), and the mean of n values has the
 * error deviation * sqrt((1 + memory) / (1 - memory) / n). */
static void fill(double memory, uint64_t seed)
{
    struct rng rng = {seed};
    double x = rng_normal(&rng) / sqrt(1 - memory * memory);
    for (int k = 0; k < LENGTH; k++) {
        series[k] = 7 + x;
        x = memory * x + rng_normal(&rng);
    }
}

static struct stats_mean mean_of(const double *values, size_t count)
{
    struct stats_mean mean;
    struct error error;
    if (!stats_mean(values, count, &mean, &error)) fail_msg("%s", error.text);
    return mean;
}

static void test_the_error_of_a_correlated_series_is_that_of_theory(void **unused)
{
    (void)unused;
    const double memories[] = {0, 0.5, 0.9, 0.98};
    for (size_t m = 0; m < 4; m++) {
        const double memory = memories[m], growth = (1 + memory) / (1 - memory);
        const double truth = sqrt(growth / (1 - memory * memory) / LENGTH);
        for (uint64_t seed = 1; seed <= 5; seed++) {
            fill(memory, seed);
            const struct stats_mean mean = mean_of(series, LENGTH);
            CHECK(mean.settled);
            /* The block's bias is below its scatter by the choice of the block: 4 of the latter. */
            CHECK_NEAR(mean.error, truth, 4 * mean.error_error + 0.01 * truth);
            CHECK(mean.error_error < 0.15 * truth);
            CHECK_NEAR(mean.mean, 7, 5 * truth);
            CHECK_NEAR(mean.deviation, 1 / sqrt(1 - memory * memory), 5 * truth);
            CHECK_NEAR(mean.correlation / growth, 1, 8 * mean.error_error / mean.error + 0.02);
        }
    }
}

static void test_a_series_shorter_than_its_memory_says_so(void **unused)
{
    (void)unused;
    for (int k = 0; k < 256; k++) series[k] = k;        /* a drift never settles */
    CHECK(!mean_of(series, 256).settled);
    fill(0, 3);
    CHECK(mean_of(series, 256).settled);
}

static void test_short_and_constant_series_make_no_trouble(void **unused)
{
    (void)unused;
    const double same[4] = {2, 2, 2, 2};
    CHECK(isnan(mean_of(same, 0).mean) && isnan(mean_of(same, 1).error));
    CHECK(mean_of(same, 1).mean == 2 && mean_of(same, 4).error == 0);
    const double two[2] = {1, 3};
    CHECK(mean_of(two, 2).mean == 2 && mean_of(two, 2).error == 1);     /* sqrt(c0 / (n - 1)) */
}

static void test_a_line_and_its_errors(void **unused)
{
    (void)unused;
    /* y = 3 + 2 x with unit noise at x = 0..99: slope error 1/sqrt(sum (x - xm)^2); over 400
     * fits the pulls have deviation 1 to 1/sqrt(800) = 3.5 %, with 97 degrees of freedom more. */
    struct rng rng = {11};
    double x[100], y[100], slopes = 0, offsets = 0;
    for (int fit = 0; fit < 400; fit++) {
        for (int k = 0; k < 100; k++) x[k] = k, y[k] = 3 + 2.0 * k + rng_normal(&rng);
        const struct stats_line line = stats_line(x, y, 100);
        CHECK_NEAR(line.slope_error, 1 / sqrt(83325), 0.4 / sqrt(83325));
        slopes += pow((line.slope - 2) / line.slope_error, 2) / 400;
        offsets += pow((line.offset - 3) / line.offset_error, 2) / 400;
    }
    CHECK_NEAR(sqrt(slopes), 1, 0.15);
    CHECK_NEAR(sqrt(offsets), 1, 0.15);
    CHECK(isnan(stats_line(x, y, 1).slope) && isnan(stats_line(x, y, 2).slope_error));
    x[1] = x[0];
    CHECK(isnan(stats_line(x, y, 2).slope));
}

static void test_a_parabola_finds_its_top_within_its_error(void **unused)
{
    (void)unused;
    struct rng rng = {12};
    double x[40], y[40], errors[40], tops = 0, heights = 0, chi2 = 0;
    for (int fit = 0; fit < 400; fit++) {
        for (int k = 0; k < 40; k++) {
            x[k] = 1000 + k;
            errors[k] = 1 + 0.05 * k;
            y[k] = 50 - 0.1 * pow(x[k] - 1023.3, 2) + errors[k] * rng_normal(&rng);
        }
        const struct stats_parabola p = stats_parabola(x, y, errors, 40);
        CHECK_NEAR(p.curvature, -0.1, 0.03);
        tops += pow((p.top - 1023.3) / p.top_error, 2) / 400;
        heights += pow((p.height - 50) / p.height_error, 2) / 400;
        chi2 += p.chi2 / 400;
    }
    CHECK_NEAR(sqrt(tops), 1, 0.15);            /* pulls: 1 +- 3.5 % */
    CHECK_NEAR(sqrt(heights), 1, 0.15);
    CHECK_NEAR(chi2, 37, 5 * sqrt(2 * 37 / 400.0));
    for (int k = 0; k < 40; k++) y[k] = x[k] * x[k];
    CHECK(isnan(stats_parabola(x, y, errors, 40).top));         /* no top */
    CHECK(isnan(stats_parabola(x, y, errors, 2).offset));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_error_of_a_correlated_series_is_that_of_theory),
        cmocka_unit_test(test_a_series_shorter_than_its_memory_says_so),
        cmocka_unit_test(test_short_and_constant_series_make_no_trouble),
        cmocka_unit_test(test_a_line_and_its_errors),
        cmocka_unit_test(test_a_parabola_finds_its_top_within_its_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
