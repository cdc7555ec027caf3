/* test_ed.c - hard discs: what one or a few of them must do, and what many of them must keep.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "check.h"
#include "scenes.h"

#define PERIODIC                                                                        \
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
#define DISC "grains = ({ radius = 0.5; restitution = 1.0; });"

/* A placement of one grain. */
#define AT(x0, y0, x1, y1, vx, vy)                                                      \
    "{ region = [" #x0 ", " #y0 ", " #x1 ", " #y1 "]; kind = \"square\"; count = 1;"    \
    " velocity = (" #vx ", " #vy "); }"

/* The largest overlap of two grains as a share of the smaller diameter, by every pair. */
static double overlap(const struct scenes_run *run)
{
    struct grains g = scenes_look(run);
    const struct scene *scene = run->scene;
    const double lx = scene->box[2] - scene->box[0], ly = scene->box[3] - scene->box[1];
    double worst = 0;
    for (uint32_t i = 0; i < g.count; i++) {
        for (uint32_t j = 0; j < i; j++) {
            double dx = g.x[i] - g.x[j], dy = g.y[i] - g.y[j];
            if (scene->left == BORDER_PERIODIC) dx -= lx * rint(dx / lx);
            if (scene->bottom == BORDER_PERIODIC) dy -= ly * rint(dy / ly);
            const double deep = g.radius[i] + g.radius[j] - sqrt(dx * dx + dy * dy);
            worst = fmax(worst, deep / (2 * fmin(g.radius[i], g.radius[j])));
        }
    }
    grains_free(&g);
    return worst;
}

static void test_an_elastic_gas_keeps_energy_and_momentum_and_never_overlaps(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 1000.0; box = [0.0, 0.0, 36.0, 36.0];" PERIODIC
        DISC "placements = ({ kind = \"square\"; spacing = 1.8; temperature = 1.0; });", "ed");
    const struct counters a = simulation_count(&run->sim);
    for (int k = 1; k <= 20; k++) {
        scenes_advance(run, 10.0 * k);
        CHECK(overlap(run) < 1e-9);
    }
    const struct counters b = simulation_count(&run->sim);
    CHECK(b.collisions > 50000);
    /* Each collision rounds two velocities by some 1e-16 of themselves; errors add up at random:
     * 1e-16 sqrt(1e5) = 3e-14, and 1e-12 leaves room for a drift. */
    CHECK_NEAR(b.kinetic_energy / a.kinetic_energy, 1, 1e-12);
    CHECK_NEAR(b.momentum_x, a.momentum_x, 1e-11);
    CHECK_NEAR(b.momentum_y, a.momentum_y, 1e-11);
    scenes_end(run);
}

static void test_vector_and_plain_loops_give_the_same_bytes(void **unused)
{
    (void)unused;
    const char *const kinds[] = {
        "grains = ({ radius = 0.5; restitution = 0.8; });",
        "grains = ({ radius = [0.2, 0.5]; restitution = 0.8; friction = 0.3; });"};
    for (int k = 0; k < 2; k++) {
        uint64_t digests[2];
        for (int plain = 0; plain < 2; plain++) {
            char text[600];
            snprintf(text, sizeof text, "until = 10.0; box = [0.0, 0.0, 27.0, 27.0];"
                "left = \"periodic\"; right = \"periodic\"; %s"
                "placements = ({ kind = \"square\"; spacing = 1.5;"
                "temperature = 1.0; }); ed = { vectors = \"%s\"; };", kinds[k],
                plain ? "none" : "auto");
            struct scenes_run *run = scenes_begin(text, "ed");
            scenes_advance(run, 10);
            CHECK(simulation_count(&run->sim).collisions > 1000);
            digests[plain] = simulation_digest(&run->sim);
            scenes_end(run);
        }
        CHECK(digests[0] == digests[1]);
    }
}

static void test_a_dropped_grain_bounces_on_parabolas(void **unused)
{
    (void)unused;
    /* Bottom of the grain falls from 8 to 0 in 4, then rises with r v; g = 1. */
    struct scenes_run *run = scenes_begin("until = 100.0; box = [0.0, 0.0, 9.0, 20.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.5; });"
        "placements = (" AT(4.0, 8.0, 5.0, 9.0, 0.25, 0.0) "); ed = { t_c = 1e-4; };", "ed");
    scenes_advance(run, 3);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.y[0], 8.5 - 4.5, 1e-12);
    CHECK_NEAR(g.vy[0], -3, 1e-12);
    grains_free(&g);
    scenes_advance(run, 5);                     /* one after the bounce with 2 upwards */
    g = scenes_look(run);
    CHECK_NEAR(g.y[0], 0.5 + 2 - 0.5, 1e-12);
    CHECK_NEAR(g.vy[0], 1, 1e-12);
    CHECK_NEAR(g.x[0], 4.5 + 1.25, 1e-12);
    grains_free(&g);
    scenes_advance(run, 8.5);                   /* half after the second bounce, at 8, with 1 */
    g = scenes_look(run);
    CHECK_NEAR(g.y[0], 0.5 + 0.5 - 0.125, 1e-12);
    grains_free(&g);
    scenes_advance(run, 20);            /* all bounces are over at 4 + 2 (2 + 1 + ...) = 12 */
    g = scenes_look(run);
    /* Bounces of at most t_c: v <= g t_c / 2, height v^2 / 2g. */
    CHECK_NEAR(g.y[0], 0.5, 1.26e-9);
    CHECK_NEAR(g.vy[0], 0, 5.01e-5);
    grains_free(&g);
    scenes_end(run);
}

static void test_a_grain_in_a_round_dish_keeps_its_energy(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 1000.0; box = [-5.0, -5.0, 5.0, 5.0];"
        "gravity = (0.0, -1.0);" DISC "placements = (" AT(0.7, 0.0, 1.7, 1.0, 0.3, 0.0) ");"
        "walls = ({ shape = \"arc\"; center = (0.0, 0.0); radius = 4.0; });", "ed");
    const struct counters a = simulation_count(&run->sim);
    for (int k = 1; k <= 1000; k++) {
        scenes_advance(run, k);
        struct grains g = scenes_look(run);
        CHECK(hypot(g.x[0], g.y[0]) < 3.5 + 1e-10);
        grains_free(&g);
    }
    const struct counters b = simulation_count(&run->sim);
    CHECK(b.steps > 300);
    CHECK_NEAR(b.kinetic_energy + b.potential_energy, a.kinetic_energy + a.potential_energy, 1e-9);
    scenes_end(run);
}

static void test_an_obstacle_deflects_by_geometry_and_takes_the_momentum(void **unused)
{
    (void)unused;
    /* Impact parameter 1 on radii 1.5 + 0.5: the normal makes asin(1/2) with the way in, so the
     * grain turns by 180 - 60 degrees. */
    struct scenes_run *run = scenes_begin("until = 20.0; box = [-10.0, -10.0, 10.0, 10.0];" DISC
        "placements = (" AT(-6.5, 0.5, -5.5, 1.5, 1.0, 0.0) ");"
        "obstacles = ({ shape = \"disc\"; center = (0.0, 0.0); radius = 1.5; });", "ed");
    scenes_advance(run, 6);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.vx[0], cos(M_PI * 2 / 3), 1e-12);
    CHECK_NEAR(g.vy[0], sin(M_PI * 2 / 3), 1e-12);
    const struct tally *tally = simulation_tally(&run->sim);
    CHECK_NEAR(tally->bodies[0].impulse_x, g.mass[0] * 1.5, 1e-12);
    CHECK_NEAR(tally->bodies[0].impulse_y, -g.mass[0] * sin(M_PI * 2 / 3), 1e-12);
    CHECK_NEAR(tally->bodies[0].angular_impulse, 0, 1e-12);
    CHECK(tally->bodies[0].contacts == 1);
    grains_free(&g);
    scenes_end(run);
}

static void test_a_cradle_passes_the_blow_on_to_the_last_grain(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 20.0; box = [0.0, 0.0, 20.0, 3.0];" DISC
        "placements = (" AT(1.0, 1.0, 2.0, 2.0, 1.0, 0.0) ","
        "{ region = [5.0, 1.0, 10.0, 2.0]; kind = \"square\"; spacing = 1.0; });", "ed");
    scenes_advance(run, 5);
    struct grains g = scenes_look(run);
    CHECK(g.count == 6);
    for (uint32_t i = 0; i < 6; i++) {
        const bool last = g.x[i] > 10;
        CHECK_NEAR(g.vx[i], last ? 1 : 0, 1e-12);
        if (last) CHECK_NEAR(g.x[i], 9.5 + 2, 1e-9);    /* hit at t = 3 */
    }
    grains_free(&g);
    scenes_end(run);
}

/* A column of lossy grains that runs against a wall collapses for N (1 - r) > pi or so. */
#define COLLAPSE(t_c)                                                                   \
    "until = 100.0; box = [0.0, 0.0, 60.0, 2.0];"                                       \
    "grains = ({ radius = 0.5; restitution = 0.2; });"                                  \
    "placements = ({ region = [10.0, 0.4, 34.0, 1.7]; kind = \"square\"; spacing = 1.2;" \
    " velocity = (-1.0, 0.0); }); ed = { t_c = " #t_c "; };"

static void test_collapse_stops_plain_ed_with_a_word_on_the_cut_off(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin(COLLAPSE(0.0), "ed");
    struct error error = {.text = ""};
    CHECK(simulation_advance(&run->sim, 100, 50000000, &error) == ADVANCE_BROKEN);
    CHECK(strstr(error.text, "ed.t_c"));
    /* It stays broken, and says so again without working. */
    CHECK(simulation_advance(&run->sim, 100, 50000000, &error) == ADVANCE_BROKEN);
    scenes_end(run);
}

static void test_the_cut_off_carries_a_column_through_collapse(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin(COLLAPSE(1e-4), "ed");
    struct error error = {.text = ""};
    CHECK(simulation_advance(&run->sim, 60, 50000000, &error) == ADVANCE_REACHED);
    const struct counters c = simulation_count(&run->sim);
    CHECK(c.collisions_elastic > 0 && c.collisions_elastic <= c.collisions);
    CHECK(overlap(run) < 1e-9);
    scenes_end(run);
}

static void test_a_small_budget_returns_from_collapse(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin(COLLAPSE(0.0), "ed");
    struct error error = {.text = ""};
    CHECK(simulation_advance(&run->sim, 100, 10000, &error) == ADVANCE_BUDGET);
    scenes_end(run);
}

static void test_a_heap_comes_to_rest_on_the_floor_without_end_of_time(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 60.0; box = [0.0, 0.0, 8.0, 20.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.6; });"
        "placements = ({ region = [0.5, 1.0, 7.5, 9.0]; spacing = 1.1; temperature = 0.2; });"
        "ed = { t_c = 1e-2; };", "ed");
    scenes_advance(run, 20);
    const struct counters a = simulation_count(&run->sim);
    scenes_advance(run, 25);
    const struct counters b = simulation_count(&run->sim);
    CHECK(b.grains == a.grains && b.grains > 30);
    /* Bounces of t_c leave v = g t_c / 2 and g times the depth of the heap, ten grains: at most
     * 1e-2 d of fall a grain is far above what stays, and far below one diameter. */
    CHECK(b.kinetic_energy / (double)b.grains < 1e-2);
    CHECK_NEAR(b.potential_energy / a.potential_energy, 1, 1e-2);
    CHECK(overlap(run) < 1e-9);
    scenes_end(run);
}

static void test_grains_set_down_at_rest_stay_there(void **unused)
{
    (void)unused;
    /* A square stack of touching grains on the floor, beside a wall: all contacts at once. */
    struct scenes_run *run = scenes_begin("until = 10.0; box = [0.0, 0.0, 5.0, 10.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.5; });"
        "placements = ({ region = [0.0, 0.0, 5.0, 4.0]; kind = \"square\"; spacing = 1.0; });"
        "ed = { t_c = 1e-2; };", "ed");
    CHECK(run->scene->placed.count == 20);
    scenes_advance(run, 3);
    struct grains g = scenes_look(run);
    for (uint32_t i = 0; i < g.count; i++) {
        CHECK_NEAR(g.x[i], run->scene->placed.x[i], 1e-3);
        /* Bounces of speed g t_c / 2 rise by 1.25e-5, four grains high and a few times over. */
        CHECK_NEAR(g.y[i], run->scene->placed.y[i], 1e-2);
    }
    grains_free(&g);
    scenes_end(run);
}

static void test_a_grain_caught_in_a_wedge_goes_on(void **unused)
{
    (void)unused;
    /* Sides at 45 degrees from the corner (0, 0): the centre is never lower than r sqrt(2), nor
     * nearer to a side than r.  While it slides down one side in bounces of t_c it meets the other
     * elastically, so the TC rule lets it swing; it must not gain energy. */
    struct scenes_run *run = scenes_begin("until = 100.0; box = [-6.0, -1.0, 6.0, 12.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.5; });"
        "walls = ({ shape = \"polyline\"; points = ((-5.0, 5.0), (0.0, 0.0), (5.0, 5.0)); });"
        "placements = (" AT(1.0, 4.0, 2.0, 5.0, 0.0, 0.0) "); ed = { t_c = 1e-3; };", "ed");
    double energy = INFINITY;
    for (int k = 1; k <= 100; k++) {
        scenes_advance(run, k);
        struct grains g = scenes_look(run);
        CHECK(fabs(g.x[0]) <= g.y[0] - 0.5 * M_SQRT2 + 1e-9);
        grains_free(&g);
        const struct counters c = simulation_count(&run->sim);
        CHECK(c.kinetic_energy + c.potential_energy <= energy + 1e-6);
        energy = c.kinetic_energy + c.potential_energy;
    }
    scenes_end(run);
}

static void test_a_gate_holds_and_lets_go(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 20.0; box = [0.0, 0.0, 6.0, 20.0];"
        "gravity = (0.0, -1.0); grains = ({ radius = 0.5; restitution = 0.2; });"
        "walls = ({ shape = \"segment\"; points = ((0.0, 10.0), (6.0, 10.0)); opens = 8.0; });"
        "placements = (" AT(2.0, 11.0, 3.0, 12.0, 0.0, 0.0) "); ed = { t_c = 1e-3; };", "ed");
    scenes_advance(run, 8);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.y[0], 10.5, 1e-6);
    grains_free(&g);
    scenes_advance(run, 10);
    g = scenes_look(run);
    CHECK_NEAR(g.y[0], 10.5 - 2, 1e-3);
    grains_free(&g);
    scenes_end(run);
}

static void test_a_moving_wall_gives_twice_its_speed(void **unused)
{
    (void)unused;
    /* The wall at x = 6 - 0.5 t meets the grain's front x = 1 + t at t = 10/3: v -> 2 u - v. */
    struct scenes_run *run = scenes_begin("until = 20.0; box = [-20.0, 0.0, 20.0, 6.0];" DISC
        "walls = ({ shape = \"segment\"; points = ((6.0, 0.0), (6.0, 6.0));"
        "           velocity = (-0.5, 0.0); moves = (0.0, 9.0); });"
        "placements = (" AT(0.0, 2.0, 1.0, 3.0, 1.0, 0.0) ");", "ed");
    scenes_advance(run, 5);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.vx[0], -2, 1e-12);
    CHECK_NEAR(g.x[0], 0.5 + 10.0 / 3 - 2 * (5 - 10.0 / 3), 1e-12);
    grains_free(&g);
    /* The wall stops at 1.5; the grain, back from the left border, is thrown back unchanged. */
    scenes_advance(run, 30);
    g = scenes_look(run);
    CHECK_NEAR(fabs(g.vx[0]), 2, 1e-12);
    CHECK(g.x[0] < 1);
    grains_free(&g);
    scenes_end(run);
}

static void test_unequal_grains_exchange_what_their_masses_say(void **unused)
{
    (void)unused;
    /* Radii 2 and 0.2: masses 100 to 1.  v2' = (1 + r) m1 / (m1 + m2) v1 for m2 at rest. */
    struct scenes_run *run = scenes_begin("until = 20.0; box = [0.0, 0.0, 40.0, 8.0];"
        "grains = ({ name = \"big\"; radius = 2.0; restitution = 0.8; },"
        "          { name = \"small\"; radius = 0.2; restitution = 0.8; });"
        "placements = ({ grains = \"big\"; region = [1.0, 2.0, 5.0, 6.0]; count = 1;"
        "                velocity = (1.0, 0.0); },"
        "              { grains = \"small\"; region = [9.79, 3.79, 10.21, 4.21]; count = 1; });",
        "ed");
    scenes_advance(run, 10);
    struct grains g = scenes_look(run);
    const uint32_t big = g.radius[0] > 1 ? 0u : 1u, small = 1u - big;
    CHECK_NEAR(g.mass[big] / g.mass[small], 100, 1e-9);
    const double along = (g.vx[small] * g.vx[small] + g.vy[small] * g.vy[small]) / g.vx[small];
    CHECK_NEAR(along, 1.8 * 100 / 101, 1e-12);
    grains_free(&g);
    scenes_end(run);
}

static void test_grains_of_ten_sizes_never_overlap(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 20.0; box = [0.0, 0.0, 30.0, 30.0];" PERIODIC
        "grains = ({ name = \"big\"; radius = 1.0; restitution = 1.0; },"
        "          { name = \"small\"; radius = 0.1; restitution = 1.0; });"
        "placements = ({ grains = \"big\"; region = [0.0, 0.0, 30.0, 15.0]; spacing = 1.5;"
        "                temperature = 1.0; },"
        "              { grains = \"small\"; region = [0.0, 16.0, 30.0, 19.0]; spacing = 1.5;"
        "                temperature = 20.0; });", "ed");
    CHECK(run->scene->placed.count > 900);
    const struct counters a = simulation_count(&run->sim);
    scenes_advance(run, 10);
    const struct counters b = simulation_count(&run->sim);
    CHECK(b.collisions > 10000);
    CHECK(overlap(run) < 1e-9);
    CHECK_NEAR(b.kinetic_energy / a.kinetic_energy, 1, 1e-12);
    scenes_end(run);
}

static void test_restitution_falls_with_impact_speed(void **unused)
{
    (void)unused;
    /* 1 - r = 0.2 (v / 1)^0.2 on a wall: v = 32 gives r = 0.6. */
    struct scenes_run *run = scenes_begin("until = 20.0; box = [0.0, 0.0, 40.0, 8.0];"
        "grains = ({ radius = 0.5; restitution = 0.8; });"
        "placements = (" AT(4.0, 2.0, 5.0, 3.0, 32.0, 0.0) ");"
        "ed = { exponent = 0.2; reference_speed = 1.0; t_c = 0.0; };", "ed");
    scenes_advance(run, 1.5);
    struct grains g = scenes_look(run);
    CHECK_NEAR(g.vx[0], -0.6 * 32, 1e-11);
    grains_free(&g);
    scenes_end(run);
}

/* A rough grain hits the floor at (vx, vy) = (1, -1); returns vx and spin after. */
static void bounce_rough(const char *inertia, double friction, double tangential, double *vx,
                         double *spin)
{
    char text[700];
    snprintf(text, sizeof text, "until = 20.0; box = [0.0, 0.0, 40.0, 8.0];"
        "grains = ({ radius = 0.5; restitution = 0.9; friction = %g; inertia = \"%s\"; });"
        "placements = (" AT(4.0, 2.0, 5.0, 3.0, 1.0, -1.0) ");"
        "ed = { tangential = %g; };", friction, inertia, tangential);
    struct scenes_run *run = scenes_begin(text, "ed");
    scenes_advance(run, 3);
    struct grains g = scenes_look(run);
    *vx = g.vx[0];
    *spin = g.spin[0];
    grains_free(&g);
    scenes_end(run);
}

static void test_a_rough_bounce_follows_walton_and_braun(void **unused)
{
    (void)unused;
    double vx, spin;
    /* Sticking, beta0 = 0.5: dv = -q/(1+q) (1 + beta0) v, 1/3 for discs, 2/7 for spheres; the
     * impulse turns it clockwise by dv / (q R). */
    bounce_rough("disc", 10, 0.5, &vx, &spin);
    CHECK_NEAR(vx, 1 - 1.5 / 3, 1e-12);
    CHECK_NEAR(spin, -0.5 / (0.5 * 0.5), 1e-12);
    bounce_rough("sphere", 10, 0.5, &vx, &spin);
    CHECK_NEAR(vx, 1 - 1.5 * 2 / 7, 1e-12);
    /* Sliding: mu (1 + r) |v_n|. */
    bounce_rough("disc", 0.1, 0.5, &vx, &spin);
    CHECK_NEAR(vx, 1 - 0.1 * 1.9, 1e-12);
    CHECK_NEAR(spin, -0.19 / (0.5 * 0.5), 1e-12);
}

static void test_rough_grains_keep_angular_momentum(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 20.0; box = [-20.0, -20.0, 20.0, 20.0];"
        "grains = ({ name = \"a\"; radius = 0.5; restitution = 0.7; friction = 0.4; },"
        "          { name = \"b\"; radius = 0.8; restitution = 0.7; friction = 0.4; });"
        "placements = ({ grains = \"a\"; region = [-3.5, -0.2, -2.5, 0.8]; count = 1; spin = 2.0;"
        "                velocity = (1.0, 0.0); },"
        "              { grains = \"b\"; region = [-0.8, -0.8, 0.8, 0.8]; count = 1; });", "ed");
    double l[2], e[2];
    for (int after = 0; after < 2; after++) {
        if (after) scenes_advance(run, 8);
        struct grains g = scenes_look(run);
        l[after] = 0;
        for (uint32_t i = 0; i < 2; i++) {
            l[after] += g.mass[i] * (g.x[i] * g.vy[i] - g.y[i] * g.vx[i]
                                     + 0.5 * g.radius[i] * g.radius[i] * g.spin[i]);
        }
        const struct counters c = simulation_count(&run->sim);
        e[after] = c.kinetic_energy + c.rotational_energy;
        grains_free(&g);
    }
    CHECK(simulation_count(&run->sim).collisions == 1);
    CHECK_NEAR(l[1], l[0], 1e-12);
    CHECK(e[1] < e[0]);
    scenes_end(run);
}

static void test_a_long_flight_loses_no_digits(void **unused)
{
    (void)unused;
    /* One grain between two walls 9 apart for 1e6: a triangle wave of period 16. */
    struct scenes_run *run = scenes_begin("until = 1e6; box = [0.0, 0.0, 9.0, 9.0];" DISC
        "placements = (" AT(0.0, 4.0, 1.0, 5.0, 1.0, 0.0) ");", "ed");
    scenes_advance(run, 16.0 * 62500 + 5);
    struct grains g = scenes_look(run);
    /* 125,000 bounces that round the position by 1e-15 each, all to one side at worst. */
    CHECK_NEAR(g.x[0], 0.5 + 5, 2e-10);
    grains_free(&g);
    scenes_end(run);
}

static void test_a_touching_lattice_bursts_without_overlap(void **unused)
{
    (void)unused;
    struct scenes_run *run = scenes_begin("until = 20.0; box = [0.0, 0.0, 30.0, 30.0];" DISC
        "placements = ({ region = [10.0, 10.0, 20.0, 20.0]; spacing = 1.0; temperature = 1.0; });",
        "ed");
    const struct counters a = simulation_count(&run->sim);
    scenes_advance(run, 5);
    const struct counters b = simulation_count(&run->sim);
    CHECK(overlap(run) < 1e-9);
    CHECK_NEAR(b.kinetic_energy / a.kinetic_energy, 1, 1e-12);
    scenes_end(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_elastic_gas_keeps_energy_and_momentum_and_never_overlaps),
        cmocka_unit_test(test_vector_and_plain_loops_give_the_same_bytes),
        cmocka_unit_test(test_a_dropped_grain_bounces_on_parabolas),
        cmocka_unit_test(test_a_grain_in_a_round_dish_keeps_its_energy),
        cmocka_unit_test(test_an_obstacle_deflects_by_geometry_and_takes_the_momentum),
        cmocka_unit_test(test_a_cradle_passes_the_blow_on_to_the_last_grain),
        cmocka_unit_test(test_collapse_stops_plain_ed_with_a_word_on_the_cut_off),
        cmocka_unit_test(test_the_cut_off_carries_a_column_through_collapse),
        cmocka_unit_test(test_a_small_budget_returns_from_collapse),
        cmocka_unit_test(test_a_heap_comes_to_rest_on_the_floor_without_end_of_time),
        cmocka_unit_test(test_grains_set_down_at_rest_stay_there),
        cmocka_unit_test(test_a_grain_caught_in_a_wedge_goes_on),
        cmocka_unit_test(test_a_gate_holds_and_lets_go),
        cmocka_unit_test(test_a_moving_wall_gives_twice_its_speed),
        cmocka_unit_test(test_unequal_grains_exchange_what_their_masses_say),
        cmocka_unit_test(test_grains_of_ten_sizes_never_overlap),
        cmocka_unit_test(test_restitution_falls_with_impact_speed),
        cmocka_unit_test(test_a_rough_bounce_follows_walton_and_braun),
        cmocka_unit_test(test_rough_grains_keep_angular_momentum),
        cmocka_unit_test(test_a_long_flight_loses_no_digits),
        cmocka_unit_test(test_a_touching_lattice_bursts_without_overlap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
