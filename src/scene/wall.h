/* wall.h - a piece of solid geometry: segment, arc or disc, at rest or moving.
 *
 * Polylines, borders, rows of discs and obstacles all come down to a flat list of these, the same
 * for every model.  Segments and arcs have no thickness and stop grains on both sides; a disc is
 * solid.  Where two pieces share an end point they are `joined`, so that a grain at the joint is
 * not pushed twice.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef WALL_H
#define WALL_H

#include <stdbool.h>
#include <stdint.h>

enum wall_shape { WALL_SEGMENT, WALL_ARC, WALL_DISC };

#define WALL_NONE UINT32_MAX

struct wall {
    enum wall_shape shape;
    double x0, y0, x1, y1;      /* segment: ends; arc: its ends too (derived) */
    double cx, cy, radius;      /* arc, disc */
    double angle0, angle1;      /* arc: from, to, counter-clockwise, radians; angle1 > angle0 */
    double vx, vy;              /* constant velocity while it moves */
    double moves_from, moves_to;        /* the time in which it moves */
    double amplitude_x, amplitude_y, frequency;     /* plus a * sin(2 pi f t), f in 1/time */
    double opens, closes;       /* a gate is absent from `opens` to `closes`; INFINITY: never */
    double surface_speed;       /* tangential speed of the surface, along (x1-x0, y1-y0) or
                                 * counter-clockwise (conveyor, rotating disc) */
    uint32_t joined0, joined1;  /* the wall that shares the first, second end; WALL_NONE */
    uint32_t body;              /* index of the obstacle that it belongs to; WALL_NONE */
    uint32_t species;           /* contact parameters as if made of this species */
    bool     border;            /* one of the four sides of the box */
};

/* The wall as it stands at time t: shifted, with vx, vy its velocity at t. */
struct wall wall_at(const struct wall *wall, double t);

/* Is it there at time t (a gate that is open is not)? */
bool wall_present(const struct wall *wall, double t);

/* Does it ever move or open? */
bool wall_moves(const struct wall *wall);
bool wall_is_gate(const struct wall *wall);

/* Where the wall (already placed by wall_at) is nearest to a point. */
struct wall_nearest {
    double nx, ny;              /* unit vector from the wall towards the point */
    double distance;            /* from the wall's surface; negative inside a disc */
    int    end;                 /* 0: in its interior; 1, 2: at its first, second end */
};
struct wall_nearest wall_nearest(const struct wall *wall, double x, double y);

/* Smallest axis-parallel box around the wall as placed. */
void wall_bounds(const struct wall *wall, double *x0, double *y0, double *x1, double *y1);

#endif
