/* test_dsmc_heap.c - heaps of cells that can be full, and what plain DSMC makes of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Units: d = g = 1.  A heap grows by one grain a time unit, which begins 5 d above what lies
 * highest (paper 000, 3.4): from a fixed place it falls the farther the smaller the heap still is,
 * and with a fall of 70 d the splash makes the slope a fifth flatter.  `slow` as the first argument
 * runs the long ones.
 */
#include "measure/heap.h"
#include "scenes.h"

#include <omp.h>

enum { COLUMNS = 100 };         /* of two diameters, the cells of hsmc */

enum { ABOVE = 5 };             /* fall onto the top of the heap */

/* height 0: a low box whose source does not rise. */
static struct scenes_run *begin_heap(uint32_t count, double height, const char *settings)
{
    char text[1200];
    snprintf(text, sizeof text,
        "until = 1e6; seed = 1; box = [%d.0, 0.0, %d.0, %g]; left = \"open\"; right = \"open\";"
        "top = \"open\"; gravity = (0.0, -1.0);"
        "grains = ({ radius = 0.5; density = 1.2732395447351628; restitution = 0.9; });"
        "sources = ({ position = (0.0, %d.0); above = %d; width = 1.0; rate = 1.0; count = %u; });"
        "dsmc = { %s };", -COLUMNS, COLUMNS,
        height > 0 ? height : 22, ABOVE, height > 0 ? ABOVE : 0, count, settings);
    return scenes_begin(text, "dsmc");
}

/* Grains in each cell; returns the most. */
static uint32_t load_cells(const struct grains *grains, uint32_t columns[COLUMNS])
{
    enum { ROWS = 200 };
    uint32_t most = 0;
    uint32_t (*cells)[ROWS] = calloc(COLUMNS, sizeof *cells);
    memset(columns, 0, COLUMNS * sizeof *columns);
    for (uint32_t i = 0; i < grains->count; i++) {
        const int x = (int)floor((grains->x[i] + COLUMNS) / 2), y = (int)floor(grains->y[i] / 2);
        if (x < 0 || x >= COLUMNS || y < 0 || y >= ROWS) continue;
        columns[x]++;
        if (++cells[x][y] > most) most = cells[x][y];
    }
    free(cells);
    return most;
}

/* Mean slope of both flanks where they are 15 to 85 % of the height; two grains of a column are
 * one diameter of height. */
static double slope_of(const uint32_t columns[COLUMNS])
{
    uint32_t top = 0;
    for (uint32_t k = 1; k < COLUMNS; k++) if (columns[k] > columns[top]) top = k;
    double slope = 0;
    for (int side = -1; side <= 1; side += 2) {
        double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
        for (uint32_t k = 0; k < COLUMNS; k++) {
            const double x = 2.0 * side * ((double)k - top), y = 0.5 * columns[k];
            const double share = (double)columns[k] / columns[top];
            if (x <= 0 || share < 0.15 || share > 0.85) continue;
            n++;
            sx += x;
            sy += y;
            sxx += x * x;
            sxy += x * y;
        }
        CHECK(n > 5);
        slope -= 0.5 * (n * sxy - sx * sy) / (n * sxx - sx * sx);
    }
    return slope;
}

struct heap_state { double slope, energy, height; uint32_t most; };

static struct heap_state heap_after(struct scenes_run *run, double t)
{
    uint32_t columns[COLUMNS];
    scenes_advance(run, t);
    const struct counters counters = simulation_count(&run->sim);
    struct grains grains = scenes_look(run);
    struct heap_state state = {.energy = counters.kinetic_energy / (double)counters.grains};
    state.most = load_cells(&grains, columns);
    state.slope = slope_of(columns);
    for (uint32_t i = 0; i < grains.count; i++) state.height += grains.y[i] / grains.count;
    grains_free(&grains);
    return state;
}

static void check_heap(uint32_t count, double low, double high, double later)
{
    struct scenes_run *run = begin_heap(count, 50, "method = \"hsmc\"; reach = 2;");
    const struct heap_state at_rest = heap_after(run, count + 500.0);
    print_message("slope %.4f, most in a cell %u\n", at_rest.slope, at_rest.most);
    CHECK(at_rest.slope > low && at_rest.slope < high);
    CHECK(at_rest.most == 4);                                   /* full, never more */
    CHECK(at_rest.energy < 1e-6);
    const struct heap_state old = heap_after(run, count + later);
    CHECK(old.most == 4);
    CHECK_NEAR(old.slope, at_rest.slope, 0.01);                 /* it does not creep */
    CHECK_NEAR(old.height, at_rest.height, 0.01 * at_rest.height);
    scenes_end(run);
}

static void test_a_heap_stands_at_its_slope_and_does_not_creep(void **unused)
{
    (void)unused;
    /* 0.461(6) with 3000 grains, 37 d high, by an independent program.  Top and foot are round by
     * about a row of cells (2 d) each, which makes a heap of 19 d flatter by up to 4/19 - 4/37, a
     * tenth: 0.41 to 0.46.  Heaps of 800 grains scatter by 0.012; three of that. */
    check_heap(800, 0.37, 0.50, 1000);
}

static void test_a_large_heap_has_the_known_slope(void **unused)
{
    (void)unused;
    check_heap(3000, 0.43, 0.49, 3000);
}

static void test_grains_that_roll_less_far_make_a_steeper_heap(void **unused)
{
    (void)unused;
    struct scenes_run *run = begin_heap(3200, 70, "method = \"hsmc\"; reach = 1;");
    /* About 0.9 / reach.  Top and foot are round by about a row of cells (2 d) each, and the heap
     * is 53 d high: flatter by up to 4/53.  (0.811(7), 0.843(8), 0.869(2) and 0.883 for 800, 1600,
     * 3200 and 6400 grains.)  Heaps of this size scatter by 0.005. */
    const double slope = heap_after(run, 3700).slope;
    print_message("slope %.4f\n", slope);
    CHECK_NEAR(slope, 0.9, 0.9 * 4 / 53 + 3 * 0.005);
    scenes_end(run);
}

static bool is_told(const struct findings *findings, const char *word)
{
    for (uint32_t k = 0; k < findings->count && k < FINDINGS_MAX; k++) {
        if (strstr(findings->list[k].text, word)) return true;
    }
    return false;
}

static void test_a_rising_source_keeps_its_height_above_the_heap(void **unused)
{
    (void)unused;
    struct scenes_run *run = begin_heap(400, 50, "method = \"hsmc\"; reach = 1;");
    uint32_t seen = 0, born = 0;
    double top = 0;
    for (int t = 1; t <= 400; t++) {
        scenes_advance(run, t);
        struct grains grains = scenes_look(run);                /* sorted by age */
        const uint32_t last = grains.count - 1;
        top = 0;
        for (uint32_t i = 0; i < last; i++) {
            if (grains.vx[i] == 0 && grains.vy[i] == 0) top = fmax(top, grains.y[i]);
        }
        /* The youngest has fallen for a time unit at most, by 1/2, and the picture shows a grain at
         * rest anywhere in its cell of 2 x 2. */
        if (grains.count > seen && top > 2) {
            CHECK_NEAR(grains.y[last], top + ABOVE - 0.25, 0.25 + 2);
            born++;
        }
        seen = grains.count;
        grains_free(&grains);
    }
    CHECK(born > 300);
    CHECK(top > 10);                                            /* it did rise */
    scenes_end(run);
}

static void test_a_source_rises_only_where_grains_come_to_rest(void **unused)
{
    (void)unused;
    struct findings findings;
    static const char *const text = "until = 10; box = [0.0, 0.0, 20.0, 30.0]; gravity = (0.0, %s);"
        "grains = ({ radius = 0.5; restitution = 0.9; });"
        "sources = ({ position = (10.0, 5.0); above = 5; %s });"
        "dsmc = { method = \"%s\"; };";
    static const char *const cases[][4] = {
        {"-1.0", "rate = 1.0;", "dense", "come to rest by hsmc only"},
        {"1.0", "rate = 1.0;", "hsmc", "against gravity"},
        {"-1.0", "kind = \"stream\"; width = 4.0; velocity = (1.0, 0.0);", "hsmc",
         "a stream cannot"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char scene[700];
        snprintf(scene, sizeof scene, text, cases[k][0], cases[k][1], cases[k][2]);
        scene_free(scenes_load(scene, "dsmc", &findings));
        CHECK(findings.errors > 0 && is_told(&findings, cases[k][3]));
    }
    /* Discs that collide know no rest. */
    char scene[700];
    snprintf(scene, sizeof scene, text, "-1.0", "rate = 1.0;", "hsmc");
    struct scene *loaded = scenes_load(scene, "ed", &findings);
    struct simulation sim = {0};
    struct error error = {0};
    CHECK(loaded && findings.errors == 0);
    CHECK(!simulation_create(&sim, model_find("ed"), loaded, &error));
    CHECK(strstr(error.text, "rising source"));
    scene_free(loaded);
}

/* Grains fall to the floor of a box 20 wide; the most in a cell of two diameters. */
static uint32_t crowd_on_the_floor(const char *settings)
{
    char text[1000];
    snprintf(text, sizeof text,
        "until = 1e6; seed = 1; box = [0.0, 0.0, 20.0, 30.0]; gravity = (0.0, -1.0);"
        "grains = ({ radius = 0.5; restitution = 0.9; });"
        "placements = ({ kind = \"square\"; spacing = 1.3; temperature = 1.0; count = 300; });"
        "dsmc = { %s };", settings);
    struct scenes_run *run = scenes_begin(text, "dsmc");
    uint32_t columns[COLUMNS];
    scenes_advance(run, 600);
    struct grains grains = scenes_look(run);
    CHECK(grains.count == 300);
    const uint32_t most = load_cells(&grains, columns);
    grains_free(&grains);
    scenes_end(run);
    return most;
}

static void test_plain_dsmc_lets_grains_at_rest_fall_into_each_other(void **unused)
{
    (void)unused;
    /* 300 grains would fill ten columns 7.5 cells high, four a cell.  Points do not mind. */
    const uint32_t plain = crowd_on_the_floor("method = \"plain\";");
    const uint32_t full = crowd_on_the_floor("method = \"hsmc\";");
    print_message("most in a cell: plain %u, hsmc %u\n", plain, full);
    CHECK(plain > 12);
    CHECK(full == 4);
}

static void test_what_goes_wrong_is_told_before_the_run(void **unused)
{
    (void)unused;
    struct scenes_run *run = begin_heap(30, 0, "method = \"plain\";");
    CHECK(is_told(&run->findings, "runs away"));
    scenes_end(run);
    run = begin_heap(30, 0, "");
    CHECK(is_told(&run->findings, "runs away"));
    scenes_end(run);
    run = begin_heap(30, 0, "method = \"hsmc\";");
    CHECK(run->findings.count == 0);
    scenes_end(run);
    run = begin_heap(30, 0, "method = \"hsmc\"; cell = 0.5;");
    CHECK(is_told(&run->findings, "less than a diameter"));
    scenes_end(run);
    run = begin_heap(30, 0, "method = \"plain\"; dt = 5.0;");
    CHECK(is_told(&run->findings, "of a cell in a step"));
    scenes_end(run);
}

/* How many of 600 grains have come in, ten time units after all are due. */
static double let_in(double rate, bool *warned)
{
    char text[700];
    const double until = 600 / rate + 10;
    snprintf(text, sizeof text,
        "until = %g; seed = 5; box = [-60, 0, 60, 40]; left = \"open\"; right = \"open\";"
        "top = \"open\"; gravity = (0, -1); grains = ({ radius = 0.5; restitution = 0.9; });"
        "sources = ({ position = (0, 20); width = 2; rate = %g; count = 600; });"
        "dsmc = { method = \"hsmc\"; };", until, rate);
    struct scenes_run *run = scenes_begin(text, "dsmc");
    *warned = is_told(&run->findings, "carry off 3;");
    scenes_advance(run, until);
    const double in = (double)simulation_count(&run->sim).grains_in;
    scenes_end(run);
    return in;
}

/* With the slope of 0.46 a heap of 600 is sqrt(0.46 600) = 17 high.  Poured from 20, all have room
 * if there is time to roll.  If there is not, their own steep heap blocks the source: of ten a time
 * unit four at most can roll away (dsmc_settings.c).  352 of 600 were seen. */
static void test_what_is_poured_faster_than_it_rolls_blocks_its_source(void **unused)
{
    (void)unused;
    bool warned;
    CHECK(let_in(1, &warned) == 600);
    CHECK(!warned);
    CHECK(let_in(10, &warned) < 550);
    CHECK(warned);
}

static void test_sand_runs_out_of_a_funnel(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin(
        "until = 1e6; seed = 2; box = [-20.0, 0.0, 20.0, 60.0]; bottom = \"open\";"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.7; });"
        "placements = ({ kind = \"square\"; spacing = 1.1; region = [-10.0, 36.0, 10.0, 56.0]; });"
        "walls = ({ shape = \"polyline\"; points = ((-20.0, 45.0), (-4.0, 20.0)); },"
        "         { shape = \"polyline\"; points = ((4.0, 20.0), (20.0, 45.0)); });"
        "dsmc = { method = \"hsmc\"; };", "dsmc");
    const struct counters before = simulation_count(&run->sim);
    scenes_advance(run, 200);
    struct grains grains = scenes_look(run);
    const struct counters after = simulation_count(&run->sim);
    /* All but a few that rest on others at the rim; nobody is left outside of the walls. */
    CHECK(after.grains_out > 0.9 * (double)before.grains);
    for (uint32_t i = 0; i < grains.count; i++) {
        const double rim = 4 + (grains.y[i] - 20) * 16 / 25;
        if (grains.y[i] > 20 && grains.y[i] < 45) CHECK(fabs(grains.x[i]) < rim);
    }
    grains_free(&grains);
    scenes_end(run);
}

static void test_a_heap_of_thirty_thousand_has_the_tail_of_equation_8(void **unused)
{
    (void)unused;
    enum { COUNT = 30500, HALF = 320 };
    struct scenes_run *run = scenes_begin(
        "until = 1e6; seed = 1; box = [-320.0, 0.0, 320.0, 150.0]; left = \"open\";"
        "right = \"open\"; top = \"open\"; gravity = (0.0, -1.0);"
        "grains = ({ radius = 0.5; density = 1.2732395447351628; restitution = 0.9; });"
        "sources = ({ position = (0.0, 5.0); above = 5; width = 1.0; rate = 1.0; count = 30500; });"
        "dsmc = { method = \"hsmc\"; reach = [1, 3]; };", "dsmc");
    scenes_advance(run, COUNT + 500);
    struct grains grains = scenes_look(run);
    CHECK(grains.count == COUNT);
    struct heap heap;
    struct heap_tail tail;
    struct error error = {0};
    CHECK(heap_create(&grains, -HALF, HALF, HALF, 0, 0.1, &heap, &error));
    CHECK(heap_tail(&heap, 2, 0.95, &tail, &error));
    print_message("m %.3f(%.3f), l/r %.1f(%.1f), h_m %.1f, rms %.1f, of a line %.1f\n", tail.slope,
                  tail.slope_error, tail.tail, tail.tail_error, tail.height, tail.rms,
                  tail.rms_line);
    /* An independent program: m = 0.54, l/r = 15 d, rms 4.8 d.  The slope of a heap of 3000 is
     * given to 6 %; the tail is a fourteenth of the foot, 270 d, so 2 % of that make a third of
     * it. */
    CHECK_NEAR(tail.slope, 0.54, 0.06 * 0.54);
    CHECK_NEAR(tail.tail, 15, 5);
    CHECK(tail.tail > 5 * tail.tail_error);                     /* it is a tail, no line */
    CHECK(tail.rms < tail.rms_line && tail.rms < 1.2 * 4.8);
    heap_free(&heap);
    grains_free(&grains);
    scenes_end(run);
}

static uint64_t pour_with(int threads, struct tally_body *body)
{
    omp_set_num_threads(threads);
    struct scenes_run *run = scenes_begin(
        "until = 1e6; seed = 5; box = [0.0, 0.0, 120.0, 110.0]; gravity = (0.0, -1.0);"
        "grains = ({ radius = 0.5; restitution = 0.7; });"
        "placements = ({ kind = \"square\"; spacing = 1.2; region = [5.0, 30.0, 115.0, 105.0];"
        "                temperature = 0.1; });"
        "obstacles = ({ shape = \"disc\"; center = (60.0, 20.0); radius = 8.0; });"
        "dsmc = { method = \"hsmc\"; };", "dsmc");
    CHECK(simulation_count(&run->sim).grains > 5000);          /* enough to share */
    scenes_advance(run, 12);
    const uint64_t digest = simulation_digest(&run->sim);
    *body = simulation_tally(&run->sim)->bodies[0];
    scenes_end(run);
    omp_set_num_threads(1);
    return digest;
}

static void test_a_pour_ends_alike_on_any_number_of_threads(void **unused)
{
    (void)unused;
    struct tally_body one, more;
    const uint64_t digest = pour_with(1, &one);
    CHECK(one.contacts > 0);                                    /* grains met the obstacle */
    for (int threads = 2; threads <= 3; threads++) {
        CHECK(pour_with(threads, &more) == digest);
        CHECK(more.impulse_y == one.impulse_y && more.contacts == one.contacts);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest quick[] = {
        cmocka_unit_test(test_a_heap_stands_at_its_slope_and_does_not_creep),
        cmocka_unit_test(test_a_rising_source_keeps_its_height_above_the_heap),
        cmocka_unit_test(test_a_source_rises_only_where_grains_come_to_rest),
        cmocka_unit_test(test_plain_dsmc_lets_grains_at_rest_fall_into_each_other),
        cmocka_unit_test(test_what_goes_wrong_is_told_before_the_run),
        cmocka_unit_test(test_what_is_poured_faster_than_it_rolls_blocks_its_source),
        cmocka_unit_test(test_sand_runs_out_of_a_funnel),
        cmocka_unit_test(test_a_pour_ends_alike_on_any_number_of_threads),
    };
    const struct CMUnitTest slow[] = {
        cmocka_unit_test(test_a_large_heap_has_the_known_slope),
        cmocka_unit_test(test_a_heap_of_thirty_thousand_has_the_tail_of_equation_8),
        cmocka_unit_test(test_grains_that_roll_less_far_make_a_steeper_heap),
    };
    omp_set_num_threads(1);
    if (argc > 1 && strcmp(argv[1], "slow") == 0) return cmocka_run_group_tests(slow, NULL, NULL);
    return cmocka_run_group_tests(quick, NULL, NULL);
}
