/* bench_live.h - what it costs to be watched, and how soon one sees.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef BENCH_LIVE_H
#define BENCH_LIVE_H

#include "base/error.h"

enum bench_live_what { BENCH_LIVE_PICTURES, BENCH_LIVE_DELAY, BENCH_LIVE_KEPT };

/* 20,000 frictional discs in 1280 x 720, simulated as fast as it goes.  PICTURES: pictures a second
 * that a viewer can have; DELAY: milliseconds from a command to its picture; KEPT: the speed of the
 * simulation with a viewer of 10 pictures a second over that without, in turns, the median. */
bool bench_live(enum bench_live_what what, double *value, struct error *error);

#endif
