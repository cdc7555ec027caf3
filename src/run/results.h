/* results.h - results.csv of a study: one line for each run that ended well.
 *
 * Behind the point's values come the simulated time, the steps and the wall seconds, then of every
 * column of its log the last value and, over the time from `from` on, the mean with its error
 * (blocking, stats.h).  failed.csv has the runs that did not end well, and why.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef RESULTS_H
#define RESULTS_H

#include "run/plan.h"

/* RUN directory of a point; returns path. */
char *results_point(char path[4096], const char *directory, uint32_t point);

/* The file beside it that says why a point failed. */
char *results_cause(char path[4096], const char *directory, uint32_t point);

/* Writes both tables anew from all points of the plan that are there, whoever computed them.
 * Several processes may call this at once: a lock lets one after the other. */
bool results_write(const struct plan *plan, uint32_t count, const char *directory, double from,
                   struct error *error);

#endif
