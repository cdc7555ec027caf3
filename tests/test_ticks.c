/* test_ticks.c - ticks stand at round numbers inside the range and say exactly where they are.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/ticks.h"

#include "base/rng.h"
#include "check.h"

/* What a reader reads: the number written, minus signs and powers of ten included. */
static double read_number(const char *text)
{
    static const char *const raised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    char plain[100] = "";
    bool power = false;
    while (*text) {
        char letter[2] = {*text, 0};
        size_t length = 1;
        if (strncmp(text, "\u2212", 3) == 0 || strncmp(text, "\u207b", 3) == 0) {
            power = power || strncmp(text, "\u207b", 3) == 0;
            letter[0] = '-';
            length = 3;
            if (power && !strchr(plain, 'e')) strcat(plain, "e");
        }
        if (strncmp(text, "\u00b710", 4) == 0) {
            letter[0] = 0;
            length = 4;
        }
        for (int d = 0; d < 10; d++) {
            if (strncmp(text, raised[d], strlen(raised[d])) != 0) continue;
            if (!strchr(plain, 'e')) strcat(plain, "e");
            letter[0] = (char)('0' + d);
            length = strlen(raised[d]);
        }
        strcat(plain, letter);
        text += length;
    }
    /* "10" raised alone is one times that power. */
    if (strncmp(plain, "10e", 3) == 0) return pow(10, strtod(plain + 3, NULL));
    char *end;
    const double value = strtod(plain, &end);
    CHECK(*end == 0 && end > plain);
    return value;
}

static bool is_round(double value)
{
    if (value == 0) return true;
    const double mantissa = fabs(value) / pow(10, floor(log10(fabs(value)) + 1e-9));
    return fabs(mantissa - 1) < 1e-6 || fabs(mantissa - 2) < 1e-6 || fabs(mantissa - 5) < 1e-6;
}

static void check_common(const struct ticks *ticks, const double range[2], uint32_t wanted)
{
    const double width = range[1] - range[0];
    CHECK(ticks->count <= wanted);
    for (uint32_t k = 0; k < ticks->count; k++) {
        const struct tick *tick = &ticks->list[k];
        CHECK(tick->value >= range[0] - 1e-6 * width && tick->value <= range[1] + 1e-6 * width);
        CHECK(tick->position >= 0 && tick->position <= 1);
        if (k > 0) CHECK(tick->value > tick[-1].value && tick->position > tick[-1].position);
        /* Reading the text back gives the very same value up to the last bit or two; the only
         * tick of a range without width is written with four digits. */
        const double told = read_number(tick->text) * pow(10, ticks->exponent);
        CHECK_NEAR(told, tick->value, (ticks->count > 1 ? 4e-16 : 1e-3) * fabs(tick->value));
        CHECK(strlen(tick->text) <= 18);
    }
}

static void random_range(struct rng *rng, double range[2])
{
    const double size = pow(10, 16 * rng_uniform(rng) - 8);
    range[0] = rng_uniform(rng) < 0.4 ? 0 : size * (2 * rng_uniform(rng) - 1);
    range[1] = range[0] + size * (0.1 + rng_uniform(rng));
}

static void test_linear_ticks_are_equally_spaced_and_round(void **unused)
{
    (void)unused;
    struct rng rng = rng_stream(1, 0, 0);
    for (int trial = 0; trial < 20000; trial++) {
        double range[2];
        random_range(&rng, range);
        const uint32_t wanted = trial % 2 ? 8 : 9;
        struct ticks ticks;
        ticks_make(&ticks, SCALE_LINEAR, range, wanted);
        check_common(&ticks, range, wanted);
        CHECK(ticks.count >= 3);
        const double step = ticks.list[1].value - ticks.list[0].value;
        CHECK(is_round(step));
        for (uint32_t k = 0; k < ticks.count; k++) {
            const double multiple = ticks.list[k].value / step;
            CHECK_NEAR(multiple, round(multiple), 1e-6);
            CHECK_NEAR(ticks.list[k].value, ticks.list[0].value + k * step, 1e-6 * step);
        }
    }
}

static void test_few_ticks_are_given_where_few_are_wanted(void **unused)
{
    (void)unused;
    struct rng rng = rng_stream(2, 0, 0);
    for (int trial = 0; trial < 3000; trial++) {
        double range[2];
        random_range(&rng, range);
        for (uint32_t wanted = 2; wanted <= TICKS_MAX; wanted++) {
            for (int scale = SCALE_LINEAR; scale <= SCALE_LOG; scale++) {
                struct ticks ticks;
                ticks_make(&ticks, (enum scale)scale, range, wanted);
                check_common(&ticks, range, wanted);
            }
        }
    }
}

static void test_square_root_ticks_reach_both_ends(void **unused)
{
    (void)unused;
    struct rng rng = rng_stream(3, 0, 0);
    for (int trial = 0; trial < 5000; trial++) {
        const double range[2] = {0, pow(10, 12 * rng_uniform(&rng) - 6)};
        struct ticks ticks;
        ticks_make(&ticks, SCALE_SQRT, range, 8);
        check_common(&ticks, range, 8);
        CHECK(ticks.count >= 4);
        CHECK(ticks.list[0].value == 0);
        CHECK(ticks.list[ticks.count - 1].position > 0.7);
        for (uint32_t k = 0; k < ticks.count; k++) {
            CHECK_NEAR(ticks.list[k].position, sqrt(ticks.list[k].value / range[1]), 1e-12);
            /* Room between labels: no two nearer than two thirds of an even spacing. */
            if (k) CHECK(ticks.list[k].position - ticks.list[k - 1].position > 0.66 / 8);
        }
    }
}

static void test_logarithmic_ticks_stand_at_decades(void **unused)
{
    (void)unused;
    const double two[2] = {0.1, 10}, three[2] = {0, 1000};
    struct ticks ticks;
    ticks_make(&ticks, SCALE_LOG, two, 9);
    assert_int_equal(ticks.count, 7);
    static const char *const words[] = {"0.1", "0.2", "0.5", "1", "2", "5", "10"};
    for (int k = 0; k < 7; k++) assert_string_equal(ticks.list[k].text, words[k]);
    CHECK_NEAR(ticks.list[3].position, 0.5, 1e-12);
    ticks_make(&ticks, SCALE_LOG, three, 4);
    assert_int_equal(ticks.count, 4);
    CHECK(ticks.list[0].value == 1 && ticks.list[3].value == 1000);
    struct rng rng = rng_stream(4, 0, 0);
    for (int trial = 0; trial < 5000; trial++) {
        const double high = pow(10, 12 * rng_uniform(&rng) - 6);
        const double range[2] = {high * pow(10, -4 * rng_uniform(&rng) - 0.05), high};
        ticks_make(&ticks, SCALE_LOG, range, 9);
        check_common(&ticks, range, 9);
        CHECK(ticks.count >= 3);
    }
}

static void test_numbers_are_written_as_people_write_them(void **unused)
{
    (void)unused;
    static const struct { double value; const char *text; } numbers[] = {
        {0, "0"}, {9.81, "9.81"}, {-2.5, "\u22122.5"}, {0.3, "0.3"}, {20, "20"}, {0.001, "0.001"},
        {123456, "123000"}, {2e-5, "2\u00b710\u207b\u2075"}, {1e7, "10\u2077"},
        {6.02e23, "6.02\u00b710\u00b2\u00b3"}, {9.999, "10"}};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        char text[TICKS_TEXT_MAX];
        ticks_number(text, numbers[k].value, 3);
        assert_string_equal(text, numbers[k].text);
    }
}

static void test_large_and_small_numbers_share_their_power_of_ten(void **unused)
{
    (void)unused;
    const double small[2] = {0, 4e-6}, large[2] = {0, 6e7};
    struct ticks ticks;
    ticks_make(&ticks, SCALE_LINEAR, small, 6);
    assert_int_equal(ticks.exponent, -6);
    assert_string_equal(ticks.list[1].text, "1");
    ticks_make(&ticks, SCALE_LINEAR, large, 8);
    assert_int_equal(ticks.exponent, 6);
    assert_string_equal(ticks.list[1].text, "10");
}

static void test_an_empty_range_has_one_tick(void **unused)
{
    (void)unused;
    const double point[2] = {3, 3}, none[2] = {NAN, NAN};
    struct ticks ticks;
    for (int scale = SCALE_LINEAR; scale <= SCALE_LOG; scale++) {
        ticks_make(&ticks, (enum scale)scale, point, 5);
        assert_int_equal(ticks.count, 1);
        assert_string_equal(ticks.list[0].text, "3");
        ticks_make(&ticks, (enum scale)scale, none, 5);
        assert_int_equal(ticks.count, 0);
    }
}

static void test_rounding_down_finds_one_two_or_five(void **unused)
{
    (void)unused;
    static const double pairs[][2] = {{1, 1}, {1.99, 1}, {2, 2}, {4.9, 2}, {5, 5}, {9.99, 5},
                                      {0.03, 0.02}, {700, 500}, {1e-7, 1e-7}};
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        CHECK_NEAR(ticks_round_down(pairs[k][0]), pairs[k][1], 1e-14 * pairs[k][1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_ticks_are_equally_spaced_and_round),
        cmocka_unit_test(test_few_ticks_are_given_where_few_are_wanted),
        cmocka_unit_test(test_square_root_ticks_reach_both_ends),
        cmocka_unit_test(test_logarithmic_ticks_stand_at_decades),
        cmocka_unit_test(test_numbers_are_written_as_people_write_them),
        cmocka_unit_test(test_large_and_small_numbers_share_their_power_of_ten),
        cmocka_unit_test(test_an_empty_range_has_one_tick),
        cmocka_unit_test(test_rounding_down_finds_one_two_or_five),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
