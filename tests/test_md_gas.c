/* test_md_gas.c - many soft discs: conserved energy, the same bytes however they are run,
 * effects that are absent cost nothing, grains that enter and leave.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes.h"

#include <omp.h>

static const char elastic_box[] =
    "until = 100.0; box = [0.0, 0.0, 40.0, 40.0]; left = \"%s\"; right = \"%s\";"
    "grains = ({ radius = [0.4, 0.5]; restitution = 1.0; stiffness = 1e4; });"
    "placements = ({ kind = \"square\"; spacing = 1.25; jitter = 0.5; temperature = 1.0; });"
    "md = { %s };";

static void test_an_elastic_box_keeps_its_energy(void **unused)
{
    (void)unused;
    const char *borders[] = {"wall", "periodic"};
    for (int k = 0; k < 2; k++) {
        char text[1000];
        snprintf(text, sizeof text, elastic_box, borders[k], borders[k], "dt = 5e-4;");
        struct scenes_run *run = scenes_begin(text, "md");
        const struct counters before = simulation_count(&run->sim);
        scenes_advance(run, 20);
        const struct counters after = simulation_count(&run->sim);
        CHECK(after.collisions > 2 * before.grains);
        /* 40 steps a contact: each keeps its energy to about 1e-5 at random (order 3). */
        const double e0 = before.kinetic_energy + before.potential_energy;
        CHECK_NEAR((after.kinetic_energy + after.potential_energy) / e0, 1, 1e-3);
        assert_int_equal(after.tangential, 0);
        assert_int_equal(after.grains, before.grains);
        scenes_end(run);
    }
}

/* Everything at once: friction with springs, two species, walls, an obstacle, sources, a sink. */
static const char busy[] =
    "until = 100.0; box = [0.0, 0.0, 40.0, 30.0]; left = \"periodic\"; right = \"periodic\"; "
    "seed = 5;"
    "gravity = (0.1, -1.0); count_max = 12000; overlap_limit = 1.0;"
    "grains = ({ name = \"a\"; radius = [0.1, 0.15]; restitution = 0.6; stiffness = 2e3; "
    "friction = 0.4; },"
    "          { name = \"b\"; radius = 0.3; density = 2.0; restitution = 0.9; stiffness = 4e3; "
    "friction = 0.2; });"
    "placements = ({ grains = \"a\"; region = [0.0, 0.0, 40.0, 20.0]; spacing = 1.1; "
    "jitter = 0.5; temperature = 0.2; },"
    "              { grains = \"b\"; region = [5.0, 21.0, 30.0, 24.0]; spacing = 1.1; });"
    "sources = ({ grains = \"a\"; position = (10.0, 27.0); width = 4.0; rate = 600.0; "
    "velocity = (0.0, -4.0); });"
    "walls = ({ shape = \"polyline\"; points = ((0.0, 1.0), (20.0, 0.5), (30.0, 1.0)); },"
    "         { shape = \"arc\"; center = (20.0, 25.0); radius = 2.0; angles = (180.0, 360.0); "
    "velocity = (0.5, 0.0); moves = (0.0, 5.0); });"
    "obstacles = ({ shape = \"disc\"; center = (8.0, 20.5); radius = 0.4; });"
    "sinks = ({ region = [18.0, 0.0, 22.0, 2.0]; });"
    "measure = { collisions = true; collision_window = 0.02; };"
    "md = { dt = 4e-4; %s };";

static uint64_t digest_of(struct scenes_run *run)
{
    const uint64_t digest = simulation_digest(&run->sim);
    scenes_end(run);
    return digest;
}

static struct scenes_run *begin_busy(const char *settings)
{
    char text[3000];
    snprintf(text, sizeof text, busy, settings);
    return scenes_begin(text, "md");
}

static void test_the_bytes_do_not_depend_on_threads_pieces_or_watching(void **unused)
{
    (void)unused;
    const char *settings[] = {"", "integrator = \"gear\";", "force = \"hertz\";"};
    for (int k = 0; k < 3; k++) {
        omp_set_num_threads(1);
        struct scenes_run *run = begin_busy(settings[k]);
        scenes_advance(run, 0.06);
        const struct counters counters = simulation_count(&run->sim);
        CHECK(counters.grains > 8000);                          /* several strips */
        CHECK(counters.grains_in > 3);
        CHECK(counters.grains_out > 5);
        CHECK(counters.rebuilds > 2);
        const uint64_t one = digest_of(run);

        omp_set_num_threads(2);
        run = begin_busy(settings[k]);
        scenes_advance(run, 0.06);
        CHECK(digest_of(run) == one);

        run = begin_busy(settings[k]);
        for (int piece = 1; piece <= 17; piece++) {
            enum advance outcome;
            while ((outcome = simulation_advance(&run->sim, 0.06 * piece / 17, 13, NULL))
                   == ADVANCE_BUDGET) {}
            CHECK(outcome == ADVANCE_REACHED);
            struct grains grains;
            CHECK(grains_create(&grains, 12000, 40000, NULL));
            simulation_observe(&run->sim, &grains);
            CHECK(grains.count > 8000 && grains.contact_count > 0);
            grains_free(&grains);
            simulation_count(&run->sim);
        }
        CHECK(digest_of(run) == one);

        run = begin_busy(settings[k]);
        struct archive save, load;
        scenes_advance(run, 0.0333);
        archive_begin_save(&save);
        CHECK(simulation_save(&run->sim, &save, NULL));
        scenes_end(run);
        run = begin_busy(settings[k]);
        archive_begin_load(&load, save.bytes, save.size);
        CHECK(simulation_load(&run->sim, &load, NULL));
        archive_end(&save);
        scenes_advance(run, 0.06);
        CHECK(digest_of(run) == one);
    }
}

static void test_a_column_of_discs_comes_to_rest_and_carries_its_weight(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin(
        "until = 100.0; box = [0.0, 0.0, 1.0, 30.0]; top = \"open\"; gravity = (0.0, -1.0);"
        "grains = ({ radius = 0.5; density = 1.2732395447351628; restitution = 0.3; "
        "stiffness = 1e4; friction = 0.5; });"
        "placements = ({ kind = \"square\"; region = [0.0, 0.0, 1.0, 20.0]; });"
        "md = { dt = 1e-3; };", "md");
    scenes_advance(run, 100);
    struct grains g = scenes_look(run), contacts;
    double y = 0;
    for (uint32_t k = 0; k < 20; k++) {
        /* Contact k carries the 20 - k discs above it; the sum of overlaps lowers disc k. */
        y += k == 0 ? 0.5 - 20 / 1e4 : 1 - (20.0 - k) / 1e4;
        CHECK_NEAR(g.y[k], y, 1e-7);
    }
    CHECK(grains_create(&contacts, 20, 100, NULL));
    simulation_observe(&run->sim, &contacts);
    double floor_force = 0;
    for (uint32_t k = 0; k < contacts.contact_count; k++) {
        if (contacts.contacts[k].j >= CONTACT_WALL) floor_force += (double)contacts.contacts[k].fy;
    }
    CHECK_NEAR(floor_force, 20, 1e-4);
    grains_free(&g);
    grains_free(&contacts);
    scenes_end(run);
}

static void test_without_friction_no_tangential_force_is_evaluated(void **unused)
{
    (void)unused;
    const char text[] =
        "until = 10.0; box = [0.0, 0.0, 20.0, 20.0]; gravity = (0.0, -1.0);"
        "grains = ({ radius = 0.5; restitution = 0.5; stiffness = 1e4; friction = %s; });"
        "placements = ({ region = [0.0, 0.0, 20.0, 10.0]; }); md = { dt = 1e-3; };";
    size_t bytes[2];
    for (int k = 0; k < 2; k++) {
        char full[1000];
        snprintf(full, sizeof full, text, k ? "0.5" : "0.0");
        struct scenes_run *run = scenes_begin(full, "md");
        scenes_advance(run, 2);
        const struct counters counters = simulation_count(&run->sim);
        struct archive archive;
        archive_begin_save(&archive);
        run->sim.model->archive(run->sim.state, &archive);
        bytes[k] = archive.size;
        archive_end(&archive);
        if (k == 0) {
            assert_int_equal(counters.tangential, 0);
            CHECK(counters.rotational_energy == 0);
        } else {
            CHECK(counters.tangential > 1000);
            CHECK(counters.rotational_energy > 0);
        }
        scenes_end(run);
    }
    CHECK(bytes[0] < bytes[1]);                                 /* no springs are kept */
}

static void test_dissipation_may_begin_in_a_later_phase(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin(
        "until = 20.0; box = [0.0, 0.0, 30.0, 30.0]; left = \"periodic\"; right = \"periodic\";"
        "bottom = \"periodic\"; top = \"periodic\";"
        "grains = ({ radius = 0.5; restitution = 1.0; stiffness = 1e4; });"
        "placements = ({ spacing = 1.5; temperature = 1.0; jitter = 0.3; });"
        "phases = ({ time = 5.0; set = [\"grains.[0].restitution=0.6\", "
        "\"grains.[0].friction=0.3\", \"md.dt=2e-4\"]; });"
        "md = { dt = 5e-4; };", "md");
    const double e0 = simulation_count(&run->sim).kinetic_energy;
    scenes_advance(run, 5);
    const struct counters elastic = simulation_count(&run->sim);
    CHECK_NEAR((elastic.kinetic_energy + elastic.potential_energy) / e0, 1, 1e-3);
    assert_int_equal(elastic.tangential, 0);
    scenes_advance(run, 10);
    const struct counters inelastic = simulation_count(&run->sim);
    CHECK(inelastic.kinetic_energy < 0.7 * e0);
    CHECK(inelastic.tangential > 0);
    CHECK_NEAR(inelastic.time, 10, 2e-4);
    assert_int_equal(inelastic.steps, 10000 + 25000);
    scenes_end(run);
}

static void test_a_collision_rate_counts_contacts_begun(void **unused)
{
    (void)unused;
    /* Two discs in a narrow box hit each other and the walls: gap 1 between the surfaces in all,
     * each disc's path from wall to middle 0.5 at speed 1: four contacts a time unit ... a disc
     * meets a wall or its partner each 0.5. */
    struct scenes_run *run = scenes_begin(
        "until = 100.0; box = [0.0, 0.0, 3.0, 1.0];"
        "grains = ({ radius = 0.5; restitution = 1.0; stiffness = 1e5; });"
        "placements = ({ region = [0.0, 0.0, 1.3, 1.0]; count = 1; velocity = (1.0, 0.0); },"
        "              { region = [2.0, 0.0, 3.0, 1.0]; count = 1; velocity = (-1.0, 0.0); });"
        "measure = { collisions = true; collision_window = 5.0; }; md = { dt = 1e-4; };", "md");
    scenes_advance(run, 21);
    struct grains g = scenes_look(run);
    /* Contacts last 0.01, so slightly fewer than 2 a unit; floor and ceiling are touched by
     * rounding only. */
    CHECK_NEAR((double)g.collision_rate[0], 2, 0.25);
    CHECK_NEAR((double)g.collision_rate[1], 2, 0.25);
    grains_free(&g);
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_elastic_box_keeps_its_energy),
        cmocka_unit_test(test_the_bytes_do_not_depend_on_threads_pieces_or_watching),
        cmocka_unit_test(test_a_column_of_discs_comes_to_rest_and_carries_its_weight),
        cmocka_unit_test(test_without_friction_no_tangential_force_is_evaluated),
        cmocka_unit_test(test_dissipation_may_begin_in_a_later_phase),
        cmocka_unit_test(test_a_collision_rate_counts_contacts_begun),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
