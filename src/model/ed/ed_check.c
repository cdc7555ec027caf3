/* ed_check.c - see ed_check.h.
 *
 * The hashes of a checkpoint tell damage, not intent: numbers that somebody wrote on purpose must
 * not lead a loop out of its array or round in a circle.  Every grain must lie once in the cells,
 * in the one that its event names, and every block once in a chain or in the list of free ones.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_check.h"

#include <math.h>
#include <string.h>

/* The square of a distance or a speed, and the sum of many, is still a number. */
static const double number_max = 1e150;

static bool is_number(double x) { return fabs(x) < number_max; }

/* Times that are to come may be INFINITY. */
static bool clock_holds(const struct ed_clock *c)
{
    return c->epoch >= 0 && is_number(c->epoch) && is_number(c->epoch_low)
        && c->now >= 0 && is_number(c->now) && c->present >= 0 && is_number(c->present)
        && !isnan(c->epoch_end) && is_number(c->noise) && !isnan(c->stuck_mark)
        && c->stuck_step >= 0 && is_number(c->stuck_step) && is_number(c->gx)
        && is_number(c->gy) && !isnan(c->rate_from) && !isnan(c->retry)
        && is_number(c->shear_speed) && is_number(c->ahead) && !isnan(c->slide);
}

const char *ed_check_grains(const struct ed *ed)
{
    if (!clock_holds(&ed->clock)) return "the saved clock does not show a time";
    for (uint32_t i = 0; i < ed->count; i++) {
        const struct ed_grain *g = &ed->grains[i];
        bool holds = is_number(g->x) && is_number(g->y) && is_number(g->vx) && is_number(g->vy);
        if (ed->species) holds = holds && ed->species[i] < ed->scene->species_count;
        if (ed->radius) {
            holds = holds && ed->radius[i] > 0 && is_number(ed->radius[i]) && ed->mass[i] > 0
                 && is_number(ed->mass[i]);
        }
        if (ed->spin) holds = holds && is_number(ed->spin[i]) && is_number(ed->angle[i]);
        if (!holds) return "the saved state holds an impossible hard disc";
    }
    return NULL;
}

/* Who is gone since is found out when the event is due; a solid must be there. */
static bool partner_holds(const struct ed *ed, uint32_t i, uint32_t partner)
{
    if (partner == ED_NOBODY) return true;
    if (!(partner & ED_SOLID)) return partner != i;
    const uint32_t index = ed_partner_index(partner);
    switch (ed_partner_part(partner)) {
    case ED_PART_FACE: return index < ed->walls.count;
    case ED_PART_FIRST_END: case ED_PART_SECOND_END:
        return index < ed->walls.count && ed->walls.walls[index].shape != WALL_DISC;
    case ED_PART_SINK: return index < ed->scene->sink_count;
    case ED_PART_SCREEN: return index < ed->scene->screen_count;
    }
    return false;
}

static bool events_hold(const struct ed *ed)
{
    const struct ed_cells *c = &ed->cells;
    for (uint32_t i = 0; i < ed->count; i++) {
        const struct ed_event *e = &ed->events[i];
        if (isnan(e->contact) || isnan(e->due) || isnan(e->last)) return false;
        if (e->contact < -number_max || e->due < -number_max) return false;
        if (e->cx < 1 || e->cx > c->nx || e->cy < 1 || e->cy > c->ny) return false;
        if (!partner_holds(ed, i, e->partner)) return false;
    }
    return true;
}

/* Ticks off a block that has not been seen before. */
static bool see_block(const struct ed_cells *c, uint32_t block, uint32_t *seen)
{
    if (block < c->count || block - c->count >= c->block_count) return false;
    return !seen[block - c->count]++;
}

/* The grains of one cell and of the blocks behind it: filled from the front, none twice. */
static bool cell_holds(struct ed *ed, uint32_t cell, uint32_t *blocks, uint32_t *grains)
{
    const struct ed_cells *c = &ed->cells;
    for (uint32_t at = cell;; at = c->chain[at]) {
        const uint32_t *ids = c->cells[at].id;
        uint32_t used = 0;
        while (used < ED_CELL_ROOM && ids[used] != ED_CELL_EMPTY) used++;
        for (uint32_t k = 0; k < ED_CELL_ROOM; k++) {
            if (k >= used && ids[k] != ED_CELL_EMPTY) return false;
            if (k >= used) continue;
            if (ids[k] >= ed->count || grains[ids[k]]++) return false;
            const struct ed_event *e = &ed->events[ids[k]];
            if (ed_cells_index(c, e->cx, e->cy) != cell) return false;
        }
        if (at != cell && used == 0) return false;
        if (!c->chain[at]) return true;
        if (used < ED_CELL_ROOM || !see_block(c, c->chain[at], blocks)) return false;
    }
}

static bool cells_hold(struct ed *ed)
{
    const struct ed_cells *c = &ed->cells;
    uint32_t *const blocks = ed->order, *const grains = ed->place;
    memset(blocks, 0, c->block_count * sizeof *blocks);
    memset(grains, 0, ed->count * sizeof *grains);
    for (uint32_t cell = 0; cell < c->count; cell++) {
        if (!cell_holds(ed, cell, blocks, grains)) return false;
    }
    for (uint32_t b = c->block_free; b; b = c->chain[b]) {
        if (!see_block(c, b, blocks) || c->cells[b].id[0] != ED_CELL_EMPTY) return false;
    }
    for (uint32_t b = 0; b < c->block_count; b++) if (!blocks[b]) return false;
    for (uint32_t i = 0; i < ed->count; i++) if (!grains[i]) return false;
    return true;
}

const char *ed_check_events(struct ed *ed)
{
    if (ed->walls.change > ed->walls.change_count || !events_hold(ed)) {
        return "the saved events name grains, walls or cells that there are not";
    }
    return cells_hold(ed) ? NULL : "the saved cells do not hold every grain once";
}
