/* plan.h - the points of a parameter study: which keys take which values, and the seeds.
 *
 * All combinations of the values of all keys, the last key fastest; each as often as there are
 * repeats, one after the other.  A seed follows from the base seed, the point's own values and the
 * number of the repeat, so it does not change when other values are added to the study.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PLAN_H
#define PLAN_H

#include "base/error.h"
#include "scene/key.h"

#include <stdio.h>

enum { PLAN_KEYS_MAX = 16 };

struct plan_key {
    char     name[KEY_TEXT_MAX];
    uint32_t count;             /* of values; a drawn key has one */
    char   (*texts)[KEY_TEXT_MAX];      /* of a list; NULL: numbers */
    double   low, step;         /* value k of a grid is low + k step; drawn: low .. low + step */
    bool     drawn;
};

struct plan {
    uint64_t seed;
    uint32_t repeats, draws;    /* 1 or more; draws: how often the drawn keys are drawn */
    uint32_t key_count;
    struct plan_key keys[PLAN_KEYS_MAX];
};

/* Adds "KEY=a:b:step" (a grid, b included), "KEY=v,w,(x, y)" (a list), or "KEY=a:b" (drawn
 * uniformly between a and b for each of the plan's draws). */
bool plan_vary(struct plan *plan, const char *text, struct error *error);
void plan_free(struct plan *plan);

/* How many runs there are; false if there are too many. */
bool plan_count(const struct plan *plan, uint32_t *count, struct error *error);

uint32_t plan_repeat(const struct plan *plan, uint32_t point);

/* The value of key number `key` at a point, as in a scene file. */
char *plan_value(const struct plan *plan, uint32_t point, uint32_t key, char text[KEY_TEXT_MAX]);

uint64_t plan_seed(const struct plan *plan, uint32_t point);

/* "point,repeat,seed,KEY,..." and the same of one point, without an end of line. */
void plan_header(const struct plan *plan, FILE *stream);
void plan_row(const struct plan *plan, uint32_t point, FILE *stream);

#endif
