/* md_check.c - see md_check.h.
 *
 * The hashes of a checkpoint tell damage, not intent: numbers that somebody wrote on purpose must
 * not lead a loop out of its array.  Strips, their links and their walls are cut without a gap
 * from beginning to end, and in the order of the grains; all that is asked for here.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/md/md_check.h"

#include <math.h>

/* The square of a distance or a speed, and the sum of many, is still a number. */
static const double number_max = 1e150;

static bool is_number(double x) { return fabs(x) < number_max; }

static bool grains_hold(const struct md *md)
{
    for (uint32_t i = 0; i < md->count; i++) {
        const struct grain *g = &md->grains[i];
        const struct half *h = &md->halves[i];
        const struct trait *t = md->traits ? &md->traits[i] : NULL;
        const struct turn *turn = md->turns ? &md->turns[i] : NULL;
        if (md->tags[i].species >= md->scene->species_count) return false;
        if (!is_number(g->x) || !is_number(g->y) || !is_number(g->ux) || !is_number(g->uy)
            || !is_number(h->hx) || !is_number(h->hy)) return false;
        if (turn && (!is_number(turn->hrim) || !is_number(turn->angle))) return false;
        if (t && (!(t->radius > 0) || !is_number(t->radius) || !(t->inverse_mass > 0)
                  || !is_number(t->inverse_mass) || !(t->inverse_inertia > 0)
                  || !is_number(t->inverse_inertia) || !is_number(t->rim))) return false;
    }
    return true;
}

static bool links_hold(const struct md *md)
{
    for (uint32_t k = 0; k < md->link_count; k++) {
        const uint32_t i = md->links[k].i, j = md->links[k].j & LINK_INDEX;
        const uint32_t image = md->links[k].j >> LINK_IMAGE_SHIFT & 15;
        if (i >= j || j >= md->count || image >= LINK_IMAGES) return false;
    }
    for (uint32_t k = 0; k < md->wall_link_count; k++) {
        const struct wall_link *link = &md->wall_links[k];
        if (link->grain >= md->count || link->wall >= md->scene->wall_count
            || link->image >= LINK_IMAGES) return false;
        if (k > 0 && link->grain < link[-1].grain) return false;
    }
    return true;
}

static bool within(const struct strip *strip, uint32_t i)
{
    return i >= strip->first && i < strip->last;
}

/* Do the links that are listed under a strip begin and end where they should? */
static bool strip_holds(const struct md *md, const struct strip *strip)
{
    const uint32_t base = md->link_count - md->cross_count;
    for (uint32_t k = strip->link_first; k < strip->link_last; k++) {
        const struct link *link = &md->links[k];
        if (!within(strip, link->i) || !within(strip, link->j & LINK_INDEX)) return false;
        if (k > strip->link_first && link->i < link[-1].i) return false;
    }
    for (uint32_t k = strip->cross_first; k < strip->cross_last; k++) {
        if (!within(strip, md->links[k].i)) return false;
    }
    for (uint32_t in = strip->in_first; in < strip->in_last; in++) {
        const uint32_t k = md->incoming[in];
        if (k < base || k >= md->link_count) return false;
        if (!within(strip, md->links[k].j & LINK_INDEX)) return false;
    }
    for (uint32_t k = strip->wall_first; k < strip->wall_last; k++) {
        if (!within(strip, md->wall_links[k].grain)) return false;
    }
    return true;
}

/* Does the stretch go on where the last one ended?  Moves the mark to its end. */
static bool goes_on(uint32_t *mark, uint32_t first, uint32_t last, uint32_t end)
{
    if (first != *mark || last < first || last > end) return false;
    *mark = last;
    return true;
}

static bool strips_hold(const struct md *md)
{
    const uint32_t base = md->link_count - md->cross_count, walls = md->wall_link_count;
    uint32_t grain = 0, link = 0, cross = base, in = 0, wall = 0;
    for (uint32_t t = 0; t < md->strip_count; t++) {
        const struct strip *s = &md->strips[t];
        if (!goes_on(&grain, s->first, s->last, md->count)
            || s->last - s->first > md->strip_room
            || !goes_on(&link, s->link_first, s->link_last, base)
            || !goes_on(&cross, s->cross_first, s->cross_last, md->link_count)
            || !goes_on(&in, s->in_first, s->in_last, md->cross_count)
            || !goes_on(&wall, s->wall_first, s->wall_last, walls)) return false;
        if (!strip_holds(md, s)) return false;
    }
    return grain == md->count && link == base && cross == md->link_count
        && in == md->cross_count && wall == walls;
}

const char *md_check(const struct md *md)
{
    if (!grains_hold(md)) return "the saved state holds an impossible soft disc";
    if (md->cross_count > md->link_count || !links_hold(md)) {
        return "the saved list of neighbours names grains or walls that there are not";
    }
    if (!(md->travel >= 0) || !(md->stride >= 0) || (!md->stale && !strips_hold(md))) {
        return "the saved list of neighbours does not fit together";
    }
    return NULL;
}
