/* test_lga_bits.c - the fast form of the lattice gas is the plain form, bit for bit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The plain form goes node by node through the table of collisions, which test_lga_gas.c
 * enumerates; here both start from the same lattice and take the same random bits.
 */
#include "check.h"
#include "model/lga/lga_bits.h"

#include <omp.h>

/* What stands on the lattice. */
enum ground { TORUS, BOX, PIPE, OBSTACLES, SINKS, CROWDED };

struct trial {
    uint32_t columns, rows;
    enum ground ground;
    struct lga_rule rule;
};

static uint64_t noise(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return *state >> 33;
}

static void make_kinds(const struct trial *trial, uint8_t *kind)
{
    uint64_t state = 7;
    for (uint32_t y = 0; y < trial->rows; y++) {
        for (uint32_t x = 0; x < trial->columns; x++) {
            const bool side = x == 0 || x + 1 == trial->columns;
            const bool end = y == 0 || y + 1 == trial->rows;
            uint8_t *k = &kind[y * trial->columns + x];
            *k = LGA_FLUID;
            if (trial->ground == BOX || trial->ground >= SINKS) *k = side || end ? LGA_WALL : *k;
            if (trial->ground == PIPE) *k = side ? LGA_WALL : *k;
            if (trial->ground == OBSTACLES) *k = noise(&state) % 5 == 0 ? LGA_WALL : *k;
            if (trial->ground == SINKS && y > 3 && y < 7 && x > 8 && x < 20) *k = LGA_SINK;
        }
    }
}

static struct lga *make(const struct trial *trial, bool plain, enum lga_simd simd)
{
    struct lga *lga = calloc(1, sizeof *lga);
    lga->lattice = (struct lga_lattice){.columns = trial->columns, .rows = trial->rows,
                                        .spacing = 1, .along = 1, .across = 1};
    lga->sites = trial->columns * trial->rows;
    lga->rule = trial->rule;
    lga->seed = 3;
    lga->tick = 1;
    lga->plain = plain;
    lga->sinks = trial->ground == SINKS;
    lga->rate.window = 7;
    CHECK(lga_step_allocate(lga));
    CHECK(plain == !lga->bits);
    if (simd < lga->simd) lga->simd = simd;
    lga->crowded = trial->ground == CROWDED;    /* more grains on a node than gravity lets in */
    uint8_t *kind = calloc(lga->sites, 1);
    make_kinds(trial, kind);
    if (plain) memcpy(lga->kind, kind, lga->sites);
    for (uint32_t y = 0; !plain && y < trial->rows; y++) {
        lga_bits_set_kinds(lga, y, kind + y * trial->columns);
    }
    if (!plain) lga_bits_join_walls(lga);
    uint64_t state = 99;
    for (uint32_t n = 0; n < lga->sites; n++) {
        unsigned moving = noise(&state) & noise(&state) & 0x3f;
        unsigned rest = (noise(&state) & 3) == 0;
        if (trial->rule.method == LGA_GMLG) {
            if (noise(&state) & 1) moving |= (unsigned)noise(&state) & 0x3f;
            const int most = lga->crowded ? 7 : 7 - __builtin_popcount(moving);
            rest = (unsigned)(noise(&state) % (uint64_t)(most + 1));
        }
        /* Grains of a sandpile need room to rest. */
        if (trial->rule.method == LGA_SANDPILE) moving &= (unsigned)noise(&state);
        if (kind[n] == LGA_FLUID) lga_node_set(lga, n, moving, rest);
    }
    free(kind);
    return lga;
}

static void unmake(struct lga *lga)
{
    arena_free(&lga->arena);
    free(lga);
}

static uint64_t mass(const struct lga *lga)
{
    uint64_t sum = 0;
    for (uint32_t n = 0; n < lga->sites; n++) sum += lga_node_load(lga, n);
    return sum;
}

/* Does a node belong to the heap? */
static bool is_heap(const struct lga *lga, uint32_t n)
{
    const uint32_t row = n / lga->lattice.columns, x = n % lga->lattice.columns;
    if (lga->heap) return lga->heap[n];
    return lga->rule.heap && lga_bits_heap(lga, row)[x % lga->words] >> x / lga->words & 1;
}

static void check_equal(const struct lga *a, const struct lga *b)
{
    for (uint32_t n = 0; n < a->sites; n++) {
        const struct lga_node p = lga_node_get(a, n), q = lga_node_get(b, n);
        CHECK(is_heap(a, n) == is_heap(b, n));
        CHECK(lga_rate_of(a, n) == lga_rate_of(b, n));
        if (p.moving == q.moving && p.rest == q.rest && p.kind == q.kind) continue;
        fail_msg("%u x %u, tick %d, node %u: %02x %d, not %02x %d", a->lattice.columns,
                 a->lattice.rows, (int)a->ticks, n, q.moving, q.rest, p.moving, p.rest);
    }
    CHECK(a->collisions == b->collisions);
    CHECK(a->grains_out == b->grains_out);
    CHECK(a->refused == b->refused);
}

static const struct lga_rule elastic = {.method = LGA_FHP2, .gain = 1};
static const struct lga_rule lossy = {.method = LGA_FHP2, .gain = 1, .loss = 0.3};
static const struct lga_rule heavy = {.method = LGA_FHP2, .gain = 1, .gravity = true, .fall = 0.2};
static const struct lga_rule all = {.method = LGA_FHP2, .gain = 0.9, .loss = 0.5, .gravity = true,
                                    .fall = 0.1, .smooth = 0.4};
static const struct lga_rule certain = {.method = LGA_FHP2, .gain = 0, .gravity = true, .fall = 1,
                                        .smooth = 1};

static const struct lga_rule cold = {.method = LGA_SANDPILE, .gain = 1, .loss = 0.7};
static const struct lga_rule pipe = {.method = LGA_SANDPILE, .gain = 1, .loss = 0.5,
    .gravity = true, .fall = 0.5, .strict = true, .smooth = 0.1};
static const struct lga_rule pile = {.method = LGA_SANDPILE, .gain = 1, .loss = 1,
    .gravity = true, .fall = 0.5, .fly = true};

static const struct lga_rule heaped = {.method = LGA_SANDPILE, .gain = 1, .loss = 0.5,
    .gravity = true, .fall = 0.5, .fly = true, .heap = true, .smooth = 0.3};
static const struct lga_rule sticky = {.method = LGA_SANDPILE, .gain = 0.7, .loss = 1,
    .gravity = true, .fall = 0.8, .fly = true, .strict = true, .heap = true};

static const struct lga_rule thin = {.method = LGA_GMLG, .gain = 1};
static const struct lga_rule cooling = {.method = LGA_GMLG, .gain = 0.7, .inelastic = 0.6,
                                        .wall_stop = 0.3};
static const struct lga_rule level = {.method = LGA_GMLG, .gain = 1, .inelastic = 0.5,
    .gravity = true, .fall = 0.5, .wall_stop = 0.5};
static const struct lga_rule upright = {.method = LGA_GMLG, .gain = 0.9, .inelastic = 0.9,
    .gravity = true, .vertical = true, .fall = 0.3, .friction = 0.4, .wall_stop = 0.9};
static const struct lga_rule stiff = {.method = LGA_GMLG, .gain = 1, .inelastic = 1,
    .gravity = true, .fall = 1, .friction = 0.7, .frozen = true, .wall_stop = 0};

static void test_bits_and_bytes_make_the_same_lattice(void **unused)
{
    (void)unused;
    /* Widths below, at and above a block of words, with and without a column to spare. */
    const struct trial trials[] = {
        {512, 6, TORUS, elastic}, {513, 4, TORUS, elastic}, {100, 8, TORUS, all},
        {8, 10, TORUS, lossy}, {2, 2, TORUS, all}, {1024, 4, PIPE, all}, {63, 20, PIPE, heavy},
        {64, 20, PIPE, lossy}, {65, 20, BOX, all}, {700, 10, BOX, certain},
        {100, 30, OBSTACLES, all},
        {512, 12, OBSTACLES, lossy}, {40, 30, SINKS, all}, {512, 10, SINKS, heavy},
        {120, 30, OBSTACLES, certain}, {100, 20, TORUS, cold}, {13, 60, PIPE, pipe},
        {600, 12, BOX, pile}, {512, 12, TORUS, pile}, {90, 40, SINKS, pile}, {90, 40, SINKS, cold},
        {90, 40, OBSTACLES, pile}, {700, 6, OBSTACLES, pipe},
        {65, 40, BOX, heaped}, {512, 20, BOX, sticky}, {90, 40, OBSTACLES, heaped},
        {600, 12, OBSTACLES, sticky}, {90, 40, SINKS, heaped}, {100, 20, TORUS, heaped},
        {100, 20, TORUS, thin}, {512, 8, TORUS, cooling}, {2, 2, TORUS, cooling},
        {513, 6, OBSTACLES, cooling}, {2, 2, TORUS, level}, {100, 4, TORUS, upright},
        {65, 30, BOX, level}, {65, 30, BOX, upright}, {65, 30, BOX, stiff},
        {512, 12, OBSTACLES, level}, {700, 12, OBSTACLES, upright}, {120, 16, OBSTACLES, stiff},
        {90, 40, SINKS, level}, {90, 40, SINKS, upright}, {90, 40, SINKS, cooling},
        {100, 20, CROWDED, level}, {100, 20, CROWDED, upright},
    };
    for (size_t k = 0; k < sizeof trials / sizeof *trials; k++) {
        struct lga *plain = make(&trials[k], true, LGA_SIMD_AVX512);
        struct lga *fast = make(&trials[k], false, LGA_SIMD_AVX512);
        const uint64_t start = mass(plain);
        check_equal(plain, fast);
        for (int t = 0; t < 60; t++) {
            lga_step(plain);
            lga_step(fast);
            check_equal(plain, fast);
            CHECK(mass(fast) + fast->grains_out == start);
        }
        CHECK(fast->collisions > 0);
        if (trials[k].ground == SINKS) CHECK(fast->grains_out > 0);
        uint32_t in_heap = 0;
        for (uint32_t n = 0; n < fast->sites; n++) in_heap += is_heap(fast, n);
        CHECK((in_heap > 0) == (trials[k].rule.heap && trials[k].ground != TORUS));
        unmake(plain);
        unmake(fast);
    }
}

/* The lattices are so large that their rows are shared out among threads. */
static void check_machines(const struct trial *trial)
{
    struct lga *reference = NULL;
    for (int simd = 0; simd < LGA_SIMD_LEVELS; simd++) {
        for (int threads = 1; threads <= 3; threads++) {
            omp_set_num_threads(threads);
            struct lga *lga = make(trial, false, (enum lga_simd)simd);
            for (int t = 0; t < 20; t++) lga_step(lga);
            if (!reference) {
                reference = lga;
                continue;
            }
            check_equal(reference, lga);
            CHECK(memcmp(reference->bits->planes, lga->bits->planes,
                         lga->bits->depth * sizeof(uint64_t) * trial->rows * lga->words) == 0);
            unmake(lga);
        }
    }
    unmake(reference);
    omp_set_num_threads(1);
}

static void test_every_set_of_instructions_and_number_of_threads_gives_the_same_bytes(void **unused)
{
    (void)unused;
    check_machines(&(struct trial){600, 120, OBSTACLES, all});
    check_machines(&(struct trial){600, 120, OBSTACLES, pile});
    check_machines(&(struct trial){600, 120, OBSTACLES, heaped});
    check_machines(&(struct trial){600, 120, OBSTACLES, level});
    check_machines(&(struct trial){600, 120, SINKS, upright});
    check_machines(&(struct trial){600, 120, TORUS, cooling});
}

static void check_held(const struct trial *trial)
{
    struct lga *lga[2] = {make(trial, true, LGA_SIMD_AVX512), make(trial, false, LGA_SIMD_AVX512)};
    for (int k = 0; k < 2; k++) {
        for (uint32_t n = 0; n < lga[k]->sites; n++) {
            if (lga_node_get(lga[k], n).kind == LGA_WALL) lga_node_set(lga[k], n, 0x2d, 1);
        }
        lga[k]->trapped = true;
    }
    for (int t = 0; t < 20; t++) {
        for (int k = 0; k < 2; k++) lga_step(lga[k]);
        check_equal(lga[0], lga[1]);
    }
    for (uint32_t n = 0; n < lga[1]->sites; n++) {
        const struct lga_node node = lga_node_get(lga[1], n);
        if (node.kind == LGA_WALL) CHECK(node.moving == 0x2d && node.rest == 1);
    }
    unmake(lga[0]);
    unmake(lga[1]);
}

static void test_a_grain_held_by_a_wall_waits(void **unused)
{
    (void)unused;
    check_held(&(struct trial){100, 10, OBSTACLES, lossy});
    check_held(&(struct trial){100, 10, OBSTACLES, pile});
    check_held(&(struct trial){100, 10, OBSTACLES, heaped});
    check_held(&(struct trial){100, 10, OBSTACLES, upright});
}

static uint64_t movers(const struct lga *lga)
{
    uint64_t sum = 0;
    for (uint32_t n = 0; n < lga->sites; n++) {
        sum += (uint64_t)__builtin_popcount(lga_node_get(lga, n).moving);
    }
    return sum;
}

static void step_both(struct lga *lga[2], int ticks)
{
    for (int t = 0; t < ticks; t++) {
        for (int k = 0; k < 2; k++) lga_step(lga[k]);
    }
    check_equal(lga[0], lga[1]);
}

/* Sand in a corner of a large box comes to rest, and then a grain falls from the middle.  Compared
 * to the plain form, or to the fast one on a single thread. */
static void check_settles(const struct trial *trial, bool plain)
{
    enum { TICKS_MAX = 3000, THREADS = 3 };
    struct lga *lga[2];
    lga[0] = make(trial, plain, LGA_SIMD_AVX512);
    omp_set_num_threads(THREADS);
    lga[1] = make(trial, false, LGA_SIMD_AVX512);
    omp_set_num_threads(1);
    CHECK(plain || lga[1]->bits->bands == THREADS);
    const uint32_t columns = trial->columns, middle = lga[0]->sites / 2 + columns / 2;
    for (int k = 0; k < 2; k++) {
        for (uint32_t n = 0; n < lga[k]->sites; n++) {
            if (n / columns > 16 || n % columns > 16) lga_node_set(lga[k], n, 0, 0);
        }
    }
    step_both(lga, 100);
    for (int t = 0; t < TICKS_MAX && movers(lga[1]) > 0; t += 20) step_both(lga, 20);
    CHECK(movers(lga[1]) == 0);
    CHECK(mass(lga[1]) > 500);
    step_both(lga, 20);
    for (int k = 0; k < 2; k++) lga_node_set(lga[k], middle, 0, 1);
    step_both(lga, 100);
    CHECK(lga_node_load(lga[1], middle) == 0);
    for (int k = 0; k < 2; k++) unmake(lga[k]);
}

static void test_sand_at_rest_lies_until_a_grain_falls_on_it(void **unused)
{
    (void)unused;
    check_settles(&(struct trial){60, 90, BOX, level}, true);
    check_settles(&(struct trial){60, 90, BOX, upright}, true);
    check_settles(&(struct trial){300, 220, BOX, level}, false);
    check_settles(&(struct trial){300, 220, BOX, upright}, false);
}

static void test_dice_fall_as_often_as_they_should(void **unused)
{
    (void)unused;
    /* 2^21 bits a die: the share deviates by sqrt(p q / 2^21), of which four are allowed, and the
     * cut of the probability by a thousandth of the smaller of p and q. */
    enum { ROWS = 64, WORDS = 512 };
    static const double probabilities[] = {0.5, 0.25, 0.3, 0.9, 0.05, 0.999, 1e-3};
    static _Alignas(64) uint64_t bits[WORDS];         /* as an arena gives them */
    for (size_t k = 0; k < sizeof probabilities / sizeof *probabilities; k++) {
        const double p = probabilities[k];
        struct lga_dice dice = {{{0}}};
        dice.of[LGA_DIE_LOSS] = lga_dice_die(p);
        uint64_t *out[LGA_DICE] = {NULL};
        out[LGA_DIE_LOSS] = bits;
        double sum = 0;
        for (uint32_t row = 0; row < ROWS; row++) {
            const struct lga_dice_source source = {1, 2, row, 0};
            lga_bits_roll(&dice, lga_dice_simd(), lga_dice_key(source), WORDS, out);
            for (int w = 0; w < WORDS; w++) sum += __builtin_popcountll(bits[w]);
        }
        const double n = 64.0 * ROWS * WORDS, least = fmin(p, 1 - p);
        CHECK_NEAR(sum / n, p, 4 * sqrt(p * (1 - p) / n) + 1e-3 * least);
    }
    CHECK(lga_dice_die(0.5).bits == 1);
    CHECK(lga_dice_die(1 / 3.0).threshold == LGA_CUT_THIRD);
    CHECK(lga_dice_die(1 / 3.0).bits == LGA_CUT_BITS);
    CHECK(lga_dice_die(1 / 5.0).threshold == LGA_CUT_FIFTH);
    CHECK(lga_dice_die(1 / 5.0).bits == LGA_CUT_BITS);
    CHECK(lga_dice_die(0).bits == 0 && lga_dice_die(0).threshold == 0);
    CHECK(lga_dice_die(1).bits == 0 && lga_dice_die(1).threshold == 1);
}

static void test_each_collision_is_counted_at_one_node(void **unused)
{
    (void)unused;
    /* Over a window of ten ticks, and what is not over yet counts not. */
    const struct lga_rule rules[] = {all, pile, level, cooling};
    for (size_t k = 0; k < sizeof rules / sizeof *rules; k++) {
        const struct trial trial = {130, 20, TORUS, rules[k]};
        struct lga *lga = make(&trial, false, LGA_SIMD_AVX512);
        lga->rate.window = 10;
        uint64_t before = 0, sum = 0;
        for (int t = 0; t < 25; t++) {
            if (t == 10) before = lga->collisions;
            if (t == 20) sum = lga->collisions - before;
            lga_step(lga);
        }
        double counted = 0;
        for (uint32_t n = 0; n < lga->sites; n++) counted += 10 * lga_rate_of(lga, n);
        CHECK(sum > 0);
        CHECK_NEAR(counted, (double)sum, 1e-6);
        unmake(lga);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bits_and_bytes_make_the_same_lattice),
        cmocka_unit_test(test_every_set_of_instructions_and_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(test_a_grain_held_by_a_wall_waits),
        cmocka_unit_test(test_sand_at_rest_lies_until_a_grain_falls_on_it),
        cmocka_unit_test(test_each_collision_is_counted_at_one_node),
        cmocka_unit_test(test_dice_fall_as_often_as_they_should),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
