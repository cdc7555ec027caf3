/* ed_watch.c - see ed_watch.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_watch.h"

#include "model/ed/ed.h"

bool ed_watch_wanted(const struct ed *ed)
{
    return ed->contacts || ed->begun || ed->tally.impact.count || ed->tally.stress.cells;
}

static void count_contact(struct ed *ed, uint32_t i, bool elastic)
{
    if (ed->contacts) ed->contacts[i]++;
    if (!ed->begun) return;
    ed->begun[i]++;
    ed->elastic[i] += elastic;
}

void ed_watch_pair(struct ed *ed, uint32_t i, uint32_t j, const struct ed_blow *blow,
                   bool elastic)
{
    count_contact(ed, i, elastic);
    count_contact(ed, j, elastic);
    tally_collision(&ed->tally, blow->dx, blow->dy, blow->du, blow->dv);
    if (!ed->tally.stress.cells) return;
    const struct ed_path p = ed_walls_path(ed, i);
    const double ri = ed_radius(ed, i), share = ri / (ri + ed_radius(ed, j));
    tally_contact(&ed->tally, p.x + share * blow->dx, p.y + share * blow->dy, blow->dx, blow->dy,
                  blow->px, blow->py);
}

void ed_watch_wall(struct ed *ed, uint32_t i, const struct ed_touch *touch, double px, double py,
                   bool elastic)
{
    const double radius = ed_radius(ed, i);
    count_contact(ed, i, elastic);
    tally_contact(&ed->tally, touch->x, touch->y, -radius * touch->nx, -radius * touch->ny, px,
                  py);
}
