/* wall.c - see wall.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/wall.h"

#include <math.h>

static const double full_turn = 6.283185307179586;

struct wall wall_at(const struct wall *wall, double t)
{
    struct wall placed = *wall;
    const double moved = fmin(fmax(t, wall->moves_from), wall->moves_to) - wall->moves_from;
    const bool moves = t >= wall->moves_from && t < wall->moves_to;
    const double omega = full_turn * wall->frequency, phase = omega * t;
    double dx = wall->amplitude_x * sin(phase), dy = wall->amplitude_y * sin(phase);
    /* Not 0 * INFINITY for a wall at rest whose motion would begin never. */
    if (wall->vx != 0 && isfinite(moved)) dx += wall->vx * moved;
    if (wall->vy != 0 && isfinite(moved)) dy += wall->vy * moved;
    placed.vx = (moves ? wall->vx : 0) + wall->amplitude_x * omega * cos(phase);
    placed.vy = (moves ? wall->vy : 0) + wall->amplitude_y * omega * cos(phase);
    placed.x0 += dx; placed.x1 += dx; placed.cx += dx;
    placed.y0 += dy; placed.y1 += dy; placed.cy += dy;
    return placed;
}

bool wall_present(const struct wall *wall, double t)
{
    return !(t >= wall->opens && t < wall->closes);
}

bool wall_moves(const struct wall *wall)
{
    const bool shifts = (wall->vx != 0 || wall->vy != 0) && wall->moves_to > wall->moves_from;
    const bool shakes = wall->frequency != 0 && (wall->amplitude_x != 0 || wall->amplitude_y != 0);
    return shifts || shakes;
}

bool wall_is_gate(const struct wall *wall)
{
    return wall->opens < wall->closes;
}

/* From (fx, fy) on the wall towards (x, y); `ux, uy` is the direction if both coincide. */
static struct wall_nearest towards(double fx, double fy, double x, double y, double ux, double uy,
                                   int end)
{
    const double dx = x - fx, dy = y - fy, distance = sqrt(dx * dx + dy * dy);
    if (distance == 0) return (struct wall_nearest){ux, uy, 0, end};
    return (struct wall_nearest){dx / distance, dy / distance, distance, end};
}

static struct wall_nearest segment_nearest(const struct wall *wall, double x, double y)
{
    const double sx = wall->x1 - wall->x0, sy = wall->y1 - wall->y0;
    const double length2 = sx * sx + sy * sy, length = sqrt(length2);
    const double along = ((x - wall->x0) * sx + (y - wall->y0) * sy) / length2;
    const double ux = -sy / length, uy = sx / length;           /* normal, left of the segment */
    if (!(along > 0)) return towards(wall->x0, wall->y0, x, y, ux, uy, 1);
    if (along >= 1) return towards(wall->x1, wall->y1, x, y, ux, uy, 2);
    /* The distance from the normal's projection keeps all digits close to the wall. */
    const double off = (x - wall->x0) * ux + (y - wall->y0) * uy;
    return off < 0 ? (struct wall_nearest){-ux, -uy, -off, 0} : (struct wall_nearest){ux, uy, off,
                                                                                      0};
}

static struct wall_nearest arc_nearest(const struct wall *wall, double x, double y)
{
    const double dx = x - wall->cx, dy = y - wall->cy, r = sqrt(dx * dx + dy * dy);
    const double middle = 0.5 * (wall->angle0 + wall->angle1);
    if (r == 0) {                                               /* every point is as near */
        return (struct wall_nearest){-cos(middle), -sin(middle), wall->radius, 0};
    }
    double turn = atan2(dy, dx) - middle;                       /* how far from the middle */
    turn -= full_turn * floor(turn / full_turn + 0.5);
    if (fabs(turn) <= 0.5 * (wall->angle1 - wall->angle0)) {
        const double off = r - wall->radius, sign = off < 0 ? -1 : 1;
        return (struct wall_nearest){sign * dx / r, sign * dy / r, fabs(off), 0};
    }
    return turn < 0 ? towards(wall->x0, wall->y0, x, y, dx / r, dy / r, 1)
                    : towards(wall->x1, wall->y1, x, y, dx / r, dy / r, 2);
}

struct wall_nearest wall_nearest(const struct wall *wall, double x, double y)
{
    if (wall->shape == WALL_SEGMENT) return segment_nearest(wall, x, y);
    if (wall->shape == WALL_ARC) return arc_nearest(wall, x, y);
    struct wall_nearest nearest = towards(wall->cx, wall->cy, x, y, 0, 1, 0);
    nearest.distance -= wall->radius;
    return nearest;
}

void wall_bounds(const struct wall *wall, double *x0, double *y0, double *x1, double *y1)
{
    if (wall->shape == WALL_DISC) {
        *x0 = wall->cx - wall->radius;
        *x1 = wall->cx + wall->radius;
        *y0 = wall->cy - wall->radius;
        *y1 = wall->cy + wall->radius;
        return;
    }
    *x0 = fmin(wall->x0, wall->x1);
    *x1 = fmax(wall->x0, wall->x1);
    *y0 = fmin(wall->y0, wall->y1);
    *y1 = fmax(wall->y0, wall->y1);
    if (wall->shape == WALL_SEGMENT) return;
    /* An arc also reaches out where it passes one of the four directions. */
    for (double k = ceil(wall->angle0 / (full_turn / 4)); k * full_turn / 4 <= wall->angle1; k++) {
        const int side = (int)fmod(fmod(k, 4) + 4, 4);
        if (side == 0) *x1 = wall->cx + wall->radius;
        if (side == 1) *y1 = wall->cy + wall->radius;
        if (side == 2) *x0 = wall->cx - wall->radius;
        if (side == 3) *y0 = wall->cy - wall->radius;
    }
}
