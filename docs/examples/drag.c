/* drag.c - what the effect of drag.patch must hold: a grain slows down as exp(-drag t), a scene
 * without the key knows no drag, and a model that does not claim it would refuse the scene.
 *
 * tests/test_example_effect.py applies the patch to a copy of the sources, builds this with them
 * and runs it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern const struct model model_dust;

static const char scene_text[] = "until = 9.0; box = [0.0, 0.0, 100.0, 100.0]; %s"
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\";"
    "grains = ({ radius = 0.5; restitution = 1.0; });"
    "placements = ({ kind = \"square\"; count = 1; velocity = (3.0, 0.0); });";

static void check(bool holds, const char *sentence)
{
    printf("%s %s\n", holds ? "ok" : "does not hold:", sentence);
    if (!holds) exit(1);
}

static struct scene *load(const char *key)
{
    static struct findings findings;
    static char text[1000];
    snprintf(text, sizeof text, scene_text, key);
    const struct scene_request request = {.path = "drag", .text = text, .place = true};
    findings = (struct findings){0};
    struct scene *scene = scene_load(&request, &findings);
    if (!scene) check(false, findings.list[0].text);
    return scene;
}

/* How fast the grain flies after a time. */
static double speed_at(const struct scene *scene, double t)
{
    struct grains grains;
    void *dust = model_dust.create(scene, NULL);
    check(dust && grains_create(&grains, 2, 0, NULL), "there is memory for one grain");
    model_dust.advance(dust, t, UINT64_MAX);
    model_dust.observe(dust, &grains);
    const double speed = grains.vx[0];
    grains_free(&grains);
    model_dust.destroy(dust);
    return speed;
}

int main(void)
{
    struct scene *dragged = load("drag = 0.5;"), *free_flight = load("");
    char words[200];
    effect_words(dragged->effects, words, sizeof words);
    check(strstr(words, "drag") != NULL, "the scene calls for drag");
    check(!(free_flight->effects & EFFECT_DRAG), "a scene without the key does not");
    check(!(dragged->effects & ~model_dust.effects), "dust can do it");
    check(dragged->effects & ~(model_dust.effects & ~(effects_t)EFFECT_DRAG),
          "a model without it would be refused");
    /* Three roundings. */
    check(fabs(speed_at(dragged, 2) - 3 * exp(-1)) < 1e-15, "a grain slows down as exp(-drag t)");
    check(speed_at(free_flight, 2) == 3, "and keeps its speed without");
    scene_free(dragged);
    scene_free(free_flight);
    return 0;
}
