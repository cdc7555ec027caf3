/* test_ed_md.c - hard and soft discs agree where they must: in a dilute gas that cools.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

enum { SEEDS = 40, SIDE = 32 };

/* Energy left at two times, of 1024 discs at a volume fraction of 0.1 with r = 0.9. */
static void cool(const char *model, int seed, double left[2])
{
    /* d = m = 1, T = 1.  A soft contact lasts pi sqrt(m / 2k) = 7e-3; free flights some 2. */
    const double spacing = sqrt(M_PI / 4 / 0.1), length = SIDE * spacing;
    char text[900];
    snprintf(text, sizeof text, "until = 100.0; seed = %d; box = [0.0, 0.0, %.15g, %.15g];"
        "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
        "grains = ({ radius = 0.5; density = 1.2732395447351628; restitution = 0.9;"
        "            stiffness = 1e5; });"
        "placements = ({ kind = \"square\"; spacing = %.15g; count = %d; temperature = 1.0; });"
        "ed = { t_c = 1e-6; };", seed, length, length, spacing * (1 - 1e-9), SIDE * SIDE);
    struct scenes_run *run = scenes_begin(text, model);
    CHECK(run->scene->placed.count == SIDE * SIDE);
    const double start = simulation_count(&run->sim).kinetic_energy;
    for (int k = 0; k < 2; k++) {
        scenes_advance(run, 8.0 * (k + 1));
        left[k] = simulation_count(&run->sim).kinetic_energy / start;
    }
    scenes_end(run);
}

static void test_a_dilute_gas_cools_alike_with_hard_and_soft_discs(void **unused)
{
    (void)unused;
    double sum[2] = {0}, sum2[2] = {0}, level[2] = {0};
    for (int seed = 1; seed <= SEEDS; seed++) {
        double hard[2], soft[2];
        cool("ed", seed, hard);
        cool("md", seed, soft);
        for (int k = 0; k < 2; k++) {
            const double ratio = soft[k] / hard[k];
            sum[k] += ratio;
            sum2[k] += ratio * ratio;
            level[k] += hard[k] / SEEDS;
        }
    }
    for (int k = 0; k < 2; k++) {
        const double mean = sum[k] / SEEDS;
        const double error = sqrt((sum2[k] / SEEDS - mean * mean) / (SEEDS - 1));
        print_message("t = %d: left %.4f, soft / hard = %.4f +- %.4f\n", 8 * (k + 1), level[k],
                      mean, error);
        CHECK(level[k] < 0.8 && level[k] > 0.1);
        CHECK(error < 0.006);
        /* Three standard errors.  A contact that lasts 7e-3 delays each collision of a grain by
         * that of the 2 between two: 0.35 % of the rate, and less of E while d ln E / d ln t < 1.
         * As large a share of the grains is in contact and holds some of its energy there. */
        CHECK_NEAR(mean, 1, 3 * error + 0.005);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_dilute_gas_cools_alike_with_hard_and_soft_discs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
