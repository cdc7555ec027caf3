/* test_place.c - grains at the start: lattices, random packings, temperature; none overlaps.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "check.h"
#include "scene/scene.h"

static struct findings findings;

static struct scene *load(const char *text)
{
    const struct scene_request request = {.path = "test.cfg", .text = text, .place = true};
    memset(&findings, 0, sizeof findings);
    struct scene *scene = scene_load(&request, &findings);
    char told[1000];
    if (!scene) fail_msg("%s", findings_line(&findings.list[0], told, sizeof told));
    return scene;
}

/* The deepest overlap of two grains or of a grain with a wall, by comparing all with all. */
static double deepest_overlap(const struct scene *scene)
{
    const struct placed *p = &scene->placed;
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    double deepest = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        for (uint32_t j = 0; j < i; j++) {
            double dx = fabs(p->x[i] - p->x[j]), dy = fabs(p->y[i] - p->y[j]);
            if (scene->left == BORDER_PERIODIC) dx = fmin(dx, width - dx);
            if (scene->bottom == BORDER_PERIODIC) dy = fmin(dy, height - dy);
            deepest = fmax(deepest, p->radius[i] + p->radius[j] - hypot(dx, dy));
        }
        for (uint32_t k = 0; k < scene->wall_count; k++) {
            const double distance = wall_nearest(&scene->walls[k], p->x[i], p->y[i]).distance;
            deepest = fmax(deepest, p->radius[i] - distance);
        }
    }
    return deepest;
}

static double area_of_grains(const struct scene *scene)
{
    double area = 0;
    for (uint32_t i = 0; i < scene->placed.count; i++) {
        area += M_PI * scene->placed.radius[i] * scene->placed.radius[i];
    }
    return area;
}

#define HEAD "until = 1; box = [0, 0, 20, 20];\n"
#define ONE "grains = ( { radius = 0.5; restitution = 1; } );\n"
#define SPREAD "grains = ( { radius = [0.45, 0.55]; restitution = 1; } );\n"

static void test_lattices_hold_as_many_grains_as_geometry_says(void **unused)
{
    (void)unused;
    struct scene *scene = load(HEAD ONE "placements = ( { kind = \"square\"; } );");
    CHECK(scene->placed.count == 400);
    CHECK(deepest_overlap(scene) < 1e-9);
    scene_free(scene);
    /* Rows sqrt(3)/2 apart: 1 + floor(19 / 0.866) = 22 of them, of 20 and 19 grains in turn. */
    scene = load(HEAD ONE "placements = ( { kind = \"triangular\"; } );");
    CHECK(scene->placed.count == 11 * 20 + 11 * 19);
    CHECK(deepest_overlap(scene) < 1e-9);
    CHECK_NEAR(scene->placed.y[20] - scene->placed.y[0], sqrt(3) / 2, 1e-12);
    scene_free(scene);
}

static void test_a_periodic_lattice_is_the_same_across_the_border(void **unused)
{
    (void)unused;
    struct scene *scene = load("until = 1; box = [0, 0, 20.3, 18.1]; left = \"periodic\";\n"
        "right = \"periodic\"; top = \"periodic\"; bottom = \"periodic\";\n" ONE
        "placements = ( { kind = \"triangular\"; } );");
    /* 20 columns of 1.015; rows in pairs: 2 floor(18.1 / (2 * 0.866)) = 20. */
    CHECK(scene->placed.count == 400);
    CHECK(deepest_overlap(scene) < 1e-9);
    scene_free(scene);
}

static void test_a_lattice_is_filled_from_below_and_jitter_keeps_grains_apart(void **unused)
{
    (void)unused;
    struct scene *scene = load(HEAD SPREAD
        "placements = ( { count = 29; spacing = 1.2; jitter = 1; } );");
    CHECK(scene->placed.count == 29);
    /* Rows of 15 and 14 sites of 1.32; the second one lies at 0.66 + 1.14, shifted by 0.11. */
    for (uint32_t i = 0; i < 29; i++) CHECK(scene->placed.y[i] < 1.92);
    CHECK(deepest_overlap(scene) < 1e-9);
    scene_free(scene);
}

static void test_grains_keep_clear_of_walls_obstacles_and_other_placements(void **unused)
{
    (void)unused;
    struct scene *scene = load(HEAD SPREAD
        "placements = ( { kind = \"random\"; fraction = 0.6; region = [0, 0, 20, 8]; },\n"
        "               { kind = \"triangular\"; } );\n"
        "walls = ( { shape = \"polyline\"; points = ((0, 12), (10, 10), (20, 12)); },\n"
        "          { shape = \"arc\"; center = (10, 16); radius = 2; angles = (0, 180); } );\n"
        "obstacles = ( { shape = \"disc\"; center = (10, 4); radius = 2; } );");
    CHECK(scene->placed.count > 250);
    CHECK(deepest_overlap(scene) < 1e-9);
    scene_free(scene);
}

static void check_packing(const char *text, double area, double fraction)
{
    struct scene *scene = load(text);
    CHECK(deepest_overlap(scene) < 1e-9);
    /* The last grain may go beyond what was asked: one grain's area, at most pi 0.55^2 = 0.95. */
    CHECK(area_of_grains(scene) >= fraction * area);
    CHECK(area_of_grains(scene) <= fraction * area + 0.96);
    scene_free(scene);
}

#define TORUS "left = \"periodic\"; right = \"periodic\";\n" \
              "bottom = \"periodic\"; top = \"periodic\";\n"

static void test_random_packings_reach_the_asked_fraction_without_overlap(void **unused)
{
    (void)unused;
    check_packing(HEAD SPREAD "placements = ( { kind = \"random\"; fraction = 0.3; } );", 400, 0.3);
    check_packing(HEAD SPREAD "placements = ( { kind = \"random\"; fraction = 0.78; } );", 400,
                  0.78);
    check_packing(HEAD SPREAD TORUS "placements = ( { kind = \"random\"; fraction = 0.84; } );",
                  400, 0.84);
    check_packing(HEAD ONE TORUS "placements = ( { kind = \"random\"; fraction = 0.82; } );",
                  400, 0.82);
    check_packing(HEAD ONE "placements = ( { kind = \"random\"; fraction = 0.7;\n"
                  "    outline = ((2, 2), (18, 2), (18, 10), (10, 10), (10, 18), (2, 18)); } );",
                  16 * 8 + 8 * 8, 0.7);
}

static void test_the_same_seed_packs_alike_and_another_one_does_not(void **unused)
{
    (void)unused;
    static const char text[] = HEAD SPREAD "placements = ( { kind = \"random\"; count = 100; } );";
    static const char other_text[] = "seed = 2;" HEAD SPREAD
        "placements = ( { kind = \"random\"; count = 100; } );";
    struct scene *a = load(text), *b = load(text), *c = load(other_text);
    CHECK(memcmp(a->placed.x, b->placed.x, 100 * sizeof(double)) == 0);
    CHECK(memcmp(a->placed.radius, b->placed.radius, 100 * sizeof(double)) == 0);
    CHECK(memcmp(a->placed.x, c->placed.x, 100 * sizeof(double)) != 0);
    scene_free(a);
    scene_free(b);
    scene_free(c);
}

static void test_the_temperature_is_exact_and_the_mean_velocity_is_the_asked_one(void **unused)
{
    (void)unused;
    struct scene *scene = load(HEAD ONE "placements = ( { count = 100; temperature = 2.5;\n"
                               "    velocity = (3, -1); spin = 4; } );");
    double mx = 0, my = 0, square = 0;
    const struct placed *p = &scene->placed;
    for (uint32_t i = 0; i < p->count; i++) {
        mx += p->vx[i] / p->count;
        my += p->vy[i] / p->count;
        CHECK(p->spin[i] == 4);
    }
    for (uint32_t i = 0; i < p->count; i++) {
        square += pow(p->vx[i] - mx, 2) + pow(p->vy[i] - my, 2);
    }
    CHECK_NEAR(mx, 3, 1e-13);                           /* rounding of 100 terms of about 3 */
    CHECK_NEAR(my, -1, 1e-13);
    CHECK_NEAR(square / (2 * p->count), 2.5, 1e-12);
    scene_free(scene);
}

static void test_a_sheared_scene_begins_with_a_linear_profile(void **unused)
{
    (void)unused;
    struct scene *scene = load("until = 1; box = [0, -4, 20, 16]; left = \"periodic\";\n"
        "right = \"periodic\"; top = \"periodic\"; bottom = \"periodic\"; shear_rate = -0.25;\n" ONE
        "placements = ( { count = 100; velocity = (3, -1); temperature = 2.5; } );");
    const struct placed *p = &scene->placed;
    double square = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        const double ux = p->vx[i] - 3 + 0.25 * (p->y[i] - 6);  /* the middle of the box is y = 6 */
        square += pow(ux, 2) + pow(p->vy[i] + 1, 2);
    }
    CHECK_NEAR(square / (2 * p->count), 2.5, 1e-12);            /* heat is what the flow leaves */
    scene_free(scene);
}

static void test_radii_are_uniform_in_their_range_or_out_of_their_list(void **unused)
{
    (void)unused;
    struct scene *scene = load("until = 1; box = [0, 0, 200, 200];" SPREAD "placements = ( {} );");
    const struct placed *p = &scene->placed;
    double mean = 0, square = 0;
    for (uint32_t i = 0; i < p->count; i++) mean += p->radius[i] / p->count;
    for (uint32_t i = 0; i < p->count; i++) square += pow(p->radius[i] - 0.5, 2) / p->count;
    CHECK(p->count > 30000);
    /* Uniform in 0.1: deviation 0.1/sqrt(12) = 0.0289, of the mean 1.7e-4; four of those.  The
     * variance 8.33e-4 scatters by 0.9 / sqrt(N) = 0.5 % of itself; four of those. */
    CHECK_NEAR(mean, 0.5, 7e-4);
    CHECK_NEAR(square, 0.01 / 12, 0.02 * 0.01 / 12);
    scene_free(scene);
    scene = load("until = 1; box = [0, 0, 50, 50];\n"
                 "grains = ( { radii = [0.3, 0.5]; restitution = 1; } ); placements = ( {} );");
    uint32_t small = 0;
    p = &scene->placed;
    for (uint32_t i = 0; i < p->count; i++) {
        CHECK(p->radius[i] == 0.3 || p->radius[i] == 0.5);
        small += p->radius[i] == 0.3;
    }
    /* Half of them, deviation sqrt(N)/2; four of those. */
    CHECK_NEAR(small, p->count / 2.0, 2 * sqrt(p->count));
    scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lattices_hold_as_many_grains_as_geometry_says),
        cmocka_unit_test(test_a_periodic_lattice_is_the_same_across_the_border),
        cmocka_unit_test(test_a_lattice_is_filled_from_below_and_jitter_keeps_grains_apart),
        cmocka_unit_test(test_grains_keep_clear_of_walls_obstacles_and_other_placements),
        cmocka_unit_test(test_random_packings_reach_the_asked_fraction_without_overlap),
        cmocka_unit_test(test_the_same_seed_packs_alike_and_another_one_does_not),
        cmocka_unit_test(test_the_temperature_is_exact_and_the_mean_velocity_is_the_asked_one),
        cmocka_unit_test(test_a_sheared_scene_begins_with_a_linear_profile),
        cmocka_unit_test(test_radii_are_uniform_in_their_range_or_out_of_their_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
