/* test_wall.c - distances from walls against brute force; walls that move, shake and open.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "scene/wall.h"

/* A point of the wall's line at share s of its length. */
static void point_on(const struct wall *wall, double s, double *x, double *y)
{
    if (wall->shape == WALL_SEGMENT) {
        *x = wall->x0 + s * (wall->x1 - wall->x0);
        *y = wall->y0 + s * (wall->y1 - wall->y0);
        return;
    }
    const double from = wall->shape == WALL_ARC ? wall->angle0 : 0;
    const double to = wall->shape == WALL_ARC ? wall->angle1 : 2 * M_PI;
    *x = wall->cx + wall->radius * cos(from + s * (to - from));
    *y = wall->cy + wall->radius * sin(from + s * (to - from));
}

enum { SAMPLES = 20000 };

static double sampled_distance(const struct wall *wall, double x, double y)
{
    double best = INFINITY;
    for (int k = 0; k <= SAMPLES; k++) {
        double px, py;
        point_on(wall, (double)k / SAMPLES, &px, &py);
        best = fmin(best, hypot(x - px, y - py));
    }
    return best;
}

static struct wall random_wall(struct rng *rng, enum wall_shape shape)
{
    struct wall wall = {.shape = shape, .opens = INFINITY, .closes = INFINITY};
    wall.x0 = rng_uniform(rng);
    wall.y0 = rng_uniform(rng);
    wall.x1 = rng_uniform(rng);
    wall.y1 = rng_uniform(rng);
    wall.cx = rng_uniform(rng);
    wall.cy = rng_uniform(rng);
    wall.radius = 0.1 + rng_uniform(rng);
    if (shape != WALL_ARC) return wall;
    wall.angle0 = 4 * M_PI * (rng_uniform(rng) - 0.5);
    wall.angle1 = wall.angle0 + 0.01 + 6.27 * rng_uniform(rng);
    point_on(&wall, 0, &wall.x0, &wall.y0);
    point_on(&wall, 1, &wall.x1, &wall.y1);
    return wall;
}

static void test_the_nearest_point_of_a_wall_is_the_nearest_of_many_samples(void **unused)
{
    (void)unused;
    struct rng rng = rng_stream(7, 1, 1);
    for (int k = 0; k < 300; k++) {
        const struct wall wall = random_wall(&rng, (enum wall_shape)(k % 3));
        const double x = 4 * rng_uniform(&rng) - 1.5, y = 4 * rng_uniform(&rng) - 1.5;
        const struct wall_nearest near = wall_nearest(&wall, x, y);
        const double sampled = sampled_distance(&wall, x, y);
        const bool inside = wall.shape == WALL_DISC && hypot(x - wall.cx,
                                                             y - wall.cy) < wall.radius;
        /* The samples are at most h = 2 pi 1.1 / 20000 = 3.5e-4 apart; the true distance is no
         * more than h/2 below the sampled one, and never above it. */
        const double distance = inside ? -near.distance : near.distance;
        CHECK(distance <= sampled + 1e-12);
        CHECK_NEAR(distance, sampled, 2e-4);
        CHECK_NEAR(near.nx * near.nx + near.ny * near.ny, 1, 1e-12);
        /* Going back along the normal leads onto the wall. */
        CHECK_NEAR(sampled_distance(&wall, x - near.distance * near.nx,
                                    y - near.distance * near.ny),
                   0, 2e-4);
    }
}

static void test_ends_are_told_from_the_interior(void **unused)
{
    (void)unused;
    const struct wall segment = {.shape = WALL_SEGMENT, .x0 = 0, .y0 = 0, .x1 = 2, .y1 = 0};
    CHECK(wall_nearest(&segment, 1, 1).end == 0);
    CHECK(wall_nearest(&segment, -1, 1).end == 1);
    CHECK(wall_nearest(&segment, 3, 1).end == 2);
    CHECK_NEAR(wall_nearest(&segment, 1, -1).ny, -1, 0);
    CHECK_NEAR(fabs(wall_nearest(&segment, 1, 0).ny), 1, 0);            /* on the wall itself */
    const struct wall arc = {.shape = WALL_ARC, .radius = 1, .angle0 = 0, .angle1 = M_PI / 2,
                             .x0 = 1, .y1 = 1};
    CHECK(wall_nearest(&arc, 1, 1).end == 0);
    CHECK(wall_nearest(&arc, 2, -1).end == 1);
    CHECK(wall_nearest(&arc, -1, 2).end == 2);
    CHECK_NEAR(wall_nearest(&arc, 0, 0).distance, 1, 0);
    const struct wall disc = {.shape = WALL_DISC, .radius = 2};
    CHECK_NEAR(wall_nearest(&disc, 0, 1).distance, -1, 1e-15);
    CHECK_NEAR(wall_nearest(&disc, 0, 1).ny, 1, 0);                     /* the way out */
}

static void test_bounds_hold_every_sample_and_touch_one_on_each_side(void **unused)
{
    (void)unused;
    struct rng rng = rng_stream(7, 2, 1);
    for (int k = 0; k < 300; k++) {
        const struct wall wall = random_wall(&rng, (enum wall_shape)(k % 3));
        double b[4], seen[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY};
        wall_bounds(&wall, &b[0], &b[1], &b[2], &b[3]);
        for (int s = 0; s <= 2000; s++) {
            double x, y;
            point_on(&wall, s / 2000.0, &x, &y);
            seen[0] = fmin(seen[0], x);
            seen[1] = fmin(seen[1], y);
            seen[2] = fmax(seen[2], x);
            seen[3] = fmax(seen[3], y);
        }
        /* A circle between two samples rises by h^2 / (8 r), h = 2 pi r / 2000. */
        for (int side = 0; side < 4; side++) CHECK_NEAR(b[side], seen[side], 1e-5);
    }
}

static void test_a_wall_moves_only_in_its_time_and_shakes_about_its_place(void **unused)
{
    (void)unused;
    const struct wall slide = {.shape = WALL_SEGMENT, .x1 = 1, .vx = 2, .vy = -1, .moves_from = 1,
                               .moves_to = 3, .opens = INFINITY, .closes = INFINITY};
    const double times[] = {0, 1, 2, 3, 9}, shifts[] = {0, 0, 2, 4, 4}, speeds[] = {0, 2, 2, 0, 0};
    for (int k = 0; k < 5; k++) {
        const struct wall at = wall_at(&slide, times[k]);
        CHECK_NEAR(at.x0, shifts[k], 1e-15);
        CHECK_NEAR(at.x1, 1 + shifts[k], 1e-15);
        CHECK_NEAR(at.y0, -shifts[k] / 2, 1e-15);
        CHECK_NEAR(at.vx, speeds[k], 0);
    }
    const struct wall shake = {.shape = WALL_DISC, .radius = 1, .amplitude_y = 0.5, .frequency = 2,
                               .moves_to = INFINITY};
    CHECK_NEAR(wall_at(&shake, 0.125).cy, 0.5, 1e-15);                  /* a quarter of a period */
    /* The velocity is the slope of the position: central difference, error (2 pi f h)^2 / 6. */
    const double h = 1e-5, low = wall_at(&shake, 0.3 - h).cy, high = wall_at(&shake, 0.3 + h).cy;
    CHECK_NEAR(wall_at(&shake, 0.3).vy, (high - low) / (2 * h), 1e-7);
    CHECK(wall_moves(&slide) && wall_moves(&shake));
    const struct wall still = {.shape = WALL_DISC, .vx = 1, .moves_from = 2, .moves_to = 2};
    CHECK(!wall_moves(&still));
}

static void test_a_gate_is_gone_between_its_times(void **unused)
{
    (void)unused;
    const struct wall gate = {.opens = 1, .closes = 2}, wall = {.opens = INFINITY,
                                                                .closes = INFINITY};
    CHECK(wall_present(&gate, 0.99) && !wall_present(&gate, 1) && !wall_present(&gate, 1.99));
    CHECK(wall_present(&gate, 2));
    CHECK(wall_present(&wall, 1e9));
    CHECK(wall_is_gate(&gate) && !wall_is_gate(&wall));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_nearest_point_of_a_wall_is_the_nearest_of_many_samples),
        cmocka_unit_test(test_ends_are_told_from_the_interior),
        cmocka_unit_test(test_bounds_hold_every_sample_and_touch_one_on_each_side),
        cmocka_unit_test(test_a_wall_moves_only_in_its_time_and_shakes_about_its_place),
        cmocka_unit_test(test_a_gate_is_gone_between_its_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
