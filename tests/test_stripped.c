/* test_stripped.c - the kernels by hand of `bench --effects` are their models: grains end in the
 * same places, to rounding or to the last bit, or the comparison of their times would mean nothing.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/stripped.h"
#include "check.h"

static void check_kernel(const char *model)
{
    struct stripped_kernel kernel = *stripped_find(model);
    struct stripped_result result;
    struct error error = {0};
    kernel.turns = 1;
    if (!stripped_measure(&kernel, &result, &error)) fail_msg("%s", error.text);
    CHECK(result.apart >= 0);           /* and at most the kernel's own limit */
    CHECK(result.model > 0);
    CHECK(result.by_hand > 0);
}

static void test_soft_discs_by_hand_move_as_in_md(void **unused)
{
    (void)unused;
    check_kernel("md");
}

static void test_hard_discs_by_hand_collide_as_in_ed(void **unused)
{
    (void)unused;
    check_kernel("ed");
}

static void test_bird_s_method_by_hand_is_that_of_dsmc_to_the_last_bit(void **unused)
{
    (void)unused;
    check_kernel("dsmc");
}

static void test_the_lattice_gas_by_hand_is_that_of_lga_to_the_last_bit(void **unused)
{
    (void)unused;
    check_kernel("lga");
}

/* Soft discs that meet are apart by rounding at least. */
static void test_a_kernel_that_goes_another_way_is_told(void **unused)
{
    (void)unused;
    struct stripped_kernel kernel = *stripped_find("md");
    struct stripped_result result;
    struct error error = {0};
    kernel.turns = 1;
    kernel.apart_max = 1e-18;
    CHECK(!stripped_measure(&kernel, &result, &error));
    assert_non_null(strstr(error.text, "diameters away from the model"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_soft_discs_by_hand_move_as_in_md),
        cmocka_unit_test(test_hard_discs_by_hand_collide_as_in_ed),
        cmocka_unit_test(test_bird_s_method_by_hand_is_that_of_dsmc_to_the_last_bit),
        cmocka_unit_test(test_the_lattice_gas_by_hand_is_that_of_lga_to_the_last_bit),
        cmocka_unit_test(test_a_kernel_that_goes_another_way_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
