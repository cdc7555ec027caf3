/* parts.h - where the time of a run goes: wall and processor seconds of each part.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PARTS_H
#define PARTS_H

/* X(name, what it covers) */
#define PARTS(X)                                                \
    X(core,    "advancing the model")                           \
    X(measure, "looking at grains, maps, ranges")               \
    X(draw,    "drawing frames")                                \
    X(encode,  "compressing frames, beside the other parts")    \
    X(files,   "writing logs, maps, dumps and checkpoints")

enum part {
#define X(name, doc) PART_##name,
    PARTS(X)
#undef X
    PART_COUNT
};

struct parts {
    double wall[PART_COUNT], cpu[PART_COUNT];
    enum part now;
    double wall_mark, cpu_mark; /* when the present part began */
};

const char *parts_name(enum part part);

/* Starts the clock in `part`. */
void parts_begin(struct parts *parts, enum part part);

/* Books the time since the last call to the part it was spent in and goes over to `part`.
 * `elsewhere` is the processor time that other threads have booked themselves so far (encoders),
 * which is no part's here.  Returns the part it leaves. */
enum part parts_enter(struct parts *parts, enum part part, double elsewhere);

#endif
