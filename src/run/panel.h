/* panel.h - one or several films side by side in one movie.
 *
 * A panel is a scene under one model, or a run.  If the colours need the whole film first, every
 * panel is recorded (dumped beside the movie, removed afterwards) and then drawn, all with the
 * same range where they show the same quantity.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PANEL_H
#define PANEL_H

#include "run/film.h"
#include "run/movie.h"
#include "run/footage.h"

enum { PANEL_MAX = 8 };

struct panel {
    const struct setup *setup;
    struct footage footage;
    struct film   film;
    struct dumps  record;       /* what was seen, when colours need the whole film first */
    double       *walls;        /* seconds spent until each frame */
    uint32_t      frames;
};

struct panel_request {
    struct panel *panels;       /* setup, source and film are open */
    uint32_t count;
    const char *path;           /* of the movie */
    double interval;            /* between frames, simulated time */
    double frame_rate;
    void (*report)(void *context, const struct run_status *status);     /* may be NULL */
    void  *context;
    const volatile sig_atomic_t *signal;        /* may be NULL */
};

/* Films from t = 0 to the latest end of any panel; one that has ended stays at its last frame. */
bool panel_film(const struct panel_request *request, uint64_t *frames, struct error *error);

#endif
