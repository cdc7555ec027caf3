/* test_heap.c - heaps built by hand have the slope they were built with.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/heap.h"

static struct grains empty(uint32_t capacity)
{
    struct grains grains;
    struct error error;
    if (!grains_create(&grains, capacity, 0, &error)) fail_msg("%s", error.text);
    return grains;
}

static void put(struct grains *grains, double x, double y, double r, double speed)
{
    const uint32_t k = grains->count++;
    CHECK(k < grains->capacity);
    grains->x[k] = x;
    grains->y[k] = y;
    grains->radius[k] = r;
    grains->vy[k] = -speed;
}

static struct heap profile(const struct grains *grains, double x0, double x1, uint32_t bins,
                           double speed_max)
{
    struct heap heap;
    struct error error;
    if (!heap_create(grains, x0, x1, bins, 0, speed_max, &heap, &error)) fail_msg("%s", error.text);
    return heap;
}

/* Discs of radius 1/2 at random below y = 40 - |x - 3| * slope, dense enough to have no holes. */
static struct grains cone(double left, double right, uint64_t seed)
{
    struct grains grains = empty(60000);
    struct rng rng = {seed};
    while (grains.count < 50000) {
        const double x = 200 * rng_uniform(&rng) - 100, y = 40 * rng_uniform(&rng);
        if (y < 40 - (x < 3 ? (3 - x) * left : (x - 3) * right)) put(&grains, x, y, 0.5, 0);
    }
    return grains;
}

static void test_a_cone_has_the_slope_it_was_built_with(void **unused)
{
    (void)unused;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        struct grains grains = cone(0.5, 0.7, seed);
        struct heap heap = profile(&grains, -110, 110, 220, INFINITY);
        const struct heap_slope slope = heap_slope(&heap, 0.15, 0.85);
        /* The surface is rough by a few tenths of a diameter over 40 to 56 bins of one diameter:
         * 0.3 / sqrt(40^3 / 12) = 0.004; a share of it is left over as bias of the fit's ends. */
        CHECK_NEAR(slope.left, 0.5, 0.015);
        CHECK_NEAR(slope.right, 0.7, 0.015);
        CHECK_NEAR(slope.left, 0.5, 6 * slope.left_error);
        CHECK_NEAR(slope.right, 0.7, 6 * slope.right_error);
        CHECK(slope.left_error < 0.005 && slope.right_error < 0.005);
        CHECK_NEAR(slope.angle, atan(0.6) * 180 / M_PI, 0.5);
        CHECK_NEAR(slope.top_x, 3, 2);
        CHECK_NEAR(slope.top, 40.5, 1);
        heap_free(&heap);
        grains_free(&grains);
    }
}

static void test_falling_grains_and_strays_are_no_part_of_the_heap(void **unused)
{
    (void)unused;
    struct grains grains = cone(0.6, 0.6, 9);
    for (int k = 0; k < 200; k++) put(&grains, 3, 45 + k, 0.5, 5);      /* the stream above */
    put(&grains, 105, 0.5, 0.5, 0);                                     /* rolled away */
    put(&grains, 105.2, 9, 0.5, 0);                                     /* as high as the flank */
    struct heap heap = profile(&grains, -110, 110, 220, 1);
    const struct heap_slope slope = heap_slope(&heap, 0.15, 0.85);
    CHECK_NEAR(slope.slope, 0.6, 0.015);
    CHECK_NEAR(slope.top, 40.5, 1);
    heap_free(&heap);
    grains_free(&grains);
}

static void test_the_profile_is_the_upper_rim_of_the_discs(void **unused)
{
    (void)unused;
    struct grains grains = empty(3);
    put(&grains, 5, 1, 1, 0);
    put(&grains, 5, 0.5, 0.5, 0);
    struct heap heap = profile(&grains, 0, 10, 20, INFINITY);
    for (uint32_t b = 0; b < 20; b++) {
        const double dx = 0.25 + 0.5 * b - 5;
        CHECK_NEAR(heap.height[b], fabs(dx) < 1 ? 1 + sqrt(1 - dx * dx) : 0, 1e-12);
    }
    heap_free(&heap);
    grains.count = 0;
    heap = profile(&grains, 0, 10, 20, INFINITY);
    CHECK(isnan(heap_slope(&heap, 0.15, 0.85).slope));
    heap_free(&heap);
    grains_free(&grains);
}

static void test_a_heap_against_a_wall_has_one_flank(void **unused)
{
    (void)unused;
    struct grains grains = empty(60000);
    struct rng rng = {4};
    while (grains.count < 30000) {
        const double x = 100 * rng_uniform(&rng), y = 40 * rng_uniform(&rng);
        if (y < 40 - 0.5 * x) put(&grains, x, y, 0.5, 0);
    }
    struct heap heap = profile(&grains, 0, 100, 100, INFINITY);
    const struct heap_slope slope = heap_slope(&heap, 0.15, 0.85);
    CHECK(isnan(slope.left));
    CHECK_NEAR(slope.slope, 0.5, 0.015);
    heap_free(&heap);
    grains_free(&grains);
}

/* The curve of eq. 8 itself, as a dense row of small discs whose upper rim it is. */
static void test_the_tail_of_a_heap_is_that_of_the_equation(void **unused)
{
    (void)unused;
    const struct heap_tail wanted = {.slope = 0.54, .tail = 15, .height = 80, .middle = 7};
    struct grains grains = empty(60000);
    for (double h = 1; h < 80; h *= 1.0002) {
        const double x = heap_tail_x(&wanted, h);
        put(&grains, 7 + x, h - 0.02, 0.02, 0);
        put(&grains, 7 - x, h - 0.02, 0.02, 0);
    }
    struct heap heap = profile(&grains, -300, 314, 614, INFINITY);
    struct heap_tail tail;
    struct error error;
    CHECK(heap_tail(&heap, 2, 0.95, &tail, &error));
    print_message("m %.4f +- %.4f, l/r %.3f +- %.3f, hm %.2f +- %.2f, middle %.2f\n", tail.slope,
                  tail.slope_error, tail.tail, tail.tail_error, tail.height, tail.height_error,
                  tail.middle);
    /* A bin tells the height at its middle to half of its width times the slope at most: 0.3 of 80;
     * the middle is known to a quarter of a bin.  1 % of everything. */
    CHECK_NEAR(tail.slope, 0.54, 0.0054);
    CHECK_NEAR(tail.tail, 15, 0.15);
    CHECK_NEAR(tail.height, 80, 0.8);
    CHECK_NEAR(tail.middle, 7, 0.3);
    CHECK(tail.rms < 0.3 && tail.rms_line > 2);
    heap_free(&heap);
    grains_free(&grains);
}

static void test_the_tails_errors_are_those_of_its_scatter(void **unused)
{
    (void)unused;
    /* The same with heights rough by +-1: over many seeds the fitted values scatter by what each fit
     * tells of itself.  Errors of errors over 40 seeds are 11 %: three of these, and 10 % as the
     * roughness is of h, the fit of x. */
    enum { SEEDS = 40 };
    const struct heap_tail wanted = {.slope = 0.54, .tail = 15, .height = 80};
    double sum = 0, squares = 0, told = 0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        struct rng rng = {seed};
        struct heap heap = {.x0 = 0, .width = 1, .bins = 260};
        struct heap_tail tail;
        struct error error;
        heap.height = calloc(heap.bins, sizeof *heap.height);
        for (uint32_t b = 0; b < heap.bins; b++) {
            double low = 0.01, high = 80;
            while (high - low > 1e-9) {         /* x falls with h */
                const double h = 0.5 * (low + high);
                if (heap_tail_x(&wanted, h) > fabs(b + 0.5 - 130)) low = h;
                else high = h;
            }
            heap.height[b] = low + 0.5 * rng_normal(&rng);
        }
        CHECK(heap_tail(&heap, 10, 0.95, &tail, &error));
        sum += tail.slope / SEEDS;
        squares += tail.slope * tail.slope / SEEDS;
        told += tail.slope_error / SEEDS;
        heap_free(&heap);
    }
    const double scatter = sqrt(squares - sum * sum);
    print_message("m %.4f, scatter %.4f, told %.4f\n", sum, scatter, told);
    CHECK_NEAR(sum, 0.54, 0.03);
    CHECK_NEAR(scatter / told, 1, 0.45);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_cone_has_the_slope_it_was_built_with),
        cmocka_unit_test(test_falling_grains_and_strays_are_no_part_of_the_heap),
        cmocka_unit_test(test_the_profile_is_the_upper_rim_of_the_discs),
        cmocka_unit_test(test_a_heap_against_a_wall_has_one_flank),
        cmocka_unit_test(test_the_tail_of_a_heap_is_that_of_the_equation),
        cmocka_unit_test(test_the_tails_errors_are_those_of_its_scatter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
