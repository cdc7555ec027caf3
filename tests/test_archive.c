/* test_archive.c - saving, loading and hashing are one list; torn and foreign bytes are noticed.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/archive.h"
#include "check.h"

struct state { uint32_t count, unused; double x[4], y[4]; };

static void pass(struct archive *archive, struct state *state, bool with_y)
{
    archive_count(archive, "count", &state->count, 4);
    archive_array(archive, "x", state->x, state->count);
    if (with_y) archive_array(archive, "y", state->y, state->count);
}

static const struct state sample = {3, 0, {1, 2, 3, 0}, {4, 5, 6, 0}};

static void test_what_was_saved_is_loaded(void **unused)
{
    (void)unused;
    struct state a = sample, b = {0};
    struct archive save, load;
    archive_begin_save(&save);
    pass(&save, &a, true);
    CHECK(!save.failed);
    archive_begin_load(&load, save.bytes, save.size);
    pass(&load, &b, true);
    CHECK(!load.failed);
    CHECK(memcmp(&a, &b, sizeof a) == 0);
    archive_end(&save);
}

static void test_an_absent_array_stays_neutral_and_a_spare_one_is_passed_over(void **unused)
{
    (void)unused;
    struct state a = sample, b = {.y = {7, 7, 7, 7}};
    struct archive save, load;
    archive_begin_save(&save);
    pass(&save, &a, false);
    archive_begin_load(&load, save.bytes, save.size);
    pass(&load, &b, true);
    CHECK(!load.failed && b.y[0] == 7 && b.x[2] == 3);
    archive_end(&save);
    archive_begin_save(&save);
    pass(&save, &a, true);
    archive_begin_load(&load, save.bytes, save.size);
    pass(&load, &b, false);
    CHECK(!load.failed && b.y[0] == 7);
    archive_end(&save);
}

static void test_torn_bytes_are_noticed_at_every_length(void **unused)
{
    (void)unused;
    struct state a = sample;
    struct archive save, load;
    archive_begin_save(&save);
    pass(&save, &a, true);
    /* A cut between two records leaves a shorter, whole archive; every other cut must fail. */
    uint32_t whole = 0;
    for (size_t size = 0; size < save.size; size++) {
        archive_begin_load(&load, save.bytes, size);
        whole += !load.failed;
    }
    assert_int_equal(whole, 3);
    archive_end(&save);
}

static void test_too_many_grains_are_refused(void **unused)
{
    (void)unused;
    uint32_t count = 5;
    struct state b = {0};
    struct archive save, load;
    archive_begin_save(&save);
    archive_value(&save, "count", &count);
    archive_begin_load(&load, save.bytes, save.size);
    pass(&load, &b, true);
    CHECK(load.failed && b.count == 0);
    archive_end(&save);
}

static void test_the_hash_sees_every_byte(void **unused)
{
    (void)unused;
    struct state a = sample, b = sample;
    b.y[2] = nextafter(b.y[2], 10);
    struct archive first, second;
    archive_begin_hash(&first);
    pass(&first, &a, true);
    archive_begin_hash(&second);
    pass(&second, &b, true);
    CHECK(first.hash != second.hash);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_was_saved_is_loaded),
        cmocka_unit_test(test_an_absent_array_stays_neutral_and_a_spare_one_is_passed_over),
        cmocka_unit_test(test_torn_bytes_are_noticed_at_every_length),
        cmocka_unit_test(test_too_many_grains_are_refused),
        cmocka_unit_test(test_the_hash_sees_every_byte),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
