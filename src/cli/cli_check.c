/* cli_check.c - `check SCENE`: everything that is wrong with it, and what it amounts to.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "bench/effects.h"
#include "model/simulation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void tell_settings(const struct scene *scene, const struct model *model)
{
    const struct key_group *group = model->settings;
    const void *settings = group ? scene_settings(scene, group->name) : NULL;
    if (!settings) return;
    printf("settings of %s:", model->name);
    for (uint32_t k = 0; k < group->count; k++) {
        const struct key *key = &group->keys[k];
        const void *at = (const char *)settings + key->offset;
        char word[64];
        if (key->type == KEY_REAL && isfinite(*(const double *)at)) {
            const char *unit = scene_unit(scene, key->unit);
            printf(" %s = %.6g%s%s;", key->name, *(const double *)at, *unit ? " " : "", unit);
        } else if (key->type == KEY_CHOICE) {
            printf(" %s = %s;", key->name, key_choice_word(key->choices, *(const int *)at, word,
                                                           sizeof word));
        } else if (key->type == KEY_BOOL) {
            printf(" %s = %s;", key->name, *(const bool *)at ? "true" : "false");
        } else if (key->type == KEY_COUNT) {
            printf(" %s = %u;", key->name, *(const uint32_t *)at);
        }
    }
    printf("\n");
}

static double area_fraction(const struct scene *scene)
{
    double area = 0;
    for (uint32_t i = 0; i < scene->placed.count; i++) {
        area += M_PI * scene->placed.radius[i] * scene->placed.radius[i];
    }
    return area / ((scene->box[2] - scene->box[0]) * (scene->box[3] - scene->box[1]));
}

static void tell_summary(const struct setup *setup)
{
    const struct scene *scene = setup->scene;
    char text[400];
    printf("%s%s%s\n", scene->name, *scene->title ? ": " : "", scene->title);
    printf("grains: %u at the start, at most %u; area fraction of the box %.3g\n",
           scene->placed.count, scene->count_max, area_fraction(scene));
    printf("radii: %.4g to %.4g, mean %.4g %s\n", scene->radius_min, scene->radius_max,
           scene->radius_mean, scene_unit(scene, "length"));
    printf("box: %.6g x %.6g %s, %u walls, %u obstacles, %u phases; until t = %.6g %s\n",
           scene->box[2] - scene->box[0], scene->box[3] - scene->box[1],
           scene_unit(scene, "length"), scene->wall_count, scene->obstacle_count,
           scene->phase_count, scene->until, scene_unit(scene, "time"));
    effect_words(scene->effects, text, sizeof text);
    printf("effects: %s\n", text);
    effects_t all = 0;
    for (uint32_t p = 0; p < scene->phase_count; p++) all |= scene->phases[p]->effects;
    model_names(all, text, sizeof text);
    printf("model: %s (%s); models that can run it: %s\n", setup->model->name,
           setup->model->summary, text);
    tell_settings(scene, setup->model);
    if (!setup->model->memory) return;
    printf("memory of the model: %s\n", opening_bytes((double)setup->model->memory(scene), text,
                                                      sizeof text));
}

/* What a character of the picture stands for: what is solid in it, or else its middle. */
static char ground_of(const struct simulation *sim, double x, double y, double width, double height)
{
    enum { POINTS = 8 };
    for (int k = 0; k < POINTS * POINTS; k++) {
        const double dx = (k % POINTS + 0.5) / POINTS - 0.5;
        const double dy = (k / POINTS + 0.5) / POINTS - 0.5;
        if (sim->model->ground(sim->state, x + dx * width, y + dy * height) == '#') return '#';
    }
    return sim->model->ground(sim->state, x, y);
}

/* The box as the model's lattice has it; characters are about twice as high as wide. */
static bool tell_ground(const struct setup *setup, struct error *error)
{
    enum { COLUMNS = 72, ROWS_MAX = 48 };
    const double *box = setup->scene->box;
    const double width = box[2] - box[0], height = box[3] - box[1];
    if (!setup->model->ground) return true;
    struct simulation sim;
    if (!simulation_create(&sim, setup->model, setup->scene, error)) return false;
    const double cell = fmax(width / COLUMNS, height / (2 * ROWS_MAX));
    const int columns = (int)ceil(width / cell - 1e-9), rows = (int)ceil(height / cell / 2 - 1e-9);
    printf("its lattice at t = 0 (# solid, v sink; a character is %.3g x %.3g %s):\n", cell,
           2 * cell, scene_unit(setup->scene, "length"));
    for (int j = rows - 1; j >= 0; j--) {
        printf("    |");
        for (int i = 0; i < columns; i++) {
            putchar(ground_of(&sim, box[0] + (i + 0.5) * cell, box[1] + (j + 0.5) * 2 * cell,
                              cell, 2 * cell));
        }
        printf("|\n");
    }
    simulation_destroy(&sim);
    return true;
}

/* What it costs here: measured now, by going on without it from the same state. */
static void tell_cost(struct effects_probe *probe, const struct model *model, effects_t effect)
{
    struct effects_cost cost;
    struct error error = {0};
    char bytes[32];
    if (!effects_measure(probe, effect, &cost, &error)) {
        printf("  %-18s   cost: %s\n", "", error.text);
    } else if (!cost.measured) {
        printf("  %-18s   cost: not measured (%s)\n", "", cost.why);
    } else {
        printf("  %-18s   cost: %+.1f %% of the time of %s (%.3g us with, %.3g us without), "
               "memory %s\n", "", 100 * (cost.with - cost.without) / cost.without, model->work,
               1e6 * cost.with, 1e6 * cost.without,
               opening_bytes(fmax(cost.bytes, 0), bytes, sizeof bytes));
    }
}

static void explain(const struct options *options, const struct scene *scene,
                    const struct model *model)
{
    const struct setup_request request = {.path = options->operands[0],
        .overrides = options->overrides, .override_count = options->override_count, .place = true};
    struct scene_reason reason;
    struct error error = {0};
    struct effects_probe *probe = effects_open(&request, &error);
    for (int on = 1; on >= 0; on--) {
        printf("\neffects that are %s:\n", on ? "on" : "off");
        for (uint32_t k = 0; scene_explain(scene, k, &reason); k++) {
            if (reason.on != (on == 1)) continue;
            printf("  %-18s %s\n", effect_word(reason.effect), effect_doc(reason.effect));
            printf("  %-18s   %s\n", "", reason.why);
            if (on && probe) tell_cost(probe, model, reason.effect);
            if (on && !probe) printf("  %-18s   cost: not measured (%s)\n", "", error.text);
            fflush(stdout);
        }
    }
    effects_close(probe);
}

int cli_check(const struct options *options)
{
    struct error error = {0};
    struct setup setup;
    if (!opening_load(&setup, options, options->operands[0], NULL, true, &error)) {
        setup_free(&setup);
        return opening_fail(&error);
    }
    tell_summary(&setup);
    const bool told = tell_ground(&setup, &error);
    if (options_given(options, OPTION_explain)) explain(options, setup.scene, setup.model);
    setup_free(&setup);
    return told ? EXIT_DONE : opening_fail(&error);
}
