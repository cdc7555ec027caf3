/* test_colormap.c - colour maps are perceptual, and values find their place on every scale.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/colormap.h"

#include "check.h"

/* CIE 1976 lightness of an sRGB colour (IEC 61966-2-1, D65). */
static double lightness(const uint8_t rgb[3])
{
    static const double weight[3] = {0.2126, 0.7152, 0.0722};
    double y = 0;
    for (int c = 0; c < 3; c++) {
        const double s = rgb[c] / 255.0;
        y += weight[c] * (s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4));
    }
    return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

static void test_lightness_rises_evenly_along_the_perceptual_maps(void **unused)
{
    (void)unused;
    static const char *const names[] = {"viridis", "inferno", "cividis"};
    for (int k = 0; k < 3; k++) {
        const uint8_t (*map)[3] = colormap_find(names[k]);
        CHECK(map != NULL);
        /* A byte is worth up to 0.3 of lightness, in the darkest colours a little more. */
        for (int i = 1; i < COLORMAP_SIZE; i++) {
            CHECK(lightness(map[i]) > lightness(map[i - 1]) - 0.4);
        }
        for (int i = 16; i < COLORMAP_SIZE; i += 16) {
            CHECK(lightness(map[i]) > lightness(map[i - 16]) + 1);
        }
    }
}

/* As published: viridis and inferno from BIDS, cividis from PLoS ONE 13, e0199239, turbo from
 * Google's article of 2019. */
static void test_the_ends_of_the_maps_are_those_published(void **unused)
{
    (void)unused;
    static const struct { const char *name; uint8_t first[3], last[3]; } maps[] = {
        {"viridis", {68, 1, 84}, {253, 231, 37}}, {"inferno", {0, 0, 4}, {252, 255, 164}},
        {"cividis", {0, 34, 78}, {254, 232, 56}}, {"turbo", {48, 18, 59}, {122, 4, 3}}};
    for (int k = 0; k < 4; k++) {
        const uint8_t (*map)[3] = colormap_find(maps[k].name);
        CHECK(map != NULL);
        for (int c = 0; c < 3; c++) {
            CHECK_NEAR(map[0][c], maps[k].first[c], 1);
            CHECK_NEAR(map[COLORMAP_SIZE - 1][c], maps[k].last[c], 1);
        }
    }
    CHECK(colormap_find("jet") == NULL);
    assert_string_equal(colormap_names(), "viridis, inferno, cividis, turbo");
}

static void test_values_find_their_place_on_each_scale(void **unused)
{
    (void)unused;
    const double range[2] = {2, 10}, decades[2] = {0.1, 10};
    CHECK_NEAR(colormap_position(SCALE_LINEAR, range, 4), 0.25, 1e-15);
    CHECK_NEAR(colormap_position(SCALE_SQRT, range, 4), 0.5, 1e-15);
    CHECK_NEAR(colormap_position(SCALE_LOG, decades, 1), 0.5, 1e-15);
    CHECK_NEAR(colormap_position(SCALE_LOG, decades, 10), 1, 1e-15);
}

static void test_opposite_spins_lie_equally_far_from_the_middle_on_a_root_scale(void **state)
{
    (void)state;
    const double range[2] = {-4, 4};
    CHECK_NEAR(colormap_position(SCALE_SQRT, range, 0), 0.5, 1e-15);
    CHECK_NEAR(colormap_position(SCALE_SQRT, range, 1), 0.75, 1e-15);       /* sqrt(1/4) up */
    CHECK_NEAR(colormap_position(SCALE_SQRT, range, -1), 0.25, 1e-15);
    CHECK_NEAR(colormap_position(SCALE_SQRT, range, -9), 0, 1e-15);
}

static void test_the_logarithm_starts_three_decades_below_the_top(void **unused)
{
    (void)unused;
    const double from_zero[2] = {0, 1000};
    CHECK_NEAR(colormap_position(SCALE_LOG, from_zero, 1), 0, 1e-15);
    CHECK_NEAR(colormap_position(SCALE_LOG, from_zero, 0), 0, 0);
    CHECK_NEAR(colormap_position(SCALE_LOG, from_zero, -5), 0, 0);
    CHECK_NEAR(colormap_position(SCALE_LOG, from_zero, 10), 1.0 / 3, 1e-15);
    CHECK_NEAR(colormap_position(SCALE_LOG, from_zero, 1000), 1, 1e-15);
}

static void test_what_is_outside_or_no_number_is_clamped(void **unused)
{
    (void)unused;
    const double ranges[][2] = {{0, 1}, {-3, 5}, {2, 2}, {-2, -1}, {0, 0}};
    for (int k = 0; k < 5; k++) {
        for (int scale = SCALE_LINEAR; scale <= SCALE_LOG; scale++) {
            const enum scale s = (enum scale)scale;
            CHECK_NEAR(colormap_position(s, ranges[k], NAN), 0, 0);
            CHECK_NEAR(colormap_position(s, ranges[k], 1e300), 1, 0);
            CHECK_NEAR(colormap_position(s, ranges[k], INFINITY), 1, 0);
            CHECK_NEAR(colormap_position(s, ranges[k], -1e300), 0, 0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lightness_rises_evenly_along_the_perceptual_maps),
        cmocka_unit_test(test_the_ends_of_the_maps_are_those_published),
        cmocka_unit_test(test_values_find_their_place_on_each_scale),
        cmocka_unit_test(
            test_opposite_spins_lie_equally_far_from_the_middle_on_a_root_scale),
        cmocka_unit_test(test_the_logarithm_starts_three_decades_below_the_top),
        cmocka_unit_test(test_what_is_outside_or_no_number_is_clamped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
