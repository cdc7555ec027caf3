/* test_ed_paper.c - hard discs at the papers' sizes (MODELS section 2): minutes, suite 'slow'.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "ed_gas.h"

#include "base/clock.h"

enum { SIDE = 316, GRAINS = SIDE * SIDE };      /* 99,856 */

static void test_elastic_collisions_come_at_enskogs_rate_in_the_large(void **unused)
{
    (void)unused;
    struct scenes_run *run = ed_gas_begin(SIDE, 0.25, 1, 1e5, 1, 0);
    const double omega = ed_gas_enskog(0.25, 1);
    scenes_advance(run, 20 / omega);
    const struct counters a = simulation_count(&run->sim);
    const double begun = clock_process();
    scenes_advance(run, 120 / omega);
    const struct counters b = simulation_count(&run->sim);
    const double count = (double)(b.collisions - a.collisions);
    const double rate = 2 * count / GRAINS / (b.time - a.time);
    print_message("rate / Enskog %.5f; %.0f ns a collision; energy off by %.1e, momentum by %.1e\n",
                  rate / omega, 1e9 * (clock_process() - begun) / count,
                  b.kinetic_energy / a.kinetic_energy - 1,
                  hypot(b.momentum_x - a.momentum_x, b.momentum_y - a.momentum_y));
    CHECK_NEAR(rate / omega, 0.997, 0.01);
    CHECK_NEAR(b.kinetic_energy / a.kinetic_energy, 1, 1e-12);
    scenes_end(run);
}

static void test_a_lossy_gas_cools_as_known_in_the_large(void **unused)
{
    (void)unused;
    const double omega = ed_gas_enskog(0.25, 1), t0 = ed_gas_cooling_time(0.25, 1, 0.8);
    struct scenes_run *run = ed_gas_begin(SIDE, 0.25, 0.8, 20 / omega, 2, 0);
    scenes_advance(run, 20 / omega);
    const double k0 = simulation_count(&run->sim).kinetic_energy;
    scenes_advance(run, 20 / omega + 0.25 * t0);
    const double early = simulation_count(&run->sim).kinetic_energy / k0;
    scenes_advance(run, 20 / omega + t0);
    const double late = simulation_count(&run->sim).kinetic_energy / k0;
    print_message("K/K0 at t/t0 = 0.25: %.4f (0.6442), at 1: %.4f (0.2649)\n", early, late);
    CHECK_NEAR(early, 0.6442, 0.005 * 0.6442);
    CHECK_NEAR(late, 0.2649, 0.01 * 0.2649);
    scenes_end(run);
}

/* Runs 10,000 grains to `units` of t0; tells the time reached, in t0, and whether it stopped. */
static double cool(double r, double t_c, double units, bool *broken, struct counters *end)
{
    const double omega = ed_gas_enskog(0.25, 1), t0 = ed_gas_cooling_time(0.25, 1, r);
    const double from = 10 / omega;
    struct scenes_run *run = ed_gas_begin(100, 0.25, r, from, 5, t_c);
    struct error error = {.text = ""};
    const enum advance outcome = simulation_advance(&run->sim, from + units * t0, 400000000,
                                                    &error);
    *broken = outcome == ADVANCE_BROKEN;
    if (*broken) CHECK(strstr(error.text, "ed.t_c"));
    *end = simulation_count(&run->sim);
    scenes_end(run);
    return (end->time - from) / t0;
}

static void test_collapse_comes_when_known_and_the_cut_off_carries_through(void **unused)
{
    (void)unused;
    bool broken;
    struct counters end;
    /* Plain ED, where it stops first by chance of the seed: not at r = 0.6; 16 to 74 t0 for 0.4
     * over eight seeds (14 t0 elsewhere); 0.3 to 3 t0 for 0.2 (0.5 to 1 elsewhere). */
    double t = cool(0.6, 0, 100, &broken, &end);
    print_message("r = 0.6: %.3f t0, %s\n", t, broken ? "stopped" : "went on");
    CHECK(!broken);
    t = cool(0.4, 0, 300, &broken, &end);
    print_message("r = 0.4: %.3f t0, %s\n", t, broken ? "stopped" : "went on");
    CHECK(broken && t > 5);
    t = cool(0.2, 0, 20, &broken, &end);
    print_message("r = 0.2: %.3f t0, %s\n", t, broken ? "stopped" : "went on");
    CHECK(broken && t > 0.1 && t < 10);
    static const double cut_offs[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
    double kept_min = INFINITY, kept_max = 0, met_min = INFINITY, met_max = 0;
    for (size_t k = 0; k < sizeof cut_offs / sizeof *cut_offs; k++) {
        t = cool(0.2, cut_offs[k], 20, &broken, &end);
        const double kept = end.kinetic_energy / 10000, met = 2 * (double)end.collisions / 10000;
        print_message("r = 0.2, t_c = %g: %.3f t0, K/N %.6f, %.1f collisions a grain, %.1f %% "
                      "elastic\n", cut_offs[k], t, kept, met,
                      100 * (double)end.collisions_elastic / (double)end.collisions);
        CHECK(!broken && end.collisions_elastic > 0);
        CHECK_NEAR(t, 20, 1e-6);
        kept_min = fmin(kept_min, kept);
        kept_max = fmax(kept_max, kept);
        met_min = fmin(met_min, met);
        met_max = fmax(met_max, met);
    }
    /* Elsewhere the energy moved by a few per cent, the collisions by up to seven times; these
     * runs drift apart by chance as well, by some per cent of the energy of 10,000 grains in
     * clusters. */
    CHECK(kept_max < 1.2 * kept_min);
    CHECK(met_max < 10 * met_min);
}

static void test_ten_million_collisions_leave_no_overlap(void **unused)
{
    (void)unused;
    double worst = INFINITY;
    struct scenes_run *run = ed_gas_begin(40, 0.7, 1, 1e6, 3, 0);
    const struct counters a = simulation_count(&run->sim);
    for (int turn = 1; turn <= 30; turn++) {
        scenes_advance(run, 20.0 * turn);
        worst = fmin(worst, ed_gas_nearest(run));
    }
    const struct counters b = simulation_count(&run->sim);
    print_message("%llu collisions: nearest - d = %.2e d, energy off by %.1e, momentum by %.1e\n",
                  (unsigned long long)b.collisions, worst - 1,
                  b.kinetic_energy / a.kinetic_energy - 1,
                  hypot(b.momentum_x - a.momentum_x, b.momentum_y - a.momentum_y));
    CHECK(b.collisions > 10000000);
    CHECK(worst > 1 - 1e-9);
    scenes_end(run);
}

static void test_hard_and_soft_discs_cool_alike(void **unused)
{
    (void)unused;
    enum { RUNS = 2, SIDE_BOTH = 50 };
    static const char *const models[2] = {"ed", "md"};
    const double omega = ed_gas_enskog(0.25, 1), t0 = ed_gas_cooling_time(0.25, 1, 0.8);
    double kept[2] = {0, 0}, collisions[2] = {0, 0};
    for (int m = 0; m < 2; m++) {
        for (uint64_t seed = 1; seed <= RUNS; seed++) {
            struct scenes_run *run = ed_gas_by(models[m], SIDE_BOTH, 0.25, 0.8, 5 / omega, seed, 0);
            scenes_advance(run, 5 / omega);
            const struct counters a = simulation_count(&run->sim);
            scenes_advance(run, 5 / omega + t0);
            const struct counters b = simulation_count(&run->sim);
            kept[m] += b.kinetic_energy / a.kinetic_energy / RUNS;
            collisions[m] += (double)(b.collisions - a.collisions);
            scenes_end(run);
        }
        print_message("%s: K/K0 at t0 %.4f, %.0f collisions\n", models[m], kept[m], collisions[m]);
    }
    /* Each run scatters by 2 % (1/sqrt(2500)), the mean of two by 1.4 %, the difference by 2 %.
     * Soft discs keep hold of each other for a hundredth of the time between collisions. */
    CHECK_NEAR(kept[1] / kept[0], 1, 0.05);
    CHECK_NEAR(collisions[1] / collisions[0], 1, 0.03);
}

/* Cooperative, section 5: 1562 discs on a lattice in a pipe 20.2 wide settle without loss; at 0.1 s
 * the bottom goes, and r = 0.9, mu = 0.5, beta0 = 0.2 come on. */
static struct scenes_run *pipe_begin(unsigned seed)
{
    char text[900];
    snprintf(text, sizeof text, "until = 1.0; seed = %u; units = \"cgs\";"
        "box = [0.0, -5.5, 2.02, 8.0]; bottom = \"open\"; top = \"open\"; gravity = (0, -981);"
        "grains = ({ radius = 0.05; density = 1.0; restitution = 1.0; inertia = \"sphere\"; });"
        "placements = ({ kind = \"triangular\"; spacing = 1.01; count = 1562;"
        "                region = [0.0, 0.0, 2.02, 8.0]; temperature = 1.0; });"
        "walls = ({ shape = \"segment\"; points = ((0.0, 0.0), (2.02, 0.0)); opens = 0.1; });"
        "phases = ({ time = 0.1; set = [\"grains.[0].restitution=0.9\","
        "                              \"grains.[0].friction=0.5\"]; });"
        "ed = { t_c = 1e-6; tangential = 0.2; };", seed);
    return scenes_begin(text, "ed");
}

enum { PIPES = 4, WINDOWS = 18, JOLT = 2 };     /* after the jolt with which it was let go */

/* Collisions of a grain in each of 18 windows of 5 ms after the bottom has gone. */
static void count_in_pipe(unsigned seed, double met[WINDOWS])
{
    struct scenes_run *run = pipe_begin(seed);
    CHECK(run->scene->placed.count == 1562);
    scenes_advance(run, 0.1);
    uint64_t last = simulation_count(&run->sim).collisions;
    for (int k = 0; k < WINDOWS; k++) {
        scenes_advance(run, 0.1 + 0.005 * (k + 1));
        const uint64_t now = simulation_count(&run->sim).collisions;
        met[k] = 2 * (double)(now - last) / run->scene->placed.count;
        last = now;
    }
    scenes_end(run);
}

static void test_sand_that_falls_through_a_pipe_arches(void **unused)
{
    (void)unused;
    double peaks = 0;
    for (unsigned seed = 1; seed <= PIPES; seed++) {
        double met[WINDOWS], quiet = 0, peak = 0;
        int arch = JOLT;
        count_in_pipe(seed, met);
        /* MODELS section 2: 4 to 5 before arches; an arch has three times as many. */
        while (arch < WINDOWS && met[arch] < 15) quiet += met[arch++];
        quiet /= arch - JOLT;
        for (int k = arch; k < WINDOWS; k++) peak = fmax(peak, met[k]);
        print_message("seed %u: %.1f collisions in 5 ms until %d ms, %.0f at the peak\n", seed,
                      quiet, 5 * arch, peak);
        /* 4 to 5, and as far again for what the seed does. */
        CHECK_NEAR(quiet, 4.5, 1.5);
        CHECK(5 * arch >= 30 && 5 * arch <= 60);
        peaks += peak / PIPES;
    }
    /* 170 to 320 by another program; eight seeds of this one scatter by 66, the mean of four
     * by 33. */
    CHECK(peaks > 170 - 33 && peaks < 320 + 33);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_elastic_collisions_come_at_enskogs_rate_in_the_large),
        cmocka_unit_test(test_a_lossy_gas_cools_as_known_in_the_large),
        cmocka_unit_test(test_ten_million_collisions_leave_no_overlap),
        cmocka_unit_test(test_hard_and_soft_discs_cool_alike),
        cmocka_unit_test(test_sand_that_falls_through_a_pipe_arches),
        cmocka_unit_test(test_collapse_comes_when_known_and_the_cut_off_carries_through),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
