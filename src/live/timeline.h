/* timeline.h - the scene of a session, with all that its user has changed and when.
 *
 * A change made while running is a phase like those that scene files have: it begins at its time
 * and stays.  So the session's whole past is a scene, and running that scene from the start gives
 * the same state bit for bit.  What is changed at time 0, before anything has moved, is laid over
 * the scene itself, and may be any key.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef TIMELINE_H
#define TIMELINE_H

#include "run/setup.h"

struct timeline_texts { uint32_t count; char **texts; };

struct timeline_entry {
    double time;
    struct timeline_texts sets;         /* "KEY=VALUE", each key once */
    uint32_t push_count;        /* numbers */
    double  *push;
};

struct timeline {
    char *path, *text;          /* as the user named the scene, and what it said */
    struct timeline_texts overrides;
    uint32_t entry_count;
    struct timeline_entry *entries;     /* in the order of time, the scene's own among them */
};

/* Reads the scene's text once and for all; a run directory gives its scene.cfg. `text` (may be
 * NULL) is taken instead of reading. */
bool timeline_open(struct timeline *timeline, const char *path, const char *text,
                   const char *const *overrides, uint32_t override_count, struct error *error);
void timeline_close(struct timeline *timeline);

/* A deep copy, so that a change can be tried and dropped. */
bool timeline_copy(const struct timeline *timeline, struct timeline *copy, struct error *error);

/* The scene as it now is, for all times, with `extra` overrides (may be NULL) over it.
 * `grains_of`: see scene.h; NULL places them.  The error is the first finding. */
bool timeline_setup(const struct timeline *timeline, const struct scene *grains_of,
                    const struct timeline_texts *extra, struct setup *setup,
                    struct error *error);

/* Takes the phases over that a scene itself brings. */
bool timeline_adopt(struct timeline *timeline, const struct scene *scene, struct error *error);

/* Forgets all but the first `count` entries. */
void timeline_cut(struct timeline *timeline, uint32_t count);

/* Adds the entries of another timeline that begin after `time`. */
bool timeline_append(struct timeline *timeline, const struct timeline *from, double time,
                     struct error *error);

/* The entry that begins at `time`, made if it is not there. */
struct timeline_entry *timeline_at(struct timeline *timeline, double time, struct error *error);

/* Its number as a phase: 1 for the first entry. */
uint32_t timeline_phase(const struct timeline *timeline, const struct timeline_entry *entry);

/* Adds "KEY=VALUE" to a list, in place of an earlier one of this key. */
bool timeline_put(struct timeline_texts *texts, const char *text, struct error *error);
void timeline_free_texts(struct timeline_texts *texts);

bool timeline_push(struct timeline_entry *entry, const double push[PHASE_PUSH],
                   struct error *error);

#endif
