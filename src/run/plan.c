/* plan.c - see plan.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/plan.h"

#include "base/archive.h"
#include "base/rng.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint32_t count_limit = 10000000;   /* runs: more are a slip of the pen */

/* Seeds are short enough to be read, and exact in any program that takes numbers as doubles. */
static const uint64_t seed_mask = ((uint64_t)1 << 48) - 1;

static bool refuse(const char *text, const char *why, struct error *error)
{
    return error_set_code(error, EXIT_USAGE, "--vary %s: %s; write KEY=a:b:step, KEY=v,w,... or, "
                          "with --random N, KEY=a:b", text, why);
}

/* Up to three numbers parted by colons; 0 if the text is something else. */
static int read_range(const char *text, double numbers[3])
{
    int count = 0;
    for (; count < 3; count++) {
        char *end;
        numbers[count] = strtod(text, &end);
        if (end == text || !isfinite(numbers[count])) return 0;
        if (*end == 0) return count + 1;
        if (*end != ':') return 0;
        text = end + 1;
    }
    return 0;
}

/* The length of the next entry of a list: up to a comma outside of brackets. */
static size_t entry_length(const char *text)
{
    int depth = 0;
    size_t length = 0;
    for (; text[length]; length++) {
        if (strchr("([", text[length])) depth++;
        if (strchr(")]", text[length])) depth--;
        if (text[length] == ',' && depth == 0) break;
    }
    return length;
}

static bool read_list(struct plan_key *key, const char *values, const char *text,
                      struct error *error)
{
    uint32_t room = 1;
    for (const char *at = values; *at; at++) room += *at == ',';
    key->texts = calloc(room, sizeof *key->texts);
    if (!key->texts) return error_set(error, "not enough memory for the values of a study");
    while (*values) {
        const size_t length = entry_length(values);
        if (length == 0 || length >= KEY_TEXT_MAX) return refuse(text, "an entry is empty or too "
                                                                 "long", error);
        memcpy(key->texts[key->count++], values, length);
        values += length + (values[length] == ',');
    }
    return key->count > 0 || refuse(text, "no value is named", error);
}

bool plan_vary(struct plan *plan, const char *text, struct error *error)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || equals - text >= KEY_TEXT_MAX) {
        return refuse(text, "no key is named", error);
    }
    if (plan->key_count == PLAN_KEYS_MAX) return refuse(text, "more than 16 keys", error);
    struct plan_key *key = &plan->keys[plan->key_count++];
    memcpy(key->name, text, (size_t)(equals - text));
    double numbers[3];
    const int count = read_range(equals + 1, numbers);
    if (count < 2) return read_list(key, equals + 1, text, error);
    key->low = numbers[0];
    key->count = 1;
    if (count == 2) {
        key->drawn = true;
        key->step = numbers[1] - numbers[0];
        return plan->draws > 0 || refuse(text, "a range without a step is drawn from", error);
    }
    key->step = numbers[2];
    const double steps = (numbers[1] - numbers[0]) / numbers[2];
    if (!(steps >= 0) || !(steps < count_limit)) {
        return refuse(text, "the steps do not lead from a to b", error);
    }
    key->count = (uint32_t)floor(steps * (1 + 1e-12) + 1e-9) + 1;
    return true;
}

void plan_free(struct plan *plan)
{
    for (uint32_t k = 0; k < plan->key_count; k++) free(plan->keys[k].texts);
    plan->key_count = 0;
}

static uint32_t draws_of(const struct plan *plan) { return plan->draws ? plan->draws : 1; }

bool plan_count(const struct plan *plan, uint32_t *count, struct error *error)
{
    double product = (double)plan->repeats * draws_of(plan);
    for (uint32_t k = 0; k < plan->key_count; k++) product *= plan->keys[k].count;
    *count = (uint32_t)fmin(product, count_limit);
    return product <= count_limit || error_set_code(error, EXIT_USAGE, "%.3g runs are more than a "
        "study can have (%" PRIu32 "); vary less", product, count_limit);
}

uint32_t plan_repeat(const struct plan *plan, uint32_t point) { return point % plan->repeats; }

char *plan_value(const struct plan *plan, uint32_t point, uint32_t key, char text[KEY_TEXT_MAX])
{
    uint32_t rest = point / plan->repeats, index = 0;
    for (uint32_t k = plan->key_count; k-- > key;) {
        index = rest % plan->keys[k].count;
        rest /= plan->keys[k].count;
    }
    for (uint32_t k = key; k-- > 0;) rest /= plan->keys[k].count;   /* what is left: the draw */
    const struct plan_key *one = &plan->keys[key];
    if (one->texts) {
        memcpy(text, one->texts[index], KEY_TEXT_MAX);
        return text;
    }
    double share = index;
    if (one->drawn) {
        const uint64_t name = archive_hash(ARCHIVE_HASH_START, one->name, strlen(one->name));
        share = rng_unit(rng_keyed(plan->seed, name, rest, 0));
    }
    snprintf(text, KEY_TEXT_MAX, "%.10g", one->low + share * one->step);
    return text;
}

uint64_t plan_seed(const struct plan *plan, uint32_t point)
{
    uint64_t hash = ARCHIVE_HASH_START;
    for (uint32_t k = 0; k < plan->key_count; k++) {
        char text[KEY_TEXT_MAX];
        const char *name = plan->keys[k].name;
        plan_value(plan, point, k, text);
        hash = archive_hash(hash, name, strlen(name) + 1);
        hash = archive_hash(hash, text, strlen(text) + 1);
    }
    return rng_keyed(plan->seed, hash, plan_repeat(plan, point), 1) & seed_mask;
}

void plan_header(const struct plan *plan, FILE *stream)
{
    fputs("point,repeat,seed", stream);
    for (uint32_t k = 0; k < plan->key_count; k++) fprintf(stream, ",%s", plan->keys[k].name);
}

void plan_row(const struct plan *plan, uint32_t point, FILE *stream)
{
    fprintf(stream, "%" PRIu32 ",%" PRIu32 ",%" PRIu64, point, plan_repeat(plan, point),
            plan_seed(plan, point));
    for (uint32_t k = 0; k < plan->key_count; k++) {
        char text[KEY_TEXT_MAX];
        plan_value(plan, point, k, text);
        fprintf(stream, strchr(text, ',') ? ",\"%s\"" : ",%s", text);
    }
}
