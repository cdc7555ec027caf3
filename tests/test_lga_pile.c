/* test_lga_pile.c - the sandpile automaton: density waves in a rough pipe, and the slope of a heap.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Reference numbers come from an independent program for the same rules, as means and standard
 * errors over three seeds.
 */
#include "lga_gas.h"

#define ROW_HEIGHT 0.86602540378443864676

static struct lga *lattice(uint32_t columns, uint32_t rows, struct lga_rule rule, uint64_t seed)
{
    struct lga *lga = calloc(1, sizeof *lga);
    lga->lattice = (struct lga_lattice){.columns = columns, .rows = rows, .spacing = 1, .along = 1,
                                        .across = 1};
    lga->sites = columns * rows;
    lga->rule = rule;
    lga->seed = seed;
    lga->tick = 1;
    lga->sinks = rule.heap;
    CHECK(lga_step_allocate(lga));
    return lga;
}

static void lattice_free(struct lga *lga)
{
    arena_free(&lga->arena);
    free(lga);
}

static double random_unit(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/* --- a pipe of eleven nodes between its walls, 400 high, periodic --- */

enum { PIPE_WIDTH = 11, PIPE_HEIGHT = 400, SLAB = 20, SLABS = PIPE_HEIGHT / SLAB, SEEDS = 3 };

struct flow { double speed, moving, contrast; };

static struct lga *pipe_filled(double loss, double roughness, uint64_t seed)
{
    const struct lga_rule rule = {.method = LGA_SANDPILE, .gravity = true, .fall = 0.5, .gain = 1,
                                  .loss = loss, .smooth = 1 - roughness, .strict = true};
    struct lga *lga = lattice(PIPE_WIDTH + 2, PIPE_HEIGHT, rule, seed);
    uint8_t kind[PIPE_WIDTH + 2] = {0};
    kind[0] = kind[PIPE_WIDTH + 1] = LGA_WALL;
    uint64_t state = seed;
    for (uint32_t y = 0; y < PIPE_HEIGHT; y++) {
        lga_bits_set_kinds(lga, y, kind);
        for (uint32_t x = 1; x <= PIPE_WIDTH; x++) {
            unsigned filled = 0;
            for (int k = 0; k < 7; k++) filled |= (unsigned)(random_unit(&state) < 0.8 / 7) << k;
            lga_node_set(lga, y * (PIPE_WIDTH + 2) + x, filled & 0x3f, filled >> 6);
        }
    }
    lga_bits_join_walls(lga);
    return lga;
}

/* Mean speed along +y, share of movers, and the rms of the density of slabs over its mean. */
static struct flow look(const struct lga *lga)
{
    double slabs[SLABS] = {0}, mass = 0, movers = 0, speed = 0, square = 0;
    for (uint32_t y = 0; y < PIPE_HEIGHT; y++) {
        uint64_t sum[LGA_PLANES], load = 0;
        lga_bits_sum(lga, y, sum);
        for (int p = 0; p < LGA_PLANES; p++) load += sum[p];
        movers += (double)(load - sum[LGA_DIRECTIONS]);
        speed += ROW_HEIGHT * ((double)(sum[1] + sum[2]) - (double)(sum[4] + sum[5]));
        slabs[y / SLAB] += (double)load;
        mass += (double)load;
    }
    for (int k = 0; k < SLABS; k++) square += pow(slabs[k] * SLABS / mass - 1, 2) / SLABS;
    return (struct flow){speed / mass, movers / mass, sqrt(square)};
}

static struct flow flow(double loss, double roughness)
{
    enum { TICKS = 16384, START = 2048, EVERY = 4 };
    struct flow mean = {0};
    double looks = 0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        struct lga *lga = pipe_filled(loss, roughness, seed);
        for (int t = 0; t < TICKS; t++) {
            lga_step(lga);
            if (t < START || t % EVERY) continue;
            const struct flow now = look(lga);
            mean.speed += now.speed;
            mean.moving += now.moving;
            mean.contrast += now.contrast;
            looks++;
        }
        lattice_free(lga);
    }
    return (struct flow){mean.speed / looks, mean.moving / looks, mean.contrast / looks};
}

static void test_rough_walls_and_loss_make_density_waves_in_a_pipe(void **unused)
{
    (void)unused;
    /* <v_y> -0.2011 +- 0.0009, movers 0.803, contrast 0.758 +- 0.004.  Ours scatters as much, and
     * where in the lattice the walls stand (on even or odd rows first, one more half node or less
     * of width) is not told: half a node in eleven is 4.5 %, and so much is allowed. */
    const struct flow wave = flow(0.5, 1);
    CHECK_NEAR(wave.speed, -0.2011, 0.045 * 0.2011);
    CHECK_NEAR(wave.moving, 0.803, 0.02);
    CHECK_NEAR(wave.contrast, 0.758, 0.045 * 0.758);
}

static void test_smoother_walls_and_little_loss_make_none(void **unused)
{
    (void)unused;
    /* <v_y> -0.3429, movers 0.900; the contrast 0.074 is that of independent grains: 11 x 20 nodes
     * of 0.8 grains give 0.071. */
    const struct flow even = flow(0.1, 0.9);
    CHECK_NEAR(even.speed, -0.3429, 0.045 * 0.3429);
    CHECK_NEAR(even.moving, 0.900, 0.01);
    CHECK_NEAR(even.contrast, 0.074, 0.006);
}

static void test_in_a_smooth_pipe_everything_falls_freely(void **unused)
{
    (void)unused;
    /* Nothing takes momentum up: all movers end in the two directions down, sqrt(3)/2 each. */
    struct lga *lga = pipe_filled(0.5, 0, 1);
    for (int t = 0; t < 2000; t++) lga_step(lga);
    const struct flow end = look(lga);
    CHECK_NEAR(end.speed, -ROW_HEIGHT, 1e-9);
    CHECK_NEAR(end.moving, 1, 1e-9);
    lattice_free(lga);
}

/* --- a heap on a plate, fed from a point --- */

enum { HEAP_WIDTH = 201, HEAP_HEIGHT = 120, GRAINS = 3000 };

static struct lga *heap_poured(uint64_t seed)
{
    const struct lga_rule rule = {.method = LGA_SANDPILE, .gravity = true, .fall = 0.5, .gain = 1,
                                  .loss = 0.5, .fly = true, .heap = true};
    struct lga *lga = lattice(HEAP_WIDTH, HEAP_HEIGHT, rule, seed);
    for (uint32_t n = 0; n < lga->sites; n++) {
        const uint32_t x = n % HEAP_WIDTH, y = n / HEAP_WIDTH;
        if (x == 0 || x == HEAP_WIDTH - 1 || y == HEAP_HEIGHT - 1) lga->kind[n] = LGA_SINK;
        if (y == 0) lga->kind[n] = LGA_WALL;
    }
    const uint32_t source = (HEAP_HEIGHT - 2) * HEAP_WIDTH + HEAP_WIDTH / 2;
    uint64_t state = seed;
    for (int poured = 0, after = 0; after < 300; lga_step(lga)) {
        if (poured == GRAINS) after++;
        else if (random_unit(&state) < 0.2 && !lga->rest[source]) {
            lga->rest[source] = 1;
            poured++;
        }
    }
    return lga;
}

/* The angle of the upper part, 40 to 90 % of the height, both sides together. */
static double upper_slope(const struct lga *lga)
{
    double top[HEAP_WIDTH] = {0}, most = 0, n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (uint32_t k = 0; k < lga->sites; k++) {
        if (lga->rest[k]) top[k % HEAP_WIDTH] = ROW_HEIGHT * (k / HEAP_WIDTH);
    }
    for (int x = 0; x < HEAP_WIDTH; x++) most = fmax(most, top[x]);
    for (int x = 0; x < HEAP_WIDTH; x++) {
        const double away = abs(x - HEAP_WIDTH / 2);
        if (top[x] < 0.4 * most || top[x] > 0.9 * most) continue;
        n++;
        sx += away;
        sy += top[x];
        sxx += away * away;
        sxy += away * top[x];
    }
    return -atan((n * sxy - sx * sy) / (n * sxx - sx * sx)) * 180 / M_PI;
}

static void test_a_poured_heap_is_almost_as_steep_as_the_lattice(void **unused)
{
    (void)unused;
    /* 56.5 +- 0.1 degrees for the upper slope; which part is upper is not told, and moving its
     * lower end between 20 and 40 % of the height changes ours by one degree.  The height of a
     * column is whole rows: over 20 columns that makes a seed scatter by 0.7 degrees. */
    double mean = 0;
    for (uint64_t seed = 1; seed <= 2; seed++) {
        struct lga *lga = heap_poured(seed);
        uint64_t grains = lga->grains_out;
        for (uint32_t n = 0; n < lga->sites; n++) grains += lga_node_load(lga, n);
        assert_int_equal(grains, GRAINS);
        mean += upper_slope(lga) / 2;
        lattice_free(lga);
    }
    CHECK_NEAR(mean, 56.5, 1 + 2 * 0.7 / sqrt(2));
}

/* --- a million ticks --- */

static void check_million(struct lga_rule rule)
{
    enum { COLUMNS = 300, ROWS = 20, TICKS = 1000000, EVERY = 10000 };
    struct lga *lga = gas(COLUMNS, ROWS, rule, 3);
    uint64_t state = 17;
    uint8_t kind[COLUMNS * ROWS] = {0};
    for (uint32_t n = 0; n < lga->sites; n++) {
        const uint32_t x = n % COLUMNS, y = n / COLUMNS;
        if (x == 0 || y == 0 || x == 99 || gas_unit(&state) < 0.03) kind[n] = LGA_WALL;
        if (x == 150 && y == 1) kind[n] = LGA_SINK;
    }
    gas_set_kinds(lga, kind);
    for (uint32_t n = 0; n < lga->sites; n++) {
        if (kind[n] == LGA_FLUID) lga_node_set(lga, n, gas_movers(&state, 0.15), 0);
    }
    const int64_t start = totals(lga).mass;
    for (int t = 1; t <= TICKS; t++) {
        lga_step(lga);
        if (t % EVERY) continue;
        assert_int_equal(totals(lga).mass + (int64_t)lga->grains_out, start);
        for (uint32_t n = 0; n < lga->sites; n++) {
            if (kind[n] != LGA_FLUID) assert_int_equal(lga_node_load(lga, n), 0);
        }
    }
    CHECK(lga->grains_out > 0 && totals(lga).mass > 0);
    gas_free(lga);
}

static void test_no_grain_is_lost_or_doubled_in_a_million_ticks(void **unused)
{
    (void)unused;
    /* Walls, a sink, gravity and loss; every grain is on a node or has gone down the sink. */
    check_million((struct lga_rule){.method = LGA_FHP2, .gain = 1, .loss = 0.1, .gravity = true,
                                    .fall = 0.01, .smooth = 0.5});
    check_million((struct lga_rule){.method = LGA_SANDPILE, .gain = 1, .loss = 0.1,
                                    .gravity = true, .fall = 0.1, .strict = true});
    check_million((struct lga_rule){.gain = 1, .inelastic = 0.1, .gravity = true, .fall = 0.1,
                                    .wall_stop = 0.1});
    check_million((struct lga_rule){.gain = 1, .inelastic = 0.5, .gravity = true, .fall = 0.5,
                                    .wall_stop = 0.5, .vertical = true, .friction = 0.5});
}

static void test_momentum_is_exact_for_a_million_ticks_where_nothing_takes_it_up(void **unused)
{
    (void)unused;
    static const struct lga_rule rules[] = {{.method = LGA_FHP2, .gain = 1},
                                            {.method = LGA_GMLG, .gain = 1, .inelastic = 1e-3}};
    for (int k = 0; k < 2; k++) {
        struct lga *lga = gas(64, 64, rules[k], 3);
        uint64_t state = 4;
        gas_set_kinds(lga, NULL);
        for (uint32_t n = 0; n < lga->sites; n++) lga_node_set(lga, n, gas_movers(&state, 0.2), 0);
        const struct totals start = totals(lga);
        for (int t = 0; t < 1000000; t++) lga_step(lga);
        const struct totals end = totals(lga);
        CHECK(end.mass == start.mass && end.twice_x == start.twice_x && end.y == start.y);
        gas_free(lga);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rough_walls_and_loss_make_density_waves_in_a_pipe),
        cmocka_unit_test(test_smoother_walls_and_little_loss_make_none),
        cmocka_unit_test(test_in_a_smooth_pipe_everything_falls_freely),
        cmocka_unit_test(test_no_grain_is_lost_or_doubled_in_a_million_ticks),
        cmocka_unit_test(test_momentum_is_exact_for_a_million_ticks_where_nothing_takes_it_up),
        cmocka_unit_test(test_a_poured_heap_is_almost_as_steep_as_the_lattice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
