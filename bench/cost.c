/* cost.c - see cost.h.
 *
 * The reference is hard discs where contacts are short encounters, and soft discs with half the
 * time step where grains rest on each other or friction remembers: there hard discs are the
 * approximation.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/cost.h"

#include "base/clock.h"
#include "model/simulation.h"
#include "run/look.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TIMES = 16, SIDE = 6, ROW = SIDE * SIDE, PIECE = 5000 };

static const char *const names[] = {
#define X(name, doc) #name,
    COST_OBSERVABLES(X)
#undef X
};

const char *cost_name(enum cost_observable observable) { return names[observable]; }

/* All observables of one run. */
struct rows { double values[COST_COUNT][ROW]; };

/* Mean over the seeds and variance of that mean. */
struct mean { double mean[COST_COUNT][ROW], variance[COST_COUNT][ROW]; };

/* ---- one run ------------------------------------------------------------------------------- */

static double obstacle_momentum(const struct simulation *sim)
{
    const struct tally *tally = simulation_tally(sim);
    double x = 0, y = 0;
    for (uint32_t b = 0; tally && b < tally->body_count; b++) {
        x += tally->bodies[b].impulse_x;
        y += tally->bodies[b].impulse_y;
    }
    return hypot(x, y);
}

static void note_density(const struct scene *scene, const struct grains *grains, double weight,
                         double row[ROW])
{
    const double *box = scene->box;
    for (uint32_t k = 0; k < grains->count; k++) {
        const double u = (grains->x[k] - box[0]) / (box[2] - box[0]) * SIDE;
        const double v = (grains->y[k] - box[1]) / (box[3] - box[1]) * SIDE;
        if (!(u >= 0 && u < SIDE && v >= 0 && v < SIDE)) continue;
        row[(int)v * SIDE + (int)u] += weight;
    }
}

static bool note(struct rows *rows, const struct simulation *sim, uint32_t k,
                 struct grains *grains, struct error *error)
{
    const struct counters now = simulation_count(sim);
    /* A model may simulate several particles for a grain: counts are shares of all. */
    const double all = fmax((double)(now.grains + now.grains_out), 1);
    rows->values[COST_energy][k] = now.kinetic_energy;
    rows->values[COST_collisions][k] = (double)now.collisions / all;
    rows->values[COST_discharge][k] = (double)now.grains / all;
    rows->values[COST_height][k] = now.potential_energy;
    rows->values[COST_force][k] = obstacle_momentum(sim);
    if (k < TIMES / 2) return true;
    if (!look_at(sim, grains, false, error)) return false;
    note_density(sim->scene, grains, 1 / all, rows->values[COST_density]);
    return true;
}

/* Runs to the end; the wall seconds of the model alone. */
static bool run_once(const struct setup *setup, double seconds, struct rows *rows, double *wall,
                     struct error *error)
{
    struct simulation sim = {0};
    struct grains grains = {0};
    const double until = setup->scene->until;
    bool done = simulation_create(&sim, setup->model, setup->scene, error);
    *wall = 0;
    *rows = (struct rows){0};
    for (uint32_t k = 0; done && k < TIMES; k++) {
        const double t = until * (k + 1) / TIMES, start = clock_wall();
        enum advance outcome;
        do {
            outcome = simulation_advance(&sim, t, PIECE, error);
        } while (outcome == ADVANCE_BUDGET && *wall + clock_wall() - start < seconds);
        *wall += clock_wall() - start;
        done = outcome == ADVANCE_REACHED;
        if (outcome == ADVANCE_BUDGET) error_set(error, "takes longer than %g s", seconds);
        done = done && note(rows, &sim, k, &grains, error);
    }
    grains_free(&grains);
    if (sim.state) simulation_destroy(&sim);
    return done;
}

/* ---- one setting --------------------------------------------------------------------------- */

static bool load(struct setup *setup, const struct cost_request *request,
                 const struct cost_point *point, uint32_t seed, struct error *error)
{
    const char *overrides[300];
    char seed_text[40];
    uint32_t count = 0;
    assert(request->override_count + point->key_count + 1 < 300);
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

static void average(const struct rows *rows, uint32_t seeds, struct mean *mean)
{
    *mean = (struct mean){0};
    for (int o = 0; o < COST_COUNT; o++) {
        for (int k = 0; k < ROW; k++) {
            double sum = 0, squares = 0;
            for (uint32_t s = 0; s < seeds; s++) sum += rows[s].values[o][k];
            const double middle = sum / seeds;
            for (uint32_t s = 0; s < seeds; s++) {
                const double off = rows[s].values[o][k] - middle;
                squares += off * off;
            }
            mean->mean[o][k] = middle;
            mean->variance[o][k] = seeds > 1 ? squares / (seeds - 1) / seeds : 0;
        }
    }
}

/* All seeds of a setting. */
static bool run_setting(const struct cost_request *request, struct cost_point *point,
                        struct mean *mean, struct error *error)
{
    struct rows *rows = calloc(request->seeds, sizeof *rows);
    if (!rows) return error_set(error, "not enough memory");
    bool done = true;
    point->wall = INFINITY;
    for (uint32_t s = 0; done && s < request->seeds; s++) {
        struct setup setup;
        double wall = 0;
        done = load(&setup, request, point, s + 1, error)
            && run_once(&setup, request->seconds, &rows[s], &wall, error);
        point->wall = fmin(point->wall, wall);
        setup_free(&setup);
    }
    if (done) average(rows, request->seeds, mean);
    free(rows);
    point->ran = done;
    return done;
}

/* ---- errors -------------------------------------------------------------------------------- */

static void compare(const struct cost_table *table, const struct mean *mean,
                    const struct mean *reference, struct cost_point *point)
{
    for (int o = 0; o < COST_COUNT; o++) {
        double off2 = 0, scale2 = 0, noise2 = 0;
        point->errors[o] = point->noise[o] = NAN;
        if (!(table->observables >> o & 1)) continue;
        for (int k = 0; k < ROW; k++) {
            const double off = mean->mean[o][k] - reference->mean[o][k];
            off2 += off * off;
            scale2 += reference->mean[o][k] * reference->mean[o][k];
            noise2 += mean->variance[o][k] + reference->variance[o][k];
        }
        if (!(scale2 > 0)) continue;
        point->errors[o] = sqrt(off2 / scale2);
        point->noise[o] = sqrt(noise2 / scale2);
        if (point->errors[o] < point->error) continue;
        point->error = point->errors[o];
        point->error_noise = point->noise[o];
    }
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

/* ---- the whole ----------------------------------------------------------------------------- */

static unsigned suitable(const struct scene *scene, struct error *error)
{
    unsigned set = 0;
    for (uint32_t k = 0; k < scene->measure.cost.count; k++) {
        int o = 0;
        while (o < COST_COUNT && strcmp(names[o], scene->measure.cost.texts[k]) != 0) o++;
        if (o == COST_COUNT) {
            error_set_code(error, EXIT_SCENE, "measure.cost: '%.60s' is unknown; it must be one of "
                "energy, collisions, discharge, height, force, density",
                scene->measure.cost.texts[k]);
            return 0;
        }
        set |= 1u << o;
    }
    if (set) return set;
    const effects_t effects = scene->effects;
    if (effects & EFFECT_OBSTACLE) set |= 1u << COST_force;
    if (effects & (EFFECT_OUTFLOW | EFFECT_INFLOW)) set |= 1u << COST_discharge;
    if (effects & EFFECT_GRAVITY) set |= 1u << COST_height;
    else set |= 1u << COST_energy;
    return set;
}

/* A model as it chooses itself, for what factors refer to. */
static bool load_plain(struct setup *setup, const struct cost_request *request, const char *model,
                       struct error *error)
{
    struct cost_point plain = {.key_count = 1};
    snprintf(plain.keys[0], COST_KEY, "model=%s", model);
    return load(setup, request, &plain, 0, error);
}

static bool begin(const struct cost_request *request, struct cost_table *table,
                  struct cost_point *reference, struct error *error)
{
    static const struct cost_setting hard = {"ed", ""}, soft = {"md", "md.dt=*0.5"};
    struct setup setup;
    struct cost_point none = {0};
    bool done = load(&setup, request, &none, 0, error);
    if (done) {
        const struct scene *scene = setup.scene;
        snprintf(table->scene, sizeof table->scene, "%.60s", scene->name);
        table->quick = scene->quick;
        table->seeds = request->seeds;
        table->observables = suitable(scene, error);
        const bool rests = scene->effects & (EFFECT_GRAVITY | EFFECT_FRICTION)
                        && scene->effects & EFFECT_DISSIPATION;
        const struct cost_setting *first = rests ? &soft : &hard;
        setup_free(&setup);
        done = table->observables != 0 && load_plain(&setup, request, first->model, error)
            && cost_keys(first, &setup, reference);
    }
    setup_free(&setup);
    snprintf(table->reference, sizeof table->reference, "%s", reference->label);
    return done;
}

static void try_setting(const struct cost_request *request, const struct cost_setting *setting,
                        const struct mean *reference, struct cost_table *table)
{
    struct cost_point *point = &table->points[table->count];
    struct error error = {0};
    struct setup setup;
    struct mean *mean = calloc(1, sizeof *mean);
    *point = (struct cost_point){0};
    const bool able = mean && load_plain(&setup, request, setting->model, &error);
    const bool known = able && cost_keys(setting, &setup, point);
    if (mean) setup_free(&setup);
    if (known) {
        if (run_setting(request, point, mean, &error)) compare(table, mean, reference, point);
        else snprintf(point->why, sizeof point->why, "%.190s", error.text);
    } else {
        snprintf(point->label, sizeof point->label, "%s %s", setting->model, setting->keys);
        snprintf(point->why, sizeof point->why, "%.190s", able ? "not chosen here" : error.text);
    }
    free(mean);
    if (request->report) request->report(request->context, point);
    table->count++;
}

bool cost_measure(const struct cost_request *request, struct cost_table *table,
                  struct error *error)
{
    *table = (struct cost_table){0};
    assert(request->seeds > 0 && request->seeds <= COST_SEEDS_MAX);
    struct cost_point *first = &table->points[0];
    struct mean *reference = calloc(1, sizeof *reference);
    if (!reference) return error_set(error, "not enough memory");
    bool done = begin(request, table, first, error);
    if (done) {
        struct cost_request more = *request;
        more.seconds *= 4;              /* the reference may take its time */
        done = run_setting(&more, first, reference, error);
        first->reference = true;
        compare(table, reference, reference, first);
        table->count = 1;
        if (done && request->report) request->report(request->context, first);
    }
    for (const struct cost_setting *s = cost_settings; done && s->model; s++) {
        char label[COST_KEY];
        snprintf(label, sizeof label, "%s%s%s", s->model, s->keys[0] ? " " : "", s->keys);
        if (strcmp(label, first->label) == 0) continue;
        if (table->count < COST_POINTS_MAX) try_setting(request, s, reference, table);
    }
    if (done) find_front(table);
    free(reference);
    return done;
}
