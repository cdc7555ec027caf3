/* opening.h - what most commands begin with: threads, signals, the scene with its findings told,
 * and what they end with: an error told.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef OPENING_H
#define OPENING_H

#include "cli/options.h"
#include "cli/progress.h"
#include "run/setup.h"

#include <signal.h>

/* Becomes the number of the first SIGINT or SIGTERM; a second one kills as usual. */
extern volatile sig_atomic_t opening_signal;
void opening_catch_signals(void);

/* -j: how many threads models, maps and drawing may use.  0 with an error if it is no number. */
uint32_t opening_threads(const struct options *options, struct error *error);

/* Loads operand `path` with the options' overrides, with this model instead of the scene's if
 * `model` is not NULL, and tells the findings on stderr. */
bool opening_load(struct setup *setup, const struct options *options, const char *path,
                  const char *model, bool place, struct error *error);

/* All findings on stderr. */
void opening_findings(const struct findings *findings);

/* Tells the error on stderr; returns its exit code. */
int opening_fail(const struct error *error);

/* A callback for reports and one for warnings; `context` is a struct progress. */
void opening_report(void *context, const struct run_status *status);
void opening_warn(void *context, const char *text);

/* Key group number `index`: the scene's, then the models'; NULL past the last. */
const struct key_group *opening_key_group(uint32_t index);

/* "640000 bytes" for people. */
char *opening_bytes(double bytes, char *text, size_t size);

#endif
