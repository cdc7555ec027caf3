/* ed_walls.c - see ed_walls.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_walls.h"

#include "model/ed/ed.h"
#include "model/ed/ed_root.h"

#include <math.h>
#include <stdlib.h>

static const double full_turn = 6.283185307179586;

/* Less than this share of gravity does not press a grain on a wall: a vertical wall whose normal
 * is off by rounding. */
static const double press_least = 1e-9;

struct ed_path ed_walls_path(const struct ed *ed, uint32_t i)
{
    const struct ed_grain *g = &ed->grains[i];
    const double t = ed->clock.now;
    return (struct ed_path){
        g->x + t * (g->vx + 0.5 * ed->gx * t), g->y + t * (g->vy + 0.5 * ed->gy * t),
        g->vx + ed->gx * t, g->vy + ed->gy * t, ed->gx, ed->gy
    };
}

/* The path seen from a wall that moves. */
static struct ed_path relative(struct ed_path path, const struct ed_wall *wall, double now)
{
    path.x -= wall->dx + wall->vx * now;
    path.y -= wall->dy + wall->vy * now;
    path.vx -= wall->vx;
    path.vy -= wall->vy;
    return path;
}

static struct ed_path from_point(struct ed_path path, double x, double y)
{
    path.x -= x;
    path.y -= y;
    return path;
}

/* The one sign test of walls, for prediction and collision alike: does a gap that changes at
 * speed vn and is pressed shut with acceleration `press` close? */
static bool closes(const struct ed *ed, double vn, double press)
{
    if (vn < -ed->clock.noise) return true;
    const double g = fabs(ed->gx) + fabs(ed->gy);
    return vn <= ed->clock.noise && press > press_least * g && press > 0;
}

static bool within_arc(const struct wall *wall, double x, double y)
{
    const double middle = 0.5 * (wall->angle0 + wall->angle1);
    double turn = atan2(y, x) - middle;
    turn -= full_turn * floor(turn / full_turn + 0.5);
    return fabs(turn) <= 0.5 * (wall->angle1 - wall->angle0);
}

/* When the gap f0 + f1 s + f2 s^2 / 2 falls through zero; INFINITY if never. */
static double gap_shuts(const struct ed *ed, double f0, double f1, double f2)
{
    const double q = f1 * f1 - 2 * f2 * f0, root = sqrt(fmax(q, 0));
    if (q < 0) return INFINITY;
    double s = INFINITY;
    if (f1 < 0) s = 2 * f0 / (root - f1);
    else if (f2 < 0) s = (f1 + root) / -f2;
    if (s < 0 || !closes(ed, -root, -f2)) return INFINITY;
    return s;
}

/* The face of a segment, from both sides. */
static double segment_meets(const struct ed *ed, const struct wall *wall, struct ed_path path,
                            double reach)
{
    const double sx = wall->x1 - wall->x0, sy = wall->y1 - wall->y0;
    const double length = sqrt(sx * sx + sy * sy), tx = sx / length, ty = sy / length;
    const struct ed_path p = from_point(path, wall->x0, wall->y0);
    const double h = -ty * p.x + tx * p.y, along = tx * p.x + ty * p.y;
    double soonest = INFINITY;
    for (int side = -1; side <= 1; side += 2) {
        const double nx = -ty * side, ny = tx * side;
        double gap = h * side - reach;
        /* Beside the segment on this side an overlap can only be rounding: it touches. */
        if (h * side > 0 && along >= 0 && along <= length) gap = fmax(gap, 0);
        const double s = gap_shuts(ed, gap, nx * p.vx + ny * p.vy, nx * p.ax + ny * p.ay);
        if (!(s < soonest)) continue;
        const double foot = along + s * (tx * p.vx + ty * p.vy + 0.5 * s * (tx * p.ax + ty * p.ay));
        if (foot >= 0 && foot <= length) soonest = s;
    }
    return soonest;
}

/* Is a circle about the origin farther away than the path can go in s_max? */
static bool stays_off(const struct ed_path *p, double rho, double s_max)
{
    const double way = s_max * (fabs(p->vx) + fabs(p->vy)
                                + 0.5 * s_max * (fabs(p->ax) + fabs(p->ay)));
    const double near = rho + way;
    return p->x * p->x + p->y * p->y > near * near * (1 + 1e-12);
}

/* A circle about the origin, of radius rho for the grain's centre, from outside (sign 1) or inside
 * (-1); `arc` restricts the angle (NULL: none). */
static double circle_meets(const struct ed *ed, const struct wall *arc, struct ed_path p,
                           double rho, int sign, double s_max, bool touching)
{
    if (sign > 0 && stays_off(&p, rho, s_max)) return INFINITY;
    double c[5] = {
        sign * (p.x * p.x + p.y * p.y - rho * rho),
        sign * 2 * (p.x * p.vx + p.y * p.vy),
        sign * (p.vx * p.vx + p.vy * p.vy + p.x * p.ax + p.y * p.ay),
        sign * (p.vx * p.ax + p.vy * p.ay),
        sign * 0.25 * (p.ax * p.ax + p.ay * p.ay)
    };
    if (touching) c[0] = fmax(c[0], 0);
    double times[ED_ROOT_MAX];
    const int n = ed_root_falls(c, 4, s_max, times);
    for (int k = 0; k < n; k++) {
        const double s = times[k];
        const double vn = (c[1] + s * (2 * c[2] + s * (3 * c[3] + s * 4 * c[4]))) / (2 * rho);
        const double press = -(2 * c[2] + s * (6 * c[3] + s * 12 * c[4])) / (2 * rho);
        if (!closes(ed, vn, press)) continue;
        if (arc && !within_arc(arc, p.x + s * (p.vx + 0.5 * s * p.ax),
                               p.y + s * (p.vy + 0.5 * s * p.ay))) continue;
        return s;
    }
    return INFINITY;
}

static double arc_meets(const struct ed *ed, const struct wall *wall, struct ed_path path,
                        double reach, double s_max)
{
    const struct ed_path p = from_point(path, wall->cx, wall->cy);
    const double r2 = p.x * p.x + p.y * p.y;
    const bool beside = within_arc(wall, p.x, p.y), outside = r2 >= wall->radius * wall->radius;
    double soonest = circle_meets(ed, wall, p, wall->radius + reach, 1, s_max, beside && outside);
    if (reach < wall->radius) {
        soonest = fmin(soonest, circle_meets(ed, wall, p, wall->radius - reach, -1, s_max,
                                             beside && !outside));
    }
    return soonest;
}

static double face_meets(const struct ed *ed, const struct wall *wall, struct ed_path path,
                         double reach, double s_max)
{
    if (wall->shape == WALL_SEGMENT) return segment_meets(ed, wall, path, reach);
    if (wall->shape == WALL_ARC) return arc_meets(ed, wall, path, reach, s_max);
    return circle_meets(ed, NULL, from_point(path, wall->cx, wall->cy), wall->radius + reach, 1,
                        s_max, true);
}

static double end_meets(const struct ed *ed, const struct wall *wall, int end, struct ed_path path,
                        double reach, double s_max)
{
    const struct ed_path p = end == 0 ? from_point(path, wall->x0, wall->y0)
                                      : from_point(path, wall->x1, wall->y1);
    return circle_meets(ed, NULL, p, reach, 1, s_max, true);
}

/* When the centre enters a sink's rectangle; 0 if it is inside. */
static double sink_meets(const struct sink *sink, struct ed_path p)
{
    const double *r = sink->region;
    if (p.x >= r[0] && p.x <= r[2] && p.y >= r[1] && p.y <= r[3]) return 0;
    double soonest = INFINITY;
    for (int side = 0; side < 4; side++) {
        const bool x = side % 2 == 0;
        const double sign = side < 2 ? 1 : -1;          /* left and bottom sides, right and top */
        const double c[3] = {sign * (r[side] - (x ? p.x : p.y)), -sign * (x ? p.vx : p.vy),
                             -0.5 * sign * (x ? p.ax : p.ay)};
        double times[ED_ROOT_MAX];
        const int n = ed_root_falls(c, 2, INFINITY, times);
        for (int k = 0; k < n && times[k] < soonest; k++) {
            const double s = times[k];
            const double other = x ? p.y + s * (p.vy + 0.5 * s * p.ay)
                                   : p.x + s * (p.vx + 0.5 * s * p.ax);
            if (other >= r[x ? 1 : 0] && other <= r[x ? 3 : 2]) soonest = s;
        }
    }
    return soonest;
}

static double screen_meets(const struct screen *screen, struct ed_path path, double s_max)
{
    double c[5] = {screen->x - path.x, -path.vx, -0.5 * path.ax, 0, 0}, times[ED_ROOT_MAX];
    if (screen->kind == SCREEN_CIRCLE) {
        const struct ed_path p = from_point(path, screen->center[0], screen->center[1]);
        c[0] = screen->radius * screen->radius - p.x * p.x - p.y * p.y;
        c[1] = -2 * (p.x * p.vx + p.y * p.vy);
        c[2] = -(p.vx * p.vx + p.vy * p.vy + p.x * p.ax + p.y * p.ay);
        c[3] = -(p.vx * p.ax + p.vy * p.ay);
        c[4] = -0.25 * (p.ax * p.ax + p.ay * p.ay);
    }
    if (c[0] < 0) return 0;
    return ed_root_falls(c, 4, s_max, times) > 0 ? times[0] : INFINITY;
}

static double sensors_meet(const struct ed *ed, struct ed_path path, double s_max,
                           uint32_t *partner)
{
    const struct scene *scene = ed->scene;
    double soonest = INFINITY;
    for (uint32_t k = 0; k < scene->sink_count; k++) {
        const double s = sink_meets(&scene->sinks[k], path);
        if (!(s < soonest)) continue;
        soonest = s;
        *partner = ED_SOLID | (uint32_t)ED_PART_SINK << ED_PART_SHIFT | k;
    }
    for (uint32_t k = 0; k < scene->screen_count; k++) {
        const double s = screen_meets(&scene->screens[k], path, s_max);
        if (!(s < soonest)) continue;
        soonest = s;
        *partner = ED_SOLID | (uint32_t)ED_PART_SCREEN << ED_PART_SHIFT | k;
    }
    return soonest;
}

double ed_walls_meet(const struct ed *ed, uint32_t i, double s_max, uint32_t *partner)
{
    const struct ed_walls *walls = &ed->walls;
    const struct ed_event *event = &ed->events[i];
    if (!walls->start) return INFINITY;
    const uint32_t cell = ed_cells_index(&ed->cells, event->cx, event->cy);
    const uint32_t from = walls->start[cell], to = walls->start[cell + 1];
    if (from == to && !walls->sensors) return INFINITY;
    const struct ed_path path = ed_walls_path(ed, i);
    const double reach = ed_radius(ed, i);
    double soonest = walls->sensors ? sensors_meet(ed, path, s_max, partner) : INFINITY;
    for (uint32_t k = from; k < to; k++) {
        const uint32_t w = walls->list[k];
        const struct ed_wall *now = &walls->now[w];
        if (!now->present) continue;
        const struct wall *wall = &walls->walls[w];
        const struct ed_path p = relative(path, now, ed->clock.now);
        for (int part = ED_PART_FACE; part <= ED_PART_SECOND_END; part++) {
            if (part != ED_PART_FACE && !now->ends[part - 1]) continue;
            const double most = fmin(s_max, soonest);
            const double s = part == ED_PART_FACE ? face_meets(ed, wall, p, reach, most)
                                                  : end_meets(ed, wall, part - 1, p, reach, most);
            if (!(s < soonest)) continue;
            soonest = s;
            *partner = ED_SOLID | (uint32_t)part << ED_PART_SHIFT | w;
        }
    }
    return soonest <= s_max ? soonest : INFINITY;
}

bool ed_walls_touch(const struct ed *ed, uint32_t i, uint32_t partner, struct ed_touch *touch)
{
    const uint32_t w = ed_partner_index(partner);
    const struct wall *wall = &ed->walls.walls[w];
    const struct ed_wall *now = &ed->walls.now[w];
    const enum ed_part part = ed_partner_part(partner);
    const struct ed_path path = relative(ed_walls_path(ed, i), now, ed->clock.now);
    const double radius = ed_radius(ed, i);
    double curvature = 0;                       /* of the centre's path while in contact */
    if (part == ED_PART_FACE && wall->shape == WALL_SEGMENT) {
        const double sx = wall->x1 - wall->x0, sy = wall->y1 - wall->y0;
        const double length = sqrt(sx * sx + sy * sy);
        const double h = (-sy * (path.x - wall->x0) + sx * (path.y - wall->y0)) / length;
        const double side = h < 0 ? -1 : 1;
        touch->nx = -side * sy / length;
        touch->ny = side * sx / length;
        touch->gap = fabs(h) - radius;
    } else {
        const bool round = part == ED_PART_FACE;
        const double cx = round ? wall->cx : part == ED_PART_FIRST_END ? wall->x0 : wall->x1;
        const double cy = round ? wall->cy : part == ED_PART_FIRST_END ? wall->y0 : wall->y1;
        const double dx = path.x - cx, dy = path.y - cy, r = sqrt(dx * dx + dy * dy);
        const double size = round ? wall->radius : 0;
        const double sign = round && wall->shape == WALL_ARC && r < size ? -1 : 1;
        touch->nx = r > 0 ? sign * dx / r : 1;
        touch->ny = r > 0 ? sign * dy / r : 0;
        touch->gap = sign * (r - size) - radius;
        curvature = -sign / fmax(r, 1e-300);
    }
    touch->vn = path.vx * touch->nx + path.vy * touch->ny;
    touch->vt = -path.vx * touch->ny + path.vy * touch->nx;
    touch->press = -(path.ax * touch->nx + path.ay * touch->ny) + curvature * touch->vt * touch->vt;
    const struct ed_path here = ed_walls_path(ed, i);
    touch->x = here.x - radius * touch->nx;
    touch->y = here.y - radius * touch->ny;
    return closes(ed, touch->vn, touch->press);
}

double ed_walls_surface(const struct ed *ed, uint32_t w, const struct ed_touch *touch)
{
    const struct wall *wall = &ed->walls.walls[w];
    const double tx = -touch->ny, ty = touch->nx;
    if (wall->shape == WALL_SEGMENT) {
        return copysign(1, tx * (wall->x1 - wall->x0) + ty * (wall->y1 - wall->y0));
    }
    /* Counter-clockwise is t where n points outwards. */
    const struct ed_wall *now = &ed->walls.now[w];
    const double dx = touch->x - wall->cx - now->dx - now->vx * ed->clock.now,
                 dy = touch->y - wall->cy - now->dy - now->vy * ed->clock.now;
    return copysign(1, touch->nx * dx + touch->ny * dy);
}
