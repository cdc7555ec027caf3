/* test_scene_override.c - KEY=VALUE reaches every key, adds what is absent, and tells typing
 * errors with the nearest known key; vectors, numbers and includes are read generously.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/file.h"
#include "check.h"
#include "model/model.h"
#include "scene/scene.h"

#include <sys/stat.h>
#include <unistd.h>

static struct findings findings;

static const char plain[] =
    "until = 4; box = [0, 0, 10, 10];\n"
    "grains = ( { radius = 0.5; restitution = 1; } );\n"
    "placements = ( { count = 20; } );\n";

static struct scene *load_with(const char *const *overrides, uint32_t count)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = "plain.cfg", .text = plain, .groups = groups,
        .group_count = model_settings(groups), .overrides = overrides, .override_count = count,
        .place = false};
    memset(&findings, 0, sizeof findings);
    return scene_load(&request, &findings);
}

#define LOAD(...)                                                                       \
    load_with((const char *const[]){__VA_ARGS__},                                       \
              sizeof((const char *const[]){__VA_ARGS__}) / sizeof(const char *))

static bool told(const char *fragment)
{
    char line[1000];
    for (uint32_t k = 0; k < findings.count; k++) {
        findings_line(&findings.list[k], line, sizeof line);
        if (strstr(line, fragment)) return true;
        print_error("%s\n", line);
    }
    return false;
}

static void test_an_integer_of_any_length_keeps_its_value(void **unused)
{
    (void)unused;
    /* 2^32 + 5 and 1e11 lose their upper half in 32 bits. */
    struct scene *scene = LOAD("grains.[0].stiffness=100000000000", "grains.density=0x100000005",
        "gravity=(0, -99999999999)", "until=2147483648", "title=\"17179869184\"");
    CHECK(scene != NULL);
    CHECK(scene->species[0].stiffness == 1e11 && scene->species[0].density == 4294967301.0);
    CHECK(scene->gravity[1] == -99999999999.0 && scene->until == 2147483648.0);
    CHECK(strcmp(scene->title, "17179869184") == 0);
    scene_free(scene);
    scene = LOAD("grains.[0].stiffness=100000000000000000000000000000");
    CHECK(scene != NULL && scene->species[0].stiffness == 1e29);
    scene_free(scene);
    scene = LOAD("grains.[0].stiffness=0xffffffffffffffff");   /* would be -1 */
    CHECK(scene == NULL && told("must be a number"));
    scene = LOAD("view.size=[4294967936,480]");         /* 2^32 + 640 */
    CHECK(scene == NULL && told("view.size"));
    const struct scene_request request = {.path = "long.cfg", .text = "# 99999999999\nuntil = "
        "10000000000; box = [0, 0, 10, 10];\ngrains = ({ radius = 0.5; stiffness = 30000000000L; "
        "restitution = 1; "
        "});\nplacements = ({ count = 20; });\n"};
    memset(&findings, 0, sizeof findings);
    scene = scene_load(&request, &findings);
    CHECK(scene != NULL && scene->until == 1e10 && scene->species[0].stiffness == 3e10);
    scene_free(scene);
}

static void test_overrides_replace_add_and_append(void **unused)
{
    (void)unused;
    struct scene *scene = LOAD("until=7", "grains.[0].restitution=0.7", "grains[0].friction = 0.2",
        "grains.density=3", "view.size=[640,480]", "gravity=(0,-1)", "gravity.[0]=2",
        "placements.[1].region=[5,5,9,9]", "placements.[1].count=3", "title=Sand and water",
        "view.title=5", "view.theme=dark", "output.dump=true", "count_max=1e3",
        "walls.[0].shape=segment", "walls.[0].points=((1, 1), (2, 1.5))", "left=open",
        "measure.fields=density", "measure.fields.[1]=x");
    /* "density" is a single text, so it has no entry [1]. */
    CHECK(scene == NULL && told("an index [n] is used where there is no list"));
    scene = LOAD("until=7", "grains.[0].restitution=0.7", "grains[0].friction = 0.2",
        "grains.density=3", "view.size=[640,480]", "gravity=(0,-1)", "gravity.[0]=2",
        "placements.[1].region=[5,5,9,9]", "placements.[1].count=3", "title=Sand and water",
        "view.title=5", "view.theme=dark", "output.dump=true", "count_max=1e3",
        "walls.[0].shape=segment", "walls.[0].points=((1, 1), (2, 1.5))", "left=open",
        "measure.fields=[\"density\"]", "measure.fields.[1]=velocity");
    CHECK(scene != NULL);
    CHECK(scene->until == 7 && scene->species[0].restitution == 0.7);
    CHECK(scene->species[0].friction == 0.2 && scene->species[0].density == 3);
    CHECK(scene->view.size[0] == 640 && scene->view.size[1] == 480);
    CHECK(scene->gravity[0] == 2 && scene->gravity[1] == -1);
    CHECK(scene->placement_count == 2 && scene->placements[1].count == 3);
    CHECK(strcmp(scene->title, "Sand and water") == 0 && strcmp(scene->view.title, "5") == 0);
    CHECK(scene->view.theme == THEME_DARK && scene->output.dump && scene->count_max == 1000);
    CHECK(scene->wall_entry_count == 1 && scene->wall_count == 4 && scene->left == BORDER_OPEN);
    CHECK(scene->measure.fields.count == 2);
    CHECK(strcmp(scene->measure.fields.texts[1], "velocity") == 0);
    scene_free(scene);
}

static void test_every_key_of_every_group_is_reached(void **unused)
{
    (void)unused;
    /* A value that no key takes is refused by name and by type, never as unknown. */
    uint32_t keys = 0;
    const struct key_group *models[MODEL_MAX], *group;
    const uint32_t model_count = model_settings(models);
    for (uint32_t g = 0;; g++) {
        uint32_t own = 0;
        while (scene_key_group(own)) own++;
        group = g < own ? scene_key_group(g) : g - own < model_count ? models[g - own] : NULL;
        if (!group) break;
        const bool list = g > 0 && g < 9;
        for (uint32_t k = 0; k < group->count; k++) {
            char path[200], text[300];
            snprintf(path, sizeof path, "%s%s%s%s", group->name, list ? ".[0]" : "", g ? "." : "",
                     group->keys[k].name);
            snprintf(text, sizeof text, "%s={ x = 1; }", path);
            struct scene *scene = LOAD(text);
            snprintf(text, sizeof text, "'%s' must be", path);
            if (scene || !told(text)) fail_msg("%s is not reached", path);
            keys++;
        }
    }
    CHECK(keys > 100);
}

static void test_a_typing_error_names_the_nearest_key(void **unused)
{
    (void)unused;
    CHECK(!LOAD("grains.[0].restituton=0.7") && told("-s: error: unknown key "
          "'grains.[0].restituton'; did you mean 'restitution'?"));
    CHECK(!LOAD("viev.size=[1,2]") && told("did you mean 'view'?"));
    CHECK(!LOAD("view.siez=[100,200]") && told("did you mean 'size'?"));
    CHECK(!LOAD("grains.[5].radius=1") && told("this list has 1 entries, so its next one is [1]"));
    CHECK(!LOAD("until") && told("KEY=VALUE"));
    CHECK(!LOAD("=3") && told("KEY=VALUE"));
    CHECK(!LOAD("grains.[x].radius=1") && told("malformed"));
    CHECK(!LOAD("until.x=1") && told("no group"));
}

static void test_numbers_that_are_none_are_refused(void **unused)
{
    (void)unused;
    CHECK(!LOAD("until=nan") && told("'until' is nan"));
    CHECK(!LOAD("until=-nan"));
    CHECK(!LOAD("until=inf") && told("no finite number"));
    CHECK(!LOAD("until=1e999") && told("no finite number"));
    CHECK(!LOAD("until=") && told("must be a number"));
    CHECK(!LOAD("until=1;quick=true") && told("must be a number"));
    CHECK(!LOAD("gravity=(0,nan)"));
    CHECK(!LOAD("grains.[0].radius=-1") && told("greater than 0"));
    CHECK(!LOAD("count_max=99999999999") && told("must be 0 to 1073741823"));
    CHECK(!LOAD("seed=-0.5") && told("'seed' must be a whole number"));
}

static void test_the_quick_form_yields_to_overrides(void **unused)
{
    (void)unused;
    struct scene *scene = LOAD("quick_set=[\"until=1\", \"placements.[0].count=5\"]");
    CHECK(scene && scene->until == 4 && scene->placements[0].count == 20);
    scene_free(scene);
    scene = LOAD("quick=true", "quick_set=[\"until=1\", \"placements.[0].count=5\"]", "until=2");
    CHECK(scene && scene->until == 2 && scene->placements[0].count == 5);
    scene_free(scene);
}

static void write_file(const char *path, const char *text)
{
    struct error error;
    CHECK(file_save(path, text, strlen(text), &error));
}

static void test_an_include_is_found_beside_the_file_and_blamed_for_its_own_faults(void **unused)
{
    (void)unused;
    char folder[] = "/tmp/sandreel-include-XXXXXX", main_path[100], part_path[100];
    CHECK(mkdtemp(folder) != NULL);
    snprintf(main_path, sizeof main_path, "%s/main.cfg", folder);
    snprintf(part_path, sizeof part_path, "%s/part.cfg", folder);
    write_file(main_path, "until = 1; box = [0, 0, 10, 0.5e1];\n@include \"part.cfg\"\n");
    write_file(part_path, "\ngrains = ( { radius = 0.5; restitution = 1; } );\n"
                          "placements = ( { count = 3; spacing = 0.5; } );\n");
    const struct scene_request request = {.path = main_path, .place = true};
    memset(&findings, 0, sizeof findings);
    CHECK(scene_load(&request, &findings) == NULL);
    CHECK(findings.count == 1 && findings.list[0].line == 3);
    CHECK(strstr(findings.list[0].file, "part.cfg") != NULL);
    write_file(part_path, "grains = ( { radius = 0.5; restitution = 1; } );\n"
                          "placements = ( { count = 3; } );\n");
    struct scene *scene = scene_load(&request, &findings);
    CHECK(scene && scene->placed.count == 3 && strcmp(scene->name, "main") == 0);
    scene_free(scene);
    unlink(main_path);
    unlink(part_path);
    rmdir(folder);
}

static bool is_refused(const char *path, const char *why)
{
    const struct scene_request request = {.path = path};
    memset(&findings, 0, sizeof findings);
    struct scene *scene = scene_load(&request, &findings);
    const bool refused = !scene && findings.count == 1 && strstr(findings.list[0].text, why);
    scene_free(scene);
    return refused;
}

/* libconfig itself ends the program at a directory and waits at a pipe. */
static void test_what_is_no_scene_file_is_refused_as_an_include_and_as_a_scene(void **unused)
{
    (void)unused;
    char folder[] = "/tmp/sandreel-include-XXXXXX", scene[100], part[100], text[200];
    CHECK(mkdtemp(folder) != NULL);
    snprintf(scene, sizeof scene, "%s/main.cfg", folder);
    snprintf(part, sizeof part, "%s/part.cfg", folder);
    write_file(scene, "/* \n@include \"no\" */ until = 1; # it counts at the beginning of a line\n"
                      "  @include \"part.cfg\"\n");
    CHECK(mkfifo(part, 0600) == 0);
    CHECK(is_refused(scene, "part.cfg: not an ordinary file"));
    CHECK(findings.list[0].line == 3);
    CHECK(is_refused(part, "not an ordinary file"));
    unlink(part);
    CHECK(mkdir(part, 0700) == 0);
    CHECK(is_refused(scene, "this is a directory"));
    rmdir(part);
    write_file(part, "@include \"part.cfg\"\n");
    CHECK(is_refused(scene, "does it include itself?"));
    struct error error;
    CHECK(file_save(part, "/*\0*/", 5, &error));
    CHECK(is_refused(scene, "holds zero bytes"));
    write_file(scene, "@include \"a\\b\"\n");
    CHECK(is_refused(scene, "no name of a file"));
    snprintf(text, sizeof text, "until=1;\n@include \"%s\"\n", folder);
    const char *overrides[] = {text};
    write_file(scene, "until = 1; box = (0, 0, 10, 5); grains = ({ radius = 0.5; });\n");
    const struct scene_request request = {.path = scene, .overrides = overrides,
                                          .override_count = 1};
    CHECK(scene_load(&request, &findings) == NULL);
    unlink(scene);
    unlink(part);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_integer_of_any_length_keeps_its_value),
        cmocka_unit_test(test_overrides_replace_add_and_append),
        cmocka_unit_test(test_every_key_of_every_group_is_reached),
        cmocka_unit_test(test_a_typing_error_names_the_nearest_key),
        cmocka_unit_test(test_numbers_that_are_none_are_refused),
        cmocka_unit_test(test_the_quick_form_yields_to_overrides),
        cmocka_unit_test(test_an_include_is_found_beside_the_file_and_blamed_for_its_own_faults),
        cmocka_unit_test(test_what_is_no_scene_file_is_refused_as_an_include_and_as_a_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
