/* tally.c - see tally.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/tally.h"

#include <math.h>
#include <stdio.h>

bool tally_create(struct tally *tally, const struct scene *scene, struct arena *arena)
{
    *tally = (struct tally){.body_count = scene->obstacle_count,
                            .screen_count = scene->screen_count};
    bool done = arena_array(arena, &tally->bodies, tally->body_count)
             && arena_array(arena, &tally->screens, tally->screen_count);
    for (uint32_t k = 0; done && k < tally->screen_count; k++) {
        struct tally_screen *screen = &tally->screens[k];
        screen->bins = scene->screens[k].bins;
        done = arena_array(arena, &screen->count, screen->bins)
            && arena_array(arena, &screen->mass, screen->bins)
            && arena_array(arena, &screen->momentum, screen->bins)
            && arena_array(arena, &screen->spin, screen->bins)
            && arena_array(arena, &screen->energy, screen->bins);
    }
    return done;
}

static bool is_behind(const struct screen *screen, double x, double y)
{
    if (screen->kind == SCREEN_LINE) return x > screen->x;
    return hypot(x - screen->center[0], y - screen->center[1]) > screen->radius;
}

bool tally_cross(struct tally *tally, const struct scene *scene, double t, double x, double y,
                 double vx, double vy, double spin, double mass, double inertia)
{
    for (uint32_t k = 0; k < tally->screen_count; k++) {
        const struct screen *screen = &scene->screens[k];
        if (!is_behind(screen, x, y)) continue;
        if (t < screen->from) return true;
        struct tally_screen *sums = &tally->screens[k];
        const double turn = atan2(y - screen->center[1], x - screen->center[0]) / (2 * M_PI) + 0.5;
        const uint32_t bin = (uint32_t)(turn * sums->bins) % sums->bins;
        sums->count[bin] += 1;
        sums->mass[bin] += mass;
        sums->momentum[bin] += mass * hypot(vx, vy);
        sums->spin[bin] += inertia * spin;
        sums->energy[bin] += 0.5 * mass * (vx * vx + vy * vy) + 0.5 * inertia * spin * spin;
        return true;
    }
    return false;
}

void tally_archive(struct tally *tally, struct archive *archive)
{
    archive_array(archive, "tally.bodies", tally->bodies, tally->body_count);
    archive_value(archive, "tally.mass_in", &tally->mass_in);
    archive_value(archive, "tally.mass_out", &tally->mass_out);
    for (uint32_t k = 0; k < tally->screen_count; k++) {
        struct tally_screen *screen = &tally->screens[k];
        double *const sums[] = {screen->count, screen->mass, screen->momentum, screen->spin,
                                screen->energy};
        for (size_t s = 0; s < sizeof sums / sizeof *sums; s++) {
            char name[48];
            snprintf(name, sizeof name, "tally.screen.%u.%zu", k, s);
            archive_array(archive, name, sums[s], screen->bins);
        }
    }
}
