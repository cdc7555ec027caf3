/* writer.h - what a run writes while it goes: frames, dumps, maps, log rows, histograms, a
 * trajectory, a movie.
 *
 * Every output has its own interval in simulated time and happens at whole multiples of it; all
 * of it only looks at the simulation.  When the colours of the frames are only known after the
 * whole run, the grains are dumped and the frames drawn at the end.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef WRITER_H
#define WRITER_H

#include "measure/stress.h"
#include "model/simulation.h"
#include "run/dumps.h"
#include "run/encoder.h"
#include "run/film.h"
#include "run/histograms.h"
#include "run/h5md.h"
#include "run/logbook.h"
#include "run/mapper.h"
#include "run/movie.h"
#include "run/parts.h"

enum writer_event {
    WRITER_FRAME, WRITER_LOG, WRITER_MAP, WRITER_TALLY, WRITER_TRAJECTORY, WRITER_EVENTS
};

struct schedule {
    double   interval;          /* 0: never */
    double   from, to;          /* first event not before `from`, none after `to` */
    uint64_t next;              /* the coming event is at next * interval */
};

struct writer {
    const struct simulation *sim;
    char directory[4096];
    struct schedule schedules[WRITER_EVENTS];
    struct parts   *parts;
    struct encoder *encoder;
    struct movie   *movie;      /* fed while running; NULL: none, or made afterwards */
    struct logbook  logbook;
    struct film     film;
    struct histograms histograms;
    struct mapper   mapper;
    struct stress  *stress;     /* NULL: no maps of it */
    struct dumps    dumps;
    struct h5md    *h5md;       /* the trajectory; NULL: none */
    struct grains   grains;
    bool   draws;               /* frames are wanted */
    bool   draws_later;         /* ... but only once the whole run is known */
    bool   keeps_grains;        /* grains are dumped at each frame */
    bool   averages;            /* one mean map instead of snapshots */
    bool   movie_late;          /* the movie is put together after the run */
    uint64_t maps;              /* written */
};

bool writer_open(struct writer *writer, const struct simulation *sim, const char *directory,
                 uint32_t encoders, bool resume, struct parts *parts, struct error *error);

/* After the archive was loaded: cuts back what was written after the checkpoint, and looks again
 * at the frames before it. */
bool writer_resume(struct writer *writer, struct error *error);

/* The time of the soonest output after the last served one; INFINITY when there is none. */
double writer_due(const struct writer *writer);

/* Writes all that is due at t. */
bool writer_serve(struct writer *writer, double t, double wall, struct error *error);

/* Everything queued is on the disk, with its names (before a checkpoint refers to it). */
bool writer_sync(struct writer *writer, struct error *error);

/* After the run: the frames that had to wait, the movie.  `step` (may be NULL) is called after
 * each frame and stops the drawing by returning false, with the error filled. */
bool writer_finish(struct writer *writer, double wall, bool (*step)(void *, uint64_t, uint64_t),
                   void *context, struct error *error);

/* Removes what only the run itself needed, once the manifest tells that it is done. */
void writer_tidy(const struct writer *writer);

void writer_archive(struct writer *writer, struct archive *archive);
void writer_close(struct writer *writer);

#endif
