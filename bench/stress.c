/* stress.c - see stress.h.
 *
 * A run advances in small pieces of work, so that a model that hangs is noticed by the clock; what
 * it does between two looks never changes its state (model.h).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/stress.h"

#include "base/asset.h"
#include "base/clock.h"
#include "bench/stress_look.h"
#include "run/setup.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char folder[] = "scenes/hard/";

static const char *const names[] = {
#define X(name, doc) #name,
    STRESS_CHECKS(X)
#undef X
};

static const char *const docs[] = {
#define X(name, doc) doc,
    STRESS_CHECKS(X)
#undef X
};

const char *stress_check_name(enum stress_check check) { return names[check]; }
const char *stress_check_doc(enum stress_check check) { return docs[check]; }

const char *stress_name(uint32_t index, char *name, size_t size)
{
    for (const struct asset *asset = asset_list; asset->name; asset++) {
        if (strncmp(asset->name, folder, strlen(folder)) != 0 || index-- > 0) continue;
        const char *plain = asset->name + strlen("scenes/");
        snprintf(name, size, "%.*s", (int)(strlen(plain) - strlen(".cfg")), plain);
        return name;
    }
    return NULL;
}

double stress_strain(const struct stress_value *value)
{
    if (!value->asked) return 0;
    if (isnan(value->worst)) return INFINITY;
    double strain = 0;
    if (value->worst > 0 && !isnan(value->high)) strain = value->worst / value->high;
    /* Below a lower limit it fails; above, the limit says nothing about how near it is. */
    if (!isnan(value->low) && value->worst < value->low) strain = INFINITY;
    return strain;
}

/* ---- the run that is asked for ------------------------------------------------------------- */

enum { OVERRIDES_MAX = 40 };

struct try {
    struct stress_result *result;
    struct setup setup;
    struct simulation sim;
    struct stress_look look;
    char words[STRESS_RUN_MAX], model[STRESS_RUN_MAX];
    const char *overrides[OVERRIDES_MAX];
    uint32_t override_count;
    double start, start_cpu;
    struct error *error;
};

/* "md md.dt=1e-4" as overrides: the model, then the keys. */
static void split(struct try *try, const char *text)
{
    snprintf(try->words, sizeof try->words, "%s", text);
    char *save = NULL;
    for (char *word = strtok_r(try->words, " ", &save); word; word = strtok_r(NULL, " ", &save)) {
        if (try->override_count == 0) {
            snprintf(try->model, sizeof try->model, "model=%.200s", word);
            word = try->model;
        }
        if (try->override_count < OVERRIDES_MAX) try->overrides[try->override_count++] = word;
    }
}

/* The scene's own words, before any model is asked; NULL with an error. */
static struct scene *read_case(const char *scene, struct error *error)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = scene, .groups = groups,
                                          .group_count = model_settings(groups)};
    struct findings *findings = calloc(1, sizeof *findings);
    if (!findings) return NULL;
    struct scene *read = scene_load(&request, findings);
    char line[800];
    if (!read) {
        error_set_code(error, EXIT_SCENE, "%s", findings_line(&findings->list[0], line,
                                                              sizeof line));
    } else if (read->stress.models.count == 0) {
        error_set_code(error, EXIT_USAGE, "%s: not a hard case: its group `stress` names no models",
                       scene);
        scene_free(read);
        read = NULL;
    }
    free(findings);
    return read;
}

uint32_t stress_runs(const char *scene, bool *slow, struct error *error)
{
    struct scene *read = read_case(scene, error);
    if (!read) return 0;
    const uint32_t count = read->stress.models.count;
    *slow = read->stress.slow;
    scene_free(read);
    return count;
}

/* ---- checks -------------------------------------------------------------------------------- */

static bool fail(struct try *try, enum stress_check check, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool fail(struct try *try, enum stress_check check, const char *format, ...)
{
    struct stress_result *result = try->result;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(result->why, sizeof result->why, format, arguments);
    va_end(arguments);
    result->passed = false;
    result->tightest = check;
    return false;
}

static void ask(struct stress_result *result, enum stress_check check, double low, double high)
{
    if (isnan(low) && isnan(high)) return;
    result->values[check] = (struct stress_value){.asked = true, .low = low, .high = high,
                                                  .worst = isnan(high) ? INFINITY : 0};
}

static void ask_all(struct stress_result *result, const struct ordeal *stress)
{
    const double none = NAN;
    /* Grains are whole; half of one is less than the least that can be missing. */
    if (stress->mass) ask(result, STRESS_CHECK_mass, none, 0);
    ask(result, STRESS_CHECK_inside, none, isfinite(stress->within[0]) ? 0 : 1);
    ask(result, STRESS_CHECK_momentum, none, stress->momentum);
    ask(result, STRESS_CHECK_rises, none, stress->energy_rises);
    ask(result, STRESS_CHECK_keeps, none, stress->energy_changes);
    ask(result, STRESS_CHECK_overlap, none, stress->overlap);
    ask(result, STRESS_CHECK_grains, stress->grains[0], stress->grains[1]);
    ask(result, STRESS_CHECK_left, stress->energy_left[0], stress->energy_left[1]);
    ask(result, STRESS_CHECK_travel, stress->travel[0], stress->travel[1]);
    ask(result, STRESS_CHECK_collides, stress->collisions > 0 ? stress->collisions : none, none);
    ask(result, STRESS_CHECK_work, none, stress->work);
    ask(result, STRESS_CHECK_positions, none, stress->positions);
    ask(result, STRESS_CHECK_energies, none, stress->energies);
    ask(result, STRESS_CHECK_ends, none, 0);
}

/* Notes the value if it is asked for; false and a sentence if it is out of its limits. */
static bool judge(struct try *try, enum stress_check check, double number,
                  const struct stress_blame *blame)
{
    struct stress_value *value = &try->result->values[check];
    if (!value->asked) return true;
    const bool lower = isnan(value->high);
    if (lower || !(number <= value->worst)) value->worst = number;
    if (number <= value->high || lower) {
        if (isnan(value->low) || number >= value->low) return true;
    }
    const bool low = !isnan(value->low) && number < value->low;
    char who[160] = "";
    if (blame && blame->with[0]) {
        snprintf(who, sizeof who, "; grain %u at (%.7g, %.7g) and %s", blame->grain, blame->x,
                 blame->y, blame->with);
    } else if (blame) {
        snprintf(who, sizeof who, "; grain %u at (%.7g, %.7g)%s", blame->grain, blame->x, blame->y,
                 check == STRESS_CHECK_inside ? "" : " is the fastest");
    }
    return fail(try, check, "t = %.6g: %s: %.4g, %s %.4g%s", try->look.counters.time, docs[check],
                number, low ? "at least" : "at most", low ? value->low : value->high, who);
}

static bool judge_look(struct try *try)
{
    struct stress_look *look = &try->look;
    if (!stress_look_take(look, &try->sim, try->error)) return false;
    const struct stress_blame broken = stress_look_broken_number(look);
    if (broken.value > 0) {
        return fail(try, STRESS_CHECK_inside, "t = %.6g: grain %u at (%g, %g) is nowhere: not a "
                    "number", look->counters.time, broken.grain, broken.x, broken.y);
    }
    const struct stress_blame fastest = stress_look_fastest(look),
                              outside = stress_look_outside(look);
    struct stress_blame overlap = {0};
    if (try->result->values[STRESS_CHECK_overlap].asked) overlap = stress_look_overlap(look);
    return judge(try, STRESS_CHECK_mass, stress_look_loss(look), NULL)
        && judge(try, STRESS_CHECK_inside, outside.value, &outside)
        && judge(try, STRESS_CHECK_overlap, overlap.value, &overlap)
        && judge(try, STRESS_CHECK_momentum, stress_look_momentum_change(look), &fastest)
        && judge(try, STRESS_CHECK_rises, stress_look_energy_rise(look), &fastest)
        && judge(try, STRESS_CHECK_keeps, stress_look_energy_change(look), &fastest)
        && judge(try, STRESS_CHECK_work, (double)look->counters.steps, NULL);
}

static bool judge_end(struct try *try)
{
    const struct stress_look *look = &try->look;
    const struct counters *now = &look->counters, *first = &look->first;
    const double left = first->kinetic_energy > 0 ? now->kinetic_energy / first->kinetic_energy : 0;
    return judge(try, STRESS_CHECK_grains, (double)now->grains, NULL)
        && judge(try, STRESS_CHECK_left, left, NULL)
        && judge(try, STRESS_CHECK_travel, stress_look_travel(look), NULL)
        && judge(try, STRESS_CHECK_collides, (double)now->collisions, NULL);
}

/* ---- advancing ----------------------------------------------------------------------------- */

enum { PIECE = 2000 };          /* units of work between two looks at the clock */

static double seconds_spent(const struct try *try) { return clock_wall() - try->start; }

/* To time t; ADVANCE_BUDGET: the wall clock says no. */
static enum advance advance_to(struct try *try, struct simulation *sim, double t,
                               struct error *error)
{
    for (;;) {
        const enum advance outcome = simulation_advance(sim, t, PIECE, error);
        if (outcome != ADVANCE_BUDGET) return outcome;
        if (seconds_spent(try) > sim->scene->stress.seconds) return outcome;
    }
}

/* The run broke: as it must, for the reason that it must give, naming a grain - or not. */
static bool judge_stop(struct try *try, const char *reason)
{
    const struct ordeal *stress = &try->setup.scene->stress;
    if (stress->ends != STRESS_STOPPED) return fail(try, STRESS_CHECK_ends, "%.600s", reason);
    if (!strstr(reason, stress->because)) {
        return fail(try, STRESS_CHECK_ends, "stopped, but not because of '%.100s': %.400s",
                    stress->because, reason);
    }
    const struct model *model = try->sim.model;
    const struct fault *fault = model->fault ? model->fault(try->sim.state) : NULL;
    if (fault && fault->text[0] && isfinite(fault->time)) return true;
    return fail(try, STRESS_CHECK_ends, "stopped, but does not say where: %.400s", reason);
}

static bool run_through(struct try *try)
{
    const struct scene *scene = try->setup.scene;
    struct error reason = {0};
    const uint32_t looks = scene->stress.looks;
    for (uint32_t k = 0; k <= looks; k++) {
        const double since = scene->stress.since, t = since + (scene->until - since) * k / looks;
        switch (advance_to(try, &try->sim, t, &reason)) {
        case ADVANCE_BROKEN:
            return judge_stop(try, reason.text);
        case ADVANCE_BUDGET:
            try->look.counters = simulation_count(&try->sim);
            return fail(try, STRESS_CHECK_work, "t = %.6g of %g: not done after %g s and %llu "
                        "units of work", try->look.counters.time, scene->until,
                        scene->stress.seconds, (unsigned long long)try->look.counters.steps);
        case ADVANCE_REACHED:
            if (k == 0 && !stress_look_begin(&try->look, &try->sim, try->error)) return false;
            if (!judge_look(try)) return false;
        }
    }
    if (scene->stress.ends == STRESS_STOPPED) {
        return fail(try, STRESS_CHECK_ends, "reached t = %g, but it must be stopped: %s",
                    scene->until, scene->stress.because);
    }
    return judge_end(try);
}

/* The first error that was found, or what the loading said. */
static const char *first_error(const struct setup *setup, const struct error *reason)
{
    const struct findings *findings = setup->findings;
    for (uint32_t k = 0; findings && k < findings->count && k < FINDINGS_MAX; k++) {
        if (findings->list[k].kind == FINDING_ERROR) return findings->list[k].text;
    }
    return reason->text;
}

/* ---- a second run that must end alike ------------------------------------------------------ */

/* Grain `id` of the other run; its count if there is none. */
static uint32_t find_grain(const struct grains *grains, uint32_t id)
{
    uint32_t k = 0;
    while (k < grains->count && grains->id[k] != id) k++;
    return k;
}

/* How far a grain is from where the other run has it, both measured from the corner of the box in
 * its widths; in mean diameters of this run. */
static double distance_apart(const struct stress_look *a, uint32_t k, const struct stress_look *b,
                             uint32_t other)
{
    const double *box = a->scene->box, *with = b->scene->box;
    const double width = box[2] - box[0], height = box[3] - box[1];
    double dx = (a->grains.x[k] - box[0]) / width
              - (b->grains.x[other] - with[0]) / (with[2] - with[0]);
    double dy = (a->grains.y[k] - box[1]) / height
              - (b->grains.y[other] - with[1]) / (with[3] - with[1]);
    if (a->scene->left == BORDER_PERIODIC) dx -= round(dx);
    if (a->scene->bottom == BORDER_PERIODIC) dy -= round(dy);
    return hypot(dx * width, dy * height) / (2 * a->scene->radius_mean);
}

static bool compare(struct try *try, const struct stress_look *with)
{
    const struct stress_look *look = &try->look;
    const struct grains *grains = &look->grains;
    if (grains->count != with->grains.count) {
        return fail(try, STRESS_CHECK_positions, "t = %.6g: %u grains, but %u in the second run",
                    look->counters.time, grains->count, with->grains.count);
    }
    struct stress_blame worst = {0};
    for (uint32_t k = 0; k < grains->count; k++) {
        const uint32_t other = find_grain(&with->grains, grains->id[k]);
        const double apart = other < with->grains.count ? distance_apart(look, k, with, other)
                                                        : INFINITY;
        if (!(apart > worst.value)) continue;
        worst = (struct stress_blame){.value = apart, .grain = grains->id[k], .x = grains->x[k],
                                      .y = grains->y[k], .with = "its second self"};
    }
    /* Energies in units of each run's own start, so that other units compare too. */
    const double left = look->counters.kinetic_energy / look->first.kinetic_energy,
                 there = with->counters.kinetic_energy / with->first.kinetic_energy;
    return judge(try, STRESS_CHECK_positions, worst.value, &worst)
        && judge(try, STRESS_CHECK_energies, fabs(left - there) / there, NULL);
}

static bool agree(struct try *try, const char *path)
{
    const struct scene *scene = try->setup.scene;
    const struct key_texts *keys = &scene->stress.agrees_with;
    if (keys->count == 0) return true;
    const char *overrides[2 * OVERRIDES_MAX];
    uint32_t count = 0;
    for (; count < try->override_count; count++) overrides[count] = try->overrides[count];
    for (uint32_t k = 0; k < keys->count && k < OVERRIDES_MAX; k++) {
        overrides[count++] = keys->texts[k];
    }
    const struct setup_request request = {.path = path, .overrides = overrides,
                                          .override_count = count, .place = true};
    struct setup setup;
    struct simulation sim = {0};
    struct stress_look look = {0};
    struct error reason = {0};
    bool done = setup_load(&setup, &request, &reason)
        && simulation_create(&sim, setup.model, setup.scene, &reason)
        && stress_look_begin(&look, &sim, &reason);
    const double until = done ? setup.scene->until : 0;
    if (done && advance_to(try, &sim, until, &reason) != ADVANCE_REACHED) done = false;
    done = done && stress_look_take(&look, &sim, &reason);
    if (!done) {
        fail(try, STRESS_CHECK_positions, "the second run did not reach its end: %.500s",
             first_error(&setup, &reason));
    }
    done = done && compare(try, &look);
    stress_look_end(&look);
    if (sim.state) simulation_destroy(&sim);
    setup_free(&setup);
    return done;
}

/* ---- one run ------------------------------------------------------------------------------- */

/* The scene was refused: by an error that is expected, or not. */
static bool judge_refusal(struct try *try, const struct ordeal *stress, const char *text)
{
    if (stress->ends != STRESS_REFUSED) return fail(try, STRESS_CHECK_ends, "%.600s", text);
    return strstr(text, stress->because) || fail(try, STRESS_CHECK_ends,
        "refused, but not because of '%.100s': %.400s", stress->because, text);
}

static void find_tightest(struct stress_result *result)
{
    double most = -1;
    for (int k = 0; k < STRESS_CHECKS_COUNT; k++) {
        const double strain = stress_strain(&result->values[k]);
        if (!result->values[k].asked || strain <= most) continue;
        most = strain;
        result->tightest = (enum stress_check)k;
    }
}

static bool carry_out(struct try *try, const char *path, const struct ordeal *asked)
{
    const struct setup_request request = {.path = path, .overrides = try->overrides,
                                          .override_count = try->override_count, .place = true};
    struct error reason = {0};
    if (!setup_load(&try->setup, &request, &reason)) {
        ask(try->result, STRESS_CHECK_ends, NAN, 0);
        return judge_refusal(try, asked, first_error(&try->setup, &reason));
    }
    const struct ordeal *stress = &try->setup.scene->stress;
    ask_all(try->result, stress);
    if (!simulation_create(&try->sim, try->setup.model, try->setup.scene, &reason)) {
        return judge_refusal(try, stress, reason.text);
    }
    if (stress->ends == STRESS_REFUSED) {
        return fail(try, STRESS_CHECK_ends, "accepted, but it must be refused: %s",
                    stress->because);
    }
    return run_through(try) && agree(try, path);
}

bool stress_try(const char *scene, uint32_t index, struct stress_result *result,
                struct error *error)
{
    *result = (struct stress_result){0};
    struct scene *read = read_case(scene, error);
    struct try *try = read ? calloc(1, sizeof *try) : NULL;
    if (!try || index >= read->stress.models.count) {
        scene_free(read);
        free(try);
        return false;
    }
    try->result = result;
    try->error = error;
    try->start = clock_wall();
    try->start_cpu = clock_process();
    snprintf(result->run, sizeof result->run, "%s", read->stress.models.texts[index]);
    split(try, result->run);
    result->passed = carry_out(try, scene, &read->stress);
    if (result->passed) find_tightest(result);
    else if (!result->why[0]) snprintf(result->why, sizeof result->why, "%.600s", error->text);
    if (try->sim.state) result->steps = simulation_count(&try->sim).steps;
    result->wall = clock_wall() - try->start;
    result->cpu = clock_process() - try->start_cpu;
    stress_look_end(&try->look);
    if (try->sim.state) simulation_destroy(&try->sim);
    setup_free(&try->setup);
    scene_free(read);
    free(try);
    return true;
}
