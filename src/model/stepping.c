/* stepping.c - see stepping.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/stepping.h"

#include <math.h>
#include <stdio.h>

uint32_t stepping_room(const struct scene *scene)
{
    const uint32_t room = scene->count_max > scene->placed.count ? scene->count_max
                                                                 : scene->placed.count;
    return room > 0 ? room : 1;
}

bool stepping_left(const struct scene *scene, double x, double y, double radius)
{
    const double *box = scene->box, far = 2 * radius;
    if ((scene->left == BORDER_OPEN && x < box[0] - far)
        || (scene->right == BORDER_OPEN && x > box[2] + far)
        || (scene->bottom == BORDER_OPEN && y < box[1] - far)
        || (scene->top == BORDER_OPEN && y > box[3] + far)) return true;
    for (uint32_t k = 0; k < scene->sink_count; k++) {
        const double *r = scene->sinks[k].region;
        if (x >= r[0] && y >= r[1] && x <= r[2] && y <= r[3]) return true;
    }
    return false;
}

double stepping_window(const struct scene *scene, double dt)
{
    if (isfinite(scene->measure.collision_window)) return scene->measure.collision_window;
    return scene->output.frames > 0 ? scene->output.frames : 100 * dt;
}

/* Time counts from 0 and goes on; a clock far back would let the run take steps without end. */
static bool clock_holds(struct stepping_clock clock, double dt)
{
    const double time = *clock.epoch + (double)*clock.here * dt;
    return dt > 0 && isfinite(dt) && *clock.epoch >= 0 && isfinite(time);
}

double stepping_archive(struct archive *archive, const char *model, double dt,
                        struct stepping_clock clock)
{
    char name[48];
    double old = dt;
    snprintf(name, sizeof name, "%s.dt", model);
    archive_value(archive, name, &old);
    snprintf(name, sizeof name, "%s.epoch", model);
    archive_value(archive, name, clock.epoch);
    snprintf(name, sizeof name, "%s.steps", model);
    archive_value(archive, name, clock.steps);
    snprintf(name, sizeof name, "%s.steps_here", model);
    archive_value(archive, name, clock.here);
    if (archive->mode == ARCHIVE_LOAD && !archive->failed && !clock_holds(clock, old)) {
        archive_fail(archive, "the saved clock does not show a time");
        return dt;
    }
    if (old == dt) return dt;
    *clock.epoch += (double)*clock.here * old;
    *clock.here = 0;
    return old;
}
