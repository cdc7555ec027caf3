/* dsmc_flow.c - grains that enter and leave.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * With a weight w each grain of the scene becomes w particles of mass m / w that begin at its
 * place; all but the first get its velocity relative to the mean turned by a random angle, so that
 * they are independent and have the same temperature.
 */
#include "model/dsmc/dsmc_flow.h"

#include "base/rng.h"
#include "model/stepping.h"

#include <math.h>

static const uint64_t turn_key = 0x7475726e;    /* "turn": apart from other streams */

bool dsmc_flow_add(struct dsmc *dsmc, double x, double y, double vx, double vy, double spin)
{
    if (dsmc->count == dsmc->count_max) return false;
    const uint32_t i = dsmc->count++;
    dsmc->unsorted = true;
    dsmc->grains[i] = (struct dsmc_grain){
        .x = (float)(x - dsmc->scene->box[0]), .y = (float)(y - dsmc->scene->box[1]),
        .vx = (float)vx, .vy = (float)vy};
    dsmc->tags[i] = dsmc->id_next++ & DSMC_NAME;
    if (dsmc->spins) dsmc->spins[i] = (float)(spin * dsmc->radius);
    if (dsmc->contacts) dsmc->contacts[i] = (struct dsmc_contacts){0};
    return true;
}

void dsmc_flow_place(struct dsmc *dsmc)
{
    const struct placed *placed = &dsmc->scene->placed;
    const double rate = dsmc->scene->shear_rate;
    double mean = 0, uy = 0;            /* of what the shear leaves */
    for (uint32_t k = 0; k < placed->count; k++) {
        mean += (placed->vx[k] - rate * placed->y[k]) / placed->count;
        uy += placed->vy[k] / placed->count;
    }
    for (uint32_t k = 0; k < placed->count; k++) {
        const double ux = mean + rate * placed->y[k];
        for (uint32_t copy = 0; copy < dsmc->settings.weight; copy++) {
            const double angle = copy == 0 ? 0
                : 2 * M_PI * rng_unit(rng_keyed(dsmc->seed, turn_key, k, copy));
            const double vx = placed->vx[k] - ux, vy = placed->vy[k] - uy;
            const double c = cos(angle), s = sin(angle);
            dsmc_flow_add(dsmc, placed->x[k], placed->y[k], ux + c * vx - s * vy,
                          uy + s * vx + c * vy, placed->spin ? placed->spin[k] : 0);
        }
    }
}

/* ---- out ------------------------------------------------------------------------------------ */

static bool has_left(struct dsmc *dsmc, uint32_t i, double t)
{
    const struct scene *scene = dsmc->scene;
    const struct dsmc_grain *g = &dsmc->grains[i];
    const double x = scene->box[0] + (double)g->x, y = scene->box[1] + (double)g->y;
    if (stepping_left(scene, x, y, dsmc->radius)) return true;
    if (scene->screen_count == 0) return false;
    const double spin = dsmc->spins ? (double)dsmc->spins[i] / dsmc->radius : 0;
    return tally_cross(&dsmc->tally, scene, t, x, y, (double)g->vx, (double)g->vy, spin, dsmc->mass,
                       dsmc->inertia);
}

/* Closes the gaps in order. */
static void let_out(struct dsmc *dsmc, double t)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < dsmc->count; i++) {
        if (has_left(dsmc, i, t)) {
            dsmc->tally.mass_out += dsmc->mass;
            dsmc->grains_out++;
            continue;
        }
        dsmc->grains[kept] = dsmc->grains[i];
        dsmc->tags[kept] = dsmc->tags[i];
        if (dsmc->spins) dsmc->spins[kept] = dsmc->spins[i];
        if (dsmc->contacts) dsmc->contacts[kept] = dsmc->contacts[i];
        kept++;
    }
    dsmc->unsorted = dsmc->unsorted || kept < dsmc->count;
    dsmc->count = kept;
}

/* ---- in ------------------------------------------------------------------------------------- */

/* hsmc: a full cell takes no grain. */
static bool has_room(const struct dsmc *dsmc, const struct source_grain *grain)
{
    if (dsmc->full == 0) return true;
    const uint32_t cell = dsmc_cell(&dsmc->ax, &dsmc->ay, (float)(grain->x - dsmc->scene->box[0]),
                                    (float)(grain->y - dsmc->scene->box[1]));
    return dsmc->load[cell] + dsmc->settings.weight <= dsmc->full;
}

/* A grain of a rising source begins above the highest grain at rest, within the box.  (000, 3.4 has
 * the highest of all; but then grains that fall slower than others come in lift the source.) */
static void lift(const struct dsmc *dsmc, uint32_t s, struct source_grain *grain)
{
    const struct scene *scene = dsmc->scene;
    const double above = scene->sources[s].above, most = scene->box[3] - 2 * dsmc->radius;
    if (above == 0) return;
    float top = -INFINITY;
    for (uint32_t i = 0; i < dsmc->count; i++) {
        if (dsmc->tags[i] & DSMC_RESTS) top = fmaxf(top, dsmc->grains[i].y);
    }
    grain->y = fmin(fmax(grain->y, scene->box[1] + (double)top + above), most);
}

static bool let_batch_in(struct dsmc *dsmc, uint32_t s, double t)
{
    const struct scene *scene = dsmc->scene;
    struct source_cursor *cursor = &dsmc->cursors[s];
    const uint32_t count = source_batch(scene, s, cursor->next, dsmc->batch, dsmc->batch_max);
    const uint32_t weight = dsmc->settings.weight;
    if (dsmc->count_max - dsmc->count < (uint64_t)count * weight) return false;
    if (count > 0) lift(dsmc, s, &dsmc->batch[0]);
    const bool waits = scene->sources[s].kind == SOURCE_POINT && dsmc->full > 0;
    if (waits && count > 0 && !has_room(dsmc, &dsmc->batch[0])) return false;
    for (uint32_t k = 0; k < count; k++) {
        if (scene->sources[s].count > 0 && cursor->made >= scene->sources[s].count) break;
        const struct source_grain grain = waits ? dsmc->batch[k]
                                        : source_flown(scene, &dsmc->batch[k], t);
        for (uint32_t copy = 0; copy < weight; copy++) {
            dsmc_flow_add(dsmc, grain.x, grain.y, grain.vx, grain.vy, 0);
        }
        if (dsmc->full > 0) {
            const uint32_t cell = dsmc_cell(&dsmc->ax, &dsmc->ay, (float)(grain.x - scene->box[0]),
                                            (float)(grain.y - scene->box[1]));
            dsmc->load[cell] += weight;
        }
        dsmc->tally.mass_in += weight * dsmc->mass;
        dsmc->grains_in += weight;
        cursor->made++;
    }
    cursor->next++;
    return true;
}

void dsmc_flow_pass(struct dsmc *dsmc)
{
    const double t = dsmc_time(dsmc);
    if (dsmc->effects & (EFFECT_OUTFLOW | EFFECT_SCREEN)) let_out(dsmc, t);
    for (uint32_t s = 0; s < dsmc->scene->source_count; s++) {
        while (source_due(dsmc->scene, s, &dsmc->cursors[s]) <= t && let_batch_in(dsmc, s, t)) {}
    }
}

void dsmc_flow_window(struct dsmc *dsmc)
{
    if (!dsmc->contacts) return;
    const uint64_t window = (uint64_t)(dsmc_time(dsmc) / dsmc->window_length);
    if (window == dsmc->window) return;
    for (uint32_t i = 0; i < dsmc->count; i++) {
        dsmc->contacts[i] = (struct dsmc_contacts){.last = dsmc->contacts[i].now};
    }
    dsmc->window = window;
}
