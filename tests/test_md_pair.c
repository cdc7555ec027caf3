/* test_md_pair.c - one collision of two soft discs against theory: restitution, contact time,
 * order of convergence, conserved momenta, Coulomb's limit.  References are the formulas and the
 * numbers of the literature, not the code.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes.h"

#include "model/contact.h"
#include "model/md/md_law.h"

/* Two discs of diameter and mass 1 (density 4/pi) that meet head on at relative speed 1. */
static const char head_on[] =
    "until = 100.0; box = [-10.0, -5.0, 10.0, 5.0]; left = \"open\"; right = \"open\";"
    "bottom = \"open\"; top = \"open\"; overlap_limit = 1.0;"
    "placements = ({ region = [%.17g, -0.5, 0.3, 0.51]; count = 1; velocity = (0.5, %s); "
    "spin = %s; },"
    "              { region = [0.0, -0.5, 1.0, 0.51]; count = 1; velocity = (-0.5, 0.0); });"
    "grains = ({ name = \"disc\"; radius = 0.5; density = 1.2732395447351628; %s });"
    "md = { %s };";

struct outcome { double restitution, tangential, energy, momentum, spin, angular; };

/* How fast the two surfaces pass each other where they face, with the centres along x. */
static double slip_of(const struct grains *g)
{
    return g->vy[1] - g->vy[0] - 0.5 * (g->spin[0] + g->spin[1]);
}

/* Runs until the two are apart again; they touch at t = gap. */
static struct outcome collide_later(double gap, const char *grains, const char *vy,
                                    const char *spin, const char *settings)
{
    char text[2000];
    snprintf(text, sizeof text, head_on, -1 - gap, vy, spin, grains, settings);
    struct scenes_run *run = scenes_begin(text, "md");
    struct grains before = scenes_look(run);
    scenes_advance(run, 1);
    struct grains after = scenes_look(run);
    const struct counters counters = simulation_count(&run->sim);
    struct outcome outcome = {0};
    assert_int_equal(before.count, 2);
    assert_int_equal(after.count, 2);
    CHECK(counters.overlap_max == 0);
    /* along the line of centres at the time of contact, which is x for a head-on collision */
    outcome.restitution = (after.vx[1] - after.vx[0]) / (before.vx[0] - before.vx[1]);
    outcome.tangential = slip_of(&after) / slip_of(&before);
    double e0 = 0, e1 = 0, l0 = 0, l1 = 0;
    for (int k = 0; k < 2; k++) {
        const double inertia = 0.5 * before.mass[k] * 0.25;
        e0 += 0.5 * before.mass[k] * (before.vx[k] * before.vx[k] + before.vy[k] * before.vy[k])
            + 0.5 * inertia * before.spin[k] * before.spin[k];
        e1 += 0.5 * after.mass[k] * (after.vx[k] * after.vx[k] + after.vy[k] * after.vy[k])
            + 0.5 * inertia * after.spin[k] * after.spin[k];
        l0 += before.mass[k] * (before.x[k] * before.vy[k] - before.y[k] * before.vx[k])
            + inertia * before.spin[k];
        l1 += after.mass[k] * (after.x[k] * after.vy[k] - after.y[k] * after.vx[k])
            + inertia * after.spin[k];
        outcome.momentum += fabs(after.mass[k]) * (after.vx[k] - before.vx[k]);
        outcome.momentum += fabs(after.mass[k]) * (after.vy[k] - before.vy[k]);
        outcome.spin += after.spin[k];
    }
    outcome.energy = e1 / e0;
    outcome.angular = l1 - l0;
    grains_free(&before);
    grains_free(&after);
    scenes_end(run);
    return outcome;
}

static struct outcome collide(const char *grains, const char *vy, const char *spin,
                              const char *settings)
{
    return collide_later(0, grains, vy, spin, settings);
}

/* Mean restitution, and mean error of it, over the moments of a step at which discs first touch. */
static struct outcome collide_any_time(const char *grains, const char *settings, double dt,
                                       double exact)
{
    enum { MOMENTS = 16 };
    struct outcome mean = {0};
    for (int k = 0; k < MOMENTS; k++) {
        const double r = collide_later((k + 0.5) / MOMENTS * dt, grains, "0.0", "0.0",
                                       settings).restitution;
        mean.restitution += r / MOMENTS;
        mean.energy += fabs(r - exact) / MOMENTS;
    }
    return mean;
}

/* k and m = 1/2 give omega0 = 100: a contact lasts pi/100. */
#define STIFF "stiffness = 5000.0;"
/* eta / omega0 = 0.1: c = 2 m eta = 10. */
#define DAMPED STIFF "damping = 10.0;"

static void test_linear_restitution_is_that_of_theory(void **unused)
{
    (void)unused;
    /* MODELS section 4; tolerance as there, at 100 steps a contact. */
    const double dt = M_PI / 100 / 100;
    for (int gear = 0; gear < 2; gear++) {
        char settings[100];
        snprintf(settings, sizeof settings, "dt = %.17g; integrator = \"%s\"; clip = false;", dt,
                 gear ? "gear" : "verlet");
        CHECK_NEAR(collide_any_time(DAMPED, settings, dt, 0).restitution, 0.72925, 1e-3);
        *strstr(settings, "clip") = 0;
        CHECK_NEAR(collide_any_time(DAMPED, settings, dt, 0).restitution, 0.74408, 2e-3);
    }
}

static void test_a_restitution_asked_for_is_obtained(void **unused)
{
    (void)unused;
    const double wanted[] = {0.95, 0.6, 0.2, 0.05};
    for (int k = 0; k < 4; k++) {
        char grains[100];
        snprintf(grains, sizeof grains, STIFF "restitution = %g;", wanted[k]);
        CHECK_NEAR(collide(grains, "0.0", "0.0", "dt = 3e-5;").restitution, wanted[k], 2e-3);
    }
}

static void test_the_formulas_are_those_of_theory(void **unused)
{
    (void)unused;
    /* omega = sqrt(0.99): tc = pi/omega and exp(-pi 0.1/omega); clipped: MODELS. */
    const double omega = sqrt(0.99);
    const struct contact_blow open = contact_linear(0.1, false);
    CHECK_NEAR(open.time, M_PI / omega, 1e-12);
    CHECK_NEAR(open.restitution, 0.72925, 5e-6);
    const struct contact_blow clipped = contact_linear(0.1, true);
    CHECK_NEAR(clipped.time, (M_PI - atan2(2 * 0.1 * omega, 0.99 - 0.01)) / omega, 1e-12);
    CHECK_NEAR(clipped.restitution, 0.74408, 5e-6);
    CHECK_NEAR(contact_linear_damping(clipped.restitution, true), 0.1, 1e-9);
    /* Across critical damping nothing jumps: r = exp(-2) there. */
    CHECK_NEAR(contact_linear(1 - 1e-5, true).restitution, exp(-2), 1e-5);
    CHECK_NEAR(contact_linear(1 + 1e-5, true).restitution, exp(-2), 1e-5);
    const struct contact_blow hertz = contact_hertz(0.25, true);
    CHECK_NEAR(hertz.restitution, 0.70849, 1e-5);
    CHECK_NEAR(hertz.overlap, 1.12525, 1e-5);
}

static void test_viscoelastic_hertz_restitution_is_that_of_theory(void **unused)
{
    (void)unused;
    /* Reduced units of MODELS: m xi'' = -sqrt(R) (2/3 alpha xi^1.5 + beta sqrt(xi) xi') with
     * alpha' = 1, beta' = 0.25 for m = 1/2, R = 1/4: alpha = S, beta = 0.25 S L / v with
     * L = (m / (S sqrt(R)))^0.4.  S = 1e5 keeps the overlap small. */
    const double s = 1e5, length = pow(0.5 / (s * 0.5), 0.4);
    char grains[200], settings[100];
    snprintf(grains, sizeof grains, "stiffness = %.17g; damping = %.17g;", s, 0.25 * s * length);
    for (int gear = 0; gear < 2; gear++) {
        /* A contact lasts 3.95 L; 2000 steps of it, first order in dt: 5e-4 as in MODELS. */
        snprintf(settings, sizeof settings, "force = \"hertz\"; dt = %.17g; integrator = \"%s\";",
                 3.95 * length / 2000, gear ? "gear" : "verlet");
        CHECK_NEAR(collide(grains, "0.0", "0.0", settings).restitution, 0.70849, 5e-4);
    }
}

static void test_momenta_of_a_free_pair_are_conserved_with_friction(void **unused)
{
    (void)unused;
    const char *laws[] = {
        "tangential = \"viscous\"; tangential_damping = 20.0;",
        "tangential = \"coulomb\"; tangential_damping = 50.0;", "tangential = \"spring\";",
        "tangential = \"haff-werner\"; tangential_damping = 300.0;",
        "tangential = \"spring\"; force = \"hertz\";",
        "tangential = \"spring\"; integrator = \"gear\";",
    };
    for (size_t k = 0; k < sizeof laws / sizeof *laws; k++) {
        char settings[200];
        snprintf(settings, sizeof settings, "dt = 1e-4; %s", laws[k]);
        const struct outcome o = collide(DAMPED "friction = 0.5;", "0.3", "4.0", settings);
        /* Rounding of some thousand steps of numbers of order one. */
        CHECK_NEAR(o.momentum, 0, 1e-12);
        CHECK_NEAR(o.angular, 0, 1e-12);
        CHECK(o.energy < 1);
        CHECK(o.energy > 0.1);
        CHECK(fabs(o.spin - 4) > 0.05);                         /* friction did something */
    }
}

static void test_sliding_friction_obeys_coulomb(void **unused)
{
    (void)unused;
    /* A fast spin slides all the time: the tangential impulse is mu times the normal one,
     * J_n = m_eff (1 + r) v, so each spin loses R mu J_n / I = mu (1 + r) / (2 q 2 R). */
    const char *laws[] = {"tangential = \"spring\";",
                          "tangential = \"coulomb\"; tangential_damping = 1000.0;"};
    for (int k = 0; k < 2; k++) {
        char settings[200];
        snprintf(settings, sizeof settings, "dt = 3e-5; %s", laws[k]);
        const struct outcome o = collide(STIFF "restitution = 1.0; friction = 0.1;", "0.0", "40.0",
                                         settings);
        const double impulse = 0.5 * 2;
        /* The spring takes a moment to reach the limit: 1 %. */
        CHECK_NEAR(o.spin - 40, -2 * 0.5 * 0.1 * impulse / 0.125, 0.01 * 0.8);
    }
}

/* Mean error of the slip that one blow without sliding leaves, over the moments of a step at which
 * discs first touch. */
static double error_of_slip(double share, double steps, const char *integrator)
{
    enum { MOMENTS = 8 };
    const double time = M_PI / 1e3, dt = time / steps;          /* m_eff = 1/2, k = 5e5 */
    const double exact = cos(M_PI * sqrt(3 * share));
    char settings[200];
    snprintf(settings, sizeof settings, "dt = %.17g; integrator = \"%s\"; tangential_stiffness = "
             "%.17g;", dt, integrator, share);
    const char *const rough = "stiffness = 5e5; restitution = 1.0; friction = 100.0;";
    double error = 0;
    for (int k = 0; k < MOMENTS; k++) {
        const double gap = (k + 0.5) / MOMENTS * dt;
        error += fabs(collide_later(gap, rough, "0.0", "0.1", settings).tangential - exact);
    }
    return error / MOMENTS;
}

static void test_a_tangential_spring_swings_back_as_far_as_it_was_stretched(void **unused)
{
    (void)unused;
    /* Two springs at right angles: the normal one takes half a swing, in which the tangential one,
     * whose mass is m_eff / (1 + 1/q), q = 1/2, has turned by pi sqrt(3 k_t / k_n).  So the slip is
     * multiplied by the cosine of it; k_t = k_n / 3 turns it round, as very rough hard discs do.
     * A second-order rule is off by the square of the angle of a step, pi/steps, a few times; a
     * force half a step ahead would damp by the angle itself: a tenth at 25 steps, a fortieth at
     * 100.  (The overlap of a thousandth changes the lever, and the angle, by as little.) */
    const double shares[] = {0.1, 1.0 / 3, 0.6};
    for (size_t k = 0; k < sizeof shares / sizeof *shares; k++) {
        for (int gear = 0; gear < 2; gear++) {
            const char *integrator = gear ? "gear" : "verlet";
            CHECK_NEAR(error_of_slip(shares[k], 25, integrator), 0, 3 * pow(M_PI / 25, 2));
            CHECK_NEAR(error_of_slip(shares[k], 100, integrator), 0, 3 * pow(M_PI / 100, 2));
        }
    }
}

static double order(const char *grains, const char *law, const char *integrator, double time,
                    double exact)
{
    double errors[2];
    for (int fine = 0; fine < 2; fine++) {
        char settings[200];
        const double dt = time / (fine ? 100 : 25);
        snprintf(settings, sizeof settings, "%s integrator = \"%s\"; dt = %.17g;", law, integrator,
                 dt);
        errors[fine] = collide_any_time(grains, settings, dt, exact).energy;
    }
    return log(errors[0] / errors[1]) / log(4);
}

static void test_the_kink_at_first_touch_limits_the_order(void **unused)
{
    (void)unused;
    /* MODELS section 4; 0.3 for the scatter of the phases that are averaged. */
    const char elastic[] = STIFF "restitution = 1.0;";
    CHECK_NEAR(order(elastic, "", "verlet", M_PI / 100, 1), 3.0, 0.3);
    CHECK_NEAR(order(elastic, "", "gear", M_PI / 100, 1), 4.1, 0.4);
    const char hertz[] = "stiffness = 1e5; damping = 0.0;";
    /* tc = 2.943 xi_max / v (Landau and Lifshitz), xi_max = (15/8)^0.4 L. */
    const double length = pow(0.5 / (1e5 * 0.5), 0.4), time = 2.9432 * pow(15.0 / 8, 0.4) * length;
    CHECK_NEAR(order(hertz, "force = \"hertz\";", "verlet", time, 1), 2.5, 0.3);
    CHECK_NEAR(order(hertz, "force = \"hertz\";", "gear", time, 1), 2.5, 0.3);
    char damped[100];
    snprintf(damped, sizeof damped, "stiffness = 1e5; damping = %.17g;", 0.25e5 * length);
    /* Verlet in its plain form would reach 1.0; here the dashpot reads a predicted velocity. */
    CHECK_NEAR(order(damped, "force = \"hertz\";", "verlet", time, 0.70849), 1.9, 0.3);
    CHECK_NEAR(order(damped, "force = \"hertz\";", "gear", time, 0.70849), 1.6, 0.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_formulas_are_those_of_theory),
        cmocka_unit_test(test_linear_restitution_is_that_of_theory),
        cmocka_unit_test(test_a_restitution_asked_for_is_obtained),
        cmocka_unit_test(test_viscoelastic_hertz_restitution_is_that_of_theory),
        cmocka_unit_test(test_momenta_of_a_free_pair_are_conserved_with_friction),
        cmocka_unit_test(test_sliding_friction_obeys_coulomb),
        cmocka_unit_test(test_a_tangential_spring_swings_back_as_far_as_it_was_stretched),
        cmocka_unit_test(test_the_kink_at_first_touch_limits_the_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
