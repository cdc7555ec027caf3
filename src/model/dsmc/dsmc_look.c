/* dsmc_look.c - what others see of the state.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/dsmc/dsmc_look.h"

#include "model/dsmc/dsmc_walls.h"

#include <math.h>

/* Particles of weight w are drawn so that all together cover the area of the grains. */
static double radius_shown(const struct dsmc *dsmc)
{
    return dsmc->radius / sqrt((double)dsmc->settings.weight);
}

static void show(const struct dsmc *dsmc, uint32_t i, double x, double y, struct grains *out)
{
    const struct dsmc_grain *g = &dsmc->grains[i];
    const uint32_t at = out->count++;
    if (out->id) out->id[at] = dsmc->tags[i] & DSMC_NAME;
    if (out->x) out->x[at] = x;
    if (out->y) out->y[at] = y;
    if (out->vx) out->vx[at] = (double)g->vx;
    if (out->vy) out->vy[at] = (double)g->vy;
    if (out->angle) out->angle[at] = 0;
    if (out->spin) out->spin[at] = dsmc->spins ? (double)dsmc->spins[i] / dsmc->radius : 0;
    if (out->radius) out->radius[at] = radius_shown(dsmc);
    if (out->mass) out->mass[at] = dsmc->mass;
    if (out->collision_rate) {
        out->collision_rate[at] = dsmc->contacts
            ? (float)(dsmc->contacts[i].last / dsmc->window_length) : 0;
    }
    if (out->species) out->species[at] = 0;
}

/* hsmc knows of a grain at rest no more than its cell.  The picture puts those of a cell side by
 * side, from below, unless a wall is in the way. */
static void lay_out(const struct dsmc *dsmc, uint32_t i, double *x, double *y)
{
    if (!dsmc->full || !(dsmc->tags[i] & DSMC_RESTS)) return;
    const uint32_t cell = dsmc_cell(&dsmc->ax, &dsmc->ay, dsmc->grains[i].x, dsmc->grains[i].y);
    const uint32_t side = (uint32_t)ceil(sqrt((double)dsmc->full)), rank = i - dsmc->first[cell];
    const bool falls_up = dsmc->scene->gravity[1] > 0;
    if (rank >= side * side) return;
    const double column = (rank % side + 0.5) / side, row = (rank / side + 0.5) / side;
    const double to_x = (cell % dsmc->ax.cells + column) / (double)dsmc->ax.per;
    const double to_y = (cell / dsmc->ax.cells + (falls_up ? 1 - row : row)) / (double)dsmc->ay.per;
    if (dsmc->walls.first && !dsmc_walls_clear(dsmc, &dsmc->grains[i], to_x, to_y)) return;
    *x = dsmc->scene->box[0] + to_x;
    *y = dsmc->scene->box[1] + to_y;
}

void dsmc_look_observe(const void *state, struct grains *out)
{
    const struct dsmc *dsmc = state;
    const double *w = out->window, *box = dsmc->scene->box, radius = radius_shown(dsmc);
    out->time = dsmc_time(dsmc);
    out->count = out->contact_count = out->missed = 0;
    for (uint32_t i = 0; i < dsmc->count; i++) {
        double x = box[0] + (double)dsmc->grains[i].x, y = box[1] + (double)dsmc->grains[i].y;
        lay_out(dsmc, i, &x, &y);
        /* Single precision may round onto or past a border. */
        if (!(dsmc->effects & EFFECT_OUTFLOW) && x > box[2]) x = box[2];
        if (!(dsmc->effects & EFFECT_OUTFLOW) && y > box[3]) y = box[3];
        if (w[0] <= w[2] && (x + radius < w[0] || x - radius > w[2] || y + radius < w[1]
                             || y - radius > w[3])) continue;
        if (out->count < out->capacity) show(dsmc, i, x, y, out);
        else out->missed++;
    }
}

void dsmc_look_count(const void *state, struct counters *out)
{
    const struct dsmc *dsmc = state;
    const double *gravity = dsmc->scene->gravity, *box = dsmc->scene->box;
    *out = (struct counters){
        .time = dsmc_time(dsmc), .steps = dsmc->steps, .grains = dsmc->count,
        .grains_in = dsmc->grains_in, .grains_out = dsmc->grains_out,
        .collisions = dsmc->collisions, .rejected = dsmc->rejected,
        .tangential = dsmc->tangential_count, .overlap_max = NAN,
    };
    double v2 = 0, rim2 = 0, height = 0, px = 0, py = 0;
    for (uint32_t i = 0; i < dsmc->count; i++) {
        const struct dsmc_grain *g = &dsmc->grains[i];
        const double vx = (double)g->vx, vy = (double)g->vy;
        v2 += vx * vx + vy * vy;
        px += vx;
        py += vy;
        height -= gravity[0] * (box[0] + (double)g->x) + gravity[1] * (box[1] + (double)g->y);
        if (dsmc->spins) rim2 += (double)dsmc->spins[i] * (double)dsmc->spins[i];
    }
    out->kinetic_energy = 0.5 * dsmc->mass * v2;
    out->rotational_energy = 0.5 * (double)dsmc->q * dsmc->mass * rim2;
    out->potential_energy = dsmc->mass * height;
    out->momentum_x = dsmc->mass * px;
    out->momentum_y = dsmc->mass * py;
}
