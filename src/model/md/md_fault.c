/* md_fault.c - see md_fault.h.
 *
 * The contact loop counts overlaps that could be too large even for the smallest grain; only
 * when there is one are all contacts looked at, where they were when the force was computed.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_fault.h"

#include <math.h>
#include <stdio.h>

static void blame(struct md *md, uint32_t i)
{
    const struct grain *g = &md->grains[i];
    md->broken = true;
    md->fault = (struct fault){.time = md_time(md), .x = g->x, .y = g->y, .grain = md->tags[i].id};
}

static bool blame_number(struct md *md)
{
    for (uint32_t i = 0; i < md->count; i++) {
        const struct grain *g = &md->grains[i];
        if (isfinite(g->x) && isfinite(g->y) && isfinite(g->ux) && isfinite(g->uy)) continue;
        blame(md, i);
        snprintf(md->fault.text, sizeof md->fault.text, "t = %g: grain %u at (%g, %g) moves at "
                 "(%g, %g), which is no number; the time step is too long for the contact: "
                 "delete md.dt and sandreel chooses, or divide md.dt = %g by ten",
                 md->fault.time, md->tags[i].id, g->x, g->y, g->ux, g->uy, md->dt);
        return false;
    }
    return true;
}

/* A grain that goes further than a radius in a step can be on the other side of a wall or of a
 * grain without ever having touched it, and nothing else would tell. */
static bool blame_speed(struct md *md)
{
    uint32_t fastest = 0;
    double most = -1;
    for (uint32_t i = 0; i < md->count; i++) {
        const double speed = hypot(md->grains[i].ux, md->grains[i].uy);
        if (speed > most) fastest = i;
        most = fmax(most, speed);
    }
    blame(md, fastest);
    snprintf(md->fault.text, sizeof md->fault.text, "t = %g: grain %u at (%.6g, %.6g) goes %.3g of "
             "the smallest radius in a time step at speed %.4g (walls: %.4g) and may pass others "
             "unseen; make md.dt = %g smaller, or delete it and set md.speed", md->fault.time,
             md->fault.grain, md->fault.x, md->fault.y, md->stride / md->scene->radius_min, most,
             md->wall_speed, md->dt);
    return false;
}

/* Where the grain was when the last forces were computed. */
static void place_before(const struct md *md, uint32_t i, double *x, double *y)
{
    *x = md->grains[i].x - (md->gears ? 0 : md->dt * md->halves[i].hx);
    *y = md->grains[i].y - (md->gears ? 0 : md->dt * md->halves[i].hy);
}

static bool blame_overlap(struct md *md, uint32_t i, double share, const char *with)
{
    blame(md, i);
    snprintf(md->fault.text, sizeof md->fault.text, "t = %g: grain %u at (%.6g, %.6g) overlaps %s "
             "by %.3g of a radius, more than overlap_limit = %g; make the grains stiffer "
             "(md.overlap, grains.stiffness), or md.dt = %g smaller if a grain was too fast for it",
             md->fault.time, md->fault.grain, md->fault.x, md->fault.y, with, share,
             md->scene->overlap_limit, md->dt);
    return false;
}

/* A gate that has just come back into a grain: neither stiffness nor time step would help. */
static bool blame_gate(struct md *md, uint32_t i, uint32_t w, double share)
{
    blame(md, i);
    snprintf(md->fault.text, sizeof md->fault.text, "t = %g: wall %u, a gate, shut at t = %g while "
             "grain %u at (%.6g, %.6g) was in it, %.3g of a radius deep; let it shut (`closes`) "
             "when nothing is in the way, or move a wall in from the side", md->fault.time, w,
             md->scene->walls[w].closes, md->fault.grain, md->fault.x, md->fault.y, share);
    return false;
}

/* Within the steps that a hard push needs to be noticed. */
static bool has_just_shut(const struct md *md, uint32_t w)
{
    const struct wall *wall = &md->scene->walls[w];
    const double since = md_time(md) - wall->closes;
    return wall_is_gate(wall) && since >= -md->dt && since <= 3 * md->dt;
}

static bool check_overlaps(struct md *md)
{
    const double limit = md->scene->overlap_limit;
    for (uint32_t k = 0; k < md->link_count; k++) {
        const struct link link = md->links[k];
        if (!(link.j & LINK_TOUCHES)) continue;
        const uint32_t j = link.j & LINK_INDEX, image = link.j >> LINK_IMAGE_SHIFT & 15;
        double xi, yi, xj, yj;
        place_before(md, link.i, &xi, &yi);
        place_before(md, j, &xj, &yj);
        const double dx = xi - xj - md->image_x[image], dy = yi - yj - md->image_y[image];
        const double ri = md_radius(md, link.i), rj = md_radius(md, j);
        const double share = (ri + rj - hypot(dx, dy)) / fmin(ri, rj);
        if (share <= limit) continue;
        char with[48];
        snprintf(with, sizeof with, "grain %u", md->tags[j].id);
        return blame_overlap(md, link.i, share, with);
    }
    for (uint32_t k = 0; k < md->wall_link_count; k++) {
        const struct wall_link *link = &md->wall_links[k];
        if (!link->touches) continue;
        double x, y;
        place_before(md, link->grain, &x, &y);
        const struct wall_nearest nearest = wall_nearest(&md->walls_now[link->wall],
            x - md->image_x[link->image], y - md->image_y[link->image]);
        const double share = 1 - nearest.distance / md_radius(md, link->grain);
        if (!(share > limit)) continue;
        return has_just_shut(md, link->wall) ? blame_gate(md, link->grain, link->wall, share)
                                             : blame_overlap(md, link->grain, share, "a wall");
    }
    return true;
}

bool md_fault_check(struct md *md)
{
    if (md->broken) return blame_number(md) && false;
    if (md->suspects > 0 && !check_overlaps(md)) return false;
    return md->stride <= md->scene->radius_min || blame_speed(md);
}

bool md_fault_escaped(struct md *md)
{
    const struct scene *scene = md->scene;
    const double *box = scene->box;
    if (!(md->effects & EFFECT_WALLS)) return true;
    for (uint32_t i = 0; i < md->count; i++) {
        const struct grain *g = &md->grains[i];
        const double room = 2 * md_radius(md, i);
        const bool out = (scene->left == BORDER_WALL && g->x < box[0] - room)
                      || (scene->right == BORDER_WALL && g->x > box[2] + room)
                      || (scene->bottom == BORDER_WALL && g->y < box[1] - room)
                      || (scene->top == BORDER_WALL && g->y > box[3] + room);
        if (!out || md->tags[i].gone) continue;
        blame(md, i);
        snprintf(md->fault.text, sizeof md->fault.text, "t = %g: grain %u got through the border "
                 "to (%.6g, %.6g); it was too fast for the time step: make md.dt = %g smaller, "
                 "or the grains stiffer (md.overlap)", md->fault.time, md->tags[i].id,
                 g->x, g->y, md->dt);
        return false;
    }
    return true;
}
