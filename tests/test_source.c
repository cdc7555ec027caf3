/* test_source.c - grains that enter: a pure function of seed, source and number.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes.h"

#include "model/source.h"

static struct scene *stream(void)
{
    static struct findings findings;
    struct scene *scene = scenes_load(
        "until = 1.0; box = [-10.0, -10.0, 10.0, 10.0]; units = \"cgs\"; seed = 7;"
        "left = \"open\"; right = \"open\"; top = \"open\"; bottom = \"open\";"
        "grains = ({ radius = [0.05, 0.11]; restitution = 0.9; });"
        "sources = ({ kind = \"stream\"; position = (-9.0, 0.0); width = 16.0;"
        "             velocity = (500.0, 0.0); density = 1.0; jitter = 0.02; },"
        "           { kind = \"point\"; position = (0.0, 5.0); width = 2.0; rate = 100.0;"
        "             velocity = (0.0, -1.0); from = 0.5; count = 30; });", "md", &findings);
    if (!scene) fail_msg("%s", findings.list[0].text);
    return scene;
}

static void test_columns_have_the_spacing_of_the_stream(void **unused)
{
    (void)unused;
    struct scene *scene = stream();
    struct source_grain grains[400];
    const uint32_t room = source_batch_max(scene);
    CHECK(room <= 400);
    double gaps = 0, count = 0, radii = 0, first = 0;
    for (uint64_t k = 0; k < 200; k++) {
        CHECK_NEAR(source_time(scene, 0, k), (double)k * 0.22 / 500, 1e-12);    /* 2 R_max / v */
        const uint32_t n = source_batch(scene, 0, k, grains, room);
        double low = 99, high = -99;
        for (uint32_t i = 0; i < n; i++) {
            CHECK_NEAR(grains[i].x, -9, 1e-12);
            CHECK(fabs(grains[i].y) <= 8 && grains[i].radius >= 0.05 && grains[i].radius <= 0.11);
            low = fmin(low, grains[i].y);
            high = fmax(high, grains[i].y);
            radii += grains[i].radius;
            for (uint32_t j = 0; j < i; j++) {
                CHECK(fabs(grains[i].y - grains[j].y) >= grains[i].radius + grains[j].radius
                                                             - 1e-12);
            }
        }
        gaps += high - low;
        count += n;
        first += grains[0].y;
    }
    /* MODELS errata: mean spacing 0.22 cm; 14,000 gaps of deviation 0.0044. */
    CHECK_NEAR(gaps / (count - 200), 0.22, 3e-4);
    CHECK_NEAR(radii / count, 0.08, 3 * 0.06 / sqrt(12 * count));
    CHECK_NEAR(first / 200, 0, 3 * 16 / sqrt(12 * 200));
    scene_free(scene);
}

static void test_a_batch_depends_on_nothing_but_its_number(void **unused)
{
    (void)unused;
    struct scene *scene = stream();
    struct source_grain a[400], b[400];
    const uint32_t n = source_batch(scene, 0, 17, a, 400);
    source_batch(scene, 0, 18, b, 400);
    CHECK(memcmp(a, b, sizeof *a) != 0);
    CHECK(source_batch(scene, 0, 17, b, 400) == n);
    for (uint32_t i = 0; i < n; i++) CHECK(a[i].y == b[i].y && a[i].radius == b[i].radius);
    scene_free(scene);
}

static void test_a_point_source_keeps_its_rate_its_time_and_its_number(void **unused)
{
    (void)unused;
    struct scene *scene = stream();
    struct source_cursor cursor = {0};
    CHECK_NEAR(source_due(scene, 1, &cursor), 0.5, 1e-12);
    cursor = (struct source_cursor){.next = 20, .made = 20};
    CHECK_NEAR(source_due(scene, 1, &cursor), 0.7, 1e-12);
    cursor = (struct source_cursor){.next = 30, .made = 30};
    CHECK(source_due(scene, 1, &cursor) == INFINITY);
    for (uint64_t k = 0; k < 30; k++) {
        struct source_grain g;
        CHECK(source_batch(scene, 1, k, &g, 1) == 1);
        CHECK(fabs(g.x) <= 1 && g.y == 5 && g.vy == -1);
    }
    scene_free(scene);
}

static void test_md_lets_the_stream_in_and_records_it_at_the_screen(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin(
        "until = 1.0; box = [-3.0, -3.0, 3.0, 3.0]; units = \"cgs\"; seed = 7;"
        "left = \"open\"; right = \"open\"; top = \"open\"; bottom = \"open\";"
        "grains = ({ radius = [0.05, 0.11]; restitution = 0.9; stiffness = 1e5; });"
        "sources = ({ kind = \"stream\"; position = (-2.5, 0.0); width = 2.0;"
        "             velocity = (100.0, 0.0); density = 0.5; to = 0.02; });"
        "screens = ({ kind = \"circle\"; radius = 2.7; bins = 8; });"
        "md = { dt = 1e-5; };", "md");
    scenes_advance(run, 0.01);
    struct grains g = scenes_look(run);
    for (uint32_t k = 0; k < g.count; k++) CHECK_NEAR(g.vx[k], 100, 1e-9);
    CHECK(g.count > 20);
    grains_free(&g);
    scenes_advance(run, 0.09);
    const struct counters counters = simulation_count(&run->sim);
    const struct tally *tally = simulation_tally(&run->sim);
    assert_int_equal(counters.grains, 0);
    assert_int_equal(counters.grains_in, counters.grains_out);
    CHECK_NEAR(tally->mass_in, tally->mass_out, 1e-12);
    /* All of it flies straight on, into the bins around angle 0. */
    const struct tally_screen *screen = &tally->screens[0];
    CHECK_NEAR(screen->mass[3] + screen->mass[4], tally->mass_in, 1e-9);
    CHECK_NEAR(screen->momentum[3] + screen->momentum[4], 100 * tally->mass_in, 1e-6);
    scenes_end(run);
}

static void test_a_grain_without_room_waits(void **unused)
{
    (void)unused;
    /* Discs of diameter 1 at rest are born into the same place of a closed tube, much faster
     * than they fall out of the way. */
    struct scenes_run *run = scenes_begin(
        "until = 10.0; box = [0.0, 0.0, 1.2, 12.0]; gravity = (0.0, -1.0); count_max = 40;"
        "grains = ({ radius = 0.5; restitution = 0.5; stiffness = 1e4; "
        "density = 1.2732395447351628; });"
        "sources = ({ position = (0.6, 10.0); rate = 100.0; });"
        "md = { dt = 1e-3; };", "md");
    scenes_advance(run, 1.3);
    /* A disc falls its diameter in sqrt(2): so far there is only one. */
    assert_int_equal(simulation_count(&run->sim).grains, 1);
    scenes_advance(run, 40);
    const struct counters counters = simulation_count(&run->sim);
    assert_int_equal(counters.grains, 10);                      /* 0.5 .. 9.5, then full */
    CHECK(counters.overlap_max < 0.01);
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_columns_have_the_spacing_of_the_stream),
        cmocka_unit_test(test_a_batch_depends_on_nothing_but_its_number),
        cmocka_unit_test(test_a_point_source_keeps_its_rate_its_time_and_its_number),
        cmocka_unit_test(test_md_lets_the_stream_in_and_records_it_at_the_screen),
        cmocka_unit_test(test_a_grain_without_room_waits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
