/* test_rng.c - random numbers are uniform, normal where they should be, and know nothing of each
 * other however their names differ.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * All words are functions of fixed names, so a test either always passes or never does; the limits
 * are those that a fair generator exceeds with probability below 1e-5.
 */
#include "base/rng.h"
#include "check.h"

enum { WORDS = 1 << 18, BINS = 64 };

static void test_uniform_numbers_have_the_moments_of_the_uniform_law(void **unused)
{
    (void)unused;
    struct rng rng = {1};
    double sum = 0, squares = 0, product = 0, before = 0.5;
    for (int k = 0; k < WORDS; k++) {
        const double u = rng_uniform(&rng);
        CHECK(u >= 0 && u < 1);
        sum += u;
        squares += u * u;
        product += (u - 0.5) * (before - 0.5);
        before = u;
    }
    /* Deviations of the means: sqrt(1/12), sqrt(4/45) and 1/12 over sqrt(WORDS); 4.5 of them. */
    const double scale = 4.5 / sqrt(WORDS);
    CHECK_NEAR(sum / WORDS, 1.0 / 2, sqrt(1.0 / 12) * scale);
    CHECK_NEAR(squares / WORDS, 1.0 / 3, sqrt(4.0 / 45) * scale);
    CHECK_NEAR(product / WORDS, 0, 1.0 / 12 * scale);
}

static void test_normal_numbers_have_the_moments_of_the_normal_law(void **unused)
{
    (void)unused;
    struct rng rng = rng_stream(7, 1, 2);
    double moments[5] = {0};
    for (int k = 0; k < WORDS; k++) {
        const double z = rng_normal(&rng);
        CHECK(isfinite(z));
        for (int m = 1; m <= 4; m++) moments[m] += pow(z, m) / WORDS;
    }
    /* Deviations of the means of z .. z^4: 1, sqrt 2, sqrt 15, sqrt 96. */
    const double scale = 4.5 / sqrt(WORDS);
    CHECK_NEAR(moments[1], 0, scale);
    CHECK_NEAR(moments[2], 1, sqrt(2) * scale);
    CHECK_NEAR(moments[3], 0, sqrt(15) * scale);
    CHECK_NEAR(moments[4], 3, sqrt(96) * scale);
}

/* Chi-square of pairs (word k, word k + 1) over BINS cells, of which both coordinates are the top
 * three bits of a word; and of each bit. */
static void check_words(uint64_t (*word)(uint64_t k), const char *name)
{
    uint32_t cells[BINS] = {0}, ones[64] = {0};
    for (uint64_t k = 0; k < WORDS; k++) {
        const uint64_t a = word(2 * k), b = word(2 * k + 1);
        cells[(a >> 61) * 8 + (b >> 61)]++;
        for (int bit = 0; bit < 64; bit++) ones[bit] += (uint32_t)(a >> bit & 1);
    }
    double chi2 = 0;
    for (int c = 0; c < BINS; c++) {
        const double expected = (double)WORDS / BINS;
        chi2 += (cells[c] - expected) * (cells[c] - expected) / expected;
    }
    /* 63 degrees of freedom: 63 +- 11.2; beyond 120 or below 24 in less than 1e-5 of all cases. */
    if (!(chi2 > 24 && chi2 < 120)) fail_msg("%s: chi-square %.1f of 63", name, chi2);
    for (int bit = 0; bit < 64; bit++) {
        const double excess = (ones[bit] - 0.5 * WORDS) / sqrt(0.25 * WORDS);
        if (fabs(excess) > 5.2) fail_msg("%s: bit %d is off by %.1f deviations", name, bit, excess);
    }
}

static uint64_t by_seed(uint64_t k) { return rng_keyed(k, 0, 0, 0); }
static uint64_t by_step(uint64_t k) { return rng_keyed(1, k, 3, 2); }
static uint64_t by_site(uint64_t k) { return rng_keyed(1, 100, k, 2); }
static uint64_t by_draw(uint64_t k) { return rng_keyed(1, k / 8, 5, k % 8); }
static uint64_t diagonal(uint64_t k) { return rng_keyed(k, k, k, k); }
static uint64_t by_stream(uint64_t k)
{
    struct rng rng = rng_stream(3, k, k + 1);
    return rng_u64(&rng);
}

static void test_keyed_words_are_uncorrelated_along_every_part_of_their_name(void **unused)
{
    (void)unused;
    check_words(by_seed, "seed");
    check_words(by_step, "step");
    check_words(by_site, "site");
    check_words(by_draw, "draw");
    check_words(diagonal, "all at once");
    check_words(by_stream, "first words of streams");
}

static uint64_t counting(uint64_t k) { return k << 40; }

static void test_the_check_of_words_can_fail(void **unused)
{
    (void)unused;
    /* Words that merely count fill the cells in order: chi-square is far off.  Done by hand, as
     * check_words ends the test. */
    uint32_t cells[BINS] = {0};
    for (uint64_t k = 0; k < WORDS; k++) {
        cells[(counting(2 * k) >> 61) * 8 + (counting(2 * k + 1) >> 61)]++;
    }
    double chi2 = 0;
    for (int c = 0; c < BINS; c++) {
        const double expected = (double)WORDS / BINS;
        chi2 += (cells[c] - expected) * (cells[c] - expected) / expected;
    }
    CHECK(chi2 > 1000);
}

static void test_the_order_of_asking_does_not_matter(void **unused)
{
    (void)unused;
    const uint64_t late = rng_keyed(9, 8, 7, 6);
    (void)rng_keyed(1, 2, 3, 4);
    CHECK(late == rng_keyed(9, 8, 7, 6));
    CHECK(late != rng_keyed(9, 8, 6, 7) && late != rng_keyed(9, 7, 8, 6));
    CHECK(late != rng_keyed(8, 9, 7, 6));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uniform_numbers_have_the_moments_of_the_uniform_law),
        cmocka_unit_test(test_normal_numbers_have_the_moments_of_the_normal_law),
        cmocka_unit_test(test_keyed_words_are_uncorrelated_along_every_part_of_their_name),
        cmocka_unit_test(test_the_check_of_words_can_fail),
        cmocka_unit_test(test_the_order_of_asking_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
