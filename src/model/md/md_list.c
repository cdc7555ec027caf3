/* md_list.c - the neighbour list: cells, sorting, pairs within reach plus a skin.
 *
 * Cells are at least as wide as the largest reach, so partners sit in the nine cells around.
 * Grains are sorted by cell, the shorter side of the box running fastest; a pair belongs to the
 * grain of lower index.  Strips (md.h) list their pairs side by side, each into its own stretch
 * of a scratch array, and the stretches are then pushed together.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_list.h"

#include "model/md/md_walls.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define NONE UINT32_MAX

/* A loop over grains, or over their links, in which each turn writes only its own. */
#define SHARED_LOOP                                                                        \
    _Pragma("omp parallel for num_threads(md->thread_count) if (md->count > STRIP_GRAINS)")

struct md_scratch {
    uint32_t cell_max, fast, slow;      /* cells along the fast and the slow axis */
    bool     x_is_fast;
    double   x0, y0, per_x, per_y;      /* origin and cells per length */
    uint32_t nx, ny;
    uint32_t *cell_first;       /* [cells + 1] */
    uint32_t *cell_of;          /* by old index */
    uint32_t *order;            /* old index by new */
    uint32_t *place;            /* new index by old; NONE: has left */
    struct grain *grains;
    struct half  *halves;
    struct tag   *tags;
    struct trait *traits;
    struct turn  *turns;
    struct gear  *gears;
    uint32_t *collisions;
    float    *collision_rate;
    uint32_t *kept_first;       /* contacts that go on: the first of those whose new first grain */
    uint32_t *kept_next;        /* this is, the next of them by link, NONE at the end */
    uint32_t *kept_partner;     /* by link */
    struct link *links;         /* stretches of the strips: inner from below, cross from above */
    double   *springs;
    uint32_t *inner, *cross;    /* by strip: how many */
    uint32_t links_per_grain;
};

static uint32_t links_per_grain(const struct scene *scene, double skin)
{
    /* Discs around one disc, densely packed, half of them: 0.5 ((reach + skin + R) / R)^2. */
    const double span = (2 * scene->radius_max + skin) / scene->radius_mean + 1;
    return (uint32_t)ceil(2 + 0.5 * span * span);
}

bool md_list_create(struct md *md)
{
    struct arena *arena = &md->arena;
    const uint32_t n = md->count_max;
    if (!arena_array(arena, &md->scratch, 1)) return false;
    struct md_scratch *s = md->scratch;
    s->links_per_grain = links_per_grain(md->scene, md->skin);
    if ((uint64_t)n * s->links_per_grain > UINT32_MAX / 2) return false;
    md->link_max = n * s->links_per_grain;
    md->strip_max = n / STRIP_GRAINS + STRIPS_SHARED;
    s->cell_max = 2 * n + 64;
    const bool springs = md->springs || md->law.spring;
    return arena_array(arena, &md->links, md->link_max + LINKS_AHEAD)
        && arena_array(arena, &md->springs, springs ? md->link_max : 0)
        && arena_array(arena, &md->incoming, md->link_max / 2)
        && arena_array(arena, &md->cross_push, md->strip_max > 1 ? md->link_max / 2 : 0)
        && arena_array(arena, &md->cross_twist,
                       md->strip_max > 1 && md->turns ? md->link_max / 2 : 0)
        && arena_array(arena, &md->strips, md->strip_max)
        && arena_array(arena, &md->sums, md->strip_max)
        && arena_array(arena, &s->cell_first, s->cell_max + 1)
        && arena_array(arena, &s->cell_of, n) && arena_array(arena, &s->order, n)
        && arena_array(arena, &s->place, n) && arena_array(arena, &s->grains, n)
        && arena_array(arena, &s->halves, n) && arena_array(arena, &s->tags, n)
        && arena_array(arena, &s->traits, md->traits ? n : 0)
        && arena_array(arena, &s->turns, md->turns ? n : 0)
        && arena_array(arena, &s->gears, md->gears ? n : 0)
        && arena_array(arena, &s->collisions, md->collisions ? n : 0)
        && arena_array(arena, &s->collision_rate, md->collisions ? n : 0)
        && arena_array(arena, &s->kept_first, n)
        && arena_array(arena, &s->kept_next, md->link_max)
        && arena_array(arena, &s->kept_partner, md->link_max)
        && arena_array(arena, &s->links, md->link_max)
        && arena_array(arena, &s->springs, springs ? md->link_max : 0)
        && arena_array(arena, &s->inner, md->strip_max)
        && arena_array(arena, &s->cross, md->strip_max);
}

/* Brings grains back into a periodic box. */
static void wrap(struct md *md)
{
    const double *box = md->scene->box;
    const double width = box[2] - box[0], height = box[3] - box[1];
    const bool along_x = md->scene->left == BORDER_PERIODIC;
    const bool along_y = md->scene->bottom == BORDER_PERIODIC;
    SHARED_LOOP
    for (uint32_t i = 0; i < md->count; i++) {
        struct grain *g = &md->grains[i];
        const bool out_x = g->x < box[0] || g->x >= box[2];
        const bool out_y = g->y < box[1] || g->y >= box[3];
        if (along_x && out_x) g->x -= width * floor((g->x - box[0]) / width);
        if (along_y && out_y) g->y -= height * floor((g->y - box[1]) / height);
    }
}

/* Lays the cells over all grains; over the box along periodic axes. */
static void lay_cells(struct md *md)
{
    struct md_scratch *s = md->scratch;
    const double *box = md->scene->box;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    const bool periodic[2] = {md->scene->left == BORDER_PERIODIC,
                              md->scene->bottom == BORDER_PERIODIC};
    const bool spread = !periodic[0] || !periodic[1];
    for (uint32_t i = 0; spread && i < md->count; i++) {
        const double x = md->grains[i].x, y = md->grains[i].y;
        low[0] = x < low[0] ? x : low[0];
        high[0] = x > high[0] ? x : high[0];
        low[1] = y < low[1] ? y : low[1];
        high[1] = y > high[1] ? y : high[1];
    }
    double size = md->reach_max + md->skin;
    uint32_t cells[2];
    for (;; size *= 1.25) {
        double product = 1;
        for (int axis = 0; axis < 2; axis++) {
            if (periodic[axis]) {
                low[axis] = box[axis];
                high[axis] = box[axis + 2];
            }
            const double span = fmax(high[axis] - low[axis], 0) / size;
            product *= fmax(1, floor(span) + !periodic[axis]);
        }
        if (product <= s->cell_max) break;
    }
    for (int axis = 0; axis < 2; axis++) {
        const double span = fmax(high[axis] - low[axis], 0);
        cells[axis] = (uint32_t)fmax(1, floor(span / size) + !periodic[axis]);
        const double width = periodic[axis] ? span / cells[axis] : size;
        if (axis == 0) s->per_x = 1 / width;
        else s->per_y = 1 / width;
    }
    s->x0 = low[0];
    s->y0 = low[1];
    s->nx = cells[0];
    s->ny = cells[1];
    s->x_is_fast = cells[0] < cells[1];
    s->fast = s->x_is_fast ? s->nx : s->ny;
    s->slow = s->x_is_fast ? s->ny : s->nx;
}

static uint32_t cell_index(const struct md_scratch *s, uint32_t cx, uint32_t cy)
{
    return s->x_is_fast ? cy * s->fast + cx : cx * s->fast + cy;
}

static uint32_t cell_along(double place, double per, uint32_t cells)
{
    const double c = place * per;
    return c < 0 ? 0 : c >= cells ? cells - 1 : (uint32_t)c;
}

/* Counting sort by cell, stable; grains that have left come to no place. */
static void sort_grains(struct md *md)
{
    struct md_scratch *s = md->scratch;
    const uint32_t cells = s->nx * s->ny, old_count = md->count;
    SHARED_LOOP
    for (uint32_t i = 0; i < old_count; i++) {
        const struct grain *g = &md->grains[i];
        s->cell_of[i] = md->tags[i].gone ? NONE
                      : cell_index(s, cell_along(g->x - s->x0, s->per_x, s->nx),
                                   cell_along(g->y - s->y0, s->per_y, s->ny));
    }
    memset(s->cell_first, 0, (cells + 1) * sizeof *s->cell_first);
    for (uint32_t i = 0; i < old_count; i++) {
        if (s->cell_of[i] != NONE) s->cell_first[s->cell_of[i] + 1]++;
    }
    for (uint32_t c = 0; c < cells; c++) s->cell_first[c + 1] += s->cell_first[c];
    md->count = s->cell_first[cells];
    for (uint32_t i = 0; i < old_count; i++) {
        s->place[i] = NONE;
        if (s->cell_of[i] == NONE) continue;
        s->place[i] = s->cell_first[s->cell_of[i]]++;
        s->order[s->place[i]] = i;
    }
    for (uint32_t c = cells; c > 0; c--) s->cell_first[c] = s->cell_first[c - 1];
    s->cell_first[0] = 0;
}

#define SWAP(a, b) do { void *swap_ = (a); (a) = (b); (b) = swap_; } while (0)

#define PERMUTE(array)                                                                     \
    do {                                                                                   \
        if (!md->array) break;                                                             \
        SHARED_LOOP                                                                        \
        for (uint32_t i = 0; i < md->count; i++) s->array[i] = md->array[s->order[i]];     \
        SWAP(md->array, s->array);                                                         \
    } while (0)

static void permute(struct md *md)
{
    struct md_scratch *s = md->scratch;
    PERMUTE(grains);
    PERMUTE(halves);
    PERMUTE(tags);
    PERMUTE(traits);
    PERMUTE(turns);
    PERMUTE(gears);
    PERMUTE(collisions);
    PERMUTE(collision_rate);
}

/* Chains the contacts of the old list by the new index of their first grain. */
static void keep_contacts(struct md *md)
{
    struct md_scratch *s = md->scratch;
    for (uint32_t i = 0; i < md->count; i++) s->kept_first[i] = NONE;
    for (uint32_t k = 0; k < md->link_count; k++) {
        const struct link link = md->links[k];
        if (!(link.j & LINK_TOUCHES)) continue;
        const uint32_t a = s->place[link.i], b = s->place[link.j & LINK_INDEX];
        if (a == NONE || b == NONE) continue;
        const uint32_t owner = a < b ? a : b;
        s->kept_partner[k] = a < b ? b : a;
        s->kept_next[k] = s->kept_first[owner];
        s->kept_first[owner] = k;
    }
}

static void cut_strips(struct md *md)
{
    /* Wide enough that few links cross: eight rows of cells or more, as far as it goes. */
    const uint32_t row = md->count / md->scratch->slow + 1;
    const uint32_t wanted = row < STRIP_GRAINS / 8 ? STRIP_GRAINS
                          : row < STRIP_GRAINS_MAX / 8 ? 8 * row : STRIP_GRAINS_MAX;
    uint32_t strips = (md->count + wanted - 1) / wanted;
    if (strips > 1) strips = (strips + STRIPS_SHARED - 1) / STRIPS_SHARED * STRIPS_SHARED;
    if (strips < 1) strips = 1;
    if (strips > md->strip_max) strips = md->strip_max;
    md->strip_count = strips;
    for (uint32_t k = 0; k < strips; k++) {
        md->strips[k].first = (uint32_t)((uint64_t)md->count * k / strips);
        md->strips[k].last = (uint32_t)((uint64_t)md->count * (k + 1) / strips);
    }
}

struct cell { uint32_t index, along, across; };         /* along the fast axis, and the slow one */

/* The cell of grain i, from that of a grain before it: hardly ever is a row of cells passed. */
FORCE_INLINE struct cell cell_on(const struct md_scratch *s, struct cell cell, uint32_t i)
{
    const uint32_t index = s->cell_of[s->order[i]];
    cell.along += index - cell.index;
    cell.index = index;
    for (; cell.along >= s->fast; cell.across++) cell.along -= s->fast;
    return cell;
}

/* Stretches of one cell's neighbourhood: grains first..last-1 seen as image `image`. */
struct stretch { uint32_t first, last, image; };

static uint32_t near_border(const struct md *md, struct cell here, struct stretch out[static 9])
{
    const struct md_scratch *s = md->scratch;
    const uint32_t cx = s->x_is_fast ? here.along : here.across;
    const uint32_t cy = s->x_is_fast ? here.across : here.along;
    const bool along_x = md->scene->left == BORDER_PERIODIC;
    const bool along_y = md->scene->bottom == BORDER_PERIODIC;
    uint32_t count = 0;
    for (int a = -1; a <= 1; a++) {
        for (int b = -1; b <= 1; b++) {
            const int dx = s->x_is_fast ? b : a, dy = s->x_is_fast ? a : b;
            int64_t nx = (int64_t)cx + dx, ny = (int64_t)cy + dy;
            uint32_t image = 0;
            if (nx < 0 || nx >= s->nx) {
                if (!along_x) continue;
                image += nx < 0 ? 2 : 1;        /* the partner's image is at x - W or x + W */
                nx = nx < 0 ? s->nx - 1 : 0;
            }
            if (ny < 0 || ny >= s->ny) {
                if (!along_y) continue;
                image += ny < 0 ? 6 : 3;
                ny = ny < 0 ? s->ny - 1 : 0;
            }
            const uint32_t cell = cell_index(s, (uint32_t)nx, (uint32_t)ny);
            if (cell < here.index) continue;
            const struct stretch next = {s->cell_first[cell], s->cell_first[cell + 1], image};
            struct stretch *before = count > 0 ? &out[count - 1] : NULL;
            if (before && before->last == next.first && before->image == image) {
                before->last = next.last;
            } else {
                out[count++] = next;
            }
        }
    }
    return count;
}

FORCE_INLINE uint32_t neighbourhood(const struct md *md, struct cell here,
                                    struct stretch out[static 9])
{
    const struct md_scratch *s = md->scratch;
    const uint32_t *const at = &s->cell_first[here.index];
    if (here.along == 0 || here.along + 1 == s->fast || here.across == 0
        || here.across + 1 == s->slow) return near_border(md, here, out);
    out[0] = (struct stretch){at[0], at[2], 0};
    out[1] = (struct stretch){at[s->fast - 1], at[s->fast + 2], 0};
    return 2;
}

/* Does link `at` of the new list go on with a contact that grain j had, one of those from `k` on?
 * The old list, its springs with it, is whole until the new one is. */
static void carry_contact(const struct md *md, uint32_t k, uint32_t j, uint32_t at)
{
    const struct md_scratch *s = md->scratch;
    while (k != NONE && s->kept_partner[k] != j) k = s->kept_next[k];
    if (k == NONE) return;
    s->links[at].j |= LINK_TOUCHES;
    if (s->springs) s->springs[at] = md->springs[k];
}

/* A strip's stretch of the scratch array: links within the strip from below, those to later strips
 * from above. */
struct listing { uint32_t begin, room, inner, cross, strip_last; };

/* Lists the links of grain i to those near it.  False: no room. */
FORCE_INLINE bool list_any(const struct md *md, struct listing *out, uint32_t i,
                           struct stretch near, bool sizes)
{
    const struct md_scratch *s = md->scratch;
    const struct trait *const traits = md->traits;
    const double reach_one = 2 * md->radius_one + md->skin;
    const double x = md->grains[i].x - md->image_x[near.image];
    const double y = md->grains[i].y - md->image_y[near.image];
    for (uint32_t j = near.first; j < near.last; j++) {
        const double dx = x - md->grains[j].x, dy = y - md->grains[j].y;
        const double reach = sizes ? traits[i].radius + traits[j].radius + md->skin : reach_one;
        if (dx * dx + dy * dy >= reach * reach) continue;
        if (out->inner + out->cross == out->room) return false;
        const bool crosses = j >= out->strip_last;
        const uint32_t at = out->begin + (crosses ? out->room - ++out->cross : out->inner++);
        s->links[at] = (struct link){i, j | near.image << LINK_IMAGE_SHIFT};
        if (s->springs) s->springs[at] = 0;
        if (s->kept_first[i] != NONE) carry_contact(md, s->kept_first[i], j, at);
    }
    return true;
}

/* The same where nothing can be in the way: all within the strip and the box, room for all, no
 * contacts to carry on.  Whether a pair is near is as good as random, so there is no branch. */
FORCE_INLINE uint32_t list_plain(const struct md *md, struct link *links, uint32_t i,
                                 struct stretch near, bool sizes)
{
    const struct grain *const grains = md->grains;
    const struct trait *const traits = md->traits;
    const double reach_one = 2 * md->radius_one + md->skin, skin = md->skin;
    const double x = grains[i].x, y = grains[i].y;
    uint32_t count = 0;
    for (uint32_t j = near.first; j < near.last; j++) {
        const double dx = x - grains[j].x, dy = y - grains[j].y;
        const double reach = sizes ? traits[i].radius + traits[j].radius + skin : reach_one;
        links[count] = (struct link){i, j};
        count += dx * dx + dy * dy < reach * reach;
    }
    return count;
}

FORCE_INLINE bool list_strip(struct md *md, uint32_t t, bool sizes)
{
    struct md_scratch *s = md->scratch;
    const struct strip *strip = &md->strips[t];
    struct listing out = {
        .begin = strip->first * s->links_per_grain,
        .room = (strip->last - strip->first) * s->links_per_grain, .strip_last = strip->last
    };
    uint32_t cell_end = 0, stretches = 0;
    struct stretch around[9];
    struct cell cell = {0};
    for (uint32_t i = strip->first; i < strip->last; i++) {
        if (i >= cell_end) {
            cell = cell_on(s, cell, i);
            cell_end = s->cell_first[cell.index + 1];
            stretches = neighbourhood(md, cell, around);
        }
        const bool carries = s->springs || s->kept_first[i] != NONE;
        for (uint32_t r = 0; r < stretches; r++) {
            struct stretch near = around[r];
            near.first = near.first > i ? near.first : i + 1;
            const bool fits = near.last + out.inner + out.cross <= near.first + out.room;
            if (!carries && !near.image && near.last <= strip->last && fits) {
                out.inner += list_plain(md, &s->links[out.begin + out.inner], i, near, sizes);
            } else if (!list_any(md, &out, i, near, sizes)) {
                return false;
            }
        }
    }
    s->inner[t] = out.inner;
    s->cross[t] = out.cross;
    return true;
}

static void move_links(struct md *md, uint32_t to, uint32_t from, uint32_t count)
{
    memcpy(md->links + to, md->scratch->links + from, count * sizeof *md->links);
    if (!md->springs) return;
    memcpy(md->springs + to, md->scratch->springs + from, count * sizeof *md->springs);
}

/* Pushes the stretches together: inner links of all strips, then all cross links. */
static bool join_strips(struct md *md)
{
    struct md_scratch *s = md->scratch;
    uint32_t inner = 0, cross = 0;
    for (uint32_t t = 0; t < md->strip_count; t++) inner += s->inner[t];
    md->cross_count = 0;
    for (uint32_t t = 0; t < md->strip_count; t++) md->cross_count += s->cross[t];
    if (md->cross_count > md->link_max / 2) return false;
    md->link_count = inner + md->cross_count;
    cross = inner;
    inner = 0;
    for (uint32_t t = 0; t < md->strip_count; t++) {
        struct strip *strip = &md->strips[t];
        strip->link_first = inner;
        strip->link_last = inner += s->inner[t];
        strip->cross_first = cross;
        strip->cross_last = cross += s->cross[t];
    }
    SHARED_LOOP
    for (uint32_t t = 0; t < md->strip_count; t++) {
        const struct strip *strip = &md->strips[t];
        const uint32_t begin = strip->first * s->links_per_grain;
        const uint32_t end = strip->last * s->links_per_grain;
        move_links(md, strip->link_first, begin, s->inner[t]);
        move_links(md, strip->cross_first, end - s->cross[t], s->cross[t]);
    }
    return true;
}

static uint32_t strip_of(const struct md *md, uint32_t i)
{
    uint32_t t = (uint32_t)((uint64_t)i * md->strip_count / md->count);
    while (i < md->strips[t].first) t--;
    while (i >= md->strips[t].last) t++;
    return t;
}

/* Sorts the cross links by the strip in which they end. */
static void list_incoming(struct md *md)
{
    const uint32_t first = md->link_count - md->cross_count;
    for (uint32_t t = 0; t < md->strip_count; t++) md->strips[t].in_last = 0;
    for (uint32_t k = first; k < md->link_count; k++) {
        md->strips[strip_of(md, md->links[k].j & LINK_INDEX)].in_last++;
    }
    uint32_t sum = 0;
    for (uint32_t t = 0; t < md->strip_count; t++) {
        const uint32_t count = md->strips[t].in_last;
        md->strips[t].in_first = md->strips[t].in_last = sum;
        sum += count;
    }
    for (uint32_t k = first; k < md->link_count; k++) {
        const uint32_t t = strip_of(md, md->links[k].j & LINK_INDEX);
        md->incoming[md->strips[t].in_last++] = k;
    }
}

struct md_cells md_list_cells(const struct md *md)
{
    const struct md_scratch *s = md->scratch;
    return (struct md_cells){s->x0, s->y0, s->per_x, s->per_y, s->nx, s->ny};
}

void md_list_cell(const struct md *md, uint32_t cx, uint32_t cy, uint32_t *first, uint32_t *last)
{
    const uint32_t cell = cell_index(md->scratch, cx, cy);
    *first = md->scratch->cell_first[cell];
    *last = md->scratch->cell_first[cell + 1];
}

static bool list_full(struct md *md, const char *what)
{
    md->broken = true;
    md->fault = (struct fault){.time = md_time(md)};
    snprintf(md->fault.text, sizeof md->fault.text, "t = %g: there is no room for more %s; grains "
             "overlap far too much: make them stiffer (md.overlap) or set a smaller md.dt",
             md->fault.time, what);
    return false;
}

bool md_list_rebuild(struct md *md)
{
    struct md_scratch *s = md->scratch;
    wrap(md);
    lay_cells(md);
    sort_grains(md);
    keep_contacts(md);
    permute(md);
    cut_strips(md);
    bool room = true;
#pragma omp parallel for schedule(dynamic, 1) num_threads(md->thread_count) \
        if (md->strip_count > 1) reduction(&& : room)
    for (uint32_t t = 0; t < md->strip_count; t++) {
        room = (md->traits ? list_strip(md, t, true) : list_strip(md, t, false)) && room;
    }
    if (!room || !join_strips(md)) return list_full(md, "pairs of neighbours");
    list_incoming(md);
    if (!md_walls_list(md, s->order)) return list_full(md, "grains at walls");
    md->travel = 0;
    md->stale = false;
    md->rebuilds++;
    return true;
}
