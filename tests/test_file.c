/* test_file.c - a file appears whole or not at all, and what went wrong is told.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A full disk is played by a limit on the size of files (RLIMIT_FSIZE with SIGXFSZ ignored):
 * write()
 * then fails in the middle of a file, as it does when the disk runs full.
 */
#include "base/file.h"
#include "check.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static const char *in_folder(const char *name)
{
    static char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int files_in_folder(void)
{
    DIR *directory = opendir(folder);
    int count = 0;
    for (const struct dirent *e; (e = readdir(directory));) count += e->d_name[0] != '.';
    closedir(directory);
    return count;
}

static int make_folder(void **unused)
{
    (void)unused;
    snprintf(folder, sizeof folder, "/tmp/test_file.XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **unused)
{
    (void)unused;
    DIR *directory = opendir(folder);
    for (const struct dirent *e; (e = readdir(directory));) {
        if (e->d_name[0] != '.') unlink(in_folder(e->d_name));
    }
    closedir(directory);
    return rmdir(folder);
}

static void test_what_was_saved_is_loaded(void **unused)
{
    (void)unused;
    static const char text[] = "sand\0and more";
    struct error error;
    size_t size = 0;
    CHECK(file_save(in_folder("a"), text, sizeof text, &error));
    char *loaded = file_load(in_folder("a"), 1000, &size, &error);
    CHECK(loaded && size == sizeof text && memcmp(loaded, text, size) == 0 && loaded[size] == 0);
    free(loaded);
    assert_int_equal(files_in_folder(), 1);
    CHECK(!file_load(in_folder("a"), sizeof text - 1, &size, &error));
    CHECK(strstr(error.text, "larger than"));
}

static void test_nobody_sees_a_file_before_it_is_whole(void **unused)
{
    (void)unused;
    struct file file;
    struct error error;
    CHECK(file_begin(&file, in_folder("late"), &error));
    fputs("half", file.stream);
    CHECK(!file_exists(in_folder("late")));
    CHECK(file_commit(&file, &error));
    CHECK(file_exists(in_folder("late")));
    CHECK(file_begin(&file, in_folder("never"), &error));
    fputs("half", file.stream);
    file_abandon(&file);
    file_abandon(&file);
    CHECK(!file_exists(in_folder("never")));
    assert_int_equal(files_in_folder(), 2);     /* "a", "late" and nothing half-written */
}

static void test_a_full_disk_leaves_the_old_file_as_it_was(void **unused)
{
    (void)unused;
    static char large[1 << 20];
    struct error error = {.text = ""};
    struct rlimit kept;
    size_t size = 0;
    CHECK(file_save(in_folder("late"), "old", 3, &error));
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &kept);
    const struct rlimit small = {1 << 16, kept.rlim_max};
    CHECK(setrlimit(RLIMIT_FSIZE, &small) == 0);
    const bool done = file_save(in_folder("late"), large, sizeof large, &error);
    setrlimit(RLIMIT_FSIZE, &kept);
    signal(SIGXFSZ, SIG_DFL);
    CHECK(!done && strstr(error.text, "late") && strstr(error.text, "writing stopped"));
    char *old = file_load(in_folder("late"), 1000, &size, &error);
    CHECK(old && strcmp(old, "old") == 0);
    free(old);
    assert_int_equal(files_in_folder(), 2);
}

static void test_a_place_that_cannot_be_written_is_named(void **unused)
{
    (void)unused;
    struct error error = {.text = ""};
    CHECK(!file_save(in_folder("nowhere/x"), "x", 1, &error));
    CHECK(strstr(error.text, "nowhere/x") && strstr(error.text, "cannot create"));
    CHECK(!file_save(in_folder("a/x"), "x", 1, &error));        /* below a file */
    CHECK(!file_make_directory(in_folder("a"), &error));
    CHECK(strstr(error.text, "no directory"));
    CHECK(!file_make_directory(in_folder("a/b"), &error));
    /* The superuser may write anywhere, so this says something for everybody else only. */
    if (geteuid() != 0) {
        CHECK(chmod(folder, 0500) == 0);
        const bool done = file_save(in_folder("b"), "x", 1, &error);
        chmod(folder, 0700);
        CHECK(!done && strstr(error.text, "cannot create"));
    }
    assert_int_equal(files_in_folder(), 2);
}

static void test_directories_are_made_with_their_parents(void **unused)
{
    (void)unused;
    struct error error = {.text = ""};
    char deep[400];
    snprintf(deep, sizeof deep, "%s", in_folder("one/two/three"));
    CHECK(file_make_directory(deep, &error) && file_make_directory(deep, &error));
    CHECK(file_exists(deep));
    for (int level = 0; level < 3; level++) {
        CHECK(rmdir(deep) == 0);
        *strrchr(deep, '/') = 0;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_was_saved_is_loaded),
        cmocka_unit_test(test_nobody_sees_a_file_before_it_is_whole),
        cmocka_unit_test(test_a_full_disk_leaves_the_old_file_as_it_was),
        cmocka_unit_test(test_a_place_that_cannot_be_written_is_named),
        cmocka_unit_test(test_directories_are_made_with_their_parents),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
