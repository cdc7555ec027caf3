/* test_pair.c - gases and lattices have the pair correlation of the textbook.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/pair.h"

static struct grains some(uint32_t capacity)
{
    struct grains grains;
    struct error error;
    if (!grains_create(&grains, capacity, 0, &error)) fail_msg("%s", error.text);
    return grains;
}

static struct scene box(double lx, double ly, int border)
{
    struct scene scene = {.box = {0, 0, lx, ly}};
    scene.left = scene.right = scene.bottom = scene.top = border;
    return scene;
}

static struct pair correlate(const struct grains *grains, const struct scene *scene, double reach,
                             uint32_t bins)
{
    struct pair pair;
    struct error error;
    if (!pair_create(grains, scene, reach, bins, &pair, &error)) fail_msg("%s", error.text);
    return pair;
}

static void test_an_ideal_gas_has_none_with_periodic_borders_and_with_walls(void **unused)
{
    (void)unused;
    enum { COUNT = 8000, BINS = 40 };
    struct grains grains = some(COUNT);
    struct rng rng = {11};
    for (grains.count = 0; grains.count < COUNT; grains.count++) {
        grains.x[grains.count] = 100 * rng_uniform(&rng);
        grains.y[grains.count] = 60 * rng_uniform(&rng);
    }
    static const int borders[] = {BORDER_PERIODIC, BORDER_WALL};
    for (int k = 0; k < 2; k++) {
        const struct scene scene = box(100, 60, borders[k]);
        struct pair pair = correlate(&grains, &scene, 8, BINS);
        double deviation = 0;
        for (uint32_t b = 0; b < BINS; b++) {
            /* Counting errors as told; five of them, over 80 bins. */
            CHECK_NEAR(pair.g[b], 1, 5 * pair.error[b]);
            deviation += pow((pair.g[b] - 1) / pair.error[b], 2) / BINS;
        }
        /* They are honest: chi2 per bin is 1 +- sqrt(2 / 40), four of these.  With walls a pair may
         * count from one end only, so the told errors are up to sqrt(2) too large. */
        CHECK(deviation < 1.9 && deviation > 0.25);
        pair_free(&pair);
    }
    grains_free(&grains);
}

static void test_a_square_lattice_has_its_shells(void **unused)
{
    (void)unused;
    /* Spacing 1: 4 neighbours at 1, 4 at sqrt 2, 4 at 2, 8 at sqrt 5, none between, also around
     * the periodic borders.  n pairs in a ring: g = n / (density * area of the ring). */
    struct grains grains = some(400);
    for (grains.count = 0; grains.count < 400; grains.count++) {
        grains.x[grains.count] = grains.count % 20 + 0.25;
        grains.y[grains.count] = grains.count / 20 + 0.75;
    }
    const struct scene scene = box(20, 20, BORDER_PERIODIC);
    struct pair pair = correlate(&grains, &scene, 2.4, 24);
    for (uint32_t b = 0; b < 24; b++) {
        const double r0 = 0.1 * b, r1 = r0 + 0.1;
        double neighbours = 0;
        if (b == 9 || b == 10) continue;        /* rounding puts r = 1 into either bin */
        if (b == 19 || b == 20) continue;
        if (b == 14) neighbours = 4;
        if (b == 22) neighbours = 8;
        CHECK_NEAR(pair.g[b], neighbours / (M_PI * (r1 * r1 - r0 * r0)), 1e-9);
    }
    CHECK(pair.pairs[9] + pair.pairs[10] == 1600);
    CHECK(pair.pairs[19] + pair.pairs[20] == 1600);
    CHECK(pair.grains == 400);
    pair_free(&pair);
    grains_free(&grains);
}

static void test_a_reach_beyond_half_a_periodic_box_is_refused(void **unused)
{
    (void)unused;
    struct grains grains = some(2);
    struct pair pair;
    struct error error = {0};
    grains.count = 2;
    grains.x[1] = 3;
    struct scene scene = box(20, 8, BORDER_PERIODIC);
    CHECK(!pair_create(&grains, &scene, 5, 10, &pair, &error));
    CHECK(strstr(error.text, "half of the periodic box"));
    scene.bottom = scene.top = BORDER_OPEN;
    pair = correlate(&grains, &scene, 5, 10);
    pair_free(&pair);
    grains_free(&grains);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_ideal_gas_has_none_with_periodic_borders_and_with_walls),
        cmocka_unit_test(test_a_square_lattice_has_its_shells),
        cmocka_unit_test(test_a_reach_beyond_half_a_periodic_box_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
