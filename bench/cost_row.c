/* cost_row.c - see cost_row.h.
 *
 * A model may simulate several particles for a grain, or fewer than there are: counts are shares.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/cost_row.h"

#include "base/clock.h"
#include "measure/heap.h"
#include "measure/spectrum.h"
#include "measure/stats.h"
#include "run/look.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TIMES = COST_TIMES, ROW = COST_ROW, SIDE = COST_SIDE, PIECE = 2000 };

static const char *const names[] = {
#define X(name, measure, doc) #name,
    COST_OBSERVABLES(X)
#undef X
};

static const enum cost_measure measures[] = {
#define X(name, measure, doc) measure,
    COST_OBSERVABLES(X)
#undef X
};

const char *cost_row_name(enum cost_observable observable) { return names[observable]; }

enum cost_measure cost_row_measure(enum cost_observable observable)
{
    return measures[observable];
}

unsigned cost_row_chosen(const struct scene *scene, struct error *error)
{
    unsigned set = 0;
    for (uint32_t k = 0; k < scene->measure.cost.count; k++) {
        int o = 0;
        while (o < COST_COUNT && strcmp(names[o], scene->measure.cost.texts[k]) != 0) o++;
        if (o == COST_COUNT) {
            char all[200] = "";
            for (o = 0; o < COST_COUNT; o++) {
                snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", o ? ", " : "",
                         names[o]);
            }
            error_set_code(error, EXIT_SCENE, "measure.cost: '%.60s' is unknown; it must be one "
                           "of %s", scene->measure.cost.texts[k], all);
            return 0;
        }
        set |= 1u << o;
    }
    if (set) return set;
    const effects_t effects = scene_effects(scene);
    if (effects & EFFECT_OBSTACLE) set |= 1u << COST_force;
    if (effects & EFFECT_GATES) set |= 1u << COST_discharge;
    if (effects & EFFECT_GRAVITY) set |= 1u << COST_height;
    return set ? set : 1u << COST_energy;
}

/* ---- one look ------------------------------------------------------------------------------ */

struct gauge_run {
    const struct simulation *sim;
    unsigned observables;
    struct grains grains;
    struct cost_rows *rows;
    double gate;                /* how far down it is, along gravity; INFINITY: there is none */
    double base;                /* of a heap */
};

static double depth(const struct scene *scene, double x, double y)
{
    const double *g = scene->gravity, size = hypot(g[0], g[1]);
    return size > 0 ? (x * g[0] + y * g[1]) / size : 0;
}

/* The lowest gate, and the lowest wall on which a heap may stand. */
static void find_places(struct gauge_run *run, const struct scene *scene)
{
    run->gate = -INFINITY;
    run->base = scene->bottom == BORDER_WALL ? scene->box[1] : INFINITY;
    for (uint32_t k = 0; k < scene->wall_count; k++) {
        const struct wall *wall = &scene->walls[k];
        const bool disc = wall->shape == WALL_DISC;
        const double x = disc ? wall->cx : 0.5 * (wall->x0 + wall->x1);
        const double y = disc ? wall->cy : 0.5 * (wall->y0 + wall->y1);
        if (wall_is_gate(wall)) run->gate = fmax(run->gate, depth(scene, x, y));
        else run->base = fmin(run->base, y);
    }
    if (!isfinite(run->gate)) run->gate = INFINITY;
}

static void note_discharge(struct gauge_run *run, uint32_t k, double out, double all)
{
    const struct grains *grains = &run->grains;
    double passed = out;
    for (uint32_t i = 0; i < grains->count; i++) {
        passed += depth(run->sim->scene, grains->x[i], grains->y[i]) > run->gate;
    }
    run->rows->values[COST_discharge][k] = passed / all;
}

/* While a twentieth to nineteen twentieths have passed: the slope of the straight line. */
static void note_rate(struct cost_rows *rows, double until)
{
    double times[TIMES], shares[TIMES];
    size_t n = 0;
    for (uint32_t k = 0; k < TIMES; k++) {
        const double share = rows->values[COST_discharge][k];
        if (share < 0.05 || share > 0.95) continue;
        times[n] = until * (k + 1) / TIMES;
        shares[n++] = share;
    }
    const struct stats_line line = stats_line(times, shares, n);
    rows->values[COST_rate][0] = isfinite(line.slope) ? line.slope : 0;
}

static void note_density(struct gauge_run *run, double weight)
{
    const struct grains *grains = &run->grains;
    const double *box = run->sim->scene->box;
    for (uint32_t k = 0; k < grains->count; k++) {
        const double u = (grains->x[k] - box[0]) / (box[2] - box[0]) * SIDE;
        const double v = (grains->y[k] - box[1]) / (box[3] - box[1]) * SIDE;
        if (!(u >= 0 && u < SIDE && v >= 0 && v < SIDE)) continue;
        run->rows->values[COST_density][(int)v * SIDE + (int)u] += weight;
    }
}

static bool note_structure(struct gauge_run *run, struct error *error)
{
    const struct scene *scene = run->sim->scene;
    struct spectrum spectrum;
    if (!spectrum_structure_factor(&run->grains, scene->box, 2 * scene->radius_mean, &spectrum,
                                   error)) return false;
    for (uint32_t q = 1; q < spectrum.shells && q <= ROW; q++) {
        if (spectrum.modes[q] == 0) continue;
        run->rows->values[COST_structure][q - 1] += spectrum.shell[q] / (TIMES / 2);
    }
    spectrum_free(&spectrum);
    return true;
}

/* Minus, then plus what obstacles have been given: the mean between two looks. */
static void note_force(struct gauge_run *run, double weight)
{
    const struct tally *tally = simulation_tally(run->sim);
    double *row = run->rows->values[COST_force];
    for (uint32_t b = 0; tally && b < tally->body_count && 2 * b + 1 < ROW; b++) {
        row[2 * b] += weight * tally->bodies[b].impulse_x;
        row[2 * b + 1] += weight * tally->bodies[b].impulse_y;
    }
}

static bool note_slope(struct gauge_run *run, struct error *error)
{
    const struct scene *scene = run->sim->scene;
    const double *box = scene->box, width = box[2] - box[0];
    const double diameter = 2 * scene->radius_mean;
    const uint32_t bins = (uint32_t)fmin(fmax(width / diameter, 8), 4000);
    /* What falls has gone more than half a diameter freely. */
    const double falling = sqrt(hypot(scene->gravity[0], scene->gravity[1]) * diameter);
    struct heap heap;
    if (!heap_create(&run->grains, box[0], box[2], bins, run->base, falling, &heap, error)) {
        return false;
    }
    const struct heap_slope slope = heap_slope(&heap, 0.15, 0.85);
    run->rows->values[COST_slope][0] = isfinite(slope.slope) ? slope.slope : 0;
    heap_free(&heap);
    return true;
}

/* A model that takes steps stops within half a one of the end; the rest is flown. */
static void note_path(struct gauge_run *run, double rest)
{
    const struct grains *grains = &run->grains;
    double *row = run->rows->values[COST_path];
    const double diameter = 2 * run->sim->scene->radius_mean;
    for (uint32_t k = 0; k < grains->count; k++) {
        if (grains->id[k] >= ROW / 2) continue;
        row[2 * grains->id[k]] = (grains->x[k] + rest * grains->vx[k]) / diameter;
        row[2 * grains->id[k] + 1] = (grains->y[k] + rest * grains->vy[k]) / diameter;
    }
}

static bool note(struct gauge_run *run, uint32_t k, struct error *error)
{
    const struct counters now = simulation_count(run->sim);
    const double all = fmax((double)(now.grains + now.grains_out), 1);
    const double until = run->sim->scene->until;
    const unsigned set = run->observables;
    run->rows->values[COST_energy][k] = now.kinetic_energy;
    run->rows->values[COST_collisions][k] = (double)now.collisions / all;
    run->rows->values[COST_height][k] = now.potential_energy;
    if (k == TIMES / 2 - 1) note_force(run, -2 / until);
    if (k == TIMES - 1) note_force(run, 2 / until);
    if (!look_at(run->sim, &run->grains, false, error)) return false;
    note_discharge(run, k, (double)now.grains_out, all);
    if (k >= TIMES / 2) {
        note_density(run, 2 / all / TIMES);
        if (set >> COST_structure & 1 && !note_structure(run, error)) return false;
    }
    if (k + 1 < TIMES) return true;
    note_rate(run->rows, until);
    note_path(run, until - now.time);
    return !(set >> COST_slope & 1) || note_slope(run, error);
}

/* ---- one run ------------------------------------------------------------------------------- */

/* Is it clear, after an eighth of the time allowed, that it will take more than twice of it?  Runs
 * are slower at their densest than in the mean, hence twice. */
static bool hopeless(double spent, double seconds, double share)
{
    return spent > seconds || (spent > seconds / 8 && spent > 2 * seconds * share);
}

bool cost_row_run(const struct model *model, const struct scene *scene, unsigned observables,
                  double seconds, struct cost_rows *rows, struct error *error)
{
    struct simulation sim = {0};
    struct gauge_run run = {.sim = &sim, .observables = observables, .rows = rows};
    bool done = simulation_create(&sim, model, scene, error);
    *rows = (struct cost_rows){0};
    find_places(&run, scene);
    for (uint32_t k = 0; done && k < TIMES; k++) {
        const double t = scene->until * (k + 1) / TIMES;
        for (enum advance outcome = ADVANCE_BUDGET; done && outcome != ADVANCE_REACHED;) {
            const double start = clock_wall(), start_cpu = clock_process();
            outcome = simulation_advance(&sim, t, PIECE, error);
            rows->wall += clock_wall() - start;
            rows->cpu += clock_process() - start_cpu;
            /* What other programs take of a busy machine is not the model's. */
            const double spent = fmin(rows->wall, rows->cpu);
            const double share = simulation_count(&sim).time / scene->until;
            done = outcome != ADVANCE_BROKEN;
            if (outcome == ADVANCE_BUDGET && hopeless(spent, seconds, share)) {
                done = error_set(error, "takes longer than %g s, about %.2g s", seconds,
                                 spent / fmax(share, 1e-3));
            }
        }
        done = done && note(&run, k, error);
    }
    grains_free(&run.grains);
    if (sim.state) simulation_destroy(&sim);
    return done;
}
