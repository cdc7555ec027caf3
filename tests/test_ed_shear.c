/* test_ed_shear.c - hard discs under Lees-Edwards shear: the lattice of images, the stationary
 * state, and what must not depend on how a run is cut into pieces.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

#include "measure/stress.h"

#define PERIODIC                                                                        \
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"

/* 1,146 discs, d = m = 1, area fraction 1/4, r = 0.9, at about the temperature they keep. */
#define SHEARED(rate)                                                                   \
    "until = 1000.0; seed = 3; box = [0.0, 0.0, 60.0, 60.0];" PERIODIC                  \
    "shear_rate = " #rate ";"                                                           \
    "grains = ({ radius = 0.5; restitution = 0.9; density = 1.2732395447351628; });"    \
    "placements = ({ kind = \"random\"; fraction = 0.25; temperature = 1.75; });"       \
    "ed = { t_c = 0.0; }; measure = { stress = true; cell = 10.0; };"

/* The smallest distance of two centres, by every pair and the images around. */
static double nearest(const struct scenes_run *run)
{
    struct grains g = scenes_look(run);
    const double *box = run->scene->box, lx = box[2] - box[0], ly = box[3] - box[1];
    const double ahead = fmod(run->scene->shear_rate * ly * g.time, lx);
    double nearest2 = INFINITY;
    for (uint32_t i = 0; i < g.count; i++) {
        CHECK(g.x[i] >= box[0] && g.x[i] <= box[2] && g.y[i] >= box[1] && g.y[i] <= box[3]);
        for (uint32_t j = 0; j < i; j++) {
            for (int up = -1; up <= 1; up++) {
                const double dy = g.y[i] - g.y[j] - up * ly;
                double dx = g.x[i] - g.x[j] - up * ahead;
                dx -= lx * rint(dx / lx);
                nearest2 = fmin(nearest2, dx * dx + dy * dy);
            }
        }
    }
    grains_free(&g);
    return sqrt(nearest2);
}

static void test_a_free_grain_flies_straight_through_the_sliding_images(void **unused)
{
    (void)unused;
    /* In the lattice of images the grain goes straight on: n boxes up the image is n U t ahead and
     * n U faster.  After t = 123,456.7 the image has slid through 133,745 periods. */
    const double t = 123456.7, u = 1.3 * 10;
    struct scenes_run *run = scenes_begin("until = 1e6; box = [0.0, 0.0, 12.0, 10.0];" PERIODIC
        "shear_rate = 1.3; grains = ({ radius = 0.5; restitution = 1.0; });"
        "placements = ({ region = [2.0, 4.5, 3.0, 5.5]; kind = \"square\"; count = 1;"
        "                velocity = (0.25, 0.0003); });", "ed");
    scenes_advance(run, t);
    struct grains g = scenes_look(run);
    const double y = 5 + 0.0003 * t, up = floor(y / 10);
    CHECK_NEAR(up, 4, 0);
    const double x = 2.5 + fmod(0.25 * t, 12) - up * fmod(u * t, 12);
    /* 4 U t = 6.4e6 in the reference, so its own last digit is 1e-9. */
    CHECK_NEAR(g.x[0], x - 12 * floor(x / 12), 1e-8);
    CHECK_NEAR(g.y[0], y - 10 * up, 1e-9);
    CHECK_NEAR(g.vx[0], 0.25 - up * u, 1e-12);
    CHECK_NEAR(g.vy[0], 0.0003, 1e-15);
    grains_free(&g);
    scenes_end(run);
}

static void test_grains_never_overlap_across_the_sliding_seam(void **unused)
{
    (void)unused;
    const char *const scenes[] = {SHEARED(1.0), SHEARED(-0.3)};
    for (int k = 0; k < 2; k++) {
        struct scenes_run *run = scenes_begin(scenes[k], "ed");
        for (int turn = 1; turn <= 20; turn++) {
            scenes_advance(run, 0.37 * turn);
            CHECK(nearest(run) > 1 - 1e-9);
        }
        CHECK(simulation_count(&run->sim).collisions > 5000);
        scenes_end(run);
    }
}

static void test_a_sheared_gas_keeps_the_known_temperature_and_stress(void **unused)
{
    (void)unused;
    enum { FROM = 40, ROWS = 1000 };
    static const double area = 3600, rate = 0.5, step = 0.2;
    struct scenes_run *run = scenes_begin(SHEARED(0.5), "ed");
    scenes_advance(run, FROM);
    const double before[2] = {simulation_tally(&run->sim)->stress.total[1],
                              simulation_tally(&run->sim)->stress.total[2]};
    double temperature = 0, stress = 0, slope = 0;
    for (int row = 1; row <= ROWS; row++) {
        scenes_advance(run, FROM + step * row);
        struct grains g, *const picture = &g;
        CHECK(grains_create(picture, 1200, 0, NULL));
        simulation_observe(&run->sim, picture);
        double part[3], xy = 0, yy = 0;
        stress_kinetic(picture, run->scene, part);
        temperature -= 0.5 * (part[0] + part[2]) * area / g.count / ROWS;
        stress += part[1] / ROWS;
        for (uint32_t i = 0; i < g.count; i++) {
            xy += g.vx[i] * (g.y[i] - 30);
            yy += (g.y[i] - 30) * (g.y[i] - 30);
        }
        slope += xy / yy / ROWS;
        grains_free(picture);
    }
    for (int k = 0; k < 2; k++) {
        stress += 0.5 * (simulation_tally(&run->sim)->stress.total[1 + k] - before[k])
                / (step * ROWS * area);
    }
    /* MODELS section 3, from soft discs: T = 7.05(5) rate^2, Sxy = 1.045(10) rate^2, 4 %.  Here a
     * run of 200 scatters by 0.8 % and 1 %. */
    CHECK_NEAR(temperature / (rate * rate), 7.05, 0.04 * 7.05);
    CHECK_NEAR(stress / (rate * rate), 1.045, 0.04 * 1.045);
    CHECK_NEAR(slope / rate, 1, 0.03);
    scenes_end(run);
}

static void test_pieces_looks_and_saving_change_no_byte(void **unused)
{
    (void)unused;
    struct scenes_run *whole = scenes_begin(SHEARED(0.7), "ed"),
                      *pieces = scenes_begin(SHEARED(0.7), "ed"),
                      *later = scenes_begin(SHEARED(0.7), "ed");
    scenes_advance(whole, 17);
    for (int k = 1; k <= 17; k++) {
        scenes_advance(pieces, k);
        struct grains g = scenes_look(pieces);
        grains_free(&g);
        if (k != 9) continue;
        struct archive save, load;
        struct error error = {0};
        archive_begin_save(&save);
        CHECK(simulation_save(&pieces->sim, &save, &error));
        archive_begin_load(&load, save.bytes, save.size);
        CHECK(simulation_load(&later->sim, &load, &error));
        archive_end(&save);
    }
    scenes_advance(later, 17);
    CHECK(simulation_digest(&pieces->sim) == simulation_digest(&whole->sim));
    CHECK(simulation_digest(&later->sim) == simulation_digest(&whole->sim));
    scenes_end(whole);
    scenes_end(pieces);
    scenes_end(later);
}

static void test_shear_may_begin_turn_round_and_end_without_overlap(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 30.0; box = [0.0, 0.0, 24.0, 20.0];" PERIODIC
        "grains = ({ radius = 0.5; restitution = 1.0; density = 1.2732395447351628; });"
        "placements = ({ kind = \"random\"; fraction = 0.5; temperature = 1.0; });"
        "phases = ({ time = 3.0; set = [\"shear_rate=0.4\"]; },"
        "          { time = 6.0; set = [\"shear_rate=-0.7\"]; },"
        "          { time = 9.0; set = [\"shear_rate=0.0\"]; });", "ed");
    scenes_advance(run, 12);
    /* The images stay where they were led: 0.4 * 20 * 3 - 0.7 * 20 * 3 = -18, or 6 ahead. */
    struct grains g = scenes_look(run);
    double worst = INFINITY;
    for (uint32_t i = 0; i < g.count; i++) {
        for (uint32_t j = 0; j < i; j++) {
            const double up = rint((g.y[i] - g.y[j]) / 20), dy = g.y[i] - g.y[j] - 20 * up;
            double dx = g.x[i] - g.x[j] - 6 * up;
            dx -= 24 * rint(dx / 24);
            worst = fmin(worst, sqrt(dx * dx + dy * dy));
        }
    }
    CHECK(worst > 1 - 1e-9);
    const double before = simulation_count(&run->sim).kinetic_energy;
    scenes_advance(run, 20);
    CHECK_NEAR(simulation_count(&run->sim).kinetic_energy / before, 1, 1e-12);
    grains_free(&g);
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_free_grain_flies_straight_through_the_sliding_images),
        cmocka_unit_test(test_grains_never_overlap_across_the_sliding_seam),
        cmocka_unit_test(test_a_sheared_gas_keeps_the_known_temperature_and_stress),
        cmocka_unit_test(test_pieces_looks_and_saving_change_no_byte),
        cmocka_unit_test(test_shear_may_begin_turn_round_and_end_without_overlap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
