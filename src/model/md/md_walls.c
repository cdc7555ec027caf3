/* md_walls.c - contacts of grains with walls.
 *
 * A wall is never a grain of the cell grid: a grain keeps a link to each wall within its skin and
 * asks for the nearest point.  At a joint of two walls the end of one counts only if the other is
 * not touched in its interior, and once for both; so a disc passes a polyline's joints as if they
 * were not there, and its tangential spring goes along.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_walls.h"

#include "model/md/md_list.h"

#include <math.h>
#include <string.h>

enum { GROUP_MAX = 24 };        /* walls that one grain can be near; more only if tiny */

bool md_walls_create(struct md *md)
{
    const uint32_t walls = md->scene->wall_count;
    if (walls == 0) return true;
    md->wall_link_max = 4 * md->count_max + 1024;
    for (uint32_t w = 0; w < walls; w++) {
        const struct wall *wall = &md->scene->walls[w];
        md->walls_vary = md->walls_vary || wall_moves(wall) || wall_is_gate(wall);
    }
    return arena_array(&md->arena, &md->wall_links, md->wall_link_max)
        && arena_array(&md->arena, &md->wall_links_old, md->wall_link_max)
        && arena_array(&md->arena, &md->wall_first, (size_t)md->count_max + 1)
        && arena_array(&md->arena, &md->walls_now, walls)
        && arena_array(&md->arena, &md->wall_here, walls)
        && arena_array(&md->arena, &md->body_sums,
                       (size_t)md->strip_max * md->scene->obstacle_count);
}

void md_walls_place(struct md *md)
{
    const double t = md_time(md);
    for (uint32_t w = 0; w < md->scene->wall_count; w++) {
        md->walls_now[w] = wall_at(&md->scene->walls[w], t);
        md->wall_here[w] = wall_present(&md->scene->walls[w], t);
    }
}

double md_walls_speed(const struct md *md)
{
    double speed = 0;
    for (uint32_t w = 0; w < md->scene->wall_count; w++) {
        const struct wall *wall = &md->scene->walls[w];
        if (!wall_moves(wall)) continue;
        speed = fmax(speed, hypot(wall->vx, wall->vy)
            + 2 * M_PI * fabs(wall->frequency) * hypot(wall->amplitude_x, wall->amplitude_y));
    }
    return speed;
}

/* Is a grain at this place near the wall's image? */
static bool is_near(const struct md *md, uint32_t w, uint32_t image, uint32_t i)
{
    const struct grain *g = &md->grains[i];
    const struct wall_nearest nearest = wall_nearest(&md->walls_now[w],
        g->x - md->image_x[image], g->y - md->image_y[image]);
    return nearest.distance < md_radius(md, i) + md->skin;
}

/* Visits grains of the cells within `box`, asking each cell first whether the wall is near. */
static bool list_wall(struct md *md, uint32_t w, uint32_t image)
{
    const struct wall *wall = &md->walls_now[w];
    double x0, y0, x1, y1;
    wall_bounds(wall, &x0, &y0, &x1, &y1);
    const double margin = md->scene->radius_max + md->skin;
    struct md_cells cells = md_list_cells(md);
    const double ix = md->image_x[image], iy = md->image_y[image];
    const double half = 0.5 * hypot(1 / cells.per_x, 1 / cells.per_y);
    const double from_x = (x0 + ix - margin - cells.x0) * cells.per_x;
    const double to_x = (x1 + ix + margin - cells.x0) * cells.per_x;
    const double from_y = (y0 + iy - margin - cells.y0) * cells.per_y;
    const double to_y = (y1 + iy + margin - cells.y0) * cells.per_y;
    if (to_x < 0 || to_y < 0 || from_x >= cells.nx || from_y >= cells.ny) return true;
    const uint32_t cx1 = to_x >= cells.nx ? cells.nx - 1 : (uint32_t)to_x;
    const uint32_t cy1 = to_y >= cells.ny ? cells.ny - 1 : (uint32_t)to_y;
    for (uint32_t cx = from_x < 0 ? 0 : (uint32_t)from_x; cx <= cx1; cx++) {
        for (uint32_t cy = from_y < 0 ? 0 : (uint32_t)from_y; cy <= cy1; cy++) {
            uint32_t first, last;
            md_list_cell(md, cx, cy, &first, &last);
            if (first == last) continue;
            const double x = cells.x0 + (cx + 0.5) / cells.per_x - ix;
            const double y = cells.y0 + (cy + 0.5) / cells.per_y - iy;
            if (wall_nearest(wall, x, y).distance > half + margin) continue;
            for (uint32_t i = first; i < last; i++) {
                if (!is_near(md, w, image, i)) continue;
                if (md->wall_link_count == md->wall_link_max) return false;
                md->wall_links_old[md->wall_link_count++] =
                    (struct wall_link){.grain = i, .wall = w, .image = image};
            }
        }
    }
    return true;
}

static void carry_wall_contact(struct wall_link *link, const struct wall_link *old,
                               uint32_t old_count, uint32_t old_grain)
{
    uint32_t low = 0, high = old_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (old[middle].grain < old_grain) low = middle + 1;
        else high = middle;
    }
    for (; low < old_count && old[low].grain == old_grain; low++) {
        if (old[low].wall != link->wall || old[low].image != link->image) continue;
        link->touches = old[low].touches;
        link->spring = old[low].spring;
        return;
    }
}

bool md_walls_list(struct md *md, const uint32_t *order)
{
    if (md->scene->wall_count == 0) return true;
    md_walls_place(md);
    struct wall_link *const old = md->wall_links;
    const uint32_t old_count = md->wall_link_count;
    md->wall_link_count = 0;
    const uint32_t images = md->effects & EFFECT_PERIODIC ? LINK_IMAGES : 1;
    for (uint32_t w = 0; w < md->scene->wall_count; w++) {
        for (uint32_t image = 0; image < images; image++) {
            const bool is_image = md->image_x[image] != 0 || md->image_y[image] != 0;
            if (image > 0 && !is_image) continue;
            if (!list_wall(md, w, image)) return false;
        }
    }
    /* The new links lie in wall_links_old, wall by wall; sort them by grain (stable, so that
     * walls stay in order) over the old ones, once those have given up their springs. */
    struct wall_link *const fresh = md->wall_links_old;
    uint32_t *const first = md->wall_first;
    memset(first, 0, ((size_t)md->count + 1) * sizeof *first);
    for (uint32_t k = 0; k < md->wall_link_count; k++) {
        carry_wall_contact(&fresh[k], old, old_count, order[fresh[k].grain]);
        first[fresh[k].grain + 1]++;
    }
    for (uint32_t i = 0; i < md->count; i++) first[i + 1] += first[i];
    for (uint32_t t = 0; t < md->strip_count; t++) {
        md->strips[t].wall_first = first[md->strips[t].first];
        md->strips[t].wall_last = first[md->strips[t].last];
    }
    for (uint32_t k = 0; k < md->wall_link_count; k++) old[first[fresh[k].grain]++] = fresh[k];
    return true;
}

/* The spring of a contact that begins at a joint where another ends. */
static double inherited_spring(const struct md *md, const struct wall_link *links,
                               const struct md_wall_touch *touch, uint32_t count, uint32_t k)
{
    const struct wall *wall = &md->walls_now[links[k].wall];
    for (uint32_t o = 0; o < count; o++) {
        const bool joined = links[o].wall == wall->joined0 || links[o].wall == wall->joined1
                         || (links[o].wall == links[k].wall && o != k);
        if (joined && links[o].touches && !touch[o].counts) return links[o].spring;
    }
    return 0;
}

/* Does the end contact k stand back behind another contact at the same joint? */
static bool stands_back(const struct md *md, const struct wall_link *links,
                        const struct md_wall_touch *touch, uint32_t count, uint32_t k)
{
    const struct wall *wall = &md->walls_now[links[k].wall];
    const int end = touch[k].nearest.end;
    const uint32_t neighbour = end == 1 ? wall->joined0 : wall->joined1;
    for (uint32_t o = 0; o < count; o++) {
        if (o == k || !(touch[o].overlap > 0)) continue;
        const bool image = links[o].wall == links[k].wall;      /* of the same wall */
        if (!image && links[o].wall != neighbour) continue;
        if (touch[o].nearest.end == 0) return true;
        const struct wall *other = &md->walls_now[links[o].wall];
        const uint32_t back = touch[o].nearest.end == 1 ? other->joined0 : other->joined1;
        if ((image || back == links[k].wall) && o < k) return true;
    }
    return false;
}

static void wall_force(const struct md *md, const struct wall_link *link, double spring,
                       struct md_wall_touch *touch)
{
    const struct wall *wall = &md->walls_now[link->wall];
    const uint32_t i = link->grain;
    const struct grain *g = &md->grains[i];
    const double own = md_radius(md, i);
    const struct md_pair_law *pair = md_pair_law(md, md->tags[i].species, wall->species);
    const double nx = touch->nearest.nx, ny = touch->nearest.ny;
    double ux = g->ux - wall->vx, uy = g->uy - wall->vy;
    if (wall->surface_speed != 0) {
        double tx = -ny, ty = nx;                               /* arc, disc: counter-clockwise */
        if (wall->shape == WALL_SEGMENT) {
            const double sx = wall->x1 - wall->x0, sy = wall->y1 - wall->y0, s = hypot(sx, sy);
            tx = sx / s;
            ty = sy / s;
        } else if (nx * (wall->cx - g->x + md->image_x[link->image])
                   + ny * (wall->cy - g->y + md->image_y[link->image]) > 0) {
            tx = -tx;                                           /* the grain is inside */
            ty = -ty;
        }
        ux -= wall->surface_speed * tx;
        uy -= wall->surface_speed * ty;
    }
    const double radius = wall->shape == WALL_DISC
                        ? own * wall->radius / (own + wall->radius) : own;
    const struct md_touch contact = {
        .overlap = touch->overlap, .closing = -(ux * nx + uy * ny),
        .slip = -ux * ny + uy * nx - touch->lever * md_rim(md, i),
        .mass = 1 / md_inverse_mass(md, i),
        .radius = radius,
        .spring = spring, .dt = md->dt,
    };
    const struct md_force_out force = md_law_force(&md->law, pair, &contact);
    touch->normal = force.normal;
    touch->tangential = force.tangential;
    touch->spring = force.spring;
    touch->fx = force.normal * nx - force.tangential * ny;
    touch->fy = force.normal * ny + force.tangential * nx;
    touch->energy = md_law_energy(&md->law, pair, touch->overlap, radius, force.stretched);
}

void md_walls_touch(const struct md *md, uint32_t first, uint32_t last,
                    struct md_wall_touch *out)
{
    const struct wall_link *links = &md->wall_links[first];
    const struct grain *g = &md->grains[links[0].grain];
    const double radius = md_radius(md, links[0].grain);
    const uint32_t count = last - first;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t w = links[k].wall, image = links[k].image;
        out[k] = (struct md_wall_touch){.overlap = -1};
        if (!md->wall_here[w]) continue;
        out[k].nearest = wall_nearest(&md->walls_now[w], g->x - md->image_x[image],
                                      g->y - md->image_y[image]);
        out[k].overlap = radius - out[k].nearest.distance;
        out[k].lever = out[k].nearest.distance / radius;
    }
    for (uint32_t k = 0; k < count; k++) {
        out[k].counts = out[k].overlap > 0
                     && (out[k].nearest.end == 0 || !stands_back(md, links, out, count, k));
    }
    for (uint32_t k = 0; k < count; k++) {
        if (!out[k].counts) continue;
        const double spring = links[k].touches || !md->law.spring ? links[k].spring
                            : inherited_spring(md, links, out, count, k);
        wall_force(md, &links[k], spring, &out[k]);
    }
}

static void add_to_body(struct md *md, uint32_t t, const struct wall_link *link,
                        const struct md_wall_touch *touch)
{
    const struct grain *g = &md->grains[link->grain];
    const struct wall *wall = &md->walls_now[link->wall];
    if (wall->body == WALL_NONE) return;
    struct tally_body *sum = &md->body_sums[t * md->scene->obstacle_count + wall->body];
    const double reach = md_radius(md, link->grain) - touch->overlap;
    const double x = g->x - md->image_x[link->image] - reach * touch->nearest.nx;
    const double y = g->y - md->image_y[link->image] - reach * touch->nearest.ny;
    const double *center = md->scene->obstacles[wall->body].center;
    const double jx = -touch->fx * md->dt, jy = -touch->fy * md->dt;
    sum->impulse_x += jx;
    sum->impulse_y += jy;
    sum->angular_impulse += (x - center[0]) * jy - (y - center[1]) * jx;
    sum->contacts += !link->touches;
}

void md_walls_push(struct md *md, uint32_t t, struct push *pushes, double *twists)
{
    const struct strip *strip = &md->strips[t];
    struct md_wall_touch touches[GROUP_MAX];
    for (uint32_t k = strip->wall_first; k < strip->wall_last;) {
        const uint32_t i = md->wall_links[k].grain;
        uint32_t last = k + 1;
        while (last < strip->wall_last && md->wall_links[last].grain == i
               && last - k < GROUP_MAX) last++;
        md_walls_touch(md, k, last, touches);
        for (uint32_t o = 0; k < last; k++, o++) {
            struct wall_link *link = &md->wall_links[k];
            if (touches[o].counts) {
                struct push *push = &pushes[i - strip->first];
                push->fx += touches[o].fx;
                push->fy += touches[o].fy;
                if (twists) twists[i - strip->first] -= touches[o].lever * touches[o].tangential;
                md->sums[t].tangential += md->law.tangential;
                if (touches[o].overlap > md->suspect_overlap) md->sums[t].suspect++;
                add_to_body(md, t, link, &touches[o]);
                if (!link->touches && md->collisions) md->collisions[i]++;
                link->spring = md->law.spring ? touches[o].spring : 0;
            } else {
                link->spring = 0;
            }
            link->touches = touches[o].counts;
        }
    }
}
