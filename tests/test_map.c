/* test_map.c - maps lose nothing; density, flow and temperature of known gases come out right.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/map.h"
#include "measure/overlap.h"

#include <omp.h>

static const enum kernel kernels[] = {KERNEL_BOX, KERNEL_GAUSS, KERNEL_LUCY};

static struct scene box_scene(double lx, double ly, enum border side, enum border floor)
{
    return (struct scene){.path = "test", .box = {0, 0, lx, ly}, .left = side, .right = side,
                          .bottom = floor, .top = floor, .radius_mean = 0.5};
}

static struct measure settings(double cell, enum kernel kernel, double width)
{
    return (struct measure){.cell = cell, .kernel = (int)kernel, .width = width};
}

static struct map *make(const struct scene *scene, double cell, enum kernel kernel, double width)
{
    const struct measure measure = settings(cell, kernel, width);
    struct error error;
    struct map *map = map_create(scene, &measure, &error);
    if (!map) fail_msg("%s", error.text);
    return map;
}

static struct field field_of(const struct map *map, enum map_kind kind)
{
    struct field field;
    struct error error;
    if (!map_field(map, kind, &field, &error)) fail_msg("%s", error.text);
    return field;
}

/* Grains at random in the box, with normal velocities and spins of the given deviation. */
static struct grains gas(const struct scene *scene, uint32_t count, double deviation)
{
    struct grains grains;
    struct error error;
    struct rng rng = {12345};
    if (!grains_create(&grains, count, 0, &error)) fail_msg("%s", error.text);
    grains.count = count;
    for (uint32_t k = 0; k < count; k++) {
        grains.x[k] = scene->box[2] * rng_uniform(&rng);
        grains.y[k] = scene->box[3] * rng_uniform(&rng);
        grains.vx[k] = deviation * rng_normal(&rng);
        grains.vy[k] = deviation * rng_normal(&rng);
        grains.spin[k] = deviation * rng_normal(&rng);
        grains.radius[k] = 0.3 + 0.2 * rng_uniform(&rng);
        grains.mass[k] = 2;
        grains.collision_rate[k] = 7;
    }
    return grains;
}

/* Sum over the map of value * area of the cell inside the box. */
static double total(const struct field *field, const struct scene *scene)
{
    double sum = 0;
    for (uint32_t j = 0; j < field->ny; j++) {
        for (uint32_t i = 0; i < field->nx; i++) {
            const double wide = fmin(field->cell, scene->box[2] - i * field->cell);
            const double high = fmin(field->cell, scene->box[3] - j * field->cell);
            sum += field->values[j * field->nx + i] * wide * high;
        }
    }
    return sum;
}

static void test_every_kernel_keeps_the_number_of_grains(void **unused)
{
    (void)unused;
    const enum border borders[][2] = {{BORDER_WALL, BORDER_WALL}, {BORDER_PERIODIC, BORDER_WALL},
                                      {BORDER_PERIODIC, BORDER_PERIODIC}};
    /* Sides that the cell does not divide; kernels from far below a cell to half the box. */
    const double widths[] = {0.01, 0.5, 1.3, 5};
    for (size_t b = 0; b < 3; b++) {
        const struct scene scene = box_scene(10.3, 7.1, borders[b][0], borders[b][1]);
        struct grains grains = gas(&scene, 500, 1);
        grains.x[0] = 10.3;             /* corners belong to the box */
        grains.y[0] = 7.1;
        grains.x[1] = grains.y[1] = 0;
        for (size_t k = 0; k < 3; k++) {
            for (size_t w = 0; w < 4; w++) {
                struct map *map = make(&scene, 0.9, kernels[k], widths[w]);
                map_add(map, &grains);
                struct field field = field_of(map, MAP_density);
                /* 500 weights of one, each right to 1e-16 times the cells it is shared among. */
                CHECK_NEAR(total(&field, &scene), 500, 500 * 1e-12);
                field_free(&field);
                map_destroy(map);
            }
        }
        grains_free(&grains);
    }
}

static void test_a_uniform_gas_has_its_density_and_temperature(void **unused)
{
    (void)unused;
    const uint32_t count = 200000, cells = 16;
    const struct scene scene = box_scene(16, 16, BORDER_WALL, BORDER_WALL);
    struct grains grains = gas(&scene, count, 3);
    const double mean = (double)count / (cells * cells);        /* grains a cell: 781 */
    for (size_t k = 0; k < 3; k++) {
        struct map *map = make(&scene, 1, kernels[k], 0.4);
        map_add(map, &grains);
        struct field density = field_of(map, MAP_density), heat = field_of(map, MAP_temperature);
        struct field spins = field_of(map, MAP_spin_temperature);
        struct field rate = field_of(map, MAP_collisions);
        for (uint32_t c = 0; c < cells * cells; c++) {
            /* Poisson: a cell scatters by sqrt(mean); five deviations over 256 cells.  Smooth
             * kernels average over more grains inside, but at a corner over half as many along
             * each axis, and a renormalised kernel is biased where the gas ends: by the share
             * that it takes back from beyond the wall, at most a fifth of the value here. */
            const double edge = kernels[k] == KERNEL_BOX ? 0 : 0.2 * mean;
            CHECK_NEAR(density.values[c], mean, 5 * sqrt(mean) + edge);
            /* T = <v'^2>/2 = 9 with relative deviation 1/sqrt(grains) (two degrees of freedom);
             * one for the spins: sqrt(2/grains). */
            CHECK_NEAR(heat.values[c], 9, 9 * 6 / sqrt(mean));
            CHECK_NEAR(spins.values[c], 9, 9 * 6 * sqrt(2 / mean));
            CHECK_NEAR(rate.values[c], 7, 1e-9);
        }
        field_free(&density);
        field_free(&heat);
        field_free(&spins);
        field_free(&rate);
        map_destroy(map);
    }
    grains_free(&grains);
}

static void test_a_rigid_rotation_leaves_only_the_shear_within_a_cell(void **unused)
{
    (void)unused;
    const double cell = 0.5, turn = 3, side = 10;
    const struct scene scene = box_scene(side, side, BORDER_WALL, BORDER_WALL);
    struct grains grains = gas(&scene, 100000, 0);
    for (uint32_t k = 0; k < grains.count; k++) {
        grains.vx[k] = 1e4 - turn * (grains.y[k] - 5);
        grains.vy[k] = turn * (grains.x[k] - 5);
    }
    struct map *map = make(&scene, cell, KERNEL_BOX, NAN);
    map_add(map, &grains);
    struct field heat = field_of(map, MAP_temperature), flow = field_of(map, MAP_velocity);
    struct field speed = field_of(map, MAP_speed);
    for (uint32_t c = 0; c < heat.nx * heat.ny; c++) {
        /* |v - u| <= turn * distance from the cell's mean position; T = turn^2 (sx^2 + sy^2) / 2
         * with sx^2 = cell^2 / 12 for places spread evenly: 250 grains scatter it by 6 %, and it
         * can never exceed that of all grains in the corners, cell^2 / 4. */
        CHECK_NEAR(heat.values[c], turn * turn * cell * cell / 12, turn * turn * cell * cell / 30);
        const double x = (c % heat.nx + 0.5) * cell - 5, y = (c / heat.nx + 0.5) * cell - 5;
        /* The mean position scatters by cell / sqrt(12 * 250) about the centre. */
        const double slack = 5 * turn * cell / sqrt(12 * 200);
        CHECK_NEAR(flow.values[c], 1e4 - turn * y, slack);
        CHECK_NEAR(flow.values[heat.nx * heat.ny + c], turn * x, slack);
        CHECK_NEAR(speed.values[c], hypot(1e4 - turn * y, turn * x), 2 * slack);
    }
    field_free(&heat);
    field_free(&flow);
    field_free(&speed);
    map_destroy(map);
    grains_free(&grains);
}

static void test_a_fast_uniform_stream_is_cold(void **unused)
{
    (void)unused;
    const struct scene scene = box_scene(8, 8, BORDER_PERIODIC, BORDER_PERIODIC);
    struct grains grains = gas(&scene, 5000, 1e-6);
    for (uint32_t k = 0; k < grains.count; k++) grains.vx[k] += 1e3;
    for (size_t k = 0; k < 3; k++) {
        struct map *map = make(&scene, 2, kernels[k], 0.7);
        map_add(map, &grains);
        struct field heat = field_of(map, MAP_temperature);
        for (uint32_t c = 0; c < heat.nx * heat.ny; c++) {
            /* T = 1e-12 beside <v>^2 = 1e6: the textbook <v^2> - <v>^2 would be off by 1e-10.
             * 1e3 + v keeps v = 1e-6 to 1e-13 / 1e-6; the rest is 313 grains' scatter. */
            CHECK_NEAR(heat.values[c] * 1e12, 1, 6 / sqrt(313));
        }
        field_free(&heat);
        map_destroy(map);
    }
    grains_free(&grains);
}

static void test_a_disc_covers_its_own_area_wherever_it_lies(void **unused)
{
    (void)unused;
    struct rng rng = {99};
    for (int periodic = 0; periodic < 2; periodic++) {
        const enum border border = periodic ? BORDER_PERIODIC : BORDER_WALL;
        const struct scene scene = box_scene(10.3, 8, border, border);
        struct grains grains = gas(&scene, 1, 0);
        for (int n = 0; n < 300; n++) {
            const double r = grains.radius[0] = 0.05 + 2 * rng_uniform(&rng);
            const double keep = periodic ? 0 : r;       /* away from walls, across periodic sides */
            grains.x[0] = keep + (10.3 - 2 * keep) * rng_uniform(&rng);
            grains.y[0] = keep + (8 - 2 * keep) * rng_uniform(&rng);
            for (size_t k = 0; k < 3; k++) {
                struct map *map = make(&scene, 0.7, kernels[k], 0.9);
                map_add(map, &grains);
                struct field field = field_of(map, MAP_area_fraction);
                CHECK_NEAR(total(&field, &scene), M_PI * r * r, 1e-12 * (1 + r * r));
                for (uint32_t c = 0; c < field.nx * field.ny; c++) {
                    CHECK(field.values[c] >= 0);
                    CHECK(kernels[k] != KERNEL_BOX || field.values[c] < 1 + 1e-12);
                }
                field_free(&field);
                map_destroy(map);
            }
        }
        grains_free(&grains);
    }
}

/* Area of the unit disc in { x < a, y < b } by ten thousand strips along x. */
static double corner_by_strips(double a, double b)
{
    const int strips = 10000;
    const double end = fmin(a, 1);
    double sum = 0;
    for (int k = 0; k < strips; k++) {
        const double x = -1 + (k + 0.5) * (end + 1) / strips, half = sqrt(fmax(0, 1 - x * x));
        sum += fmax(0, fmin(b, half) + half);
    }
    return sum * (end + 1) / strips;
}

static void test_the_corner_of_a_disc_is_that_of_many_strips(void **unused)
{
    (void)unused;
    for (double a = -0.95; a < 1.2; a += 0.1) {
        for (double b = -0.95; b < 1.2; b += 0.1) {
            /* The midpoint rule errs by about (1 / strips)^1.5 at a vertical edge, and by as much
             * where the strip's upper end has a kink. */
            CHECK_NEAR(overlap_corner(a, b), corner_by_strips(a, b), 1e-5);
        }
    }
    CHECK(overlap_corner(-1, 3) == 0 && overlap_corner(2, -1.5) == 0);
    CHECK_NEAR(overlap_corner(1, 1), M_PI, 1e-15);
}

static void test_half_a_disc_lies_on_each_side_of_a_line_between_cells(void **unused)
{
    (void)unused;
    const struct scene scene = box_scene(4, 2, BORDER_WALL, BORDER_WALL);
    struct grains grains = gas(&scene, 1, 0);
    grains.x[0] = 2;
    grains.y[0] = 1;
    grains.radius[0] = 0.5;
    struct map *map = make(&scene, 2, KERNEL_BOX, NAN);
    map_add(map, &grains);
    struct field area = field_of(map, MAP_area_fraction), flow = field_of(map, MAP_velocity);
    struct field density = field_of(map, MAP_density), heat = field_of(map, MAP_temperature);
    CHECK_NEAR(area.values[0], M_PI / 8 / 4, 1e-15);
    CHECK_NEAR(area.values[1], M_PI / 8 / 4, 1e-15);
    CHECK(density.values[0] == 0 && density.values[1] == 0.25);
    CHECK(isnan(flow.values[0]) && isnan(flow.values[2]) && isnan(heat.values[0]));
    CHECK(flow.values[1] == 0 && heat.values[1] == 0);
    field_free(&area);
    field_free(&flow);
    field_free(&density);
    field_free(&heat);
    map_destroy(map);
    grains_free(&grains);
}

static void test_a_periodic_border_is_no_place_of_its_own(void **unused)
{
    (void)unused;
    /* Moving everything by whole cells, across the seam, moves the map by whole cells. */
    const struct scene scene = box_scene(8, 6, BORDER_PERIODIC, BORDER_PERIODIC);
    struct grains grains = gas(&scene, 40, 1);
    for (size_t k = 0; k < 3; k++) {
        struct map *a = make(&scene, 1, kernels[k], 0.8), *b = make(&scene, 1, kernels[k], 0.8);
        map_add(a, &grains);
        for (uint32_t n = 0; n < grains.count; n++) grains.x[n] += 3, grains.y[n] -= 2;
        map_add(b, &grains);            /* some are outside of the box now: images */
        for (uint32_t n = 0; n < grains.count; n++) grains.x[n] -= 3, grains.y[n] += 2;
        for (int kind = 0; kind < 2; kind++) {
            struct field before = field_of(a, (enum map_kind)kind);
            struct field after = field_of(b, (enum map_kind)kind);
            for (uint32_t j = 0; j < 6; j++) {
                for (uint32_t i = 0; i < 8; i++) {
                    CHECK_NEAR(after.values[(j + 4) % 6 * 8 + (i + 3) % 8],
                               before.values[j * 8 + i], 1e-12);
                }
            }
            field_free(&before);
            field_free(&after);
        }
        map_destroy(a);
        map_destroy(b);
    }
    grains_free(&grains);
}

static void test_grains_that_swing_together_are_cold_at_once_and_warm_on_average(void **unused)
{
    (void)unused;
    const struct scene scene = box_scene(4, 4, BORDER_WALL, BORDER_WALL);
    struct grains grains = gas(&scene, 200, 0);
    struct map *map = make(&scene, 4, KERNEL_BOX, NAN);
    for (uint32_t k = 0; k < 200; k++) grains.vx[k] = 5;
    grains.time = 1;
    map_add(map, &grains);
    struct field now = field_of(map, MAP_temperature);
    CHECK(now.values[0] == 0);
    CHECK(strstr(now.label, "snapshot at t = 1") != NULL);
    for (uint32_t k = 0; k < 200; k++) grains.vx[k] = -5;
    grains.time = 2;
    map_add(map, &grains);
    struct field mean = field_of(map, MAP_temperature), density = field_of(map, MAP_density);
    CHECK_NEAR(mean.values[0], 0.5 * 25, 1e-12);        /* <v'^2>/2, v' = +-5 about zero */
    CHECK_NEAR(density.values[0], 200.0 / 16, 1e-12);   /* a mean, not a sum */
    CHECK(strstr(mean.label, "mean t = 1 .. 2") != NULL);
    map_clear(map);
    map_add(map, &grains);
    struct field again = field_of(map, MAP_temperature);
    CHECK(again.values[0] == 0);
    field_free(&now);
    field_free(&mean);
    field_free(&density);
    field_free(&again);
    map_destroy(map);
    grains_free(&grains);
}

static void test_heavy_grains_count_more_in_the_flow(void **unused)
{
    (void)unused;
    const struct scene scene = box_scene(2, 2, BORDER_WALL, BORDER_WALL);
    struct grains grains = gas(&scene, 2, 0);
    grains.mass[0] = 3;
    grains.mass[1] = 1;
    grains.vx[0] = 4;
    struct map *map = make(&scene, 2, KERNEL_BOX, NAN);
    map_add(map, &grains);
    struct field flow = field_of(map, MAP_velocity), heat = field_of(map, MAP_temperature);
    CHECK_NEAR(flow.values[0], 3, 1e-15);       /* momentum 12 over mass 4 */
    CHECK_NEAR(heat.values[0], 0.5 * (3 * 1 + 1 * 9) / 4, 1e-15);
    field_free(&flow);
    field_free(&heat);
    map_destroy(map);
    grains_free(&grains);
}

static void test_a_smooth_kernel_has_the_width_it_says(void **unused)
{
    (void)unused;
    const double width = 1.5, cell = 0.1;
    const struct scene scene = box_scene(20, 20, BORDER_WALL, BORDER_WALL);
    struct grains grains = gas(&scene, 1, 0);
    grains.x[0] = 10.03;
    grains.y[0] = 9.98;
    for (size_t k = 1; k < 3; k++) {
        struct map *map = make(&scene, cell, kernels[k], width);
        map_add(map, &grains);
        struct field field = field_of(map, MAP_density);
        double sum = 0, square = 0;
        for (uint32_t c = 0; c < field.nx * field.ny; c++) {
            const double dx = (c % field.nx + 0.5) * cell - 10.03;
            sum += field.values[c];
            square += field.values[c] * dx * dx;
        }
        /* Cutting a Gaussian at 3 deviations takes 2.7 % of its variance; Lucy's is whole. */
        CHECK_NEAR(square / sum, width * width, (k == 1 ? 0.03 : 0.002) * width * width);
        field_free(&field);
        map_destroy(map);
    }
    grains_free(&grains);
}

static void test_a_box_may_lie_anywhere_and_labels_carry_units(void **unused)
{
    (void)unused;
    struct scene scene = box_scene(10, 10, BORDER_WALL, BORDER_WALL);
    const double box[4] = {-5.3, 100.1, -1.1, 103.7};   /* 4.2 x 3.6: 5 x 4 cells, the last cut */
    memcpy(scene.box, box, sizeof box);
    scene.units = UNITS_CGS;
    struct grains grains = gas(&scene, 2, 0);
    grains.x[0] = -5.3, grains.y[0] = 100.1;
    grains.x[1] = -1.1, grains.y[1] = 103.7;
    struct map *map = make(&scene, 1, KERNEL_BOX, NAN);
    grains.time = 0.25;
    map_add(map, &grains);
    struct field density = field_of(map, MAP_density), heat = field_of(map, MAP_temperature);
    struct field turn = field_of(map, MAP_spin_temperature);
    CHECK(density.nx == 5 && density.ny == 4 && density.x0 == -5.3 && density.y0 == 100.1);
    CHECK_NEAR(density.values[0], 1, 1e-12);
    CHECK_NEAR(density.values[19], 1 / (0.2 * 0.6), 1e-9);      /* one grain in what is left */
    CHECK(strcmp(heat.label, "granular temperature (cm^2/s^2), snapshot at t = 0.25 s") == 0);
    CHECK(strcmp(heat.unit, "cm^2/s^2") == 0 && strcmp(turn.unit, "1/s^2") == 0);
    CHECK(strcmp(density.name, "density") == 0 && heat.time == 0.25);
    field_free(&density);
    field_free(&heat);
    field_free(&turn);
    map_destroy(map);
    grains_free(&grains);
}

static void test_threads_and_lost_grains_change_nothing(void **unused)
{
    (void)unused;
    const struct scene scene = box_scene(16, 16, BORDER_WALL, BORDER_PERIODIC);
    struct grains grains = gas(&scene, 60000, 1);
    const int threads = omp_get_max_threads();
    for (size_t k = 0; k < 3; k++) {
        struct map *one = make(&scene, 0.5, kernels[k], 0.3);
        struct map *many = make(&scene, 0.5, kernels[k], 0.3);
        omp_set_num_threads(1);
        map_add(one, &grains);
        omp_set_num_threads(3);
        map_add(many, &grains);
        for (int kind = 0; kind < MAP_KINDS; kind++) {
            struct field a = field_of(one, (enum map_kind)kind);
            struct field b = field_of(many, (enum map_kind)kind);
            CHECK(memcmp(a.values, b.values, sizeof *a.values * a.nx * a.ny * a.components) == 0);
            field_free(&a);
            field_free(&b);
        }
        grains.x[0] = NAN;              /* a broken grain is left out and harms no other */
        grains.y[1] = INFINITY;
        grains.x[2] = -1;
        map_clear(one);
        map_add(one, &grains);
        struct field field = field_of(one, MAP_density);
        CHECK_NEAR(total(&field, &scene), 60000 - 3, 1e-6);
        field_free(&field);
        grains.x[0] = grains.y[1] = grains.x[2] = 1;
        map_destroy(one);
        map_destroy(many);
    }
    omp_set_num_threads(threads);
    grains_free(&grains);
}

static void test_what_cannot_be_mapped_is_refused_with_the_cure(void **unused)
{
    (void)unused;
    const struct scene scene = box_scene(1e4, 1e4, BORDER_WALL, BORDER_WALL);
    struct error error;
    struct measure fine = settings(0.01, KERNEL_BOX, NAN), wide = settings(10, KERNEL_GAUSS, 1e4);
    CHECK(map_create(&scene, &fine, &error) == NULL && strstr(error.text, "measure.cell"));
    CHECK(map_create(&scene, &wide, &error) == NULL && strstr(error.text, "measure.width"));
    char names[1][KEY_TEXT_MAX] = {"temprature"};
    struct measure named = settings(100, KERNEL_BOX, NAN);
    named.fields.count = 1;
    named.fields.texts = names;
    CHECK(map_create(&scene, &named, &error) == NULL && strstr(error.text, "spin_temperature"));
    strcpy(names[0], "temperature");
    struct map *map = map_create(&scene, &named, &error);
    struct field field;
    CHECK(map && !map_field(map, MAP_area_fraction, &field, &error));
    CHECK(strstr(error.text, "measure.fields") && map_field(map, MAP_density, &field, &error));
    field_free(&field);
    map_destroy(map);
    CHECK(map_find("speed") == MAP_speed && map_find("sped") == -1);
}

static void test_a_huge_box_has_a_map_of_coarser_cells(void **unused)
{
    (void)unused;
    const enum border sides[] = {BORDER_WALL, BORDER_PERIODIC};
    for (int k = 0; k < 2; k++) {
        const struct scene scene = box_scene(32768, 28377, sides[k], sides[k]);
        const struct measure measure = settings(NAN, KERNEL_BOX, NAN);
        double nx, ny;
        const double cell = field_cells(&scene, &measure, &nx, &ny);
        CHECK(nx * ny <= FIELD_CELLS_MAX && nx * ny > 0.9 * FIELD_CELLS_MAX);
        CHECK(cell * nx >= 32768 * (1 - 1e-9) && cell * ny >= 28377 * (1 - 1e-9));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_kernel_keeps_the_number_of_grains),
        cmocka_unit_test(test_a_uniform_gas_has_its_density_and_temperature),
        cmocka_unit_test(test_a_rigid_rotation_leaves_only_the_shear_within_a_cell),
        cmocka_unit_test(test_a_fast_uniform_stream_is_cold),
        cmocka_unit_test(test_a_disc_covers_its_own_area_wherever_it_lies),
        cmocka_unit_test(test_the_corner_of_a_disc_is_that_of_many_strips),
        cmocka_unit_test(test_half_a_disc_lies_on_each_side_of_a_line_between_cells),
        cmocka_unit_test(test_a_periodic_border_is_no_place_of_its_own),
        cmocka_unit_test(test_grains_that_swing_together_are_cold_at_once_and_warm_on_average),
        cmocka_unit_test(test_heavy_grains_count_more_in_the_flow),
        cmocka_unit_test(test_a_smooth_kernel_has_the_width_it_says),
        cmocka_unit_test(test_a_box_may_lie_anywhere_and_labels_carry_units),
        cmocka_unit_test(test_threads_and_lost_grains_change_nothing),
        cmocka_unit_test(test_what_cannot_be_mapped_is_refused_with_the_cure),
        cmocka_unit_test(test_a_huge_box_has_a_map_of_coarser_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
