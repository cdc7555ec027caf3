/* test_distribution.c - counts drawn from a law are fitted by that law, with its parameter.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/distribution.h"

enum { DRAWS = 20000, BINS = 4000 };

static uint32_t draw(struct rng *rng, enum distribution_law law, double p)
{
    const double u = rng_uniform(rng);
    double product = 1 - u;
    uint32_t c = 0;
    switch (law) {
    case DISTRIBUTION_poisson:          /* Knuth: how many factors until the product is below e^-p */
        for (; product > exp(-p); c++) product *= 1 - rng_uniform(rng);
        return c;
    case DISTRIBUTION_exponential: return (uint32_t)(-p * log1p(-u));
    /* The integral of B/(B+N)^2 from 0 to N is N/(B+N): inverted. */
    case DISTRIBUTION_power: return (uint32_t)fmin(1e6, p * u / (1 - u));
    default: return 0;
    }
}

static void check_law(enum distribution_law law, double p, uint64_t seed)
{
    static uint32_t counts[DRAWS];
    struct rng rng = {seed};
    struct distribution d;
    struct error error;
    for (uint32_t k = 0; k < DRAWS; k++) counts[k] = draw(&rng, law, p);
    CHECK(distribution_create(&d, counts, DRAWS, BINS, &error));
    const struct distribution_fit fit = distribution_fit(&d, law);
    print_message("%s: %.4f +- %.4f (%g)\n", distribution_law_name(law), fit.parameter, fit.error,
                  p);
    /* Four errors as told, which are those of theory: p / sqrt(n) for the exponential, sqrt(p / n)
     * for Poisson, p sqrt(3 / n) for the power law (Fisher's information of B is 1 / (3 B^2)). */
    CHECK_NEAR(fit.parameter, p, 4 * fit.error);
    const double theory = law == DISTRIBUTION_poisson ? sqrt(p / DRAWS)
                        : law == DISTRIBUTION_exponential ? p / sqrt(DRAWS)
                        : p * sqrt(3.0 / DRAWS);
    /* Whole numbers know a little less of B than real ones do. */
    CHECK_NEAR(fit.error, theory, 0.1 * theory);
    CHECK(distribution_best(&d) == law);
    distribution_free(&d);
}

static void test_each_law_is_recognised_with_its_parameter(void **unused)
{
    (void)unused;
    check_law(DISTRIBUTION_poisson, 6.5, 1);
    check_law(DISTRIBUTION_poisson, 0.7, 2);
    check_law(DISTRIBUTION_exponential, 19, 3);
    check_law(DISTRIBUTION_power, 14, 4);
    check_law(DISTRIBUTION_power, 80, 5);
}

static void test_the_laws_are_normalised(void **unused)
{
    (void)unused;
    for (int law = 0; law < DISTRIBUTION_LAW_COUNT; law++) {
        double sum = 0;
        for (uint32_t c = 0; c < 200000; c++) {
            sum += distribution_law_share((enum distribution_law)law, 8, c);
        }
        /* What the power law has beyond: B / (B + 200000). */
        CHECK_NEAR(sum, law == DISTRIBUTION_power ? 1 - 8 / 200008.0 : 1, 1e-9);
    }
}

static void test_shares_carry_their_counting_error_and_the_last_bin_holds_the_rest(void **unused)
{
    (void)unused;
    const uint32_t counts[] = {0, 0, 1, 5, 900};
    struct distribution d;
    struct error error;
    double doubt;
    CHECK(distribution_create(&d, counts, 5, 4, &error));
    CHECK_NEAR(distribution_share(&d, 0, &doubt), 0.4, 1e-15);
    CHECK_NEAR(doubt, sqrt(2) / 5, 1e-15);
    CHECK_NEAR(distribution_share(&d, 2, &doubt), 0, 0);
    CHECK_NEAR(doubt, 0.2, 1e-15);              /* that of one */
    CHECK_NEAR(distribution_share(&d, 3, NULL), 0.4, 1e-15);
    CHECK_NEAR(d.mean, 906 / 5.0, 1e-12);
    distribution_free(&d);
    CHECK(distribution_create(&d, counts, 2, 4, &error));       /* all zero */
    CHECK(isnan(distribution_fit(&d, DISTRIBUTION_exponential).parameter));
    distribution_free(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_law_is_recognised_with_its_parameter),
        cmocka_unit_test(test_the_laws_are_normalised),
        cmocka_unit_test(test_shares_carry_their_counting_error_and_the_last_bin_holds_the_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
