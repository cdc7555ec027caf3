/* test_example.c - the worked examples of docs/extending.md do what their page says.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "check.h"
#include "model/simulation.h"

#include "spread.h"

extern const struct model model_dust;

static struct scene *load(const char *text, const char *path)
{
    static struct findings findings;
    static const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = path, .text = text, .groups = groups,
                                          .group_count = model_settings(groups), .place = true};
    findings = (struct findings){0};
    struct scene *scene = scene_load(&request, &findings);
    if (!scene) fail_msg("%s", findings.list[0].text);
    return scene;
}

static const char periodic[] = "until = 9.0; box = [0.0, 0.0, 10.0, 20.0]; gravity = (0.0, -1.0);"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
    "grains = ({ radius = 0.5; restitution = 1.0; });"
    "placements = ({ kind = \"square\"; count = 3; spacing = 2.0; velocity = (3.0, 4.0); });";

static void test_dust_flies_on_parabolas(void **unused)
{
    (void)unused;
    struct scene *scene = load(periodic, "test");
    struct simulation sim;
    struct grains grains;
    const double t = 2.5;
    CHECK(simulation_create(&sim, &model_dust, scene, NULL));
    CHECK(grains_create(&grains, 8, 0, NULL));
    CHECK(simulation_advance(&sim, t, UINT64_MAX, NULL) == ADVANCE_REACHED);
    simulation_observe(&sim, &grains);
    CHECK(grains.count == 3);
    for (uint32_t i = 0; i < 3; i++) {
        const double x = scene->placed.x[i] + 3 * t, y = scene->placed.y[i] + 4 * t - t * t / 2;
        /* A dozen roundings of numbers near 20. */
        CHECK_NEAR(fmod(x, 10), grains.x[i], 1e-13);
        CHECK_NEAR(fmod(y, 20), grains.y[i], 1e-13);
        CHECK_NEAR(grains.vy[i], 4 - t, 1e-15);
    }
    grains_free(&grains);
    simulation_destroy(&sim);
    scene_free(scene);
}

static void test_dust_goes_on_from_an_archive_as_if_it_had_never_stopped(void **unused)
{
    (void)unused;
    struct scene *scene = load(periodic, "test");
    struct simulation sim, other;
    struct archive saved, loaded;
    CHECK(simulation_create(&sim, &model_dust, scene, NULL));
    CHECK(simulation_create(&other, &model_dust, scene, NULL));
    simulation_advance(&sim, 1.5, UINT64_MAX, NULL);
    archive_begin_save(&saved);
    CHECK(simulation_save(&sim, &saved, NULL));
    archive_begin_load(&loaded, saved.bytes, saved.size);
    CHECK(simulation_load(&other, &loaded, NULL));
    CHECK(simulation_digest(&other) == simulation_digest(&sim));
    simulation_advance(&sim, 4, UINT64_MAX, NULL);
    CHECK(simulation_digest(&other) != simulation_digest(&sim));
    simulation_advance(&other, 3, UINT64_MAX, NULL);
    simulation_advance(&other, 4, UINT64_MAX, NULL);
    CHECK(simulation_digest(&other) == simulation_digest(&sim));
    archive_end(&saved);
    simulation_destroy(&other);
    simulation_destroy(&sim);
    scene_free(scene);
}

static void test_dust_refuses_walls_that_it_would_fly_through(void **unused)
{
    (void)unused;
    struct scene *scene = load("until = 1.0; box = [0.0, 0.0, 9.0, 9.0];"
        "grains = ({ radius = 0.5; restitution = 1.0; }); placements = ({ count = 3; });", "test");
    struct simulation sim;
    struct error error = {.text = ""};
    CHECK(!simulation_create(&sim, &model_dust, scene, &error));
    CHECK(error.code == EXIT_SCENE && strstr(error.text, "walls"));
    scene_free(scene);
}

static void test_a_cloud_of_two_is_as_wide_as_half_their_distance(void **unused)
{
    (void)unused;
    struct grains grains;
    CHECK(grains_create(&grains, 2, 0, NULL));
    CHECK(isnan(spread_of(&grains).width));
    grains.count = 2;
    grains.x[1] = 6;
    grains.y[1] = 8;                    /* a distance of 10 */
    grains.mass[0] = grains.mass[1] = 2;
    CHECK_NEAR(spread_of(&grains).width, 5, 1e-15);
    CHECK_NEAR(spread_of(&grains).y, 4, 1e-15);
    grains.mass[0] = 6;                 /* the centre at a quarter; width 10 sqrt(1/4 3/4) */
    CHECK_NEAR(spread_of(&grains).x, 1.5, 1e-15);
    CHECK_NEAR(spread_of(&grains).width, 10 * sqrt(3.0) / 4, 1e-14);
    grains_free(&grains);
}

static void test_the_grains_of_the_example_scene_roll_down_its_slope(void **unused)
{
    (void)unused;
    char path[1000];
    const char *root = getenv("SOURCE_ROOT");
    snprintf(path, sizeof path, "%s/docs/examples/slope.cfg", root ? root : ".");
    struct scene *scene = load(NULL, path);
    CHECK(scene->placed.count > 50);
    char able[200];
    model_names(scene->effects, able, sizeof able);
    CHECK(strstr(able, "md") != NULL);
    static struct findings findings;
    const struct model *md = model_find("md");
    md->resolve(scene, &findings);      /* its time step */
    CHECK(findings.errors == 0);
    struct simulation sim;
    CHECK(simulation_create(&sim, md, scene, NULL));
    CHECK(simulation_advance(&sim, 0.06, UINT64_MAX, NULL) == ADVANCE_REACHED);
    const struct counters now = simulation_count(&sim);
    CHECK(now.grains == scene->placed.count);
    CHECK(now.momentum_x > 0);          /* to the right, where the slope leads */
    CHECK(now.momentum_y < 0);
    simulation_destroy(&sim);
    scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dust_flies_on_parabolas),
        cmocka_unit_test(test_dust_goes_on_from_an_archive_as_if_it_had_never_stopped),
        cmocka_unit_test(test_dust_refuses_walls_that_it_would_fly_through),
        cmocka_unit_test(test_a_cloud_of_two_is_as_wide_as_half_their_distance),
        cmocka_unit_test(test_the_grains_of_the_example_scene_roll_down_its_slope),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
