/* test_lga_gas.c - FHP-II and the sandpile: every collision, the gas in equilibrium, and cooling.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "lga_gas.h"

enum { SIDE = 128 };

static struct lga_table table;

/* --- the table --- */

static void test_every_collision_keeps_mass_and_momentum(void **unused)
{
    (void)unused;
    for (int column = 0; column < 2; column++) {
        for (unsigned m = 0; m < LGA_STATES; m++) {
            for (int r = 0; r <= 1; r++) {
                const struct lga_case *entry = &table.sand[column][m][r];
                int weights = entry->count ? 0 : LGA_WEIGHT, x, y, x2, y2;
                lga_table_momentum(m, &x, &y);
                for (int k = 0; k < entry->count; k++) {
                    const struct lga_outcome *out = &entry->outcome[k];
                    weights += out->weight;
                    lga_table_momentum(out->moving, &x2, &y2);
                    CHECK(x == x2 && y == y2 && out->weight > 0);
                    assert_int_equal(out->rest + __builtin_popcount(out->moving),
                                     r + __builtin_popcount(m));
                }
                assert_int_equal(weights, LGA_WEIGHT);
            }
        }
    }
}

static void test_22_of_128_states_collide(void **unused)
{
    (void)unused;
    /* 3 head-on and 2 triple with or without rest grain, 6 {i} with one, 6 {i-1, i+1} without. */
    int active[2] = {0}, into[LGA_STATES][2] = {{0}};
    for (unsigned m = 0; m < LGA_STATES; m++) {
        for (int r = 0; r <= 1; r++) {
            const struct lga_case *entry = &table.sand[LGA_ELASTIC][m][r];
            active[0] += entry->count > 0;
            active[1] += table.sand[LGA_INELASTIC][m][r].count > 0;
            if (entry->count == 0) into[m][r] += LGA_WEIGHT;
            for (int k = 0; k < entry->count; k++) {
                into[entry->outcome[k].moving][entry->outcome[k].rest] += entry->outcome[k].weight;
            }
        }
    }
    assert_int_equal(active[0], 3 * 2 + 2 * 2 + 6 + 6);
    assert_int_equal(active[1], 22);
    for (unsigned m = 0; m < LGA_STATES; m++) {         /* and they are balanced */
        for (int r = 0; r <= 1; r++) assert_int_equal(into[m][r], LGA_WEIGHT);
    }
}

static int weight_of(int column, unsigned m, int r, unsigned to, int rest)
{
    return gas_weight(&table.sand[column][m][r], m, r, to, rest);
}

static void test_collisions_have_the_symmetry_of_the_hexagon(void **unused)
{
    (void)unused;
    for (int column = 0; column < 2; column++) {
        for (unsigned m = 0; m < LGA_STATES; m++) {
            for (int r = 0; r <= 1; r++) {
                for (unsigned to = 0; to < LGA_STATES; to++) {
                    for (int rest = 0; rest <= 4; rest++) {
                        const int w = weight_of(column, m, r, to, rest);
                        CHECK(w == weight_of(column, gas_turned(m), r, gas_turned(to), rest));
                        CHECK(w == weight_of(column, gas_mirrored(m), r, gas_mirrored(to), rest));
                    }
                }
            }
        }
    }
}

static void test_lossy_pairs_and_triples_come_to_rest(void **unused)
{
    (void)unused;
    for (int r = 0; r <= 1; r++) {
        assert_int_equal(weight_of(LGA_INELASTIC, 0x09, r, 0, r + 2), LGA_WEIGHT);
        assert_int_equal(weight_of(LGA_INELASTIC, 0x15, r, 0, r + 3), LGA_WEIGHT);
        assert_int_equal(weight_of(LGA_ELASTIC, 0x15, r, 0x2a, r), LGA_WEIGHT);
        assert_int_equal(weight_of(LGA_ELASTIC, 0x09, r, 0x12, r), LGA_WEIGHT / 2);
    }
}

/* --- the gas --- */

static void test_in_equilibrium_all_seven_slots_are_equally_full(void **unused)
{
    (void)unused;
    /* f = rho / 7 for the rest grain as for each direction, if the momentum is zero: the lower half
     * of the lattice starts as the upper one with all movers reversed.  The reference's means over
     * 2000 ticks scatter by 7e-5; of this three are allowed. */
    struct lga *lga = gas(SIDE, SIDE, (struct lga_rule){.method = LGA_FHP2, .gain = 1}, 5);
    gas_set_kinds(lga, NULL);
    uint64_t state = 12;
    for (uint32_t n = 0; n < lga->sites / 2; n++) {
        const unsigned moving = gas_movers(&state, 1.2175 / 6);
        lga_node_set(lga, n, moving, 0);
        lga_node_set(lga, n + lga->sites / 2, (moving << 3 | moving >> 3) & 0x3f, 0);
    }
    const struct totals start = totals(lga);
    CHECK(start.twice_x == 0 && start.y == 0);
    for (int t = 0; t < 500; t++) lga_step(lga);
    double share[LGA_PLANES] = {0};
    for (int t = 0; t < 2000; t++) {
        lga_step(lga);
        for (uint32_t row = 0; row < SIDE; row++) {
            uint64_t sum[LGA_PLANES];
            lga_bits_sum(lga, row, sum);
            for (int p = 0; p < LGA_PLANES; p++) share[p] += (double)sum[p] / 2000 / lga->sites;
        }
    }
    const struct totals end = totals(lga);
    CHECK(end.mass == start.mass && end.twice_x == 0 && end.y == 0);
    const double expected = (double)start.mass / lga->sites / 7;
    CHECK_NEAR(expected, 0.17393, 0.003);       /* the reference's density, as far as random */
    double least = 1, most = 0;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        least = fmin(least, share[d]);
        most = fmax(most, share[d]);
    }
    print_message("    f of the directions %.5f .. %.5f, of rest %.5f, rho/7 %.5f\n", least, most,
                  share[LGA_DIRECTIONS], expected);
    for (int p = 0; p < LGA_PLANES; p++) CHECK_NEAR(share[p], expected, 3 * 7e-5);
    gas_free(lga);
}

static void test_without_loss_a_sandpile_is_a_gas_that_keeps_its_energy(void **unused)
{
    (void)unused;
    const struct lga_rule rule = {.method = LGA_SANDPILE, .gain = 1};
    check_cooling(rule, false, (const double[4]){0.9227, 0.8639, 0.8581, 0.8608});
}

static void test_a_lossy_sandpile_cools_and_never_warms(void **unused)
{
    (void)unused;
    const struct lga_rule rule = {.method = LGA_SANDPILE, .gain = 1, .loss = 1};
    check_cooling(rule, true, (const double[4]){0.8309, 0.5494, 0.2484, 0.0461});
}

/* Movers a node of a torus with `density` grains a node, once gains and losses are equal. */
static double steady_movers(struct lga_rule rule, double density)
{
    enum { TICKS = 512, LOOKS = 16, EVERY = 16 };
    struct lga *lga = gas(SIDE, SIDE, rule, 1);
    uint64_t state = 5;
    double sum = 0;
    gas_set_kinds(lga, NULL);
    for (uint32_t n = 0; n < lga->sites; n++) {
        const unsigned moving = gas_movers(&state, density / 7);
        lga_node_set(lga, n, moving, gas_unit(&state) < density / 7);
    }
    for (int t = 0; t < TICKS; t++) lga_step(lga);
    for (int k = 0; k < LOOKS; k++) {
        for (int t = 0; t < EVERY; t++) lga_step(lga);
        sum += (double)totals(lga).movers / (double)lga->sites / LOOKS;
    }
    gas_free(lga);
    return sum;
}

static void test_the_pressure_of_a_lossy_gas_rises_with_its_density(void **unused)
{
    (void)unused;
    /* Grains gather in clusters where the pressure falls as the density rises: what is denser loses
     * more, and is pushed together by what is around it.  A mover has one speed, so the pressure is
     * half of the movers a node, and in no automaton, at no share of loss, does it fall: that is
     * why they do not cluster.  Sixteen looks at 16384 nodes know the movers a node to 0.003; the
     * steps between these densities are 0.04 and more. */
    static const double density[] = {0.3, 0.7, 1.5, 2.5, 4}, loss[] = {0.1, 0.5, 0.9};
    for (int method = LGA_GMLG; method <= LGA_SANDPILE; method++) {
        for (size_t k = 0; k < sizeof loss / sizeof *loss; k++) {
            const struct lga_rule rule = {.method = (enum lga_method)method, .gain = 1,
                                          .loss = loss[k], .inelastic = loss[k]};
            double before = 0;
            for (size_t i = 0; i < sizeof density / sizeof *density; i++) {
                const double movers = steady_movers(rule, density[i]);
                CHECK(movers > before + 0.02);
                before = movers;
            }
        }
    }
}

int main(void)
{
    lga_table_fill(&table);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_collision_keeps_mass_and_momentum),
        cmocka_unit_test(test_22_of_128_states_collide),
        cmocka_unit_test(test_collisions_have_the_symmetry_of_the_hexagon),
        cmocka_unit_test(test_lossy_pairs_and_triples_come_to_rest),
        cmocka_unit_test(test_in_equilibrium_all_seven_slots_are_equally_full),
        cmocka_unit_test(test_without_loss_a_sandpile_is_a_gas_that_keeps_its_energy),
        cmocka_unit_test(test_a_lossy_sandpile_cools_and_never_warms),
        cmocka_unit_test(test_the_pressure_of_a_lossy_gas_rises_with_its_density),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
