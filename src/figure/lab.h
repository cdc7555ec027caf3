/* lab.h - a built-in scene with some keys changed, ready to run: what the figures measure in.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LAB_H
#define LAB_H

#include "figure/figure.h"
#include "run/footage.h"

enum { LAB_KEYS = 32, LAB_KEY_TEXT = 400 };

struct lab_wish {
    const char *scene;
    bool contacts;              /* look at contacts too */
    uint32_t count;
    char keys[LAB_KEYS][LAB_KEY_TEXT];
};

struct lab {
    struct setup setup;
    struct footage footage;     /* .grains: as of the last lab_go */
};

/* "KEY=VALUE". */
void lab_set(struct lab_wish *wish, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Loads the scene and creates its model; notes in the job which command simulates the same. */
bool lab_open(struct lab *lab, struct figure_job *job, const struct lab_wish *wish,
              struct error *error);

/* Simulates up to t and looks. */
bool lab_go(struct lab *lab, double t, struct error *error);

struct counters lab_count(const struct lab *lab);

void lab_close(struct lab *lab);

#endif
