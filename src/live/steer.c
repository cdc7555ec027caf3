/* steer.c - see steer.h.
 *
 * A change is tried on a copy of the timeline: the scene is read anew with one more phase, the
 * model is created from it and takes the state over.  Only when all that has worked does the copy
 * become the timeline, so a change that is refused leaves the session as it was.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/steer.h"

#include "live/pins.h"
#include "live/sight.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Beyond what any key allows as a time: "never", which a scene file cannot say otherwise. */
#define NEVER "1e30"

static const double push_radius = 8;            /* of mean grain radii, unless one is given */
static const double pour_width = 10;            /* likewise, of the stream that is poured */

static struct counters now_of(const struct session *session)
{
    return simulation_count(&session->sim);
}

/* ---- changes ------------------------------------------------------------------------------ */

/* Grains of the first hour carry no radius or mass of their own if all are alike. */
static bool keeps_kinds(const struct session *session, const struct scene *phase,
                        struct error *error)
{
    const effects_t fresh = phase->effects & ~session->sim.phase_scene->effects;
    if (!(fresh & (EFFECT_POLYDISPERSE | EFFECT_MIXTURE))) return true;
    return error_set_code(error, EXIT_SCENE, "grains of another kind than those so far cannot come "
                          "while it runs; give the scene both kinds from the start");
}

static bool keep_before(struct session *session, double time, struct error *error)
{
    if (session->before_time == time) return true;
    if (!isnan(session->before_time)) archive_end(&session->before);
    session->before_time = NAN;
    archive_begin_save(&session->before);
    if (!simulation_save(&session->sim, &session->before, error)) {
        archive_end(&session->before);
        return false;
    }
    session->before_time = time;
    return true;
}

/* The phase that begins now, with this change in it. */
static bool try_phase(struct session *session, struct timeline *copy,
                      const struct timeline_texts *sets, const double *push, struct error *error)
{
    /* Coarse ticks may stand beyond the time that was to be reached; what is due in between belongs
     * to the phase before, as in a run. */
    const double time = now_of(session).time, reached = session->reached;
    if (!session_reach(session, time, error)) return false;
    session->reached = reached;
    struct timeline_entry *entry = timeline_at(copy, time, error);
    if (!entry) return false;
    for (uint32_t k = 0; k < sets->count; k++) {
        if (!timeline_put(&entry->sets, sets->texts[k], error)) return false;
    }
    if (push && !timeline_push(entry, push, error)) return false;
    const uint32_t phase = timeline_phase(copy, entry);
    const struct scene *base = session->base.scene;
    struct setup setup;
    if (!timeline_setup(copy, base, NULL, &setup, error)) return false;
    bool pinned;
    if (!pins_needed(base, setup.scene, &pinned, error)) {
        setup_free(&setup);
        return false;
    }
    if (pinned) {
        setup_free(&setup);
        if (!pins_put(copy, base, error) || !timeline_setup(copy, base, NULL, &setup, error)) {
            return false;
        }
    }
    const bool done = keeps_kinds(session, setup.scene->phases[phase], error)
                   && keep_before(session, time, error)
                   && session_adopt(session, &setup, phase, NULL, error);
    setup_free(&setup);
    return done;
}

/* Before anything has moved, the scene itself is another. */
static bool try_start(struct session *session, struct timeline *copy,
                      const struct timeline_texts *sets, struct error *error)
{
    for (uint32_t k = 0; k < sets->count; k++) {
        if (!timeline_put(&copy->overrides, sets->texts[k], error)) return false;
    }
    return session_restart(session, copy, error);
}

static bool change(struct session *session, const struct timeline_texts *sets,
                   const double *push, struct error *error)
{
    struct timeline copy = {0};
    const bool fresh = session_untouched(session);
    if (fresh && push) {
        return error_set_code(error, EXIT_USAGE, "nothing has moved yet; take a step first");
    }
    bool done = timeline_copy(&session->timeline, &copy, error);
    done = done && (fresh ? try_start(session, &copy, sets, error)
                          : try_phase(session, &copy, sets, push, error));
    if (done) {
        const struct timeline old = session->timeline;
        session->timeline = copy;
        copy = old;
    }
    timeline_close(&copy);
    return done;
}

bool steer_change(struct session *session, const char *text, struct error *error)
{
    char *texts[] = {(char *)(uintptr_t)text};          /* only read */
    return change(session, &(struct timeline_texts){1, texts}, NULL, error);
}

bool steer_set(struct session *session, const struct command_line *line, struct error *error)
{
    char text[COMMAND_LINE_MAX + COMMAND_WORD_MAX];
    snprintf(text, sizeof text, "%s=%s", line->word, line->rest);
    if (strncmp(line->word, "view.", 5) == 0) return sight_change(session, text, error);
    return steer_change(session, text, error);
}

bool steer_push(struct session *session, const struct command_line *line, struct error *error)
{
    double push[PHASE_PUSH] = {line->numbers[0], line->numbers[1],
                               push_radius * session_scene(session)->radius_mean,
                               line->numbers[2], line->numbers[3]};
    if (line->number_count == 5) push[2] = line->numbers[4];
    return change(session, &(struct timeline_texts){0}, push, error);
}

/* ---- gates -------------------------------------------------------------------------------- */

static bool is_gate(const struct wall_entry *entry)
{
    return isfinite(entry->opens) || isfinite(entry->closes);
}

/* The keys of one wall that open or close it now. */
static bool turn_gate(const struct session *session, uint32_t k, bool opens,
                      struct timeline_texts *sets, struct error *error)
{
    const struct wall_entry *entry = &session->sim.phase_scene->wall_entries[k];
    const double now = now_of(session).time;
    char open_text[80], close_text[80];
    const bool was_open = now > entry->opens && now < entry->closes;
    snprintf(open_text, sizeof open_text, "walls.[%u].opens=", k);
    snprintf(close_text, sizeof close_text, "walls.[%u].closes=", k);
    const size_t a = strlen(open_text), b = strlen(close_text);
    if (opens || was_open) {
        snprintf(open_text + a, sizeof open_text - a, "%.17e", opens && !was_open ? now
                 : entry->opens);
    } else {
        snprintf(open_text + a, sizeof open_text - a, NEVER);
    }
    if (!opens && was_open) snprintf(close_text + b, sizeof close_text - b, "%.17e", now);
    else snprintf(close_text + b, sizeof close_text - b, NEVER);
    return timeline_put(sets, open_text, error) && timeline_put(sets, close_text, error);
}

bool steer_gate(struct session *session, const struct command_line *line, struct error *error)
{
    const struct scene *scene = session->sim.phase_scene;
    const bool opens = strcmp(line->literal, "open") == 0, one = line->number_count > 0;
    struct timeline_texts sets = {0};
    uint32_t turned = 0;
    bool done = true;
    for (uint32_t k = 0; done && k < scene->wall_entry_count; k++) {
        if (one ? line->numbers[0] != k : !is_gate(&scene->wall_entries[k])) continue;
        done = turn_gate(session, k, opens, &sets, error);
        turned++;
    }
    if (done && turned == 0) {
        done = error_set_code(error, EXIT_USAGE, scene->wall_entry_count == 0
            ? "this scene has no walls besides its borders"
            : one ? "there is no such wall; they count from 0 to %u"
            : "no wall of this scene is a gate; name one by its number, 0 to %u",
            scene->wall_entry_count - 1);
    }
    done = done && change(session, &sets, NULL, error);
    timeline_free_texts(&sets);
    return done;
}

/* ---- gravity and grains ------------------------------------------------------------------- */

bool steer_tilt(struct session *session, const struct command_line *line, struct error *error)
{
    const double *gravity = session->sim.phase_scene->gravity;
    const double g = hypot(gravity[0], gravity[1]), angle = line->numbers[0] * M_PI / 180;
    if (g == 0) {
        return error_set_code(error, EXIT_USAGE, "there is no gravity to tilt; set one, as in: set "
                              "gravity (0, -9.81)");
    }
    char text[100];
    snprintf(text, sizeof text, "gravity=(%.17e, %.17e)", g * sin(angle), -g * cos(angle));
    return steer_change(session, text, error);
}

/* They fall in one after the other, with the speed of a fall through two of their diameters and
 * at a distance of three, so that each has room. */
bool steer_pour(struct session *session, const struct command_line *line, struct error *error)
{
    const struct scene *scene = session->sim.phase_scene;
    const double count = line->numbers[0], radius = scene->radius_max, *box = scene->box;
    if (!(count >= 1 && count <= 1e7) || count != floor(count)) {
        return error_set_code(error, EXIT_USAGE, "%g grains: a whole number, 1 or more", count);
    }
    const double *gravity = scene->gravity, g = hypot(gravity[0], gravity[1]);
    const double speed = g > 0 ? sqrt(8 * radius * g) : (box[3] - box[1]) / scene->until;
    const bool placed = line->number_count == 3;
    const double x = placed ? line->numbers[1] : 0.5 * (box[0] + box[2]);
    const double y = placed ? line->numbers[2] : box[3] - 2 * radius;
    const double width = fmin(pour_width * radius, 0.2 * (box[2] - box[0]));
    char text[400];
    snprintf(text, sizeof text, "sources.[%u]={kind = \"point\"; position = (%.7g, %.7g); "
             "width = %.7g; velocity = (%.7g, %.7g); rate = %.7g; from = %.17g; count = %.0f;}",
             scene->source_count, x, y, width, g > 0 ? speed * gravity[0] / g : 0,
             g > 0 ? speed * gravity[1] / g : -speed, speed / (6 * radius),
             now_of(session).time, count);
    return steer_change(session, text, error);
}

/* ---- the way back ------------------------------------------------------------------------- */

/* Changes after that state are forgotten; what the scene itself brings then comes again. */
static bool rewound(const struct session *session, const struct keeper_state *state,
                    struct timeline *copy, struct error *error)
{
    if (!timeline_copy(&session->timeline, copy, error)) return false;
    timeline_cut(copy, state->phase);
    const double last = state->phase ? copy->entries[state->phase - 1].time : 0;
    return timeline_append(copy, &session->origin, last, error);
}

static bool return_to(struct session *session, const struct keeper_state *state,
                      struct timeline *copy, struct error *error)
{
    struct setup setup;
    if (!timeline_setup(copy, session->base.scene, NULL, &setup, error)) return false;
    const bool done = session_adopt(session, &setup, 0, &state->archive, error);
    setup_free(&setup);
    if (!done) return false;
    const struct timeline old = session->timeline;
    session->timeline = *copy;
    *copy = old;
    keeper_rewind(&session->keeper, state);
    return logging_return(&session->logging, &state->archive, error);
}

static void rest(struct session *session)
{
    session->running = false;
    session->steps_left = 0;
    sight_movie_again(session);
    session_say(session, "t = %.6g", now_of(session).time);
}

bool steer_back(struct session *session, const struct command_line *line, struct error *error)
{
    double time = now_of(session).time;
    if (line->number_count) time = fmin(time, nextafter(line->numbers[0], INFINITY));
    const struct keeper_state *state = keeper_before(&session->keeper, time);
    struct timeline copy = {0};
    const bool done = rewound(session, state, &copy, error)
                   && return_to(session, state, &copy, error);
    timeline_close(&copy);
    if (done) rest(session);
    return done;
}

bool steer_reset(struct session *session, const struct command_line *line, struct error *error)
{
    (void)line;
    struct timeline copy = {0};
    bool done = timeline_copy(&session->origin, &copy, error);
    const bool from_start = session->keeper.start == 0;
    if (done && from_start) {
        done = session_restart(session, &copy, error);
        if (done) {
            const struct timeline old = session->timeline;
            session->timeline = copy;
            copy = old;
        }
    } else if (done) {
        done = return_to(session, &session->keeper.states[0], &copy, error);
    }
    timeline_close(&copy);
    if (done) rest(session);
    return done;
}
