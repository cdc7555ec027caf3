/* cost.c - see cost.h.
 *
 * The reference is what the scene names.  Else: hard discs where contacts are short encounters,
 * soft discs with half the time step where grains rest on each other or friction remembers, for
 * there hard discs are the approximation.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/cost.h"

#include "bench/cost_cache.h"
#include "bench/cost_settings.h"
#include "measure/stats.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROW = COST_ROW, OVERRIDES_MAX = 300 };

/* The runs of all seeds of a setting. */
struct runs { struct cost_rows seeds[COST_SEEDS_MAX]; };

/* ---- one setting --------------------------------------------------------------------------- */

static bool load(struct setup *setup, const struct cost_request *request,
                 const struct cost_point *point, uint32_t seed, struct error *error)
{
    const char *overrides[OVERRIDES_MAX];
    char seed_text[40];
    uint32_t count = 0;
    assert(request->override_count + point->key_count + 1 < OVERRIDES_MAX);
    for (uint32_t k = 0; k < request->override_count; k++) {
        overrides[count++] = request->overrides[k];
    }
    for (uint32_t k = 0; k < point->key_count; k++) overrides[count++] = point->keys[k];
    if (seed > 0) {
        snprintf(seed_text, sizeof seed_text, "seed=%u", seed);
        overrides[count++] = seed_text;
    }
    const struct setup_request wanted = {.path = request->path, .overrides = overrides,
                                         .override_count = count, .place = true};
    if (setup_load(setup, &wanted, error)) return true;
    const struct findings *findings = setup->findings;
    for (uint32_t k = 0; findings && k < findings->count && k < FINDINGS_MAX; k++) {
        if (findings->list[k].kind != FINDING_ERROR) continue;
        return error_set_code(error, EXIT_SCENE, "%s", findings->list[k].text);
    }
    return false;
}

/* A cheap setting is run often, so that its error comes out of its noise; a dear one three times:
 * the scatter of two is too often small by chance. */
enum { SEEDS_LEAST = 3 };
static const double share_of_seeds = 0.25;      /* of the seconds that one run may take */

static bool enough(const struct cost_request *request, uint32_t seeds, uint32_t most, double spent)
{
    if (request->seeds > 0) return seeds == request->seeds;
    return seeds == most
        || (seeds >= SEEDS_LEAST && spent >= share_of_seeds * request->seconds);
}

/* Only the reference is kept: of all others the wall time is what is asked for. */
static bool run_setting(const struct cost_request *request, unsigned observables, uint32_t most,
                        struct cost_point *point, struct runs *runs, struct error *error)
{
    const char *cache = point->reference ? request->cache : NULL;
    bool done = true;
    double spent = 0;
    point->wall = point->cpu = INFINITY;
    point->cached = true;
    for (uint32_t s = 0; done && !enough(request, s, most, spent); s++) {
        struct setup setup;
        struct cost_rows *rows = &runs->seeds[s];
        done = load(&setup, request, point, s + 1, error);
        const bool known = done && cost_cache_load(cache, setup.scene, observables, rows);
        if (done && !known) {
            point->cached = false;
            done = cost_row_run(setup.model, setup.scene, observables, request->seconds, rows,
                                error);
            if (done) cost_cache_save(cache, setup.scene, observables, rows);
        }
        if (done) {
            point->wall = fmin(point->wall, rows->wall);
            point->cpu = fmin(point->cpu, rows->cpu);
            point->seeds = s + 1;
            spent += fmin(rows->wall, rows->cpu);
            point->step = cost_settings_step(&setup);
        }
        setup_free(&setup);
    }
    point->ran = done;
    return done;
}

/* ---- errors -------------------------------------------------------------------------------- */

static double mean_of(const struct runs *runs, uint32_t seeds, int o, int k)
{
    double sum = 0;
    for (uint32_t s = 0; s < seeds; s++) sum += runs->seeds[s].values[o][k];
    return sum / seeds;
}

/* What a squared difference in each number of a row is divided by; 0: the number does not count. */
static bool weigh(const struct runs *reference, uint32_t seeds, int o, double weights[ROW])
{
    double squares = 0;
    uint32_t count = 0;
    for (int k = 0; k < ROW; k++) {
        const double mean = mean_of(reference, seeds, o, k);
        squares += mean * mean;
        count += mean != 0;
        weights[k] = mean * mean;
    }
    if (!(squares > 0)) return false;
    for (int k = 0; k < ROW; k++) {
        if (weights[k] == 0 && cost_row_measure((enum cost_observable)o) != COST_OF_ALL) continue;
        switch (cost_row_measure((enum cost_observable)o)) {
        case COST_OF_EACH:   weights[k] = 1 / (weights[k] * count); break;
        case COST_OF_ALL:    weights[k] = 1 / squares; break;
        case COST_OF_LENGTH: weights[k] = 2.0 / count; break;   /* a way has two components */
        }
    }
    return true;
}

/* The scatter of a few seeds is often small by chance.  An error bar that holds the truth twice in
 * three times is wider than one of many seeds by this factor: Student's t at 68 %, to 2 %. */
static double few_seeds(uint32_t seeds)
{
    const double freedom = seeds - 1;
    return 1 + 0.5 / freedom + 0.34 / (freedom * freedom);
}

/* Ways have no sign that could cancel: their lengths are averaged over the seeds. */
static void compare_ways(const struct runs *runs, const struct runs *reference, uint32_t seeds,
                         int o, const double weights[ROW], struct cost_point *point)
{
    double sum = 0, squares = 0;
    for (uint32_t s = 0; s < seeds; s++) {
        double off2 = 0;
        for (int k = 0; k < ROW; k++) {
            const double off = runs->seeds[s].values[o][k] - reference->seeds[s].values[o][k];
            off2 += weights[k] * off * off;
        }
        sum += sqrt(off2);
        squares += off2;
    }
    point->errors[o] = sum / seeds;
    point->noise[o] = few_seeds(seeds)
        * sqrt(fmax(squares / seeds - sum * sum / seeds / seeds, 0) / (seeds - 1));
}

/* Seed by seed: both runs of a seed begin with the same grains, and what this does to them both
 * is no error.  The reference itself is compared with the mean of its seeds. */
static void compare_row(const struct runs *runs, const struct runs *reference, uint32_t known,
                        int o, struct cost_point *point)
{
    const uint32_t seeds = point->seeds;
    double weights[ROW], off2 = 0, noise2 = 0;
    if (!weigh(reference, known, o, weights)) return;
    if (cost_row_measure((enum cost_observable)o) == COST_OF_LENGTH) {
        compare_ways(runs, reference, seeds, o, weights, point);
        return;
    }
    for (int k = 0; k < ROW; k++) {
        const double middle = runs == reference ? mean_of(reference, seeds, o, k) : 0;
        double sum = 0, squares = 0;
        for (uint32_t s = 0; s < seeds; s++) {
            const double there = runs == reference ? middle : reference->seeds[s].values[o][k];
            const double off = runs->seeds[s].values[o][k] - there;
            sum += off;
            squares += off * off;
        }
        const double mean = sum / seeds;
        off2 += weights[k] * mean * mean;
        noise2 += weights[k] * fmax(squares / seeds - mean * mean, 0) / (seeds - 1);
    }
    point->errors[o] = runs == reference ? 0 : sqrt(off2);
    point->noise[o] = few_seeds(seeds) * sqrt(noise2);
}

static void compare(const struct cost_table *table, const struct runs *runs,
                    const struct runs *reference, struct cost_point *point)
{
    bool first = true;
    for (int o = 0; o < COST_COUNT; o++) {
        point->errors[o] = point->noise[o] = NAN;
        if (!(table->observables >> o & 1)) continue;
        compare_row(runs, reference, table->seeds, o, point);
        if (isnan(point->errors[o])) continue;
        if (!first && point->errors[o] < point->error) continue;
        if (!first && point->errors[o] == point->error
            && point->noise[o] <= point->error_noise) continue;
        first = false;
        point->error = point->errors[o];
        point->error_noise = point->noise[o];
    }
    if (!first) return;
    point->ran = false;
    snprintf(point->why, sizeof point->why, "nothing to compare: what is measured stays zero");
}

/* Errors within their noise are no better than their noise. */
static double told_error(const struct cost_point *point)
{
    return fmax(point->error, point->error_noise);
}

static void find_front(struct cost_table *table)
{
    for (uint32_t a = 0; a < table->count; a++) {
        struct cost_point *point = &table->points[a];
        point->front = point->ran;
        for (uint32_t b = 0; b < table->count && point->front; b++) {
            const struct cost_point *other = &table->points[b];
            if (b == a || !other->ran) continue;
            if (other->wall < point->wall && told_error(other) <= told_error(point)) {
                point->front = false;
            }
        }
    }
}

const struct cost_point *cost_fastest(const struct cost_table *table, double accuracy)
{
    const struct cost_point *best = NULL;
    for (uint32_t k = 0; k < table->count; k++) {
        const struct cost_point *point = &table->points[k];
        if (!point->ran || told_error(point) > accuracy) continue;
        if (!best || point->wall < best->wall) best = point;
    }
    return best;
}

/* ---- the order of convergence -------------------------------------------------------------- */

/* A setting that changes nothing but the step (and what else the family's words say). */
static bool of_family(const struct cost_point *point, const char *model, const char *word)
{
    char rest[COST_KEY];
    const size_t length = strlen(model);
    if (strncmp(point->label, model, length) != 0 || !point->ran || point->reference) return false;
    if (*word ? !strstr(point->label, word) : strstr(point->label, "integrator") != NULL) {
        return false;
    }
    snprintf(rest, sizeof rest, "%s", point->label + length);
    char *save = NULL;
    for (char *key = strtok_r(rest, " ", &save); key; key = strtok_r(NULL, " ", &save)) {
        if (strncmp(key, "md.dt=", 6) != 0 && (!*word || strcmp(key, word) != 0)) return false;
    }
    return true;
}

/* Points that stand out of their noise by three of it, and whose error is still small. */
static void find_order(struct cost_table *table, const char *word, const char *label)
{
    double x[COST_POINTS_MAX] = {0}, y[COST_POINTS_MAX] = {0};
    uint32_t n = 0;
    for (uint32_t k = 0; k < table->count; k++) {
        const struct cost_point *point = &table->points[k];
        const bool clear = point->error > 3 * point->error_noise && point->error < 0.3;
        if (!of_family(point, "md", word) || !clear || !(point->step > 0)) continue;
        x[n] = log(point->step);
        y[n++] = log(point->error);
    }
    const struct stats_line line = stats_line(x, y, n);
    if (n < 3 || !isfinite(line.slope)) return;
    struct cost_order *order = &table->orders[table->order_count++];
    *order = (struct cost_order){.points = n, .power = line.slope,
                                 .power_error = line.slope_error};
    snprintf(order->label, sizeof order->label, "%s", label);
}

/* ---- the whole ----------------------------------------------------------------------------- */

/* The setting as keys, from what its model chooses itself. */
static bool prepare(const struct cost_request *request, const char *setting,
                    struct cost_point *point, struct error *error)
{
    struct cost_point plain = {.key_count = 1};
    struct setup setup;
    char name[40];
    snprintf(plain.keys[0], COST_KEY, "model=%s", cost_settings_model(setting, name, sizeof name));
    snprintf(point->label, sizeof point->label, "%s", setting);
    bool done = load(&setup, request, &plain, 0, error);
    if (done && !cost_settings_keys(setting, &setup, point)) {
        done = error_set_code(error, EXIT_SCENE, "not chosen here");
    }
    setup_free(&setup);
    return done;
}

/* Reads the scene and what it says about its comparison; the settings are given to the caller. */
static bool begin(const struct cost_request *request, struct cost_table *table,
                  struct setup *setup, struct error *error)
{
    const struct cost_point none = {0};
    if (!load(setup, request, &none, 0, error)) return false;
    const struct scene *scene = setup->scene;
    const effects_t effects = scene_effects(scene);
    const bool rests = effects & (EFFECT_GRAVITY | EFFECT_FRICTION)
                    && effects & EFFECT_DISSIPATION;
    snprintf(table->scene, sizeof table->scene, "%.60s", scene->name);
    snprintf(table->reference, sizeof table->reference, "%.100s",
             scene->measure.reference[0] ? scene->measure.reference
             : rests ? "md md.dt=*0.5" : "ed ed.t_c=*0.1");
    table->quick = scene->quick;
    table->hash = cost_cache_hash(request->path, request->overrides, request->override_count);
    table->observables = cost_row_chosen(scene, error);
    return table->observables != 0;
}

/* Unless the scene has named one, the most exact model that can run it is taken. */
static bool run_reference(const struct cost_request *request, struct cost_table *table, bool named,
                          struct runs *reference, struct error *error)
{
    static const char *const fallbacks[] = {"ed", "md md.dt=*0.5", "dsmc", "lga"};
    struct cost_point *point = &table->points[table->count++];
    struct cost_request more = *request;
    more.seconds *= 8;                  /* the reference may take its time */
    bool done = prepare(request, table->reference, point, error);
    for (size_t k = 0; !done && !named && k < sizeof fallbacks / sizeof *fallbacks; k++) {
        struct error ignored;
        snprintf(table->reference, sizeof table->reference, "%s", fallbacks[k]);
        done = prepare(request, fallbacks[k], point, &ignored);
    }
    if (!done) return false;
    point->reference = true;
    if (!run_setting(&more, table->observables, COST_SEEDS_MAX, point, reference, error)) {
        return false;
    }
    table->seeds = point->seeds;
    compare(table, reference, reference, point);
    if (request->report) request->report(request->context, point);
    return point->ran || error_set(error, "%s: %s", table->scene, point->why);
}

static void try_setting(const struct cost_request *request, const char *setting,
                        const struct runs *reference, struct runs *runs, struct cost_table *table)
{
    struct error error = {0};
    if (table->count == COST_POINTS_MAX || strcmp(setting, table->reference) == 0) return;
    struct cost_point *point = &table->points[table->count++];
    if (prepare(request, setting, point, &error)
        && run_setting(request, table->observables, table->seeds, point, runs, &error)) {
        compare(table, runs, reference, point);
    } else {
        snprintf(point->why, sizeof point->why, "%.190s", error.text);
    }
    if (request->report) request->report(request->context, point);
}

bool cost_measure(const struct cost_request *request, struct cost_table *table,
                  struct error *error)
{
    *table = (struct cost_table){0};
    assert(request->seeds != 1);
    assert(request->seeds <= COST_SEEDS_MAX);
    struct setup setup = {0};
    struct runs *both = calloc(2, sizeof *both), *reference = both, *runs = both + 1;
    if (!both) return error_set(error, "not enough memory");
    bool done = begin(request, table, &setup, error)
        && run_reference(request, table, setup.scene->measure.reference[0] != 0, reference, error);
    if (done) {
        const struct key_texts *own = &setup.scene->measure.settings;
        for (uint32_t k = 0; k < own->count; k++) {
            try_setting(request, own->texts[k], reference, runs, table);
        }
        for (uint32_t k = 0; own->count == 0 && cost_settings_list[k]; k++) {
            try_setting(request, cost_settings_list[k], reference, runs, table);
        }
        find_front(table);
        find_order(table, "", "md, verlet");
        find_order(table, "md.integrator=gear", "md, gear");
    }
    setup_free(&setup);
    free(both);
    return done;
}
