/* effects.c - see effects.h.
 *
 * Keys are laid over the scene to take an effect out (on the user's scene) or to put it in (on a
 * gas of our own).  The state is carried over as between phases: an archive is loaded into a model
 * that was created for the other scene.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/effects.h"

#include "base/clock.h"
#include "bench/heap.h"
#include "bench/stripped.h"
#include "model/simulation.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEYS_MAX = 48, KEY_LENGTH = 200, REPEATS = 7 };

static const double warm_seconds = 0.2;         /* before the state is taken */
static const double slice_seconds = 0.02;       /* of one measurement */

/* Keys that take an effect out, then keys that put it into the gas below; parted by ';', and * is
 * every species.  "": it cannot be taken out without another scene. */
static const struct change { effects_t effect; const char *out, *in; } changes[] = {
    {EFFECT_GRAVITY, "gravity=(0,0)", "gravity=(0,-1e-3)"},
    {EFFECT_DISSIPATION, "grains.*.restitution=1", "grains.*.restitution=0.9"},
    {EFFECT_FRICTION, "grains.*.friction=0", "grains.*.friction=0.5;md.tangential=coulomb"},
    {EFFECT_ROTATION, "grains.*.friction=0", ""},
    {EFFECT_STATIC_FRICTION, "md.tangential=coulomb", "grains.*.friction=0.5"},
    {EFFECT_POLYDISPERSE, "", "grains.*.radius=(0.45,0.5)"},
    {EFFECT_WALLS, "", "left=wall;right=wall;bottom=wall;top=wall"},
    {EFFECT_MOVING_WALLS, "", "walls=({shape=\"segment\";points=((50,50),(60,50));"
                              "surface_speed=1.0;})"},
    {EFFECT_GATES, "", "walls=({shape=\"segment\";points=((50,50),(60,50));opens=1e6;})"},
    {EFFECT_OBSTACLE, "", "obstacles=({shape=\"disc\";center=(50,50);radius=2.0;})"},
    {EFFECT_INFLOW, "sources=()", "sources=({position=(20,20);rate=1e-3;})"},
    {EFFECT_OUTFLOW, "sinks=()", "sinks=({region=(80,80,80.1,80.1);})"},
    {EFFECT_SCREEN, "screens=()", "screens=({center=(50,50);radius=1e3;})"},
    {EFFECT_COLLISION_RATE, "measure.collisions=false;view.color=speed",
     "measure.collisions=true"},
    {EFFECT_COLLISION_COUNT, "measure.collision_counts=false", "measure.collision_counts=true"},
    {EFFECT_IMPACT, "measure.impact_parameters=false", "measure.impact_parameters=true"},
    {EFFECT_STRESS, "measure.stress=false", "measure.stress=true"},
    {EFFECT_SHEAR, "shear_rate=0", "shear_rate=0.01"},
};

struct keys {
    uint32_t count;
    char texts[KEYS_MAX][KEY_LENGTH];
    const char *list[KEYS_MAX];
};

static void add_key(struct keys *keys, const char *text)
{
    if (keys->count == KEYS_MAX) return;
    snprintf(keys->texts[keys->count], KEY_LENGTH, "%s", text);
    keys->list[keys->count] = keys->texts[keys->count];
    keys->count++;
}

/* One key, or one for each species. */
static void add_for_species(struct keys *keys, const char *text, uint32_t species)
{
    const char *star = strchr(text, '*');
    for (uint32_t k = 0; star && k < species; k++) {
        char one[KEY_LENGTH];
        snprintf(one, sizeof one, "%.*s[%u]%s", (int)(star - text), text, k, star + 1);
        add_key(keys, one);
    }
    if (!star) add_key(keys, text);
}

/* Semicolons within brackets belong to a value. */
static void add_all(struct keys *keys, const char *text, uint32_t species)
{
    char one[KEY_LENGTH];
    int depth = 0;
    size_t used = 0;
    for (const char *at = text; ; at++) {
        depth += (*at == '(' || *at == '{') - (*at == ')' || *at == '}');
        if (*at && (*at != ';' || depth > 0)) {
            if (used + 1 < sizeof one) one[used++] = *at;
            continue;
        }
        one[used] = 0;
        if (used > 0) add_for_species(keys, one, species);
        used = 0;
        if (!*at) return;
    }
}

static const struct change *change_of(effects_t effect)
{
    for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
        if (changes[k].effect == effect) return &changes[k];
    }
    return NULL;
}

/* What the model chose for the whole scene stays as it is, or another time step or stiffness would
 * be compared and not the effect. */
static void pin_settings(struct keys *keys, const struct scene *scene, const struct model *model)
{
    const struct key_group *group = model->settings;
    const char *settings = group ? scene_settings(scene, group->name) : NULL;
    char text[KEY_LENGTH];
    for (uint32_t k = 0; settings && k < group->count; k++) {
        const struct key *key = &group->keys[k];
        const double *value = (const double *)(settings + key->offset);
        if (key->type != KEY_REAL || !isfinite(*value)) continue;
        snprintf(text, sizeof text, "%s.%s=%.17g", group->name, key->name, *value);
        add_key(keys, text);
    }
    for (uint32_t k = 0; k < scene->species_count; k++) {
        if (!isfinite(scene->species[k].stiffness)) continue;
        snprintf(text, sizeof text, "grains.[%u].stiffness=%.17g", k, scene->species[k].stiffness);
        add_key(keys, text);
    }
}

/* ---- a form of the scene that runs --------------------------------------------------------- */

struct form {
    struct setup setup;
    struct simulation sim;
    double bytes, best;
    uint64_t budget;
};

static bool form_open(struct form *form, const struct setup_request *request, struct error *error)
{
    *form = (struct form){.best = INFINITY};
    if (!setup_load(&form->setup, request, error)) {
        const struct findings *findings = form->setup.findings;
        for (uint32_t k = 0; findings && k < findings->count && k < FINDINGS_MAX; k++) {
            if (findings->list[k].kind != FINDING_ERROR) continue;
            return error_set_code(error, EXIT_SCENE, "%s", findings->list[k].text);
        }
        return false;
    }
    const double before = heap_bytes();
    if (!simulation_create(&form->sim, form->setup.model, form->setup.scene, error)) return false;
    form->bytes = heap_bytes() - before;
    return true;
}

static void form_close(struct form *form)
{
    if (form->sim.state) simulation_destroy(&form->sim);
    setup_free(&form->setup);
}

/* Goes on for `budget` units of work; the processor seconds of each. */
static bool form_run(struct form *form, uint64_t budget, double *seconds, struct error *error)
{
    const double far = 1000 * form->setup.scene->until;
    const uint64_t before = simulation_count(&form->sim).steps;
    const double start = clock_process();
    if (simulation_advance(&form->sim, far, budget, error) == ADVANCE_BROKEN) return false;
    const double spent = clock_process() - start;
    const uint64_t steps = simulation_count(&form->sim).steps - before;
    *seconds = spent / fmax((double)steps, 1);
    return true;
}

/* Until the clock says so; finds the budget of a slice. */
static bool form_warm(struct form *form, double seconds_wanted, struct error *error)
{
    double spent = 0, one = 0;
    for (form->budget = 1; spent < seconds_wanted;) {
        if (!form_run(form, form->budget, &one, error)) return false;
        const double took = one * (double)form->budget;
        spent += took;
        if (took < slice_seconds) form->budget *= 2;
        if (form->budget > (uint64_t)1 << 40) break;
    }
    return true;
}

static bool form_copy(struct form *from, struct form *to, struct error *error)
{
    struct archive save, load;
    archive_begin_save(&save);
    bool done = simulation_save(&from->sim, &save, error);
    archive_begin_load(&load, save.bytes, save.size);
    done = done && simulation_load(&to->sim, &load, error);
    archive_end(&save);
    return done;
}

/* The least of several slices, by turns. */
static bool compare(struct form *a, struct form *b, struct error *error)
{
    const uint64_t budget = a->budget;
    for (int k = 0; k < REPEATS; k++) {
        double one, other;
        if (!form_run(a, budget, &one, error) || !form_run(b, budget, &other, error)) return false;
        if (k == 0) continue;           /* loading leaves lists to be made anew */
        a->best = fmin(a->best, one);
        b->best = fmin(b->best, other);
    }
    return true;
}

/* ---- an effect of a user's scene ------------------------------------------------------------ */

struct effects_probe {
    struct setup_request request;
    struct form with;
};

struct effects_probe *effects_open(const struct setup_request *request, struct error *error)
{
    struct effects_probe *probe = calloc(1, sizeof *probe);
    if (!probe) {
        error_set(error, "not enough memory");
        return NULL;
    }
    probe->request = *request;
    if (form_open(&probe->with, request, error) && form_warm(&probe->with, warm_seconds, error)) {
        return probe;
    }
    effects_close(probe);
    return NULL;
}

void effects_close(struct effects_probe *probe)
{
    if (!probe) return;
    form_close(&probe->with);
    free(probe);
}

/* Why the scene of `request` cannot be held against one without the effect, or NULL.  No grain is
 * placed to find that out. */
static const char *why_not(const struct setup_request *request, effects_t effect)
{
    struct setup_request bare = *request;
    struct setup setup;
    struct error error = {0};
    bare.place = false;
    const bool loaded = setup_load(&setup, &bare, &error);
    const bool still = loaded && setup.scene->effects & effect;
    setup_free(&setup);
    return !loaded ? "the scene does not run without it"
           : still ? "another effect calls for it too" : NULL;
}

static bool measure_against(struct effects_probe *probe, const struct setup_request *request,
                            struct effects_cost *cost, struct error *error)
{
    struct form *with = &probe->with, without = {0};
    bool done = form_open(&without, request, error) && form_copy(with, &without, error);
    with->best = INFINITY;
    done = done && compare(with, &without, error);
    if (done) {
        *cost = (struct effects_cost){.measured = true, .with = with->best,
            .without = without.best, .bytes = with->bytes - without.bytes};
    }
    form_close(&without);
    return done;
}

bool effects_measure(struct effects_probe *probe, effects_t effect, struct effects_cost *cost,
                     struct error *error)
{
    *cost = (struct effects_cost){0};
    const struct change *change = change_of(effect);
    if (!change || !change->out[0]) {
        snprintf(cost->why, sizeof cost->why, "part of the scene: without it nothing compares");
        return true;
    }
    struct keys *keys = calloc(1, sizeof *keys);
    if (!keys) return error_set(error, "not enough memory");
    struct setup_request other = probe->request;
    const struct setup *setup = &probe->with.setup;
    for (uint32_t k = 0; k < other.override_count; k++) add_key(keys, other.overrides[k]);
    pin_settings(keys, setup->scene, setup->model);
    add_all(keys, change->out, setup->scene->species_count);
    other.overrides = keys->list;
    other.override_count = keys->count;
    struct error reason = {0};
    const char *why = why_not(&other, effect);
    if (why || !measure_against(probe, &other, cost, &reason)) {
        snprintf(cost->why, sizeof cost->why, "%.180s", why ? why : reason.text);
    }
    free(keys);
    return true;
}

/* ---- each effect alone --------------------------------------------------------------------- */

static const char gas_text[] =
    "until = 1e3; box = (0.0, 0.0, 100.0, 100.0);\n"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";\n"
    "grains = ({ radius = 0.5; restitution = 1.0; stiffness = 1e4; });\n"
    "placements = ({ kind = \"square\"; spacing = 1.4; temperature = 1.0; });\n"
    "overlap_limit = 1.0; count_max = 5200;\n";

static bool bench_one(const struct model *model, const char *name, const struct keys *keys,
                      struct form *none, struct effects_row *row, struct error *error)
{
    struct form form;
    const struct setup_request request = {.path = "gas", .text = gas_text, .overrides = keys->list,
                                          .override_count = keys->count, .place = true};
    bool done = form_open(&form, &request, error) && form_warm(&form, warm_seconds, error);
    /* The gas with nothing on takes turns with it, so that both meet the same machine. */
    if (done && none) done = compare(&form, none, error);
    if (done) {
        *row = (struct effects_row){.model = model->name, .work = model->work,
            .effects = form.setup.scene->effects, .seconds = form.best,
            .share = none ? form.best / none->best : 1,
            .bytes = form.bytes / fmax((double)simulation_count(&form.sim).grains, 1)};
        snprintf(row->name, sizeof row->name, "%s", name);
    }
    form_close(&form);
    return done;
}

static void begin_keys(struct keys *keys, const struct model *model)
{
    char text[KEY_LENGTH];
    keys->count = 0;
    snprintf(text, sizeof text, "model=%s", model->name);
    add_key(keys, text);
}

/* The row of the kernel by hand tells its share of the model's time on the same gas. */
static bool tell_stripped(const struct model *model,
                          void (*tell)(void *context, const struct effects_row *row),
                          void *context, struct error *error)
{
    struct stripped_result result;
    const struct stripped_kernel *kernel = stripped_find(model->name);
    if (!kernel) return true;
    if (!stripped_measure(kernel, &result, error)) return false;
    const struct effects_row row = {.model = model->name, .work = model->work,
        .name = "by hand", .seconds = result.by_hand, .share = result.share,
        .bytes = result.by_hand_bytes};
    tell(context, &row);
    return true;
}

bool effects_bench(const struct model *model,
                   void (*tell)(void *context, const struct effects_row *row), void *context,
                   struct error *error)
{
    struct keys *keys = calloc(2, sizeof *keys), *all = keys ? keys + 1 : NULL;
    struct form none = {0};
    struct effects_row row;
    if (!keys) return error_set(error, "not enough memory");
    begin_keys(keys, model);
    begin_keys(all, model);
    const struct setup_request request = {.path = "gas", .text = gas_text, .overrides = keys->list,
                                          .override_count = keys->count, .place = true};
    /* One thread: others that wait for it would count as work. */
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    bool done = form_open(&none, &request, error) && form_warm(&none, warm_seconds, error)
        && bench_one(model, "none", keys, &none, &row, error);
    if (done) tell(context, &row);
    done = done && tell_stripped(model, tell, context, error);
    for (size_t k = 0; done && k < sizeof changes / sizeof *changes; k++) {
        const struct change *change = &changes[k];
        if (!change->in[0] || (change->effect & ~model->effects)) continue;
        begin_keys(keys, model);
        add_all(keys, change->in, 1);
        struct error reason = {0};
        none.best = INFINITY;
        done = bench_one(model, effect_word(change->effect), keys, &none, &row, &reason);
        if (!done) {
            *error = reason;
            break;
        }
        tell(context, &row);
        /* A sheared border is periodic, so it does not go together with walls. */
        if (change->effect != EFFECT_SHEAR) add_all(all, change->in, 1);
    }
    if (model->effects & EFFECT_MOVING_WALLS && model->effects & EFFECT_GATES) {
        add_key(all, "walls=({shape=\"segment\";points=((50,50),(60,50));surface_speed=1.0;},"
                     "{shape=\"segment\";points=((50,60),(60,60));opens=1e6;})");
    }
    none.best = INFINITY;
    done = done && bench_one(model, "all", all, &none, &row, error);
    if (done) tell(context, &row);
    omp_set_num_threads(threads);
    form_close(&none);
    free(keys);
    return done;
}
