/* test_push.c - a phase may push grains and may bring new ones, in every model that can.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

#include <stdbool.h>

#define GAS "until = 2.0; box = [0.0, 0.0, 18.0, 18.0];"                                        \
            "grains = ({ radius = 0.5; restitution = 0.9; stiffness = 10000.0; });"             \
            "placements = ({ kind = \"square\"; spacing = 1.8; temperature = 1.0; });"

/* The time at which both phases of these scenes begin, and one just behind. */
static const double moment = 0.5;

static bool can_push(const struct model *model) { return model->push != NULL; }

/* Momentum right after a phase that only pushes, and the grains right before it. */
static void test_each_grain_gains_its_share_of_the_push(void **unused)
{
    (void)unused;
    uint32_t models = 0;
    for (const struct model *const *m = model_list; *m; m++) {
        if (!can_push(*m)) continue;
        models++;
        struct scenes_run *before = scenes_begin(GAS, (*m)->name);
        scenes_advance(before, moment);
        struct grains grains = scenes_look(before);
        /* A grain at distance r from (9, 9) gains (1 - r^2/16)^2 of (3, -2). */
        double gain_x = 0, gain_y = 0;
        for (uint32_t i = 0; i < grains.count; i++) {
            const double r2 = pow(grains.x[i] - 9, 2) + pow(grains.y[i] - 9, 2);
            const double share = r2 < 16 ? pow(1 - r2 / 16, 2) : 0;
            gain_x += 3 * share * grains.mass[i];
            gain_y -= 2 * share * grains.mass[i];
        }
        const struct counters then = simulation_count(&before->sim);
        struct archive archive;
        struct error error = {0};
        archive_begin_save(&archive);
        CHECK(simulation_save(&before->sim, &archive, &error));
        struct scenes_run *pushed = scenes_begin(GAS
            "phases = ({ time = 0.5; push = (9.0, 9.0, 4.0, 3.0, -2.0); });", (*m)->name);
        CHECK(simulation_enter(&before->sim, pushed->scene, 1, &archive, &error));
        const struct counters now = simulation_count(&before->sim);
        CHECK(gain_x > 0);
        /* dsmc keeps velocities in single precision, and the loss of every digit is 6e-8. */
        const double digits = 1e-6 * gain_x;
        CHECK_NEAR(now.momentum_x - then.momentum_x, gain_x, digits);
        CHECK_NEAR(now.momentum_y - then.momentum_y, gain_y, digits);
        archive_end(&archive);
        grains_free(&grains);
        /* The scene that says so from the start comes to the same bytes. */
        scenes_advance(before, 2);
        scenes_advance(pushed, 2);
        CHECK(simulation_digest(&before->sim) == simulation_digest(&pushed->sim));
        scenes_end(before);
        scenes_end(pushed);
    }
    CHECK(models >= 3);
}

static void test_a_model_without_pushes_refuses_the_scene(void **unused)
{
    (void)unused;
    struct findings findings;
    struct simulation sim;
    for (const struct model *const *m = model_list; *m; m++) {
        if (can_push(*m)) continue;
        struct scene *scene = scenes_load(GAS
            "phases = ({ time = 0.5; push = (9.0, 9.0, 4.0, 3.0, -2.0); });", (*m)->name,
            &findings);
        struct error error = {0};
        CHECK(scene != NULL);
        CHECK(!simulation_create(&sim, *m, scene, &error));
        CHECK(error.code == EXIT_SCENE);
        CHECK(strstr(error.text, "pushed") != NULL);
        scene_free(scene);
    }
}

static void test_a_push_of_four_numbers_is_refused(void **unused)
{
    (void)unused;
    struct findings findings;
    CHECK(!scenes_load(GAS "phases = ({ time = 0.5; push = (9.0, 9.0, 4.0, 3.0); });", "md",
                       &findings));
    CHECK(findings.errors == 1);
    CHECK(!scenes_load(GAS "phases = ({ time = 0.5; push = (9.0, 9.0, 0.0, 3.0, 1.0); });", "md",
                       &findings));
    CHECK(findings.errors == 1);
}

static void test_a_phase_may_bring_a_source(void **unused)
{
    (void)unused;
    static const char text[] = "until = 12.0; box = [0.0, 0.0, 18.0, 18.0];"
        "grains = ({ radius = 0.5; restitution = 0.9; stiffness = 10000.0; });"
        "placements = ({ region = [0.0, 0.0, 18.0, 4.0]; spacing = 2.0; temperature = 1.0; });"
        "sources = ({ position = (4.0, 14.0); velocity = (0.0, -3.0); rate = 2.0; count = 3; });"
        "phases = ({ time = 4.0; set = [\"sources.[1]={kind=\\\"point\\\"; position=(12.0, 14.0);"
        " velocity=(0.0, -3.0); rate=2.0; from=4.0; count=6;}\"]; });";
    uint32_t models = 0;
    for (const struct model *const *m = model_list; *m; m++) {
        if (!((*m)->effects & EFFECT_INFLOW)) continue;
        models++;
        struct scenes_run *run = scenes_begin(text, (*m)->name);
        const uint64_t placed = simulation_count(&run->sim).grains;
        scenes_advance(run, 3.9);
        CHECK(simulation_count(&run->sim).grains_in == 3);
        scenes_advance(run, 12);
        CHECK(simulation_count(&run->sim).grains_in == 9);
        CHECK(simulation_count(&run->sim).grains == placed + 9);
        scenes_end(run);
    }
    CHECK(models >= 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_grain_gains_its_share_of_the_push),
        cmocka_unit_test(test_a_model_without_pushes_refuses_the_scene),
        cmocka_unit_test(test_a_push_of_four_numbers_is_refused),
        cmocka_unit_test(test_a_phase_may_bring_a_source),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
