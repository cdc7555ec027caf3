/* ed_walls.h - all that a grain can meet besides grains: walls, their ends, sinks and screens.
 *
 * A grain's path is a parabola (a straight line without gravity), a wall stands still or moves at
 * constant velocity, so every meeting is the root of a polynomial in time.  Walls start, stop,
 * open and close only at the times of a list, and at each of them everything is predicted anew.
 *
 * The partner of such a contact is a word: ED_SOLID, a part, and an index.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_WALLS_H
#define ED_WALLS_H

#include "base/arena.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

struct ed;
struct ed_cells;

enum ed_part { ED_PART_FACE, ED_PART_FIRST_END, ED_PART_SECOND_END, ED_PART_SINK, ED_PART_SCREEN };

enum { ED_PART_SHIFT = 28, ED_INDEX_MASK = (1 << ED_PART_SHIFT) - 1 };

static inline enum ed_part ed_partner_part(uint32_t partner)
{
    return (enum ed_part)(partner >> ED_PART_SHIFT & 7);
}

static inline uint32_t ed_partner_index(uint32_t partner) { return partner & ED_INDEX_MASK; }

/* A wall as it is between two times of the list. */
struct ed_wall {
    double dx, dy;              /* its shift at the epoch */
    double vx, vy;
    bool   present, ends[2];    /* does it answer for its ends? */
};

struct ed_walls {
    uint32_t count;
    const struct wall *walls;   /* the scene's */
    struct ed_wall *now;
    uint32_t *start, *list;     /* by cell: walls within reach are list[start[c] .. start[c+1]) */
    uint32_t change_count, change;      /* times at which walls change; the next one */
    double  *changes;
    bool     sensors;           /* there are sinks or screens */
};

/* The motion of a grain relative to something, from the present on: p + v s + a s^2 / 2. */
struct ed_path { double x, y, vx, vy, ax, ay; };

/* How a grain touches a wall. */
struct ed_touch {
    double nx, ny;              /* from the wall to the grain */
    double gap;
    double vn, vt;              /* of the grain against the wall, along n and t = (-ny, nx) */
    double press;               /* how fast vn falls in free flight: weight and curvature */
    double x, y;                /* the point of contact */
};

bool ed_walls_list_create(struct ed_walls *walls, const struct scene *scene,
                     const struct ed_cells *cells, double margin, struct arena *arena);

/* Brings shifts and presence up to the epoch and the next change. */
void ed_walls_list_refresh(struct ed *ed);

/* The soonest meeting of grain i within (now, now + s_max], as a time since the present; INFINITY
 * if there is none.  `partner` tells with what. */
double ed_walls_meet(const struct ed *ed, uint32_t i, double s_max, uint32_t *partner);

/* How grain i touches the wall `partner` now, and whether it really comes nearer. */
bool ed_walls_touch(const struct ed *ed, uint32_t i, uint32_t partner, struct ed_touch *touch);

/* Along which way the wall's surface moves at a touch, as a factor along t: surface_speed counts
 * from its first to its second end, or counter-clockwise. */
double ed_walls_surface(const struct ed *ed, uint32_t wall, const struct ed_touch *touch);

struct ed_path ed_walls_path(const struct ed *ed, uint32_t i);

#endif
