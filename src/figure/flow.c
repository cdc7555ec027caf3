/* flow.c - see flow.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/flow.h"

#include "measure/stats.h"

#include <math.h>
#include <stdlib.h>

static const double disc = 0.08;                /* mean radius of grains; of a flat obstacle */
static const double gap = 0.22;                 /* two largest radii: columns at rho = 1 */

/* A corona is there when the stream has passed about three times the way from the source. */
static const double settling_ways = 3;

struct flow flow_paper(const struct figure_job *job)
{
    return (struct flow){.radius = 1, .density = 1, .speed = 500, .width = job->quick ? 0 : 16,
                         .rows = job->quick ? 150 : 500};
}

void flow_wish(struct flow *flow, struct lab_wish *wish)
{
    /* With b = 5 R_ob the force is 8 % too small: what is pushed aside finds nothing to push back. */
    if (!(flow->width > 0)) flow->width = fmax(4, 8 * flow->radius);
    /* Grains come back from a round obstacle by less than its diameter, but the corona of a flat
     * one stands out by its length. */
    if (!(flow->upstream > 0)) flow->upstream = 2.5 + 3 * flow->radius;
    if (!(flow->screen > 0)) {
        /* The corners of the stream enter inside the screen. */
        const double corner = hypot(flow->upstream, flow->width / 2) + 0.5;
        flow->screen = fmax(corner, flow->width == 16 ? 12 * flow->radius : 0);
    }
    const double source = flow->upstream, screen = flow->screen;
    const double reach = fmax(screen, flow->width / 2 + 1) + 0.5;
    flow->row = gap / sqrt(flow->density) / flow->speed;
    flow->start = settling_ways * (source + flow->radius) / flow->speed;
    flow->end = flow->start + flow->rows * flow->row;
    *wish = (struct lab_wish){.scene = flow->flat ? "obstacle-flat" : "obstacle"};
    /* Grains at 2000 cm/s overlap by half a radius under Table I. */
    lab_set(wish, "overlap_limit=0.8");
    lab_set(wish, "until=%.6g", flow->end);
    lab_set(wish, "box=[%g,%g,%g,%g]", -fmax(source + 1, reach), -reach, reach, reach);
    lab_set(wish, "sources.[0].position=(%g,0)", -source);
    lab_set(wish, "sources.[0].width=%g", flow->width);
    lab_set(wish, "sources.[0].velocity=(%g,0)", flow->speed);
    lab_set(wish, "sources.[0].density=%g", flow->density);
    if (flow->flat) {
        const double half = disc * fmax(0, round(flow->radius / disc) - 1);
        lab_set(wish, "obstacles.[0].from=(0,%g)", -half);
        lab_set(wish, "obstacles.[0].to=(0,%g)", half);
    } else {
        lab_set(wish, "obstacles.[0].radius=%g", flow->radius);
    }
    lab_set(wish, "screens.[0].radius=%g", screen);
    lab_set(wish, "screens.[0].from=%.6g", flow->start);
    lab_set(wish, "view.range=[0,%g]", flow->speed);
}

static double impulse(const struct lab *lab)
{
    return simulation_tally(&lab->footage.sim)->bodies[0].impulse_x;
}

bool flow_force(struct figure_job *job, struct flow *flow, struct flow_force *force,
                struct error *error)
{
    struct lab lab;
    struct lab_wish wish;
    struct stats_mean mean = {0};
    flow_wish(flow, &wish);
    const uint32_t rows = (uint32_t)flow->rows;
    double *series = calloc(rows + 1, sizeof *series);
    bool done = series != NULL || error_set(error, "not enough memory for a series of forces");
    lab = (struct lab){0};
    done = done && lab_open(&lab, job, &wish, error) && lab_go(&lab, flow->start, error);
    double before = done ? impulse(&lab) : 0;
    for (uint32_t k = 0; done && k < rows; k++) {
        done = lab_go(&lab, flow->start + (k + 1) * flow->row, error);
        if (!done) break;
        const double now = impulse(&lab);
        series[k] = (now - before) / flow->row;
        before = now;
    }
    done = done && stats_mean(series, rows, &mean, error);
    *force = (struct flow_force){mean.mean, mean.error, mean.settled};
    lab_close(&lab);
    free(series);
    return done;
}
