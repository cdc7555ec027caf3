/* hard.c - see hard.h.
 *
 * A run advances in small pieces of work, so that a model that hangs is noticed by the clock; what
 * it does between two looks never changes its state (model.h).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/hard.h"

#include "base/asset.h"
#include "base/clock.h"
#include "bench/cost_settings.h"
#include "bench/hard_look.h"
#include "run/setup.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char folder[] = "scenes/hard/";

static const char *const names[] = {
#define X(name, doc) #name,
    HARD_CHECKS(X)
#undef X
};

static const char *const docs[] = {
#define X(name, doc) doc,
    HARD_CHECKS(X)
#undef X
};

const char *hard_check_name(enum hard_check check) { return names[check]; }
const char *hard_check_doc(enum hard_check check) { return docs[check]; }

const char *hard_name(uint32_t index, char *name, size_t size)
{
    for (const struct asset *asset = asset_list; asset->name; asset++) {
        if (strncmp(asset->name, folder, strlen(folder)) != 0 || index-- > 0) continue;
        const char *plain = asset->name + strlen("scenes/");
        snprintf(name, size, "%.*s", (int)(strlen(plain) - strlen(".cfg")), plain);
        return name;
    }
    return NULL;
}

double hard_strain(const struct hard_value *value)
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
    struct hard_result *result;
    struct setup setup;
    struct simulation sim;
    struct hard_look look;
    char words[HARD_RUN_MAX], model[HARD_RUN_MAX];
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
    } else if (read->hard.models.count == 0) {
        error_set_code(error, EXIT_USAGE, "%s: not a hard case: its group `hard` names no models",
                       scene);
        scene_free(read);
        read = NULL;
    }
    free(findings);
    return read;
}

uint32_t hard_runs(const char *scene, bool *slow, struct error *error)
{
    struct scene *read = read_case(scene, error);
    if (!read) return 0;
    const uint32_t count = read->hard.models.count;
    *slow = read->hard.slow;
    scene_free(read);
    return count;
}

/* ---- checks -------------------------------------------------------------------------------- */

static bool fail(struct try *try, enum hard_check check, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool fail(struct try *try, enum hard_check check, const char *format, ...)
{
    struct hard_result *result = try->result;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(result->why, sizeof result->why, format, arguments);
    va_end(arguments);
    result->passed = false;
    result->tightest = check;
    return false;
}

static void ask(struct hard_result *result, enum hard_check check, double low, double high)
{
    if (isnan(low) && isnan(high)) return;
    result->values[check] = (struct hard_value){.asked = true, .low = low, .high = high,
                                                  .worst = isnan(high) ? INFINITY : 0};
}

static void ask_all(struct hard_result *result, const struct hard *hard)
{
    const double none = NAN;
    /* Grains are whole; half of one is less than the least that can be missing. */
    if (hard->mass) ask(result, HARD_CHECK_mass, none, 0);
    ask(result, HARD_CHECK_inside, none, isfinite(hard->within[0]) ? 0 : 1);
    ask(result, HARD_CHECK_momentum, none, hard->momentum);
    ask(result, HARD_CHECK_rises, none, hard->energy_rises);
    ask(result, HARD_CHECK_keeps, none, hard->energy_changes);
    ask(result, HARD_CHECK_overlap, none, hard->overlap);
    ask(result, HARD_CHECK_grains, hard->grains[0], hard->grains[1]);
    ask(result, HARD_CHECK_left, hard->energy_left[0], hard->energy_left[1]);
    ask(result, HARD_CHECK_travel, hard->travel[0], hard->travel[1]);
    ask(result, HARD_CHECK_collides, hard->collisions > 0 ? hard->collisions : none, none);
    ask(result, HARD_CHECK_work, none, hard->work);
    ask(result, HARD_CHECK_positions, none, hard->positions);
    ask(result, HARD_CHECK_energies, none, hard->energies);
    ask(result, HARD_CHECK_ends, none, 0);
}

/* Notes the value if it is asked for; false and a sentence if it is out of its limits. */
static bool judge(struct try *try, enum hard_check check, double number,
                  const struct hard_blame *blame)
{
    struct hard_value *value = &try->result->values[check];
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
                 check == HARD_CHECK_inside ? "" : " is the fastest");
    }
    return fail(try, check, "t = %.6g: %s: %.4g, %s %.4g%s", try->look.counters.time, docs[check],
                number, low ? "at least" : "at most", low ? value->low : value->high, who);
}

static bool judge_look(struct try *try)
{
    struct hard_look *look = &try->look;
    if (!hard_look_take(look, &try->sim, try->error)) return false;
    const struct hard_blame broken = hard_look_broken_number(look);
    if (broken.value > 0) {
        return fail(try, HARD_CHECK_inside, "t = %.6g: grain %u at (%g, %g) is nowhere: not a "
                    "number", look->counters.time, broken.grain, broken.x, broken.y);
    }
    const struct hard_blame fastest = hard_look_fastest(look),
                              outside = hard_look_outside(look);
    struct hard_blame overlap = {0};
    if (try->result->values[HARD_CHECK_overlap].asked) overlap = hard_look_overlap(look);
    return judge(try, HARD_CHECK_mass, hard_look_loss(look), NULL)
        && judge(try, HARD_CHECK_inside, outside.value, &outside)
        && judge(try, HARD_CHECK_overlap, overlap.value, &overlap)
        && judge(try, HARD_CHECK_momentum, hard_look_momentum_change(look), &fastest)
        && judge(try, HARD_CHECK_rises, hard_look_energy_rise(look), &fastest)
        && judge(try, HARD_CHECK_keeps, hard_look_energy_change(look), &fastest)
        && judge(try, HARD_CHECK_work, (double)look->counters.steps, NULL);
}

static bool judge_end(struct try *try)
{
    const struct hard_look *look = &try->look;
    const struct counters *now = &look->counters, *first = &look->first;
    const double left = first->kinetic_energy > 0 ? now->kinetic_energy / first->kinetic_energy : 0;
    return judge(try, HARD_CHECK_grains, (double)now->grains, NULL)
        && judge(try, HARD_CHECK_left, left, NULL)
        && judge(try, HARD_CHECK_travel, hard_look_travel(look), NULL)
        && judge(try, HARD_CHECK_collides, (double)now->collisions, NULL);
}

/* ---- advancing ----------------------------------------------------------------------------- */

enum { PIECE = 2000 };          /* units of work between two looks at the clock */

/* Wall time of a machine of its own: where others keep the processors busy a run gets little of the
 * wall's seconds, and with several threads it spends more of the processors'. */
static double seconds_spent(const struct try *try)
{
    return fmin(clock_wall() - try->start, clock_process() - try->start_cpu);
}

/* To time t; ADVANCE_BUDGET: the clock says no. */
static enum advance advance_to(struct try *try, struct simulation *sim, double t,
                               struct error *error)
{
    for (;;) {
        const enum advance outcome = simulation_advance(sim, t, PIECE, error);
        if (outcome != ADVANCE_BUDGET) return outcome;
        if (seconds_spent(try) > sim->scene->hard.seconds) return outcome;
    }
}

/* The run broke: as it must, for the reason that it must give, naming a grain - or not. */
static bool judge_stop(struct try *try, const char *reason)
{
    const struct hard *hard = &try->setup.scene->hard;
    if (hard->ends != HARD_STOPPED) return fail(try, HARD_CHECK_ends, "%.600s", reason);
    if (!strstr(reason, hard->because)) {
        return fail(try, HARD_CHECK_ends, "stopped, but not because of '%.100s': %.400s",
                    hard->because, reason);
    }
    const struct model *model = try->sim.model;
    const struct fault *fault = model->fault ? model->fault(try->sim.state) : NULL;
    if (fault && fault->text[0] && isfinite(fault->time)) return true;
    return fail(try, HARD_CHECK_ends, "stopped, but does not say where: %.400s", reason);
}

/* What is compared at the end only does not exist where a run is stopped. */
static bool drop_end(struct hard_result *result)
{
    for (int k = HARD_CHECK_grains; k < HARD_CHECK_ends; k++) {
        if (k != HARD_CHECK_work) result->values[k].asked = false;
    }
    return true;
}

static bool run_through(struct try *try)
{
    const struct scene *scene = try->setup.scene;
    struct error reason = {0};
    const uint32_t looks = scene->hard.looks;
    for (uint32_t k = 0; k <= looks; k++) {
        const double since = scene->hard.since, t = since + (scene->until - since) * k / looks;
        switch (advance_to(try, &try->sim, t, &reason)) {
        case ADVANCE_BROKEN:
            return judge_stop(try, reason.text) && drop_end(try->result);
        case ADVANCE_BUDGET:
            try->look.counters = simulation_count(&try->sim);
            return fail(try, HARD_CHECK_work, "t = %.6g of %g: not done after %g s and %llu "
                        "units of work", try->look.counters.time, scene->until,
                        scene->hard.seconds, (unsigned long long)try->look.counters.steps);
        case ADVANCE_REACHED:
            if (k == 0 && !hard_look_begin(&try->look, &try->sim, try->error)) return false;
            if (!judge_look(try)) return false;
        }
    }
    if (scene->hard.ends == HARD_STOPPED) {
        return fail(try, HARD_CHECK_ends, "reached t = %g, but it must be stopped: %s",
                    scene->until, scene->hard.because);
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
static double distance_apart(const struct hard_look *a, uint32_t k, const struct hard_look *b,
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

static bool compare(struct try *try, const struct hard_look *with)
{
    const struct hard_look *look = &try->look;
    const struct grains *grains = &look->grains;
    if (grains->count != with->grains.count) {
        return fail(try, HARD_CHECK_positions, "t = %.6g: %u grains, but %u in the second run",
                    look->counters.time, grains->count, with->grains.count);
    }
    struct hard_blame worst = {0};
    for (uint32_t k = 0; k < grains->count; k++) {
        const uint32_t other = find_grain(&with->grains, grains->id[k]);
        const double apart = other < with->grains.count ? distance_apart(look, k, with, other)
                                                        : INFINITY;
        if (!(apart > worst.value)) continue;
        worst = (struct hard_blame){.value = apart, .grain = grains->id[k], .x = grains->x[k],
                                      .y = grains->y[k], .with = "its second self"};
    }
    /* Energies in units of each run's own start, so that other units compare too. */
    const double left = look->counters.kinetic_energy / look->first.kinetic_energy,
                 there = with->counters.kinetic_energy / with->first.kinetic_energy;
    return judge(try, HARD_CHECK_positions, worst.value, &worst)
        && judge(try, HARD_CHECK_energies, fabs(left - there) / there, NULL);
}

static bool agree(struct try *try, const char *path)
{
    const struct scene *scene = try->setup.scene;
    const struct key_texts *keys = &scene->hard.agrees_with;
    if (keys->count == 0) return true;
    const char *overrides[2 * OVERRIDES_MAX];
    char factors[OVERRIDES_MAX][COST_KEY];
    uint32_t count = 0;
    for (; count < try->override_count; count++) overrides[count] = try->overrides[count];
    for (uint32_t k = 0; k < keys->count && k < OVERRIDES_MAX; k++) {
        overrides[count] = keys->texts[k];
        if (strstr(keys->texts[k], "=*")) {
            if (!cost_settings_key(keys->texts[k], &try->setup, factors[k])) continue;
            overrides[count] = factors[k];
        }
        count++;
    }
    const struct setup_request request = {.path = path, .overrides = overrides,
                                          .override_count = count, .place = true};
    struct setup setup;
    struct simulation sim = {0};
    struct hard_look look = {0};
    struct error reason = {0};
    bool done = setup_load(&setup, &request, &reason)
        && simulation_create(&sim, setup.model, setup.scene, &reason)
        && hard_look_begin(&look, &sim, &reason);
    const double until = done ? setup.scene->until : 0;
    if (done && advance_to(try, &sim, until, &reason) != ADVANCE_REACHED) done = false;
    done = done && hard_look_take(&look, &sim, &reason);
    if (!done) {
        fail(try, HARD_CHECK_positions, "the second run did not reach its end: %.500s",
             first_error(&setup, &reason));
    }
    done = done && compare(try, &look);
    hard_look_end(&look);
    if (sim.state) simulation_destroy(&sim);
    setup_free(&setup);
    return done;
}

/* ---- one run ------------------------------------------------------------------------------- */

/* The scene was refused: by an error that is expected, or not. */
static bool judge_refusal(struct try *try, const struct hard *hard, const char *text)
{
    if (hard->ends != HARD_REFUSED) return fail(try, HARD_CHECK_ends, "%.600s", text);
    return strstr(text, hard->because) || fail(try, HARD_CHECK_ends,
        "refused, but not because of '%.100s': %.400s", hard->because, text);
}

static void find_tightest(struct hard_result *result)
{
    double most = -1;
    for (int k = 0; k < HARD_CHECKS_COUNT; k++) {
        const double strain = hard_strain(&result->values[k]);
        if (!result->values[k].asked || strain <= most) continue;
        most = strain;
        result->tightest = (enum hard_check)k;
    }
}

static bool carry_out(struct try *try, const char *path, const struct hard *asked)
{
    const struct setup_request request = {.path = path, .overrides = try->overrides,
                                          .override_count = try->override_count, .place = true};
    struct error reason = {0};
    if (!setup_load(&try->setup, &request, &reason)) {
        ask(try->result, HARD_CHECK_ends, NAN, 0);
        /* A scene that only its model refuses says with its overrides what is expected. */
        const struct hard *hard = try->setup.scene ? &try->setup.scene->hard : asked;
        return judge_refusal(try, hard, first_error(&try->setup, &reason));
    }
    const struct hard *hard = &try->setup.scene->hard;
    ask_all(try->result, hard);
    if (!simulation_create(&try->sim, try->setup.model, try->setup.scene, &reason)) {
        return judge_refusal(try, hard, reason.text);
    }
    if (hard->ends == HARD_REFUSED) {
        return fail(try, HARD_CHECK_ends, "accepted, but it must be refused: %s",
                    hard->because);
    }
    if (!run_through(try)) return false;
    return hard->ends == HARD_STOPPED || agree(try, path);
}

bool hard_try(const char *scene, uint32_t index, struct hard_result *result,
                struct error *error)
{
    *result = (struct hard_result){0};
    struct scene *read = read_case(scene, error);
    struct try *try = read ? calloc(1, sizeof *try) : NULL;
    if (!try || index >= read->hard.models.count) {
        scene_free(read);
        free(try);
        return false;
    }
    try->result = result;
    try->error = error;
    try->start = clock_wall();
    try->start_cpu = clock_process();
    snprintf(result->run, sizeof result->run, "%s", read->hard.models.texts[index]);
    split(try, result->run);
    result->passed = carry_out(try, scene, &read->hard);
    if (result->passed) find_tightest(result);
    else if (!result->why[0]) snprintf(result->why, sizeof result->why, "%.600s", error->text);
    if (try->sim.state) result->steps = simulation_count(&try->sim).steps;
    result->wall = clock_wall() - try->start;
    result->cpu = clock_process() - try->start_cpu;
    hard_look_end(&try->look);
    if (try->sim.state) simulation_destroy(&try->sim);
    setup_free(&try->setup);
    scene_free(read);
    free(try);
    return true;
}
