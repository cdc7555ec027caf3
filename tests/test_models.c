/* test_models.c - the contract of model.h, which every model passes in every variant.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Each scene below is run by every model that can do what it calls for, once as it stands and once
 * for every choice among the model's own settings (its methods, force laws, integrators, ...).
 * Grains are soft where a model has a stiffness, so that its time steps are few.
 * Nothing here names a model: a new one is tested by being in model_list.
 */
#include "check.h"
#include "model/simulation.h"

#include <omp.h>

static const uint64_t unlimited = UINT64_MAX;

struct example {
    const char *name, *text;
    double until;
    bool   collides;            /* must collisions happen until then? */
    bool   open;                /* may grains be outside of the box? */
    const char *needs;          /* "NAME.KEY=VALUE": that model runs it with this choice alone */
};

#define SOFT "stiffness = 10000.0;"
#define GRAINS "grains = ({ radius = 0.5; restitution = 0.8; " SOFT " });"
#define GAS "placements = ({ kind = \"square\"; spacing = 1.8; temperature = 1.0; });"
#define PERIODIC "left = \"periodic\"; right = \"periodic\";"                \
                 "bottom = \"periodic\"; top = \"periodic\";"

static const struct example examples[] = {
    {"an elastic gas in a box", "until = 9.0; box = [0.0, 0.0, 18.0, 18.0];"
     "grains = ({ radius = 0.5; restitution = 1.0; " SOFT " });" GAS, 5, true, false, NULL},
    {"a cooling gas", "until = 9.0; box = [0.0, 0.0, 18.0, 18.0];" PERIODIC GRAINS GAS,
     5, true, false, NULL},
    {"falling into a box", "until = 12.0; box = [-9.0, 0.0, 9.0, 18.0]; gravity = (0.0, -1.0);"
     GRAINS GAS, 8, true, false, NULL},
    {"a funnel with a gate", "until = 12.0; box = [-9.0, 0.0, 9.0, 24.0]; gravity = (0.0, -1.0);"
     GRAINS "placements = ({ region = [-8.0, 14.0, 8.0, 22.0]; spacing = 1.2; });"
     "walls = ({ shape = \"polyline\"; points = ((-9.0, 16.0), (-3.5, 8.0)); },"
     "         { shape = \"polyline\"; points = ((3.5, 8.0), (9.0, 16.0)); },"
     "         { shape = \"segment\"; points = ((-3.5, 8.0), (3.5, 8.0)); opens = 4.0; },"
     "         { shape = \"segment\"; points = ((-9.0, 23.4), (9.0, 23.4)); opens = 1.0;"
     "           closes = 6.0; });", 8, true, false, NULL},
    {"a source and an open bottom", "until = 16.0; box = [-9.0, 0.0, 9.0, 18.0];"
     "gravity = (0.0, -1.0); bottom = \"open\"; count_max = 300;" GRAINS
     "placements = ({ region = [-9.0, 2.0, 9.0, 8.0]; kind = \"square\"; spacing = 1.8; });"
     "sources = ({ position = (0.0, 14.0); width = 4.0; rate = 2.0; });", 10, false, true, NULL},
    {"two phases: a gas, then heavy and lossy grains", "until = 12.0;"
     "box = [0.0, 0.0, 18.0, 18.0];"
     "grains = ({ radius = 0.5; restitution = 1.0; " SOFT " });" GAS
     "phases = ({ time = 5.0; set = [\"gravity=(0, -1)\", \"grains.[0].restitution=0.7\"]; });",
     8, true, false, NULL},
    {"mixed sizes", "until = 6.0; box = [0.0, 0.0, 18.0, 18.0];"
     "grains = ({ radius = [0.3, 0.5]; restitution = 0.9; " SOFT " });" GAS,
     6, true, false, NULL},
    {"rough grains", "until = 6.0; box = [0.0, 0.0, 18.0, 18.0]; gravity = (0.0, -1.0);"
     "grains = ({ radius = 0.5; restitution = 0.7; " SOFT " friction = 0.5; });" GAS,
     6, true, false, NULL},
    {"two kinds of grains", "until = 6.0; box = [0.0, 0.0, 18.0, 18.0];"
     "grains = ({ name = \"a\"; radius = 0.5; restitution = 0.7; " SOFT " },"
     "          { name = \"b\"; radius = 0.4; restitution = 0.95; " SOFT
     "            density = 2.0; });"
     "placements = ({ grains = \"a\"; region = [0.0, 0.0, 18.0, 9.0]; kind = \"square\";"
     "                spacing = 1.8; temperature = 1.0; },"
     "              { grains = \"b\"; region = [0.0, 9.0, 18.0, 18.0]; kind = \"square\";"
     "                spacing = 1.8; temperature = 1.0; });", 6, true, false, NULL},
    {"an obstacle, a moving wall and a screen", "until = 6.0; box = [-12.0, -9.0, 12.0, 9.0];"
     "left = \"open\"; right = \"open\"; top = \"open\"; bottom = \"open\";" GRAINS
     "placements = ({ region = [-11.0, -5.0, -3.0, 5.0]; velocity = (2.0, 0.0);"
     "                spacing = 1.3; });"
     "obstacles = ({ shape = \"disc\"; center = (0.0, 0.0); radius = 1.5; });"
     "walls = ({ shape = \"segment\"; points = ((5.0, -4.0), (5.0, 4.0));"
     "           velocity = (-0.5, 0.0); });"
     "screens = ({ kind = \"circle\"; center = (0.0, 0.0); radius = 14.0; });"
     "measure = { collisions = true; };", 6, true, true, NULL},
    {"sheared by the borders", "until = 6.0; box = [0.0, 0.0, 18.0, 18.0]; shear_rate = -0.3;"
     PERIODIC GRAINS GAS, 5, true, false, NULL},
    {"impact parameters and rates of a cooling gas", "until = 6.0;"
     "box = [0.0, 0.0, 18.0, 18.0];" PERIODIC GRAINS GAS
     "measure = { impact_parameters = true; impact_bins = 20; collisions = true;"
     "            collision_window = 0.7; };", 5, true, false, NULL},
    /* Grains that leave and enter move the counts of the others about. */
    {"counts and stress where grains come and go", "until = 16.0; box = [-9.0, 0.0, 9.0, 18.0];"
     "gravity = (0.0, -1.0); bottom = \"open\"; count_max = 300;"
     "grains = ({ radius = [0.4, 0.5]; restitution = 0.8; " SOFT " friction = 0.3; });"
     "placements = ({ region = [-9.0, 2.0, 9.0, 8.0]; kind = \"square\"; spacing = 1.2;"
     "                temperature = 1.0; });"
     "walls = ({ shape = \"segment\"; points = ((-9.0, 1.0), (3.0, 1.0)); });"
     "sources = ({ position = (-4.0, 14.0); width = 4.0; rate = 2.0; });"
     "measure = { collision_counts = true; stress = true; cell = 3.0; };", 8, true, true, NULL},
    {"many grains for two threads", "until = 0.5; box = [0.0, 0.0, 96.0, 96.0];" PERIODIC GRAINS
     "placements = ({ kind = \"square\"; spacing = 1.5; temperature = 16.0; "
     "});", 0.5, false, false, NULL},
    /* The floor is narrow, so that the heap soon lifts the source and grains fall off its sides. */
    {"a source that rises with its heap", "until = 80.0; box = [-7.0, 0.0, 7.0, 18.0];"
     "left = \"open\"; right = \"open\"; gravity = (0.0, -1.0);" GRAINS
     "sources = ({ position = (0.0, 4.0); above = 3.0; width = 1.0; rate = 1.0; });",
     60, true, true, "dsmc.method=hsmc"},
};

enum { EXAMPLES = sizeof examples / sizeof *examples };

/* One model, one scene, one variant. */
struct trial {
    const struct model *model;
    const struct example *example;
    const char *setting;        /* "NAME.KEY=VALUE"; NULL: as it stands */
    struct scene *scene;
};

static char where[700];         /* told when a check fails */

#define EXPECT(condition)                                                               \
    do {                                                                                \
        if (!(condition)) fail_msg("%s: not true: %s", where, #condition);              \
    } while (0)

/* A setting may call for another one that has no default, and then the finding names it: writes
 * "NAME.KEY=1" for it. */
static bool find_companion(const struct model *model, const char *text, char companion[100])
{
    for (uint32_t k = 0; model && model->settings && k < model->settings->count; k++) {
        const struct key *key = &model->settings->keys[k];
        char name[80];
        snprintf(name, sizeof name, "%s.%s", model->name, key->name);
        const char *found = key->type == KEY_REAL ? strstr(text, name) : NULL;
        if (!found) continue;
        const char next = found[strlen(name)];
        if (next == '_' || (next >= 'a' && next <= 'z')) continue;      /* a longer name */
        snprintf(companion, 100, "%s=1.0", name);
        return true;
    }
    return false;
}

static struct scene *load_with(const struct model *model, const char *text,
                               const char *const *overrides, uint32_t count,
                               struct findings *findings)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = "test", .text = text, .groups = groups,
        .overrides = overrides, .override_count = count, .group_count = model_settings(groups),
        .place = true};
    *findings = (struct findings){0};
    struct scene *scene = scene_load(&request, findings);
    for (uint32_t p = 0; scene && model && model->resolve && p < scene->phase_count; p++) {
        model->resolve(scene->phases[p], findings);
    }
    if (!findings->errors) return scene;
    scene_free(scene);
    return NULL;
}

/* Soft grains overlap deeply at a hard hit; here that is no failure. */
static const char soft[] = "overlap_limit=1.0";

static struct scene *load(const struct model *model, const struct example *example,
                          const char *setting)
{
    struct findings *findings = calloc(1, sizeof *findings);
    const char *overrides[4] = {soft}, *text = example->text;
    uint32_t count = 1;
    char companion[100];
    if (model && example->needs) overrides[count++] = example->needs;
    if (setting) overrides[count++] = setting;
    struct scene *scene = load_with(model, text, overrides, count, findings);
    for (uint32_t k = 0; !scene && k < findings->count && k < FINDINGS_MAX && count < 4; k++) {
        if (findings->list[k].kind != FINDING_ERROR) continue;
        if (!find_companion(model, findings->list[k].text, companion)) continue;
        overrides[count++] = companion;
        scene = load_with(model, text, overrides, count, findings);
    }
    for (uint32_t k = 0; !scene && k < findings->count && k < FINDINGS_MAX; k++) {
        if (findings->list[k].kind != FINDING_ERROR) continue;
        fail_msg("%s: %s", where, findings->list[k].text);
    }
    EXPECT(scene);
    free(findings);
    return scene;
}

static struct simulation start(const struct trial *trial)
{
    struct simulation sim;
    struct error error = {.text = ""};
    if (!simulation_create(&sim, trial->model, trial->scene, &error)) {
        fail_msg("%s: %s", where, error.text);
    }
    return sim;
}

/* Advances to `t` in portions of `budget`; a model that never gets there fails. */
static void advance(struct simulation *sim, double t, uint64_t budget)
{
    struct error error = {.text = ""};
    for (int calls = 0;; calls++) {
        const enum advance outcome = simulation_advance(sim, t, budget, &error);
        if (outcome == ADVANCE_BROKEN) fail_msg("%s: broken: %s", where, error.text);
        if (outcome == ADVANCE_REACHED) return;
        EXPECT(budget != unlimited && calls < 10000000);
    }
}

/* Every grain is there once, finite, and where grains can be; none is lost or made. */
static void check_grains(const struct trial *trial, const struct simulation *sim, double t)
{
    const struct counters counters = simulation_count(sim);
    struct grains grains;
    EXPECT(grains_create(&grains, (uint32_t)counters.grains + 8, 0, NULL));
    simulation_observe(sim, &grains);
    EXPECT(grains.count == counters.grains && grains.missed == 0);
    EXPECT(grains.time == counters.time);
    EXPECT(trial->scene->placed.count + counters.grains_in - counters.grains_out
           == counters.grains);
    /* Within half a step; a model without steps is there exactly.  A phase may change the step,
     * so the mean one counts double. */
    const double step = counters.steps ? counters.time / (double)counters.steps : t;
    if (counters.steps > 0) EXPECT(fabs(grains.time - t) <= step + 1e-9);
    const double *box = trial->scene->box, margin = trial->example->open ? INFINITY : 1e-9;
    for (uint32_t i = 0; i < grains.count; i++) {
        EXPECT(isfinite(grains.x[i]) && isfinite(grains.y[i]));
        EXPECT(isfinite(grains.vx[i]) && isfinite(grains.vy[i]));
        EXPECT(isfinite(grains.angle[i]) && isfinite(grains.spin[i]));
        EXPECT(grains.radius[i] > 0 && grains.mass[i] > 0);
        EXPECT(grains.x[i] >= box[0] - margin && grains.x[i] <= box[2] + margin);
        EXPECT(grains.y[i] >= box[1] - margin && grains.y[i] <= box[3] + margin);
    }
    uint32_t id_max = 0;
    for (uint32_t i = 0; i < grains.count; i++) {
        if (grains.id[i] > id_max) id_max = grains.id[i];
    }
    unsigned char *seen = calloc((size_t)id_max + 1, 1);
    for (uint32_t i = 0; i < grains.count; i++) {
        EXPECT(!seen[grains.id[i]]);
        seen[grains.id[i]] = 1;
    }
    free(seen);
    grains_free(&grains);
}

/* What the scene wants measured is there: sums are finite, and each collision is in them once. */
static void check_measured(const struct trial *trial, const struct simulation *sim)
{
    const effects_t asked = trial->scene->effects;
    const struct tally *tally = simulation_tally(sim);
    const struct counters counters = simulation_count(sim);
    if (asked & EFFECT_IMPACT) {
        double sum = 0;
        for (uint32_t b = 0; b < tally->impact.bins; b++) sum += tally->impact.count[b];
        EXPECT(tally->impact.bins == trial->scene->measure.impact_bins);
        EXPECT(sum == (double)counters.collisions);
    }
    if (asked & EFFECT_STRESS) {
        const struct tally_stress *stress = &tally->stress;
        double sum = 0, size = 0;
        for (uint32_t c = 0; c < 4 * stress->nx * stress->ny; c++) {
            sum += stress->cells[c];
            size += fabs(stress->cells[c]);
        }
        for (int k = 0; k < 4; k++) sum -= stress->total[k];
        EXPECT(stress->total[0] < 0 && stress->total[3] < 0);           /* they press */
        EXPECT(fabs(sum) <= 1e-9 * size);
    }
    if (!(asked & EFFECT_COLLISION_COUNT)) return;
    struct grains grains;
    EXPECT(grains_create(&grains, (uint32_t)counters.grains + 8, 0, NULL));
    simulation_observe(sim, &grains);
    uint64_t sum = 0;
    for (uint32_t i = 0; i < grains.count; i++) {
        EXPECT(grains.collisions_elastic[i] <= grains.collisions[i]);
        sum += grains.collisions[i];
    }
    EXPECT(sum > 0);
    /* Both grains of a pair count it, and contacts with walls come on top. */
    if (counters.grains_out == 0) EXPECT(sum >= 2 * counters.collisions);
    grains_free(&grains);
}

static uint64_t digest_after(const struct trial *trial, int pieces, bool look, uint64_t budget)
{
    struct simulation sim = start(trial);
    for (int k = 1; k <= pieces; k++) {
        const double t = trial->example->until * k / pieces;
        advance(&sim, t, budget);
        if (look) check_grains(trial, &sim, t);
    }
    const uint64_t digest = simulation_digest(&sim);
    const struct counters counters = simulation_count(&sim);
    EXPECT(counters.steps > 0);
    if (trial->example->collides) EXPECT(counters.collisions > 0);
    check_measured(trial, &sim);
    simulation_destroy(&sim);
    return digest;
}

static void check_same_however_it_is_run(const struct trial *trial, uint64_t straight)
{
    omp_set_num_threads(1);
    EXPECT(straight == digest_after(trial, 1, false, unlimited));       /* repeatable */
    EXPECT(straight == digest_after(trial, 17, false, unlimited));      /* in pieces */
    EXPECT(straight == digest_after(trial, 17, true, unlimited));       /* watched */
    EXPECT(straight == digest_after(trial, 3, true, 5));                /* small budgets */
    omp_set_num_threads(2);
    EXPECT(straight == digest_after(trial, 1, false, unlimited));       /* two threads */
}

/* Saved at `share` of the run and loaded into a fresh simulation, it goes on to the same end. */
static void check_resumed(const struct trial *trial, double share, uint64_t straight)
{
    struct simulation a = start(trial), b = start(trial);
    struct archive save, load;
    struct error error = {.text = ""};
    advance(&a, share * trial->example->until, unlimited);
    archive_begin_save(&save);
    EXPECT(simulation_save(&a, &save, &error));
    archive_begin_load(&load, save.bytes, save.size);
    EXPECT(simulation_load(&b, &load, &error));
    EXPECT(a.phase == b.phase);
    EXPECT(simulation_digest(&a) == simulation_digest(&b));
    check_grains(trial, &b, share * trial->example->until);
    simulation_destroy(&a);
    advance(&b, trial->example->until, unlimited);
    EXPECT(simulation_digest(&b) == straight);
    /* Torn within a record; records are whole words, so an odd size always is. */
    const size_t torn[] = {save.size - 1, save.size / 2 | 1, save.size / 3 | 1, 1};
    for (size_t k = 0; k < sizeof torn / sizeof *torn; k++) {
        archive_begin_load(&load, save.bytes, torn[k]);
        error.text[0] = 0;
        EXPECT(!simulation_load(&b, &load, &error));
        EXPECT(error.text[0]);
    }
    archive_end(&save);
    simulation_destroy(&b);
}

/* The state does change with time: two equal digests would otherwise mean nothing. */
static void check_digest_sees(const struct trial *trial, uint64_t straight)
{
    struct simulation sim = start(trial);
    const uint64_t first = simulation_digest(&sim);
    EXPECT(first != straight);
    simulation_destroy(&sim);
}

/* Runs the whole contract and returns the digest of the end; but a setting that ends like `plain`
 * (0: none yet) makes no difference to this scene and has been tested with it. */
static uint64_t run_trial(const struct trial *trial, uint64_t plain)
{
    if (getenv("SHOW")) fprintf(stderr, "%s\n", where);
    const uint64_t straight = digest_after(trial, 1, false, unlimited);
    if (straight == plain) return straight;
    check_same_however_it_is_run(trial, straight);
    check_digest_sees(trial, straight);
    check_resumed(trial, 0.3, straight);
    check_resumed(trial, 0.8, straight);        /* behind the change of phase where there is one */
    return straight;
}

static effects_t effects_needed(const struct scene *scene)
{
    effects_t needed = 0;
    for (uint32_t p = 0; p < scene->phase_count; p++) needed |= scene->phases[p]->effects;
    return needed;
}

/* Is this the choice that the example needs, or another one of the same key?  Of those each must be
 * refused. */
static bool is_needed_key(const struct model *model, const struct example *example,
                          const char *setting)
{
    const size_t key = (size_t)(strchr(setting, '=') - setting) + 1;
    if (!example->needs || strncmp(setting, example->needs, key) != 0) return false;
    if (strcmp(setting, example->needs) == 0) return true;
    struct findings *findings = calloc(1, sizeof *findings);
    EXPECT(!load_with(model, example->text, (const char *[]){soft, setting}, 2, findings));
    EXPECT(findings->errors > 0);
    free(findings);
    return true;
}

/* Runs the example with every choice of every setting of the model; the first choice of a key is
 * taken with the others as they stand. */
static int run_variants(const struct model *model, const struct example *example)
{
    struct trial trial = {.model = model, .example = example};
    snprintf(where, sizeof where, "%s", example->name);
    struct scene *plain = load(NULL, example, NULL);
    const bool able = !(effects_needed(plain) & ~model->effects);
    scene_free(plain);
    if (!able) return 0;
    snprintf(where, sizeof where, "%s, %s", model->name, example->name);
    trial.scene = load(model, example, NULL);
    const uint64_t plain_end = run_trial(&trial, 0);
    scene_free(trial.scene);
    int count = 1;
    for (uint32_t k = 0; model->settings && k < model->settings->count; k++) {
        const struct key *key = &model->settings->keys[k];
        if (key->type != KEY_CHOICE) continue;
        char choices[400], *rest = choices;
        snprintf(choices, sizeof choices, "%s", key->choices);
        for (char *word; (word = strsep(&rest, "|"));) {
            char setting[500];
            snprintf(setting, sizeof setting, "%s.%s=%s", model->name, key->name, word);
            snprintf(where, sizeof where, "%s, %s", setting, example->name);
            if (is_needed_key(model, example, setting)) continue;
            if (strcmp(word, key->fallback) == 0) continue;
            trial.scene = load(model, example, setting);
            count += run_trial(&trial, plain_end) != plain_end;
            scene_free(trial.scene);
        }
    }
    return count;
}

static void test_every_model_keeps_the_contract_in_every_variant(void **unused)
{
    (void)unused;
    int runs_of_example[EXAMPLES] = {0};
    for (const struct model *const *m = model_list; *m; m++) {
        int runs = 0;
        for (int e = 0; e < EXAMPLES; e++) {
            const int variants = run_variants(*m, &examples[e]);
            if (variants) print_message("%-5s %-50s %d variants\n", (*m)->name, examples[e].name,
                                        variants);
            runs_of_example[e] += variants;
            runs += variants;
        }
        if (runs == 0) fail_msg("model '%s' can run none of the scenes", (*m)->name);
    }
    CHECK(model_list[0]);
    /* The plainest scenes are for everyone. */
    for (const struct model *const *m = model_list; *m; m++) {
        CHECK(!((EFFECT_WALLS | EFFECT_DISSIPATION) & ~(*m)->effects));
    }
    for (int e = 0; e < 2; e++) CHECK(runs_of_example[e] > 0);
}

static void test_what_a_model_cannot_do_is_refused_by_name(void **unused)
{
    (void)unused;
    for (const struct model *const *m = model_list; *m; m++) {
        for (int bit = 0; bit < EFFECT_COUNT; bit++) {
            const effects_t effect = 1u << bit;
            if ((*m)->effects & effect) continue;
            snprintf(where, sizeof where, "%s, %s", (*m)->name, effect_word(effect));
            struct scene *scene = load(*m, &examples[0], NULL);
            scene->effects |= effect;
            struct simulation sim;
            struct error error = {.text = ""};
            char able[200];
            model_names(scene->effects, able, sizeof able);
            EXPECT(!simulation_create(&sim, *m, scene, &error));
            EXPECT(error.code == EXIT_SCENE && sim.state == NULL);
            EXPECT(strstr(error.text, effect_word(effect)) && strstr(error.text, able));
            EXPECT(strstr(error.text, (*m)->name));
            scene_free(scene);
        }
    }
}

static void test_an_effect_in_a_later_phase_is_refused_before_the_start(void **unused)
{
    (void)unused;
    for (const struct model *const *m = model_list; *m; m++) {
        if (!(EFFECT_SHEAR & ~(*m)->effects) || (EFFECT_GRAVITY & ~(*m)->effects)) continue;
        snprintf(where, sizeof where, "%s, two phases", (*m)->name);
        struct scene *scene = load(*m, &examples[5], NULL);
        EXPECT(scene->phase_count == 2);
        struct scene later = *scene->phases[1];
        later.effects |= EFFECT_SHEAR;
        struct scene *phases[2] = {scene, &later};
        struct scene **kept = scene->phases;
        scene->phases = phases;
        struct simulation sim;
        struct error error = {.text = ""};
        EXPECT(!simulation_create(&sim, *m, scene, &error));
        EXPECT(strstr(error.text, effect_word(EFFECT_SHEAR)));
        scene->phases = kept;
        scene_free(scene);
    }
}

static void test_every_model_describes_itself(void **unused)
{
    (void)unused;
    for (const struct model *const *m = model_list; *m; m++) {
        CHECK((*m)->name && (*m)->summary && (*m)->work);
        CHECK(model_find((*m)->name) == *m);
        for (const struct model *const *n = model_list; n != m; n++) {
            CHECK(strcmp((*n)->name, (*m)->name) != 0);
        }
        if (!(*m)->settings) continue;
        CHECK(strcmp((*m)->settings->name, (*m)->name) == 0);
        for (uint32_t k = 0; k < (*m)->settings->count; k++) {
            const struct key *key = &(*m)->settings->keys[k];
            CHECK(key->name[0] && key->fallback && key->doc);
            CHECK(key->offset < (*m)->settings->size);
        }
    }
    CHECK(!model_find("nonesuch"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_model_describes_itself),
        cmocka_unit_test(test_every_model_keeps_the_contract_in_every_variant),
        cmocka_unit_test(test_what_a_model_cannot_do_is_refused_by_name),
        cmocka_unit_test(test_an_effect_in_a_later_phase_is_refused_before_the_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
