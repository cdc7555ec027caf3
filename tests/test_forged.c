/* test_forged.c - a saved state that somebody has changed on purpose is refused, or it runs.
 *
 * Hashes keep damaged checkpoints away, but not forged ones: they come with the right hashes.  So
 * each word of the saved state is bent here, one at a time, and what loads is run on for a while;
 * it may break, but not crash (nor, with the sanitizers, leave an array).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scenes.h"

#define SOFT "stiffness = 10000.0;"
#define GAS "placements = ({ kind = \"square\"; spacing = 1.5; temperature = 1.0; });"
#define PERIODIC "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; "          \
                 "top = \"periodic\";"

/* Few grains, so that a state has few words. */
static const char *const scenes[] = {
    "until = 4.0; box = [0.0, 0.0, 4.5, 4.5]; gravity = (0.0, -1.0);"
    "grains = ({ radius = 0.5; restitution = 0.8; " SOFT " });" GAS,
    "until = 4.0; box = [0.0, 0.0, 6.0, 6.0];" PERIODIC
    "grains = ({ name = \"a\"; radius = 0.5; restitution = 0.7; friction = 0.5; " SOFT " },"
    "          { name = \"b\"; radius = 0.4; restitution = 0.9; " SOFT " });"
    "placements = ({ grains = \"a\"; region = [0.0, 0.0, 6.0, 3.0]; kind = \"square\";"
    "                spacing = 1.5; temperature = 1.0; },"
    "              { grains = \"b\"; region = [0.0, 3.0, 6.0, 6.0]; kind = \"square\";"
    "                spacing = 1.5; temperature = 1.0; });",
    "until = 4.0; box = [0.0, 0.0, 6.0, 6.0]; gravity = (0.0, -1.0); bottom = \"open\";"
    "count_max = 12;"
    "grains = ({ radius = 0.5; restitution = 0.8; " SOFT " });"
    "placements = ({ region = [0.0, 2.0, 6.0, 4.0]; kind = \"square\"; spacing = 1.8; });"
    "walls = ({ shape = \"segment\"; points = ((0.0, 1.5), (3.0, 1.0)); opens = 3.0; });"
    "sources = ({ position = (3.0, 5.2); width = 1.0; rate = 2.0; });",
    "until = 4.0; box = [-3.0, -3.0, 3.0, 3.0];" PERIODIC
    "grains = ({ radius = 0.4; restitution = 0.8; " SOFT " });"
    "placements = ({ region = [-3.0, -3.0, -1.5, 3.0]; spacing = 1.2; velocity = (1.0, 0.3); });"
    "obstacles = ({ shape = \"disc\"; center = (0.0, 0.0); radius = 0.8; });"
    "measure = { collisions = true; };",
};

enum { SCENES = sizeof scenes / sizeof *scenes, WORK = 30 };

static char where[600];

/* Ways to bend a word: an index that is off by one, or far off; no number, and huge ones. */
static uint64_t bent(uint64_t word, uint32_t way)
{
    static const double none = NAN, huge = 1e300, less = -1e300;
    uint64_t bits = 0;
    switch (way) {
    case 0: return word ^ 1;
    case 1: return word ^ 1ull << 32;
    case 2: return word | 0xffffffffu;
    case 3: return word | 0x7fffffffull << 32;
    case 4: return word + (40ull << 32 | 40);
    case 5: return word ^ 0x2000200020002000u;
    case 6: memcpy(&bits, &none, sizeof bits); return bits;
    case 7: memcpy(&bits, &huge, sizeof bits); return bits;
    case 8: memcpy(&bits, &less, sizeof bits); return bits;
    default: return 0;
    }
}

enum { WAYS = 10 };

static void look(const struct simulation *sim)
{
    struct grains grains;
    CHECK(grains_create(&grains, 64, 256, NULL));
    simulation_observe(sim, &grains);
    simulation_count(sim);
    grains_free(&grains);
}

/* True if it was taken. */
static bool try_state(const struct model *model, const struct scene *scene, const void *bytes,
                      size_t size)
{
    struct simulation sim;
    struct archive load;
    struct error error = {0};
    CHECK(simulation_create(&sim, model, scene, &error));
    archive_begin_load(&load, bytes, size);
    const bool taken = simulation_load(&sim, &load, &error);
    if (taken) {
        if (simulation_advance(&sim, 4, WORK, &error) != ADVANCE_BROKEN) look(&sim);
    } else if (error.text[0] == 0) {
        fail_msg("%s: refused without a word", where);
    }
    archive_end(&load);
    simulation_destroy(&sim);
    return taken;
}

static struct scene *load(const struct model *model, const char *text, const char *setting)
{
    const struct key_group *groups[MODEL_MAX];
    const char *overrides[2] = {"overlap_limit=1.0", setting};
    struct findings *findings = calloc(1, sizeof *findings);
    const struct scene_request request = {
        .path = "test.cfg", .text = text, .groups = groups, .overrides = overrides,
        .override_count = setting ? 2 : 1, .group_count = model_settings(groups), .place = true,
    };
    struct scene *scene = scene_load(&request, findings);
    if (scene && model->resolve) model->resolve(scene, findings);
    if (scene && (findings->errors > 0 || scene->effects & ~model->effects)) {
        scene_free(scene);
        scene = NULL;
    }
    free(findings);
    return scene;
}

/* Returns how many words were bent; 0: the model cannot run the scene. */
static uint32_t bend_all(const struct model *model, const char *text, const char *setting)
{
    struct scene *scene = load(model, text, setting);
    if (!scene) return 0;
    struct simulation sim;
    struct archive saved;
    struct error error = {0};
    if (!simulation_create(&sim, model, scene, &error)) {
        scene_free(scene);
        return 0;
    }
    CHECK(simulation_advance(&sim, 1.3, UINT64_MAX, &error) == ADVANCE_REACHED);
    archive_begin_save(&saved);
    CHECK(simulation_save(&sim, &saved, &error));
    simulation_destroy(&sim);
    CHECK(try_state(model, scene, saved.bytes, saved.size));
    uint64_t *words = (uint64_t *)(void *)saved.bytes;
    const uint32_t count = (uint32_t)(saved.size / sizeof *words);
    uint32_t refused = 0;
    for (uint32_t k = 0; k < count; k++) {
        const uint64_t kept = words[k];
        for (uint32_t turn = 0; turn < 2; turn++) {
            words[k] = bent(kept, (k * 3 + turn * 5 + k / WAYS) % WAYS);
            refused += !try_state(model, scene, words, saved.size);
        }
        words[k] = kept;
    }
    CHECK(refused > 0);
    archive_end(&saved);
    scene_free(scene);
    return count;
}

static void test_a_forged_state_is_refused_or_runs(void **unused)
{
    (void)unused;
    for (const struct model *const *m = model_list; *m; m++) {
        uint32_t words = 0, variants = 0;
        for (uint32_t s = 0; s < SCENES; s++) {
            snprintf(where, sizeof where, "%s, scene %u", (*m)->name, s);
            uint32_t bends = bend_all(*m, scenes[s], NULL);
            words += bends;
            variants += bends > 0;
            for (uint32_t k = 0; k < (*m)->settings->count; k++) {
                const struct key *key = &(*m)->settings->keys[k];
                if (key->type != KEY_CHOICE) continue;
                /* How Hertz's law is damped is found at length, each time a state is made. */
                if (strcmp(key->name, "force") == 0 && s > 0) continue;
                char choices[400], setting[500], *rest = choices;
                snprintf(choices, sizeof choices, "%s", key->choices);
                for (char *word; (word = strsep(&rest, "|"));) {
                    if (strcmp(word, key->fallback) == 0) continue;
                    snprintf(setting, sizeof setting, "%s.%s=%s", (*m)->name, key->name, word);
                    snprintf(where, sizeof where, "%s, scene %u", setting, s);
                    bends = bend_all(*m, scenes[s], setting);
                    words += bends;
                    variants += bends > 0;
                }
            }
        }
        print_message("%-5s %2u variants, %u words bent\n", (*m)->name, variants, words);
        CHECK(variants > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_forged_state_is_refused_or_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
