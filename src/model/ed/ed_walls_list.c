/* ed_walls_list.c - which walls each cell must look at, and what walls are doing when.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed.h"

#include <math.h>
#include <stdlib.h>

/* May a grain that is listed in this cell touch the wall?  `margin` is the largest radius and
 * what the grain may stick out of its cell. */
static bool is_near(const struct ed_cells *cells, uint32_t cx, uint32_t cy,
                    const struct wall *wall, double margin)
{
    const double x = cells->x0 + (cx - 0.5) * cells->width_x,
                 y = cells->y0 + (cy - 0.5) * cells->width_y;
    const double half_x = 0.5 * cells->width_x + margin, half_y = 0.5 * cells->width_y + margin;
    if (!wall_moves(wall)) {
        return wall_nearest(wall, x, y).distance <= sqrt(half_x * half_x + half_y * half_y);
    }
    double x0, y0, x1, y1;
    wall_bounds(wall, &x0, &y0, &x1, &y1);
    const double way = wall->moves_to - wall->moves_from;
    const double sx = wall->vx == 0 ? 0 : wall->vx * way, sy = wall->vy == 0 ? 0 : wall->vy * way;
    return x + half_x >= x0 + fmin(sx, 0) && x - half_x <= x1 + fmax(sx, 0)
        && y + half_y >= y0 + fmin(sy, 0) && y - half_y <= y1 + fmax(sy, 0);
}

/* One pass counts, the next fills. */
static void list_walls(struct ed_walls *walls, const struct ed_cells *cells, double margin,
                       bool fill)
{
    uint32_t total = 0;
    for (uint32_t cy = 0; cy < cells->ny + 2; cy++) {
        for (uint32_t cx = 0; cx < cells->stride; cx++) {
            walls->start[ed_cells_index(cells, cx, cy)] = total;
            for (uint32_t w = 0; w < walls->count; w++) {
                if (!is_near(cells, cx, cy, &walls->walls[w], margin)) continue;
                if (fill) walls->list[total] = w;
                total++;
            }
        }
    }
    walls->start[cells->count] = total;
}

static int by_time(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void list_changes(struct ed_walls *walls)
{
    for (uint32_t w = 0; w < walls->count; w++) {
        const struct wall *wall = &walls->walls[w];
        const double times[4] = {wall_moves(wall) ? wall->moves_from : INFINITY,
                                 wall_moves(wall) ? wall->moves_to : INFINITY,
                                 wall_is_gate(wall) ? wall->opens : INFINITY,
                                 wall_is_gate(wall) ? wall->closes : INFINITY};
        for (int k = 0; k < 4; k++) {
            if (!(times[k] > 0) || !isfinite(times[k])) continue;
            walls->changes[walls->change_count++] = times[k];
        }
    }
    if (walls->change_count) {
        qsort(walls->changes, walls->change_count, sizeof *walls->changes, by_time);
    }
}

/* Of two walls that share an end the first answers for it, if both stay and stand still. */
static bool answers_for_end(const struct ed_walls *walls, uint32_t w, int end)
{
    const struct wall *wall = &walls->walls[w];
    if (wall->border || wall->shape == WALL_DISC) return false;
    const uint32_t other = end == 0 ? wall->joined0 : wall->joined1;
    if (other == WALL_NONE || other >= w) return true;
    return wall_is_gate(&walls->walls[other]) || wall_moves(&walls->walls[other])
        || walls->walls[other].border;
}

bool ed_walls_list_create(struct ed_walls *walls, const struct scene *scene,
                     const struct ed_cells *cells, double margin, struct arena *arena)
{
    *walls = (struct ed_walls){.count = scene->wall_count, .walls = scene->walls,
                               .sensors = scene->sink_count || scene->screen_count};
    if (!walls->count && !walls->sensors) return true;
    if (!arena_array(arena, &walls->now, walls->count)
        || !arena_array(arena, &walls->changes, 4 * (size_t)walls->count)
        || !arena_array(arena, &walls->start, cells->count + 1)) return false;
    list_walls(walls, cells, margin, false);
    if (!arena_array(arena, &walls->list, walls->start[cells->count])) return false;
    list_walls(walls, cells, margin, true);
    list_changes(walls);
    for (uint32_t w = 0; w < walls->count; w++) {
        walls->now[w].ends[0] = answers_for_end(walls, w, 0);
        walls->now[w].ends[1] = answers_for_end(walls, w, 1);
    }
    return true;
}

void ed_walls_list_refresh(struct ed *ed)
{
    struct ed_walls *walls = &ed->walls;
    /* Any time strictly between the changes tells what holds until the next. */
    const uint32_t next = walls->change;
    const double after = next > 0 ? walls->changes[next - 1] : 0;
    const double before = next < walls->change_count ? walls->changes[next] : after + 2;
    const double t = 0.5 * (after + before);
    for (uint32_t w = 0; w < walls->count; w++) {
        const struct wall *wall = &walls->walls[w];
        struct ed_wall *now = &walls->now[w];
        now->present = wall_present(wall, t);
        now->dx = now->dy = now->vx = now->vy = 0;
        if (!wall_moves(wall) || t < wall->moves_from) continue;
        const bool moving = t < wall->moves_to;
        if (moving) {
            now->vx = wall->vx;
            now->vy = wall->vy;
        }
        /* The shift at the epoch of the line on which it moves now; where it stopped otherwise. */
        const double way = moving ? -ed_since_epoch(&ed->clock, wall->moves_from)
                                  : wall->moves_to - wall->moves_from;
        now->dx = wall->vx * way;
        now->dy = wall->vy * way;
    }
}
