/* teller.c - see teller.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/teller.h"

#include "live/expression.h"
#include "live/sight.h"
#include "run/jsontext.h"
#include "run/look.h"
#include "run/portrait.h"
#include "scene/scene_value.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Totals by their names, and `energy`, the sum of those that the model has. */
static bool find_total(const struct counters *now, const char *name, double *value)
{
    if (strcmp(name, "time") == 0) {
        *value = now->time;
        return true;
    }
    if (strcmp(name, "energy") == 0) {
        const double parts[] = {now->kinetic_energy, now->rotational_energy,
                                now->potential_energy};
        *value = 0;
        for (int k = 0; k < 3; k++) *value += isnan(parts[k]) ? 0 : parts[k];
        return true;
    }
#define X(total, ...)                                                                   \
    if (strcmp(name, #total) == 0) {                                                    \
        *value = (double)now->total;                                                    \
        return true;                                                                    \
    }
    COUNTERS(X)
    QUANTITIES(X)
#undef X
    return false;
}

static bool find_key(const struct session *session, const char *name, const struct key **key,
                     const void **value)
{
    const bool look = strncmp(name, "view.", 5) == 0;
    return scene_value_find(look ? sight_scene(session) : session->sim.phase_scene, name, key,
                            value);
}

bool teller_get(struct session *session, const struct command_line *line, struct error *error)
{
    const struct counters now = simulation_count(&session->sim);
    const struct key *key;
    const void *at;
    double value;
    if (find_total(&now, line->word, &value)) {
        session_say(session, "%.15g", value);
        return true;
    }
    if (!find_key(session, line->word, &key, &at)) {
        return error_set_code(error, EXIT_USAGE, "there is no key or total '%.60s'; `sandreel help "
            "keys` lists the keys; totals are time, grains, kinetic_energy, ...", line->word);
    }
    char *text;
    if (!scene_write_value(key, at, &text)) return error_set(error, "not enough memory to tell it");
    session_say(session, "%s", text ? text : "(chosen when absent, or never)");
    free(text);
    return true;
}

/* ---- a grain ------------------------------------------------------------------------------ */

bool teller_inspect(struct session *session, const struct command_line *line,
                    struct error *error)
{
    struct grains *grains = &session->grains;
    uint32_t i = 0;
    if (!look_at(&session->sim, grains, true, error)) return false;
    const double *n = line->numbers;
    const bool by_id = line->number_count == 1;
    if (by_id && (!(n[0] >= 0) || !portrait_find(grains, (uint64_t)n[0], &i))) {
        return error_set_code(error, EXIT_USAGE, "there is no grain %g now (it has left, or not "
                              "yet entered)", n[0]);
    }
    if (!by_id && !portrait_nearest(grains, n[0], n[1], &i)) {
        return error_set_code(error, EXIT_USAGE, "there is no grain now");
    }
    json_t *portrait = portrait_grain(grains, i);
    char *text = jsontext_dump(portrait, JSON_REAL_PRECISION(9));
    json_decref(portrait);
    if (!text) return error_set(error, "not enough memory to tell of a grain");
    session_say(session, "%s", text);
    free(text);
    return true;
}

/* ---- expectations ------------------------------------------------------------------------- */

struct names { const struct session *session; struct counters now; };

static bool find_name(void *context, const char *name, double *value)
{
    const struct names *names = context;
    const struct key *key;
    const void *at;
    if (find_total(&names->now, name, value)) return true;
    if (!find_key(names->session, name, &key, &at)) return false;
    switch (key->type) {
    case KEY_REAL:   *value = *(const double *)at; return true;
    case KEY_COUNT:  *value = *(const uint32_t *)at; return true;
    case KEY_WORD64: *value = (double)*(const uint64_t *)at; return true;
    case KEY_BOOL:   *value = *(const bool *)at; return true;
    default: return false;
    }
}

bool teller_expect(struct session *session, const struct command_line *line, struct error *error)
{
    struct names names = {session, simulation_count(&session->sim)};
    double value;
    if (!expression_value(line->rest, find_name, &names, &value, error)) return false;
    session->expected++;
    if (value == 1) {
        session_say(session, "holds: %s", line->rest);
        return true;
    }
    session->disappointed++;
    return error_set_code(error, EXIT_VERDICT, "does not hold at t = %.9g: %.300s (it is %.9g; "
        "grains %" PRIu64 ", kinetic_energy %.9g)", names.now.time, line->rest, value,
        names.now.grains, names.now.kinetic_energy);
}

/* ---- help --------------------------------------------------------------------------------- */

bool teller_help(struct session *session, const struct command_line *line, struct error *error)
{
    const enum command_verb only = line->word[0] ? command_find(line->word) : COMMAND_COUNT;
    if (line->word[0] && only == COMMAND_COUNT) {
        return error_set_code(error, EXIT_USAGE, "there is no command '%.40s'; `help` lists them",
                              line->word);
    }
    for (int verb = 0; verb < COMMAND_COUNT; verb++) {
        char usage[200];
        if (only != COMMAND_COUNT && (int)only != verb) continue;
        session_say(session, "%s%s\n    %s", session->reply[0] ? "\n" : "",
                    command_usage((enum command_verb)verb, usage, sizeof usage),
                    command_table[verb].doc);
    }
    return true;
}
