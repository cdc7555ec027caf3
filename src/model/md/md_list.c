/* md_list.c - the neighbour list: pairs within reach plus a skin.
 *
 * Grains are sorted by cell (md_sort.h); a pair belongs to the grain of lower index.  Strips
 * (md.h) list their pairs side by side, each into its own stretch of a scratch array, and the
 * stretches are then pushed together.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_list.h"

#include "model/md/md_sort.h"
#include "model/md/md_walls.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
        && arena_array(arena, &s->links, md->link_max + md->strip_max)
        && arena_array(arena, &s->springs, springs ? md->link_max + md->strip_max : 0)
        && arena_array(arena, &s->inner, md->strip_max)
        && arena_array(arena, &s->cross, md->strip_max);
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

struct neighbours {
    uint32_t count;
    struct stretch stretches[9];
};

static void near_border(const struct md *md, struct cell here, struct neighbours *around)
{
    const struct md_scratch *s = md->scratch;
    const uint32_t cx = s->x_is_fast ? here.along : here.across;
    const uint32_t cy = s->x_is_fast ? here.across : here.along;
    const bool along_x = md->scene->left == BORDER_PERIODIC;
    const bool along_y = md->scene->bottom == BORDER_PERIODIC;
    struct stretch *const out = around->stretches;
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
            const uint32_t cell = md_sort_cell(s, (uint32_t)nx, (uint32_t)ny);
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
    around->count = count;
}

/* Is the cell inside the box, with all its neighbours? */
FORCE_INLINE bool neighbourhood(const struct md *md, struct cell here, struct neighbours *around)
{
    const struct md_scratch *s = md->scratch;
    const uint32_t *const at = &s->cell_first[here.index];
    if (here.along == 0 || here.along + 1 == s->fast || here.across == 0
        || here.across + 1 == s->slow) {
        near_border(md, here, around);
        return false;
    }
    around->count = 2;
    around->stretches[0] = (struct stretch){at[0], at[2], 0};
    around->stretches[1] = (struct stretch){at[s->fast - 1], at[s->fast + 2], 0};
    return true;
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

/* A strip's part of the scratch array: links within the strip from below, those to later strips
 * from above, and one place more than there is room for. */
struct listing {
    uint32_t begin, room, inner, cross;
    uint32_t strip_last;
};

static uint32_t listing_end(const struct listing *out) { return out->begin + out->room + 1; }

static struct listing listing_of(const struct md *md, uint32_t t)
{
    const struct strip *strip = &md->strips[t];
    const uint32_t per_grain = md->scratch->links_per_grain;
    return (struct listing){.begin = strip->first * per_grain + t,
                            .room = (strip->last - strip->first) * per_grain,
                            .strip_last = strip->last};
}

struct place { double x, y; };

/* Where the image of grain i is to which the partners of that image are near. */
FORCE_INLINE struct place seen_from(const struct md *md, uint32_t i, uint32_t image)
{
    return (struct place){md->grains[i].x - md->image_x[image],
                          md->grains[i].y - md->image_y[image]};
}

/* Lists the links of grain i, which is at `at`, to those near it, upwards from `links` or
 * downwards; how many.
 * Whether a pair is near is as good as random, so there is no branch: what is not near is written
 * too, and written over. */
FORCE_INLINE uint32_t list_near(const struct md *md, struct link *links, bool down, uint32_t i,
                                struct place at, struct stretch near, bool sizes)
{
    const struct grain *const grains = md->grains;
    const struct trait *const traits = md->traits;
    const double reach_one = 2 * md->radius_one + md->skin, skin = md->skin;
    const uint32_t image = near.image << LINK_IMAGE_SHIFT;
    uint32_t count = 0;
    for (uint32_t j = near.first; j < near.last; j++) {
        const double dx = at.x - grains[j].x, dy = at.y - grains[j].y;
        const double reach = sizes ? traits[i].radius + traits[j].radius + skin : reach_one;
        *(down ? links - count : links + count) = (struct link){i, j | image};
        count += dx * dx + dy * dy < reach * reach;
    }
    return count;
}

/* Where room gets short, no more are looked at in one go than there are places.  False: no room. */
FORCE_INLINE bool list_stretch(const struct md *md, struct listing *out, uint32_t i,
                               struct stretch near, bool cross, bool sizes)
{
    struct link *const links = md->scratch->links;
    const struct place at = seen_from(md, i, near.image);
    while (near.first < near.last) {
        const uint32_t places = out->room - out->inner - out->cross + 1;
        struct stretch part = near;
        if (near.last - near.first > places) part.last = near.first + places;
        if (cross) {
            struct link *from = &links[listing_end(out) - 1 - out->cross];
            out->cross += list_near(md, from, true, i, at, part, sizes);
        } else {
            struct link *from = &links[out->begin + out->inner];
            out->inner += list_near(md, from, false, i, at, part, sizes);
        }
        if (out->inner + out->cross > out->room) return false;
        near.first = part.last;
    }
    return true;
}

/* Contacts that grain i had go on in its links, those listed after `inner` and `cross` others. */
static void carry_contacts(const struct md *md, uint32_t i, const struct listing *out,
                           uint32_t inner, uint32_t cross)
{
    const struct md_scratch *s = md->scratch;
    const uint32_t end = listing_end(out);
    const uint32_t ranges[2][2] = {{out->begin + inner, out->begin + out->inner},
                                   {end - out->cross, end - cross}};
    for (int r = 0; r < 2; r++) {
        for (uint32_t at = ranges[r][0]; at < ranges[r][1]; at++) {
            if (s->springs) s->springs[at] = 0;
            carry_contact(md, s->kept_first[i], s->links[at].j & LINK_INDEX, at);
        }
    }
}

/* Lists the links of the grains first..last-1 of a cell, whose neighbourhood may reach over the
 * strip's end. */
FORCE_INLINE bool list_cell(const struct md *md, struct listing *out, uint32_t first,
                            uint32_t last, const struct neighbours *around, bool sizes)
{
    const struct md_scratch *s = md->scratch;
    for (uint32_t i = first; i < last; i++) {
        const uint32_t inner = out->inner, cross = out->cross;
        for (uint32_t r = 0; r < around->count; r++) {
            struct stretch near = around->stretches[r], later = near;
            near.first = near.first > i ? near.first : i + 1;
            later.first = near.first > out->strip_last ? near.first : out->strip_last;
            near.last = near.last < out->strip_last ? near.last : out->strip_last;
            if (!list_stretch(md, out, i, near, false, sizes)
                || !list_stretch(md, out, i, later, true, sizes)) return false;
        }
        if (s->springs || s->kept_first[i] != NONE) carry_contacts(md, i, out, inner, cross);
    }
    return true;
}

/* The same well inside the box and the strip, with room for all that could be near. */
FORCE_INLINE void list_inner_cell(const struct md *md, struct listing *out, uint32_t first,
                                  uint32_t last, const struct neighbours *around, bool sizes)
{
    const struct md_scratch *s = md->scratch;
    struct stretch own = around->stretches[0], row = around->stretches[1];
    own.image = 0;
    row.image = 0;
    uint32_t inner = out->inner;
    for (uint32_t i = first; i < last; i++) {
        const struct place at = {md->grains[i].x, md->grains[i].y};
        const uint32_t before = inner;
        own.first = i + 1;
        inner += list_near(md, &s->links[out->begin + inner], false, i, at, own, sizes);
        inner += list_near(md, &s->links[out->begin + inner], false, i, at, row, sizes);
        out->inner = inner;
        if (s->springs || s->kept_first[i] != NONE) carry_contacts(md, i, out, before, out->cross);
    }
}

/* Is there no need to look where the links of these grains of an inner cell go, and whether there
 * is room? */
FORCE_INLINE bool is_plain(const struct listing *out, uint32_t first, uint32_t last,
                           const struct neighbours *around)
{
    const struct stretch *const near = around->stretches;
    const uint64_t grains = last - first;
    const uint64_t most = grains * (near[0].last - first + near[1].last - near[1].first);
    return near[1].last <= out->strip_last && most + out->inner + out->cross <= out->room;
}

FORCE_INLINE bool list_strip(struct md *md, uint32_t t, bool sizes)
{
    struct md_scratch *s = md->scratch;
    struct listing out = listing_of(md, t);
    struct neighbours around;
    struct cell cell = {0};
    for (uint32_t i = md->strips[t].first, last; i < out.strip_last; i = last) {
        cell = cell_on(s, cell, i);
        const uint32_t cell_last = s->cell_first[cell.index + 1];
        last = cell_last < out.strip_last ? cell_last : out.strip_last;
        if (neighbourhood(md, cell, &around) && is_plain(&out, i, last, &around)) {
            list_inner_cell(md, &out, i, last, &around, sizes);
        } else if (!list_cell(md, &out, i, last, &around, sizes)) {
            return false;
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
        const struct listing out = listing_of(md, t);
        move_links(md, strip->link_first, out.begin, s->inner[t]);
        move_links(md, strip->cross_first, listing_end(&out) - s->cross[t], s->cross[t]);
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
    const uint32_t cell = md_sort_cell(md->scratch, cx, cy);
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
    md_sort_find(md);
    keep_contacts(md);
    md_sort_permute(md);
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
