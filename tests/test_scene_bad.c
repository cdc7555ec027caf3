/* test_scene_bad.c - every file in tests/bad is refused, at the right line and for the right
 * reason.  Its first line says which: "# expect: LINE: part of the message" (line 0: none).
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/file.h"
#include "check.h"
#include "model/model.h"
#include "scene/scene.h"

#include <dirent.h>
#include <unistd.h>

static struct findings findings;

static struct scene *load(const char *path)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = path, .groups = groups, .place = true,
                                          .group_count = model_settings(groups)};
    memset(&findings, 0, sizeof findings);
    return scene_load(&request, &findings);
}

static bool was_found(const char *path, int line, const char *fragment)
{
    for (uint32_t k = 0; k < findings.count && k < FINDINGS_MAX; k++) {
        const struct finding *finding = &findings.list[k];
        if (finding->kind == FINDING_ERROR && finding->line == line
            && strstr(finding->text, fragment) && strcmp(finding->file, path) == 0) return true;
    }
    return false;
}

/* 1 if the file is refused as it says itself. */
static bool check_file(const char *path)
{
    struct error error;
    size_t size;
    char *text = file_load(path, 100000, &size, &error);
    int line = -1, used = 0;
    if (!text || sscanf(text, "# expect: %d: %n", &line, &used) != 1) {
        print_error("%s: no '# expect: LINE: text' in its first line\n", path);
        free(text);
        return false;
    }
    char *fragment = text + used;
    fragment[strcspn(fragment, "\n")] = 0;
    struct scene *scene = load(path);
    const bool right = !scene && was_found(path, line, fragment);
    if (!right) {
        print_error("%s: expected line %d, '%s'; found:\n", path, line, fragment);
        char told[1000];
        for (uint32_t k = 0; k < findings.count && k < FINDINGS_MAX; k++) {
            print_error("    %s\n", findings_line(&findings.list[k], told, sizeof told));
        }
    }
    scene_free(scene);
    free(text);
    return right;
}

static void test_every_broken_scene_is_refused_with_line_and_reason(void **unused)
{
    (void)unused;
    DIR *directory = opendir(".");
    CHECK(directory != NULL);
    uint32_t files = 0, wrong = 0;
    for (struct dirent *entry; (entry = readdir(directory));) {
        if (!strstr(entry->d_name, ".cfg")) continue;
        files++;
        wrong += !check_file(entry->d_name);
    }
    closedir(directory);
    CHECK(files >= 40);
    CHECK(wrong == 0);
}

static void test_all_errors_are_told_at_once(void **unused)
{
    (void)unused;
    const struct scene_request request = {.path = "many.cfg", .place = true, .text =
        "until = -1;\n"
        "box = [0, 0, 10, 10];\n"
        "gravty = (0, -1);\n"
        "grains = ( { radius = -1; restitution = 2; } );\n"
        "placements = ( { grains = \"x\"; } );\n"};
    memset(&findings, 0, sizeof findings);
    CHECK(scene_load(&request, &findings) == NULL);
    CHECK(was_found("many.cfg", 1, "until"));
    CHECK(was_found("many.cfg", 3, "gravity"));
    CHECK(was_found("many.cfg", 4, "radius"));
    CHECK(was_found("many.cfg", 4, "restitution"));
    CHECK(was_found("many.cfg", 5, "\"x\""));
}

static void test_a_file_that_is_not_there_is_told(void **unused)
{
    (void)unused;
    CHECK(!load("no/such/scene.cfg"));
    CHECK(was_found("no/such/scene.cfg", 0, "cannot open"));
    CHECK(!load("hourglas"));
    CHECK(was_found("hourglas", 0, "did you mean 'hourglass'?"));
    CHECK(!load("."));
}

/* The record of a place cuts long paths, so the files are named from within their folder. */
static int enter_folder(void **unused)
{
    (void)unused;
    const char *root = getenv("SOURCE_ROOT");
    if (root && chdir(root) != 0) return -1;
    return chdir("tests/bad");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_broken_scene_is_refused_with_line_and_reason),
        cmocka_unit_test(test_all_errors_are_told_at_once),
        cmocka_unit_test(test_a_file_that_is_not_there_is_told),
    };
    return cmocka_run_group_tests(tests, enter_folder, NULL);
}
