/* test_draw_splat.c - what grains cover: areas, bands, percentiles and fields, without OpenGL.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "draw/bands.h"
#include "draw/colormap.h"
#include "draw/fieldlayer.h"
#include "draw/percentile.h"
#include "draw/splat.h"
#include "check.h"

enum { SIDE = 64 };

static const struct splat_area whole = {0, 0, SIDE, SIDE};

static float *sums_new(void)
{
    float *const sums = aligned_alloc(64, SIDE * SIDE * 4 * sizeof *sums);
    memset(sums, 0, SIDE * SIDE * 4 * sizeof *sums);
    return sums;
}

static const struct splat_style plain = {0, 0}, rich = {1, 1};

static double coverage(const struct splat *splat, struct splat_style style)
{
    float *const sums = sums_new();
    splat_add(sums, SIDE, &whole, splat, &(uint32_t){0}, 1, style);
    double total = 0;
    for (int i = 0; i < SIDE * SIDE; i++) total += (double)sums[4 * i + 3];
    free(sums);
    return total;
}

static void test_the_coverage_of_a_disc_adds_up_to_its_area(void **unused)
{
    (void)unused;
    static const double radii[] = {0.05, 0.2, 0.5, 0.8, 1.19, 1.21, 1.5, 2, 3, 5, 8, 13, 20};
    struct rng rng = rng_stream(7, 0, 0);
    for (size_t k = 0; k < sizeof radii / sizeof *radii; k++) {
        const double radius = radii[k], area = acos(-1) * radius * radius;
        /* Squares are exact but for single precision at places of order 32.  A disc's edge is
         * sampled at pixel centres: the error falls with the number of pixels on the edge, and
         * has no mean, so that of 400 places is 20 times smaller. */
        const double one = radius < 1.2 ? 1e-4 / radius : radius < 2.5 ? 0.04 : 0.012;
        double mean = 0;
        for (int place = 0; place < 400; place++) {
            const struct splat splat = {.x = 32 + (float)rng_uniform(&rng),
                .y = 31 + (float)rng_uniform(&rng), .radius = (float)radius};
            const double covered = coverage(&splat, place % 2 ? rich : plain);
            CHECK_NEAR(covered / area, 1, one);
            mean += covered / area / 400;
        }
        CHECK_NEAR(mean, 1, 0.005);
    }
}

static void test_a_disc_is_covered_inside_and_clear_outside(void **unused)
{
    (void)unused;
    const struct splat splat = {.x = 30.3f, .y = 33.8f, .radius = 9.4f};
    float *const sums = sums_new();
    splat_add(sums, SIDE, &whole, &splat, &(uint32_t){0}, 1, plain);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double d = hypot(i % SIDE + 0.5 - 30.3, i / SIDE + 0.5 - 33.8);
        /* The half-way line of the edge lies on the circle: a linear ramp, one pixel wide. */
        const double expected = fmin(1, fmax(0, 9.4 + 0.5 - d));
        CHECK_NEAR(sums[4 * i + 3], expected, 0.01);
    }
    free(sums);
}

static void test_grains_far_below_a_pixel_give_the_mean_colour(void **unused)
{
    (void)unused;
    /* Four grains a pixel, of one eighth of a pixel each: half of the ground is covered.  They
     * keep within their quarters, so none shares its place with another. */
    enum { COUNT = SIDE * SIDE * 4 };
    struct splat *const splats = calloc(COUNT, sizeof *splats);
    uint32_t *const index = calloc(COUNT, sizeof *index);
    struct rng rng = rng_stream(8, 0, 0);
    for (uint32_t i = 0; i < COUNT; i++) {
        splats[i] = (struct splat){.radius = (float)sqrt(0.125 / acos(-1)), .rgb = {200, 40, 0},
            .x = (float)(0.5 * (i % (2 * SIDE) + 0.5) + 0.1 * (rng_uniform(&rng) - 0.5)),
            .y = (float)(0.5 * (i / (2 * SIDE) + 0.5) + 0.1 * (rng_uniform(&rng) - 0.5))};
        index[i] = i;
    }
    float *const sums = sums_new();
    splat_add(sums, SIDE, &whole, splats, index, COUNT, rich);
    uint8_t *const rgba = malloc(SIDE * SIDE * 4);
    memset(rgba, 255, SIDE * SIDE * 4);
    splat_resolve(sums, rgba, SIDE * SIDE);
    double mean[4] = {0};
    for (int i = 0; i < SIDE * SIDE * 4; i++) mean[i % 4] += (double)rgba[i] / (SIDE * SIDE);
    /* Rounding to whole levels has no mean. */
    CHECK_NEAR(mean[0], 0.5 * (200 + 255), 0.5);
    CHECK_NEAR(mean[1], 0.5 * (40 + 255), 0.5);
    CHECK_NEAR(mean[2], 0.5 * (0 + 255), 0.5);
    CHECK_NEAR(mean[3], 255, 0);
    free(splats);
    free(index);
    free(sums);
    free(rgba);
}

static struct splat *random_splats(uint32_t count, double radius_max)
{
    struct splat *const splats = calloc(count, sizeof *splats);
    struct rng rng = rng_stream(9, count, 0);
    for (uint32_t i = 0; i < count; i++) {
        splats[i] = (struct splat){.x = (float)(rng_uniform(&rng) * 80 - 8),
            .y = (float)(rng_uniform(&rng) * 80 - 8),
            .radius = (float)(rng_uniform(&rng) * radius_max),
            .rgb = {(uint8_t)rng_u64(&rng), (uint8_t)rng_u64(&rng), (uint8_t)rng_u64(&rng)}};
    }
    return splats;
}

static void test_a_picture_in_pieces_is_the_whole_picture(void **unused)
{
    (void)unused;
    enum { COUNT = 200 };
    struct splat *const splats = random_splats(COUNT, 9);
    uint32_t index[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) index[i] = i;
    float *const once = sums_new(), *const pieces = sums_new();
    splat_add(once, SIDE, &whole, splats, index, COUNT, rich);
    for (uint32_t y = 0; y < SIDE; y += 16) {
        for (uint32_t x = 0; x < SIDE; x += 32) {
            const struct splat_area area = {x, y, x + 32, y + 16};
            splat_add(pieces + (size_t)y * SIDE * 4, SIDE, &area, splats, index, COUNT, rich);
        }
    }
    CHECK(memcmp(once, pieces, SIDE * SIDE * 4 * sizeof *once) == 0);
    free(splats);
    free(once);
    free(pieces);
}

static void test_a_grain_is_in_every_band_that_it_touches_and_in_no_other(void **unused)
{
    (void)unused;
    enum { COUNT = 500, ROWS = 7 };
    struct splat *const splats = random_splats(COUNT, 12);
    struct bands bands = {0};
    CHECK(bands_reserve(&bands, COUNT, NULL));
    for (uint32_t i = 0; i < COUNT; i++) {
        bands.splats[bands.count] = splats[i];
        bands.count += splat_touches(&splats[i], &whole);
    }
    CHECK(bands_sort(&bands, ROWS, SIDE, NULL));
    for (uint32_t band = 0; band < bands.band_count; band++) {
        const struct splat_area area = {0, band * ROWS, SIDE, (band + 1) * ROWS};
        uint32_t count, found = 0;
        const uint32_t *const index = bands_index(&bands, band, &count);
        for (uint32_t k = 0; k < bands.count; k++) {
            /* A rim of a hundredth of a pixel is neither here nor there. */
            struct splat larger = bands.splats[k], smaller = larger;
            larger.radius += 0.01f;
            smaller.radius = smaller.radius > 0.01f ? smaller.radius - 0.01f : 0;
            const bool listed = found < count && index[found] == k;
            CHECK(!listed || splat_touches(&larger, &area));
            CHECK(listed || !splat_touches(&smaller, &area));
            found += listed;
        }
        assert_int_equal(found, count);
    }
    bands_free(&bands);
    free(splats);
}

static int float_compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void test_percentiles_are_those_of_the_sorted_values(void **unused)
{
    (void)unused;
    struct rng rng = rng_stream(10, 0, 0);
    for (uint32_t count = 1; count < 400; count += 7) {
        float values[400], sorted[400];
        for (uint32_t i = 0; i < count; i++) {
            /* Many equal ones, and some already in order. */
            sorted[i] = count % 2 ? (float)(rng_u64(&rng) % 9) : (float)i;
        }
        memcpy(values, sorted, sizeof values);
        qsort(sorted, count, sizeof *sorted, float_compare);
        for (uint32_t share = 0; share <= 64; share++) {
            const uint32_t rank = (share * count + 63) / 64;
            CHECK_NEAR(percentile(values, count, share / 64.0), sorted[rank ? rank - 1 : 0], 0);
        }
    }
    CHECK_NEAR(percentile(NULL, 0, 0.99), 0, 0);
}

static void test_a_field_lies_where_its_cells_are(void **unused)
{
    (void)unused;
    /* 4 x 2 cells of side 2 with their corner at (1, 1), seen at 6 pixels a length; the lower
     * left corner of the picture is the scene's origin. */
    struct field field;
    CHECK(field_create(&field, 1, 1, 2, 4, 2, 1, NULL));
    for (int i = 0; i < 8; i++) field.values[i] = i;
    field.values[5] = NAN;
    const struct transform transform = {.scale = 6, .x0 = 0, .y1 = SIDE / 6.0};
    struct fieldlayer layer = {.field = &field, .colormap = colormap_find("viridis"),
                               .scale = SCALE_LINEAR, .range = {0, 7}};
    uint8_t *const rgba = malloc(SIDE * SIDE * 4);
    for (int smooth = 0; smooth < 2; smooth++) {
        layer.smooth = smooth;
        memset(rgba, 9, SIDE * SIDE * 4);
        fieldlayer_draw(&layer, &transform, SIDE, SIDE, &whole, rgba);
        for (int i = 0; i < 8; i++) {
            /* The pixel right of and above the cell's middle. */
            const int x = 12 + 12 * (i % 4), y = 12 + 12 * (i / 4);
            const uint8_t *const pixel = rgba + 4 * (y * SIDE + x);
            const uint8_t *const color = layer.colormap[(int)(i * 255 / 7.0 + 0.5)];
            if (i == 5) {
                assert_int_equal(pixel[3], 9);
                continue;
            }
            /* Half a pixel is 1/24 of a cell; a row adds 4 and a column 1 to the value, so 5/24
             * of a step of 255/7 entries, and viridis moves by up to 4 levels an entry. */
            for (int k = 0; k < 3; k++) CHECK_NEAR(pixel[k], color[k], smooth ? 32 : 0);
            assert_int_equal(pixel[3], 255);
        }
        assert_int_equal(rgba[4 * (3 * SIDE + 3)], 9);          /* around the grid */
        assert_int_equal(rgba[4 * (31 * SIDE + 20)], 9);
    }
    free(rgba);
    field_free(&field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_coverage_of_a_disc_adds_up_to_its_area),
        cmocka_unit_test(test_a_disc_is_covered_inside_and_clear_outside),
        cmocka_unit_test(test_grains_far_below_a_pixel_give_the_mean_colour),
        cmocka_unit_test(test_a_picture_in_pieces_is_the_whole_picture),
        cmocka_unit_test(test_a_grain_is_in_every_band_that_it_touches_and_in_no_other),
        cmocka_unit_test(test_percentiles_are_those_of_the_sorted_values),
        cmocka_unit_test(test_a_field_lies_where_its_cells_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
