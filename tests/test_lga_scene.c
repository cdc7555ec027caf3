/* test_lga_scene.c - a scene's walls, times and units become those of the lattice, and no grain
 * finds a way through.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "check.h"
#include "model/simulation.h"

static struct scene *load(const char *text, const char *const *overrides, uint32_t count)
{
    static struct findings findings;
    const struct key_group *groups[MODEL_MAX];
    findings = (struct findings){0};
    const struct scene_request request = {.path = "test", .text = text, .groups = groups,
        .overrides = overrides, .override_count = count, .group_count = model_settings(groups),
        .place = true};
    struct scene *scene = scene_load(&request, &findings);
    if (!scene) fail_msg("%s", findings.list[0].text);
    for (uint32_t p = 0; p < scene->phase_count; p++) {
        model_find("lga")->resolve(scene->phases[p], &findings);
    }
    if (findings.errors) fail_msg("%s", findings.list[findings.count - 1].text);
    return scene;
}

static struct simulation start(const struct scene *scene)
{
    struct simulation sim;
    struct error error;
    if (!simulation_create(&sim, model_find("lga"), scene, &error)) fail_msg("%s", error.text);
    return sim;
}

static struct grains look(const struct simulation *sim)
{
    struct grains grains;
    CHECK(grains_create(&grains, 10000, 0, NULL));
    simulation_observe(sim, &grains);
    CHECK(grains.missed == 0);
    return grains;
}

#define GAS "until = 1000.0; box = [-20.0, -20.0, 20.0, 20.0]; seed = 4;"                          \
            "grains = ({ radius = 0.5; restitution = 1.0; });"

static void test_nothing_leaks_through_walls_however_thin_or_inclined(void **unused)
{
    (void)unused;
    /* A gas in a closed polygon whose sides have no thickness and no angle of the lattice.  In
     * hundreds of ticks at one spacing each a gap would be found. */
    static const char text[] = GAS
        "placements = ({ region = [-8.0, -8.0, 8.0, 8.0]; kind = \"square\"; spacing = 1.6;"
        "                temperature = 1.0; });"
        "walls = ({ shape = \"polyline\"; points = ((-13.0, -11.0), (11.0, -14.0), (15.1, 2.3),"
        "           (3.7, 14.9), (-12.9, 11.2), (-13.0, -11.0)); });";
    static const char *const turned[] = {"lga.orientation=\"H\"", "lga.spacing=1.7"};
    for (uint32_t variant = 0; variant < 3; variant++) {
        struct scene *scene = load(text, turned, variant);
        struct simulation sim = start(scene);
        CHECK(simulation_advance(&sim, 1000, UINT64_MAX, NULL) == ADVANCE_REACHED);
        CHECK(simulation_count(&sim).steps > 300);
        struct grains grains = look(&sim);
        assert_int_equal(grains.count, scene->placed.count);
        double reach = 0;
        for (uint32_t i = 0; i < grains.count; i++) {
            for (uint32_t w = 0; w < scene->wall_count; w++) {
                const struct wall *wall = &scene->walls[w];
                if (wall->border) continue;
                /* The corners go round counter-clockwise: inside is to the left of each side. */
                const double cross = (wall->x1 - wall->x0) * (grains.y[i] - wall->y0)
                                   - (wall->y1 - wall->y0) * (grains.x[i] - wall->x0);
                CHECK(cross > 0);
            }
            reach = fmax(reach, hypot(grains.x[i], grains.y[i]));
        }
        CHECK(reach > 11);              /* the gas has spread to the walls */
        grains_free(&grains);
        simulation_destroy(&sim);
        scene_free(scene);
    }
}

static void test_a_grain_falls_straight_down_at_one_spacing_a_tick(void **unused)
{
    (void)unused;
    static const char text[] = "until = 100.0; box = [-10.0, 0.0, 10.0, 60.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.5; });"
        "placements = ({ region = [-1.0, 54.0, 1.0, 56.0]; count = 1; });"
        "lga = { spacing = 2.0; tick = 0.5; g = 1.0; };";
    struct scene *scene = load(text, NULL, 0);
    struct simulation sim = start(scene);
    struct grains before = look(&sim);
    CHECK(before.count == 1 && before.vx[0] == 0 && before.vy[0] == 0);
    /* It is put onto the nearest node, at most spacing / sqrt(3) away. */
    CHECK(hypot(before.x[0] - scene->placed.x[0], before.y[0] - scene->placed.y[0])
          <= 2 / sqrt(3) + 1e-9);
    CHECK_NEAR(before.radius[0], 2 / (2 * sqrt(7)), 1e-12);
    CHECK(simulation_advance(&sim, 5, UINT64_MAX, NULL) == ADVANCE_REACHED);
    struct grains after = look(&sim);
    CHECK_NEAR(after.time, 5, 1e-12);
    CHECK_NEAR(after.vy[0], -2 / 0.5, 1e-12);
    CHECK_NEAR(after.vx[0], 0, 1e-12);
    /* Ten ticks down; a flying grain is drawn at most spacing / sqrt(7) from its node. */
    CHECK_NEAR(after.y[0], before.y[0] - 20, 2 / sqrt(7) + 1e-9);
    CHECK_NEAR(after.x[0], before.x[0], 2 / sqrt(7) + 1e-9);
    const struct counters counters = simulation_count(&sim);
    CHECK_NEAR(counters.kinetic_energy, 0.5 * M_PI * 0.25 * 16, 1e-9);
    CHECK_NEAR(counters.momentum_y, -M_PI * 0.25 * 4, 1e-9);
    grains_free(&before);
    grains_free(&after);
    simulation_destroy(&sim);
    scene_free(scene);
}

static void test_a_default_fall_takes_as_long_as_free_fall(void **unused)
{
    (void)unused;
    /* From top to bottom of a box of height 50 under gravity 1: sqrt(2 * 50) = 10. */
    static const char text[] = "until = 100.0; box = [-10.0, 0.0, 10.0, 50.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.5; });"
        "placements = ({ region = [-1.0, 44.0, 1.0, 46.0]; count = 1; }); lga = { g = 1.0; };";
    struct scene *scene = load(text, NULL, 0);
    struct simulation sim = start(scene);
    simulation_advance(&sim, 5, UINT64_MAX, NULL);
    struct grains grains = look(&sim);
    CHECK_NEAR(grains.vy[0], -50 / 10.0, 1e-9);
    grains_free(&grains);
    simulation_destroy(&sim);
    scene_free(scene);
}

static void test_grains_at_rest_are_packed_without_overlap(void **unused)
{
    (void)unused;
    static const char text[] = GAS "placements = ({ region = [-18.0, -19.0, 18.0, 0.0];"
                                   "                spacing = 1.02; });";
    struct scene *scene = load(text, NULL, 0);
    struct simulation sim = start(scene);
    struct grains grains = look(&sim);
    CHECK(grains.count > 500);
    double nearest = INFINITY;
    for (uint32_t i = 0; i < grains.count; i++) {
        for (uint32_t j = 0; j < i; j++) {
            nearest = fmin(nearest, hypot(grains.x[i] - grains.x[j], grains.y[i] - grains.y[j]));
        }
    }
    CHECK_NEAR(nearest, 1, 1e-9);       /* the places form one triangular lattice of discs */
    grains_free(&grains);
    simulation_destroy(&sim);
    scene_free(scene);
}

static void test_a_sample_holds_what_the_list_of_grains_holds(void **unused)
{
    (void)unused;
    /* Cells of the size of the box: the sums over all grains, to rounding.  Then cells of five
     * diameters: a grain is listed beside its node, at most one diameter away, to either side; half
     * of that is allowed for the mean place of all. */
    static const char *const methods[] = {"lga.method=\"gmlg\"", "lga.method=\"fhp2\"",
                                          "lga.orientation=\"H\""};
    for (uint32_t m = 0; m < 3; m++) {
        struct scene *scene = load("until = 100.0; box = [-20.0, -20.0, 20.0, 20.0];"
            "gravity = (0.0, -0.1); grains = ({ radius = 0.5; restitution = 0.5; });"
            "placements = ({ region = [-15.0, -19.0, 18.0, 0.0]; spacing = 1.2; temperature = 1.0;"
            "});", methods + m, 1);
        struct simulation sim = start(scene);
        simulation_advance(&sim, 5, UINT64_MAX, NULL);
        const struct counters counters = simulation_count(&sim);
        struct grains grains = look(&sim);
        double mean[2] = {0}, sampled[2] = {0}, sum[SAMPLE_COMPONENTS] = {0};
        struct field field;
        CHECK(field_create(&field, -20, -20, 5, 8, 8, SAMPLE_COMPONENTS, NULL));
        CHECK(sim.model->sample(sim.state, &field));
        for (int k = 0; k < 64; k++) {
            for (int c = 0; c < SAMPLE_COMPONENTS; c++) sum[c] += field.values[c * 64 + k];
            sampled[0] += field.values[k] * (-17.5 + 5 * (k % 8)) / grains.count;
            sampled[1] += field.values[k] * (-17.5 + 5 * (k / 8)) / grains.count;
        }
        for (uint32_t i = 0; i < grains.count; i++) {
            mean[0] += (-17.5 + 5 * floor((grains.x[i] + 20) / 5)) / grains.count;
            mean[1] += (-17.5 + 5 * floor((grains.y[i] + 20) / 5)) / grains.count;
        }
        CHECK_NEAR(sum[SAMPLE_COUNT], grains.count, 1e-9);
        CHECK_NEAR(grains_number(&grains), (double)counters.grains, 1e-9);
        CHECK_NEAR(grains_number(&(struct grains){.sample = field}),
                   (double)counters.grains, 1e-9);
        CHECK_NEAR(sum[SAMPLE_MASS], grains.count * M_PI / 4, 1e-9);
        CHECK_NEAR(sum[SAMPLE_ENERGY], 2 * counters.kinetic_energy, 1e-9);
        CHECK_NEAR(sum[SAMPLE_MOMENTUM_X], counters.momentum_x, 1e-9);
        CHECK_NEAR(sum[SAMPLE_MOMENTUM_Y], counters.momentum_y, 1e-9);
        CHECK(counters.kinetic_energy > 0);
        for (int k = 0; k < 2; k++) CHECK_NEAR(sampled[k], mean[k], 0.5);
        field_free(&field);
        grains_free(&grains);
        simulation_destroy(&sim);
        scene_free(scene);
    }
}

static uint32_t grains_below(const struct simulation *sim, double y)
{
    struct grains grains = look(sim);
    uint32_t below = 0;
    for (uint32_t i = 0; i < grains.count; i++) below += grains.y[i] < y;
    grains_free(&grains);
    return below;
}

static void test_a_gate_holds_opens_and_closes_upon_grains(void **unused)
{
    (void)unused;
    static const char text[] = "until = 100.0; box = [-15.0, 0.0, 15.0, 40.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.5; });"
        "placements = ({ region = [-14.0, 21.0, 14.0, 38.0]; spacing = 1.2; });"
        "walls = ({ shape = \"segment\"; points = ((-15.0, 20.0), (15.0, 20.0));"
        "           opens = 20.0; closes = 26.0; });";
    struct scene *scene = load(text, NULL, 0);
    struct simulation sim = start(scene);
    simulation_advance(&sim, 20, UINT64_MAX, NULL);
    assert_int_equal(grains_below(&sim, 20), 0);
    simulation_advance(&sim, 26, UINT64_MAX, NULL);
    const uint32_t fallen = grains_below(&sim, 20);
    CHECK(fallen > 50 && fallen + 50 < scene->placed.count);
    simulation_advance(&sim, 28, UINT64_MAX, NULL);     /* those in the gate were set free */
    const uint32_t shut = grains_below(&sim, 20);
    simulation_advance(&sim, 100, UINT64_MAX, NULL);
    assert_int_equal(grains_below(&sim, 20), shut);
    assert_int_equal(simulation_count(&sim).grains, scene->placed.count);
    simulation_destroy(&sim);
    scene_free(scene);
}

static void test_time_goes_on_where_a_phase_ticks_otherwise(void **unused)
{
    (void)unused;
    static const char text[] = GAS "placements = ({ count = 50; temperature = 1.0; });"
        "lga = { tick = 0.5; }; phases = ({ time = 5.0; set = [\"lga.tick=0.3\"]; });";
    struct scene *scene = load(text, NULL, 0);
    struct simulation sim = start(scene), resumed = start(scene);
    struct archive save, loaded;
    struct error error;
    simulation_advance(&sim, 11, UINT64_MAX, NULL);
    CHECK(simulation_count(&sim).steps == 10 + 20);
    CHECK_NEAR(simulation_count(&sim).time, 11, 1e-9);
    archive_begin_save(&save);
    CHECK(simulation_save(&sim, &save, &error));
    archive_begin_load(&loaded, save.bytes, save.size);
    CHECK(simulation_load(&resumed, &loaded, &error));
    CHECK_NEAR(simulation_count(&resumed).time, 11, 1e-9);
    simulation_advance(&sim, 20, UINT64_MAX, NULL);
    simulation_advance(&resumed, 20, UINT64_MAX, NULL);
    CHECK(simulation_digest(&sim) == simulation_digest(&resumed));
    archive_end(&save);
    simulation_destroy(&sim);
    simulation_destroy(&resumed);
    scene_free(scene);
}

static void test_what_the_lattice_cannot_show_is_told(void **unused)
{
    (void)unused;
    static struct findings findings;
    struct scene *scene = load(GAS "placements = ({ count = 5; });", NULL, 0);
    const struct model *lga = model_find("lga");
    findings = (struct findings){0};
    scene->gravity[0] = 1;
    lga->resolve(scene, &findings);
    CHECK(findings.errors == 1 && strstr(findings.list[0].text, "-y"));
    scene->gravity[0] = 0.1;
    scene->gravity[1] = -1;
    findings = (struct findings){0};
    lga->resolve(scene, &findings);
    CHECK(findings.errors == 0 && findings.warnings == 1);
    scene_free(scene);
    /* More grains than seven a node. */
    static const char *const coarse[] = {"lga.spacing=8"};
    scene = load("until = 1.0; box = [0.0, 0.0, 20.0, 20.0];"
                 "grains = ({ radius = 0.5; restitution = 0.5; }); placements = ({ });", coarse, 1);
    struct simulation sim;
    struct error error = {.text = ""};
    CHECK(scene->placed.count > 100);
    CHECK(!simulation_create(&sim, lga, scene, &error));
    CHECK(error.code == EXIT_SCENE && strstr(error.text, "lga.spacing"));
    scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_leaks_through_walls_however_thin_or_inclined),
        cmocka_unit_test(test_a_grain_falls_straight_down_at_one_spacing_a_tick),
        cmocka_unit_test(test_a_default_fall_takes_as_long_as_free_fall),
        cmocka_unit_test(test_grains_at_rest_are_packed_without_overlap),
        cmocka_unit_test(test_a_sample_holds_what_the_list_of_grains_holds),
        cmocka_unit_test(test_a_gate_holds_opens_and_closes_upon_grains),
        cmocka_unit_test(test_time_goes_on_where_a_phase_ticks_otherwise),
        cmocka_unit_test(test_what_the_lattice_cannot_show_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
