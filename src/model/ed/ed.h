/* ed.h - the state of the event-driven model, and its story in brief.
 *
 * Hard discs fly freely until two of them touch or one touches a wall; nothing happens in
 * between, so the model jumps from event to event.
 *
 *   - A grain's record holds where it would have been at the epoch, the zero of the model's own
 *     clock, had it always flown as it flies now: x(t) = x + vx t.  Gravity is the same for all
 *     and drops out of every pair; only walls and cells see the parabola.  Every so many events
 *     the epoch moves up to the present (ed_epoch.c), so no digits are lost on long runs.
 *   - Each grain owns one event, its soonest: a contact with a partner, or leaving its cell.
 *     A partner that was deflected in the meantime is found out when the event is due.
 *   - Cells as wide as a grain limit who can be met (ed_cells.h); a calendar of buckets keeps the
 *     events in order (ed_queue.h); both only speed things up.  Events at the same time go by the
 *     grain's index, so the future is a function of the archived arrays and nothing else.
 *   - ed_kernel.h is the loop over events, compiled for each set of effects, and for AVX2 too.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_H
#define ED_H

#include "model/ed/ed_cells.h"
#include "model/ed/ed_law.h"
#include "model/ed/ed_queue.h"
#include "model/ed/ed_settings.h"
#include "model/ed/ed_walls.h"
#include "model/model.h"
#include "model/source.h"

/* Where a grain flies; see above. */
struct ed_grain { double x, y, vx, vy; };

struct ed;

/* Partners of a contact that are not grains have this bit set (ed_walls.h). */
#define ED_SOLID 0x80000000u
#define ED_NOBODY UINT32_MAX

/* A grain's soonest event: the contact if contact <= due, else it leaves cell (cx, cy). */
struct ed_event {
    double   contact, due;      /* since the epoch; INFINITY: never */
    uint32_t partner;
    uint16_t cx, cy;
    double   last;              /* its last contact, for the TC rule */
};

/* The clock and all else that is one number, archived as a whole: only 8-byte members. */
struct ed_clock {
    double   epoch, epoch_low;  /* scene time of the epoch; the second holds the lost digits */
    double   now;               /* time of the last event, since the epoch */
    double   present;           /* scene time that the run has reached */
    double   epoch_end;         /* the epoch moves up when `now` passes this */
    double   noise;             /* a velocity below this is rounding */
    double   typical, pace;     /* speeds: of the grains now; expected of the scene (ed_epoch.c) */
    double   stuck_mark;        /* when `now` passes this, time is not stuck */
    double   stuck_step;        /* how far the mark then moves on */
    uint64_t stuck_events;      /* events since the mark was set */
    uint64_t epoch_events;      /* events since the epoch */
    uint64_t events, crossings, stale, collisions, elastic, wall_contacts, epochs;
    uint64_t grains_in, grains_out, refused;
    double   gx, gy;            /* gravity under which the grains fly */
    double   rate_from;         /* scene time at which the window of the collision rate began */
    double   retry;             /* scene time before which waiting grains do not try again */
    uint64_t fingerprint;       /* of what the predictions were made for */
    double   shear_speed;       /* of the image above (ed_shear.h) */
    double   ahead;             /* how far it is ahead along x at the epoch */
    double   slide;             /* when it has slid by a cell, since the epoch */
    int64_t  ahead_cells;       /* until then it is so many whole cells ahead */
};

/* So many events must bring the clock on by stuck_step.  Touching discs that are set in motion at
 * once have a few events each; a chain that collapses makes 1e5 among a handful of discs; a blow
 * at the end of a row or a column of N that touch makes N (N - 1) / 2 at one moment.  Rows of more
 * than 2000 are not waited for. */
static inline uint64_t ed_stuck_events(uint32_t count)
{
    const uint64_t row = count < 2000 ? count : 2000;
    return 100000 + 20ull * count + row * row / 2;
}

/* Why the loop over events came back. */
enum ed_stop { ED_LIMIT, ED_BUDGET, ED_EPOCH, ED_STUCK };

enum { ED_KERNEL_SIZES = 1, ED_KERNEL_SOLIDS = 2, ED_KERNEL_SPINS = 4, ED_KERNEL_COUNT = 8 };

/* The loop over events, compiled for every set of these three: grains of several sizes; walls,
 * gravity, sensors or open borders; spins. */
struct ed_kernels {
    void (*predict_one)(struct ed *ed, uint32_t i);
    enum ed_stop (*run[ED_KERNEL_COUNT])(struct ed *ed, double limit, uint64_t *budget);
};

extern const struct ed_kernels ed_kernel_portable, ed_kernel_avx2;

struct ed {
    const struct scene *scene;
    struct ed_settings settings;
    effects_t effects;
    struct arena arena;

    /* All arrays by grain have one place more than count_max, to exchange grains through. */
    uint32_t count, count_max;
    struct ed_grain *grains;    /* count_max is nowhere (NAN): it fills up lists */
    struct ed_event *events;
    uint32_t *id;
    uint16_t *species;          /* with several species */
    double   *radius, *mass;    /* with POLYDISPERSE or MIXTURE */
    double   *spin, *angle;     /* with ROTATION; the angle at the epoch */
    uint32_t *contacts;         /* with COLLISION_RATE: begun in this window */
    float    *rate;             /* and in the last whole one, per time */
    uint32_t *begun, *elastic;  /* with COLLISION_COUNT: contacts since the start, elastic ones */
    bool      watches;          /* the scene wants something counted (ed_watch.h) */
    uint32_t next_id;
    uint32_t *order, *place;    /* for sorting */

    double   radius_one, mass_one;      /* where all grains are alike */
    double   diameter2;
    double   gx, gy;
    double   wrap_x, wrap_y, unwrap_x, unwrap_y;        /* period and its inverse; 0: none */
    bool     sheared;           /* the image above is, or may come, ahead */
    struct ed_law   law;
    struct ed_cells cells;
    struct ed_queue queue;
    struct ed_walls walls;
    struct ed_clock clock;
    struct tally    tally;
    struct source_cursor *cursors;      /* with INFLOW, one for each source */
    struct source_grain  *batch;
    uint32_t batch_max;
    struct fault    fault;
    const struct ed_kernels *kernels;
    uint32_t kernel;            /* the one of them for this scene */
};

static inline double ed_radius(const struct ed *ed, uint32_t i)
{
    return ed->radius ? ed->radius[i] : ed->radius_one;
}

static inline double ed_mass(const struct ed *ed, uint32_t i)
{
    return ed->mass ? ed->mass[i] : ed->mass_one;
}

static inline uint32_t ed_species(const struct ed *ed, uint32_t i)
{
    return ed->species ? ed->species[i] : 0;
}

/* Scene time to time since the epoch, and back. */
static inline double ed_since_epoch(const struct ed_clock *clock, double t)
{
    return (t - clock->epoch) - clock->epoch_low;
}

static inline double ed_scene_time(const struct ed_clock *clock, double t)
{
    return clock->epoch + (clock->epoch_low + t);
}

#endif
