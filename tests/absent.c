/* absent.c - an elastic gas by every model, for test_absent.py: what comes out, bit for bit.
 *
 * Built twice: from the usual objects, and from objects in which no effect exists but what this gas
 * needs (periodic borders).  Prints one line a model: name, method, hash of the state, collisions.
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * absent [MODEL]: this model alone.  Under callgrind only absent_advance() is to be counted.
 */
#include "model/simulation.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GAS "until = 100.0; box = [0.0, 0.0, 24.0, 24.0]; "                                      \
    "left = \"periodic\"; right = \"periodic\"; bottom = \"periodic\"; top = \"periodic\"; "       \
    "grains = ({ radius = 0.5; restitution = 1.0; stiffness = 1e4; %s }); overlap_limit = 1.0; "  \
    "placements = ({ kind = \"square\"; spacing = 1.5; temperature = 1.0; }); %s"

static const struct { const char *model, *method, *species, *keys; } runs[] = {
    {"md", "verlet", "", ""},
    {"md", "gear", "", "md = { integrator = \"gear\"; };"},
    {"md", "friction", "friction = 0.5;", ""},
    {"ed", "tc", "", ""},
    {"dsmc", "dense", "", ""},
    {"dsmc", "plain", "", "dsmc = { method = \"plain\"; };"},
    {"lga", "fhp2", "", "lga = { method = \"fhp2\"; };"},
};

/* Its own function, never inlined, so that callgrind can be told to count inside it. */
bool absent_advance(struct simulation *sim, double t);
__attribute__((noinline)) bool absent_advance(struct simulation *sim, double t)
{
    return simulation_advance(sim, t, UINT64_MAX, NULL) == ADVANCE_REACHED;
}

static bool run(const char *model_name, const char *method, const char *text)
{
    static struct findings findings;
    const struct key_group *groups[MODEL_MAX];
    char override[60];
    const char *overrides[] = {override};
    snprintf(override, sizeof override, "model=\"%s\"", model_name);
    const struct scene_request request = {.path = "gas", .text = text, .overrides = overrides,
        .override_count = 1, .groups = groups, .group_count = model_settings(groups),
        .place = true};
    const struct model *model = model_find(model_name);
    struct simulation sim;
    struct error error = {0};
    findings = (struct findings){0};
    struct scene *scene = scene_load(&request, &findings);
    if (scene && model->resolve) model->resolve(scene, &findings);
    if (!scene || findings.errors > 0 || !simulation_create(&sim, model, scene, &error)) {
        fprintf(stderr, "%s: %s%s\n", model_name, error.text,
                findings.errors ? findings.list[0].text : "");
        return false;
    }
    const bool done = absent_advance(&sim, 2);
    printf("%s %s %016llx %llu\n", model_name, method, (unsigned long long)simulation_digest(&sim),
           (unsigned long long)simulation_count(&sim).collisions);
    simulation_destroy(&sim);
    scene_free(scene);
    return done;
}

int main(int count, char **arguments)
{
    bool done = true;
    omp_set_num_threads(1);             /* callgrind counts one thread after the other */
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
        char text[1200], name[60];
        snprintf(name, sizeof name, "%s %s", runs[k].model, runs[k].method);
        if (count > 1 && strcmp(arguments[1], name) != 0) continue;
        /* With friction, which a build without it must refuse to know, only if asked for. */
        if (count == 1 && runs[k].species[0]) continue;
        snprintf(text, sizeof text, GAS, runs[k].species, runs[k].keys);
        done = run(runs[k].model, runs[k].method, text) && done;
    }
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}
