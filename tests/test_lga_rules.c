/* test_lga_rules.c - the collisions of the lattice gas, all of them, and the gas that they make.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "lga_gas.h"

static struct lga_table table;

static void test_every_collision_keeps_mass_and_momentum(void **unused)
{
    (void)unused;
    for (int column = 0; column < 2; column++) {
        for (unsigned m = 0; m < LGA_STATES; m++) {
            for (int r = 0; r <= LGA_ROOM; r++) {
                const struct lga_case *entry = &table.cases[column][m][r];
                int weights = entry->count ? 0 : LGA_WEIGHT, x, y, x2, y2;
                lga_table_momentum(m, &x, &y);
                for (int k = 0; k < entry->count; k++) {
                    const struct lga_outcome *out = &entry->outcome[k];
                    weights += out->weight;
                    lga_table_momentum(out->moving, &x2, &y2);
                    CHECK(x == x2 && y == y2 && out->rest <= LGA_ROOM && out->weight > 0);
                    assert_int_equal(out->rest + __builtin_popcount(out->moving),
                                     r + __builtin_popcount(m));
                    /* Rest grains do not move: fewer movers are less energy. */
                    if (column == LGA_INELASTIC) CHECK(out->rest >= r);
                }
                assert_int_equal(weights, LGA_WEIGHT);
            }
        }
    }
}

static void test_124_of_512_states_collide_elastically(void **unused)
{
    (void)unused;
    /* 3 head-on and 2 triple with any rest, 6 x 7 {i} with rest, 6 x 7 {i-1, i+1} with room. */
    int active = 0;
    for (unsigned m = 0; m < LGA_STATES; m++) {
        for (int r = 0; r <= LGA_ROOM; r++) active += table.cases[LGA_ELASTIC][m][r].count > 0;
    }
    assert_int_equal(active, 3 * 8 + 2 * 8 + 6 * 7 + 6 * 7);
}

static void test_elastic_collisions_are_balanced(void **unused)
{
    (void)unused;
    int into[LGA_STATES][LGA_ROOM + 1] = {{0}};
    for (unsigned m = 0; m < LGA_STATES; m++) {
        for (int r = 0; r <= LGA_ROOM; r++) {
            const struct lga_case *entry = &table.cases[LGA_ELASTIC][m][r];
            if (entry->count == 0) into[m][r] += LGA_WEIGHT;
            for (int k = 0; k < entry->count; k++) {
                into[entry->outcome[k].moving][entry->outcome[k].rest] += entry->outcome[k].weight;
            }
        }
    }
    for (unsigned m = 0; m < LGA_STATES; m++) {
        for (int r = 0; r <= LGA_ROOM; r++) assert_int_equal(into[m][r], LGA_WEIGHT);
    }
}

static int weight_of(int column, unsigned m, int r, unsigned to, int rest)
{
    return gas_weight(&table.cases[column][m][r], m, r, to, rest);
}

static void test_collisions_have_the_symmetry_of_the_hexagon(void **unused)
{
    (void)unused;
    for (int column = 0; column < 2; column++) {
        for (unsigned m = 0; m < LGA_STATES; m++) {
            for (int r = 0; r <= LGA_ROOM; r++) {
                for (unsigned to = 0; to < LGA_STATES; to++) {
                    for (int rest = 0; rest <= LGA_ROOM; rest++) {
                        const int w = weight_of(column, m, r, to, rest);
                        CHECK(w == weight_of(column, gas_turned(m), r, gas_turned(to), rest));
                        CHECK(w == weight_of(column, gas_mirrored(m), r, gas_mirrored(to), rest));
                    }
                }
            }
        }
    }
}

static void test_head_on_pairs_stop_two_by_two_as_many_as_fit(void **unused)
{
    (void)unused;
    const struct lga_case *empty = &table.cases[LGA_INELASTIC][0x3f][0];
    CHECK(empty->count == 1 && empty->outcome[0].moving == 0 && empty->outcome[0].rest == 6);
    const struct lga_case *tight = &table.cases[LGA_INELASTIC][0x3f][5];    /* room for one pair */
    assert_int_equal(tight->count, 3);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(tight->outcome[k].rest, 7);
        assert_int_equal(tight->outcome[k].weight, LGA_WEIGHT / 3);
    }
    CHECK(table.cases[LGA_INELASTIC][0x15][4].outcome[0].rest == 7);        /* a triple stops */
    CHECK(table.cases[LGA_INELASTIC][0x15][5].count == 0);      /* no room, and nothing merges */
}

static void test_rest_grains_follow_a_geometric_law_in_equilibrium(void **unused)
{
    (void)unused;
    /* All states of one mass and momentum are equally likely, so P(r) ~ z^r, r = 0..7, with
     * z = f / (1 - f), f the share of filled movers; at 1.8087 grains a node the reference gives
     * z = 0.2993.  The random start scatters by 0.009 grains a node, hence z by 0.0012.  16384
     * nodes seen 40 times, 10 ticks apart, are at least 16384 independent ones: P(0) deviates by
     * at most sqrt(0.7 * 0.3 / 16384) = 0.0036; of this three. */
    struct lga *lga = gas(128, 128, (struct lga_rule){.gain = 1}, 5);
    gas_set_kinds(lga, NULL);
    uint64_t state = 5;
    for (uint32_t n = 0; n < lga->sites; n++) {         /* all of the mass flies at first */
        lga_node_set(lga, n, gas_movers(&state, 1.8087 / 6), 0);
    }
    for (int t = 0; t < 500; t++) lga_step(lga);
    double share[LGA_ROOM + 1] = {0}, movers = 0;
    for (int look = 0; look < 40; look++) {
        for (int t = 0; t < 10; t++) lga_step(lga);
        for (uint32_t n = 0; n < lga->sites; n++) {
            const struct lga_node node = lga_node_get(lga, n);
            share[node.rest] += 1.0 / 40 / lga->sites;
            movers += __builtin_popcount(node.moving) / 6.0 / 40 / lga->sites;
        }
    }
    const double z = movers / (1 - movers), expected[4] = {0.7007, 0.2097, 0.0628, 0.0188};
    double sum = 0;
    for (int r = 0; r <= LGA_ROOM; r++) sum += pow(z, r);
    print_message("    z %.4f (reference 0.2993), P(0..3) %.4f %.4f %.4f %.4f\n", z, share[0],
                  share[1], share[2], share[3]);
    CHECK_NEAR(z, 0.2993, 3 * 0.0012);
    for (int r = 0; r < 4; r++) {
        const double deviation = sqrt(expected[r] * (1 - expected[r]) / lga->sites);
        CHECK_NEAR(share[r], expected[r], 3 * deviation);
        CHECK_NEAR(share[r], pow(z, r) / sum, 3 * deviation);
    }
    gas_free(lga);
}

static void test_an_elastic_gas_reaches_the_energy_of_equilibrium(void **unused)
{
    (void)unused;
    check_cooling((struct lga_rule){.gain = 1}, false,
                  (const double[4]){0.9227, 0.8478, 0.8193, 0.8136});
}

static void test_an_inelastic_gas_cools_and_never_warms(void **unused)
{
    (void)unused;
    check_cooling((struct lga_rule){.gain = 1, .inelastic = 1}, true,
                  (const double[4]){0.7547, 0.4443, 0.1798, 0.0208});
}

static void test_a_grain_that_bounces_off_the_plate_runs_along_it(void **unused)
{
    (void)unused;
    /* Sand that gravity bends in every tick and that the plate never stops: the grain comes down,
     * bounces up to the next row and is bent down again, three ticks and one node to the left.
     * Only where nothing stops it on its first node can a heap have a tail. */
    enum { COLUMNS = 64, ROWS = 8, BOUNCES = 10, START = 40 };
    struct lga *lga = gas(COLUMNS, ROWS, (struct lga_rule){.method = LGA_SANDPILE, .gravity = true,
        .fall = 1, .gain = 1, .loss = 0, .fly = true, .heap = true}, 1);
    uint8_t kind[COLUMNS * ROWS] = {0};
    for (uint32_t x = 0; x < COLUMNS; x++) kind[x] = LGA_WALL;
    gas_set_kinds(lga, kind);
    lga_node_set(lga, COLUMNS + START, 1u << 2, 0);
    for (int t = 0; t < 3 * BOUNCES; t++) lga_step(lga);
    const struct lga_node node = lga_node_get(lga, COLUMNS + START - BOUNCES);
    assert_int_equal(totals(lga).mass, 1);
    assert_int_equal(node.moving, 1u << 2);
    gas_free(lga);
}

int main(void)
{
    lga_table_fill(&table);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_collision_keeps_mass_and_momentum),
        cmocka_unit_test(test_124_of_512_states_collide_elastically),
        cmocka_unit_test(test_elastic_collisions_are_balanced),
        cmocka_unit_test(test_collisions_have_the_symmetry_of_the_hexagon),
        cmocka_unit_test(test_head_on_pairs_stop_two_by_two_as_many_as_fit),
        cmocka_unit_test(test_rest_grains_follow_a_geometric_law_in_equilibrium),
        cmocka_unit_test(test_an_elastic_gas_reaches_the_energy_of_equilibrium),
        cmocka_unit_test(test_an_inelastic_gas_cools_and_never_warms),
        cmocka_unit_test(test_a_grain_that_bounces_off_the_plate_runs_along_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
