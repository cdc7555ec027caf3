/* test_ed_look.c - contacts of hard discs, which touch for no time.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

static struct grains look(const struct scenes_run *run)
{
    struct grains g;
    const uint32_t count = (uint32_t)simulation_count(&run->sim).grains;
    CHECK(grains_create(&g, count, 8 * count, NULL));
    simulation_observe(&run->sim, &g);
    CHECK(g.count == count && g.missed == 0);
    return g;
}

static void test_each_disc_of_a_column_at_rest_stands_on_the_one_below(void **unused)
{
    (void)unused;
    enum { COUNT = 20 };
    struct scenes_run *run = scenes_begin("until = 100.0; box = [0.0, 0.0, 1.05, 40.0];"
        "top = \"open\"; gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.5; });"
        "placements = ({ region = [0.0, 0.0, 1.05, 21.0]; kind = \"square\"; spacing = 1.05; });"
        "ed = { t_c = 1e-2; };", "ed");
    for (int k = 0; k < 5; k++) {
        scenes_advance(run, 50 + 3.3 * k);
        struct grains g = look(run);
        uint32_t below[COUNT + 1] = {0}, floors = 0;
        CHECK(g.count == COUNT && g.contact_count == COUNT);
        for (uint32_t c = 0; c < g.contact_count; c++) {
            const struct contact *contact = &g.contacts[c];
            const bool floor = contact->j >= CONTACT_WALL;
            const double y = floor ? 0 : fmax(g.y[contact->i], g.y[contact->j]) - 0.5;
            floors += floor;
            /* Contact k of the column is at a height of k; twenty gaps of 2 g t_c^2 are 4e-3. */
            CHECK_NEAR((double)contact->y, y, 1e-3);
            CHECK_NEAR((double)contact->y, round(y), 5e-3);
            CHECK_NEAR((double)contact->x, 0.525, 1e-3);
            CHECK((double)contact->overlap <= 1e-9);
            below[(int)round(y)]++;
        }
        CHECK(floors == 1);
        for (int h = 0; h < COUNT; h++) CHECK(below[h] == 1);
        grains_free(&g);
    }
    scenes_end(run);
}

/* Contacts seen in many looks at a small gas, and how many are expected: a blow counts from t_c
 * before it to t_c after it. */
static void count_contacts(const char *more, double t_c, double *seen, double *expected)
{
    enum { LOOKS = 20000 };
    char text[1000];
    snprintf(text, sizeof text, "until = 1e5; box = [0.0, 0.0, 8.0, 8.0];"
        "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
        "placements = ({ kind = \"square\"; spacing = 1.3; temperature = 0.5; });"
        "ed = { t_c = %g; }; %s", t_c, more);
    struct scenes_run *run = scenes_begin(text, "ed");
    scenes_advance(run, 20);
    const uint64_t before = simulation_count(&run->sim).collisions;
    *seen = 0;
    for (int k = 1; k <= LOOKS; k++) {
        scenes_advance(run, 20 + 0.1 * k);
        struct grains g = look(run);
        *seen += g.contact_count;
        grains_free(&g);
    }
    const double rate = (double)(simulation_count(&run->sim).collisions - before)
                      / (0.1 * LOOKS);
    *expected = LOOKS * rate * 2 * t_c;
    scenes_end(run);
}

static void test_a_gas_has_as_many_contacts_as_its_collisions_last(void **unused)
{
    (void)unused;
    /* Periodic, sizes mixed, sheared: a third of the contacts lies across the borders. */
    const char *const gases[] = {
        "grains = ({ radius = 0.5; restitution = 1.0; });",
        "grains = ({ radius = [0.35, 0.5]; restitution = 1.0; });",
        "grains = ({ radius = 0.5; restitution = 0.8; }); shear_rate = 1.0;",
    };
    for (int k = 0; k < 3; k++) {
        double seen, expected;
        count_contacts(gases[k], 1e-4, &seen, &expected);
        print_message("contacts %.0f, expected %.1f\n", seen, expected);
        CHECK(expected > 100);
        /* Looks farther apart than a free flight are independent: Poisson, three deviations. */
        CHECK_NEAR(seen, expected, 3 * sqrt(expected));
    }
}

static void test_without_a_cut_off_a_gas_has_no_contacts(void **unused)
{
    (void)unused;
    double seen, expected;
    count_contacts("grains = ({ radius = 0.5; restitution = 1.0; });", 0, &seen, &expected);
    /* A gap below 1e-8 d, at 3 collisions a grain and time: 1e-2 contacts in all the looks. */
    CHECK(seen <= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_disc_of_a_column_at_rest_stands_on_the_one_below),
        cmocka_unit_test(test_a_gas_has_as_many_contacts_as_its_collisions_last),
        cmocka_unit_test(test_without_a_cut_off_a_gas_has_no_contacts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
