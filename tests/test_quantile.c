/* test_quantile.c - percentiles of any range of numbers are right to 0.4 %, however they come.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "check.h"
#include "measure/quantile.h"

static struct quantile fresh(void)
{
    struct quantile quantile;
    struct error error;
    if (!quantile_create(&quantile, &error)) fail_msg("%s", error.text);
    return quantile;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { COUNT = 20000 };

static void test_percentiles_agree_with_sorting(void **unused)
{
    (void)unused;
    struct quantile quantile = fresh();
    struct rng rng = {5};
    double values[COUNT];
    for (int k = 0; k < COUNT; k++) {           /* both signs, over forty powers of ten */
        values[k] = rng_normal(&rng) * pow(10, 20 * rng_normal(&rng) / 3);
        quantile_add(&quantile, values[k]);
    }
    qsort(values, COUNT, sizeof *values, ascending);
    for (int percent = 0; percent <= 100; percent += 5) {
        int rank = COUNT * percent / 100 - 1;   /* so many do not exceed it */
        if (rank < 0) rank = 0;
        CHECK_NEAR(quantile_at(&quantile, percent / 100.0), values[rank],
                   fabs(values[rank]) / 256 * (1 + 1e-12));
    }
    CHECK(quantile_at(&quantile, 0) == values[0]);
    CHECK(quantile_at(&quantile, 1) == values[COUNT - 1]);
    quantile_free(&quantile);
}

static void test_order_and_merging_do_not_matter(void **unused)
{
    (void)unused;
    struct quantile all = fresh(), even = fresh(), odd = fresh();
    struct rng rng = {6};
    double values[1000];
    for (int k = 0; k < 1000; k++) quantile_add(&all, values[k] = rng_normal(&rng));
    for (int k = 999; k >= 0; k--) quantile_add(k % 2 ? &odd : &even, values[k]);
    quantile_merge(&odd, &even);
    CHECK(odd.count == 1000);
    for (int k = 0; k <= 1000; k += 50) {
        CHECK(quantile_at(&all, k / 1000.0) == quantile_at(&odd, k / 1000.0));
    }
    quantile_free(&all);
    quantile_free(&even);
    quantile_free(&odd);
}

static void test_zeros_infinities_and_nans_have_their_place(void **unused)
{
    (void)unused;
    struct quantile quantile = fresh();
    CHECK(isnan(quantile_at(&quantile, 0.5)));
    quantile_add(&quantile, NAN);
    CHECK(quantile.count == 0);
    for (int k = 0; k < 98; k++) quantile_add(&quantile, k % 2 ? 0.0 : -0.0);
    quantile_add(&quantile, 3);
    quantile_add(&quantile, INFINITY);
    CHECK(quantile_at(&quantile, 0.5) == 0 && quantile_at(&quantile, 0.98) == 0);
    CHECK_NEAR(quantile_at(&quantile, 0.99), 3, 3.0 / 256);
    CHECK(isinf(quantile_at(&quantile, 1)));
    quantile_free(&quantile);
}

static void test_a_resumed_run_keeps_its_percentiles(void **unused)
{
    (void)unused;
    struct quantile a = fresh(), b = fresh();
    struct rng rng = {7};
    for (int k = 0; k < 500; k++) quantile_add(&a, exp(5 * rng_normal(&rng)));
    quantile_add(&b, -1e300);                   /* is forgotten */
    struct archive save, load;
    archive_begin_save(&save);
    quantile_archive(&a, &save);
    archive_begin_load(&load, save.bytes, save.size);
    quantile_archive(&b, &load);
    CHECK(!save.failed && !load.failed && b.count == 500);
    for (int k = 0; k < 1000; k += 50) {
        CHECK(quantile_at(&a, k / 1000.0) == quantile_at(&b, k / 1000.0));
    }
    archive_end(&save);
    quantile_free(&a);
    quantile_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_percentiles_agree_with_sorting),
        cmocka_unit_test(test_order_and_merging_do_not_matter),
        cmocka_unit_test(test_zeros_infinities_and_nans_have_their_place),
        cmocka_unit_test(test_a_resumed_run_keeps_its_percentiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
