/* speed.c - see speed.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "model/speed.h"

#include <math.h>

static const double deviations_greatest = 4;

double speed_at_start(const struct scene *scene, double deviations)
{
    double speed = 0;
    bool from_file = false;             /* velocities that only the grains themselves tell */
    for (uint32_t k = 0; k < scene->placement_count; k++) {
        const struct placement *p = &scene->placements[k];
        const double thermal = isfinite(p->temperature) ? deviations * sqrt(2 * p->temperature) : 0;
        speed = fmax(speed, hypot(p->velocity[0], p->velocity[1]) + thermal);
        from_file = from_file || p->kind == PLACEMENT_FILE;
    }
    for (uint32_t k = 0; from_file && k < scene->placed.count; k++) {
        speed = fmax(speed, hypot(scene->placed.vx[k], scene->placed.vy[k]));
    }
    for (uint32_t k = 0; k < scene->source_count; k++) {
        speed = fmax(speed, hypot(scene->sources[k].velocity[0], scene->sources[k].velocity[1]));
    }
    return speed;
}

static double speed_of_walls(const struct scene *scene)
{
    double speed = 0;
    for (uint32_t k = 0; k < scene->wall_count; k++) {
        const struct wall *w = &scene->walls[k];
        speed = fmax(speed, hypot(w->vx, w->vy) + fabs(w->surface_speed)
            + 2 * M_PI * w->frequency * hypot(w->amplitude_x, w->amplitude_y));
    }
    return speed;
}

double speed_greatest(const struct scene *scene)
{
    const double width = scene->box[2] - scene->box[0], height = scene->box[3] - scene->box[1];
    const double profile = 0.5 * fabs(scene->shear_rate) * height;
    double speed = speed_at_start(scene, deviations_greatest) + profile;
    for (uint32_t k = 0; k < scene->placed.count; k++) {
        speed = fmax(speed, hypot(scene->placed.vx[k], scene->placed.vy[k]));
    }
    /* A fall through the whole box: twice the depth times gravity, each axis on its own. */
    const double fall2 = 2 * fabs(scene->gravity[0]) * width
                       + 2 * fabs(scene->gravity[1]) * height;
    return sqrt(speed * speed + fall2) + speed_of_walls(scene);
}
