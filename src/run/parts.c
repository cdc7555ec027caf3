/* parts.c - see parts.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/parts.h"

#include "base/clock.h"

static const char *const names[] = {
#define X(name, doc) #name,
    PARTS(X)
#undef X
};

const char *parts_name(enum part part) { return names[part]; }

void parts_begin(struct parts *parts, enum part part)
{
    *parts = (struct parts){.now = part, .wall_mark = clock_wall(), .cpu_mark = clock_process()};
}

enum part parts_enter(struct parts *parts, enum part part, double elsewhere)
{
    const enum part left = parts->now;
    const double wall = clock_wall(), cpu = clock_process() - elsewhere;
    parts->wall[left] += wall - parts->wall_mark;
    if (cpu > parts->cpu_mark) {        /* a job booked late must not make time run backwards */
        parts->cpu[left] += cpu - parts->cpu_mark;
        parts->cpu_mark = cpu;
    }
    parts->wall_mark = wall;
    parts->now = part;
    return left;
}
