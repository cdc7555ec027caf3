/* test_ed_gas.c - many hard discs: collision rate and cooling against kinetic theory and MODELS
 * section 2, at a size that takes a second.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "ed_gas.h"

static void test_elastic_collisions_come_at_enskogs_rate(void **unused)
{
    (void)unused;
    struct scenes_run *run = ed_gas_begin(50, 0.25, 1, 1e5, 7, 0);
    const double omega = ed_gas_enskog(0.25, 1);
    scenes_advance(run, 20 / omega);
    const struct counters a = simulation_count(&run->sim);
    scenes_advance(run, 120 / omega);
    const struct counters b = simulation_count(&run->sim);
    const double rate = 2 * (double)(b.collisions - a.collisions) / 2500 / (b.time - a.time);
    /* 0.997 at 99,856 grains; 125,000 collisions scatter by 1/sqrt(125,000) = 0.3 %, and the finite
     * box shifts the pair correlation by 1/N.  Three deviations. */
    CHECK_NEAR(rate / omega, 0.997, 0.009);
    scenes_end(run);
}

static void test_a_lossy_gas_cools_as_known(void **unused)
{
    (void)unused;
    enum { RUNS = 3, SIDE = 60 };
    const double omega = ed_gas_enskog(0.25, 1), t0 = ed_gas_cooling_time(0.25, 1, 0.8);
    double early = 0, late = 0;
    for (uint64_t seed = 1; seed <= RUNS; seed++) {
        struct scenes_run *run = ed_gas_begin(SIDE, 0.25, 0.8, 10 / omega, seed, 0);
        scenes_advance(run, 10 / omega);
        const double k0 = simulation_count(&run->sim).kinetic_energy;
        scenes_advance(run, 10 / omega + 0.25 * t0);
        early += simulation_count(&run->sim).kinetic_energy / k0 / RUNS;
        scenes_advance(run, 10 / omega + t0);
        late += simulation_count(&run->sim).kinetic_energy / k0 / RUNS;
        scenes_end(run);
    }
    /* References at 99,856 grains: 0.6442(6) and 0.2649(3).  The deviation goes as 1/sqrt(N): with
     * 3 runs of 3600 three times as large, 0.3 %; three of them, and the 0.5 % and 1 % of the
     * reference. */
    CHECK_NEAR(early, 0.6442, 0.6442 * 0.014);
    CHECK_NEAR(late, 0.2649, 0.2649 * 0.02);
}

static void test_dense_discs_never_overlap_in_a_million_collisions(void **unused)
{
    (void)unused;
    struct scenes_run *run = ed_gas_begin(20, 0.7, 1, 1e5, 3, 0);
    const struct counters a = simulation_count(&run->sim);
    for (int turn = 1; turn <= 10; turn++) {
        scenes_advance(run, 25.0 * turn);
        CHECK(ed_gas_nearest(run) > 1 - 1e-9);
    }
    const struct counters b = simulation_count(&run->sim);
    CHECK(b.collisions > 1000000);
    CHECK_NEAR(b.kinetic_energy / a.kinetic_energy, 1, 1e-12);
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_elastic_collisions_come_at_enskogs_rate),
        cmocka_unit_test(test_a_lossy_gas_cools_as_known),
        cmocka_unit_test(test_dense_discs_never_overlap_in_a_million_collisions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
