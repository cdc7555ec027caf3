/* flow.h - a stream of grains on an obstacle, of any size, density and speed: what the figures of
 * the stream paper share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FLOW_H
#define FLOW_H

#include "figure/lab.h"

struct flow {
    double radius;              /* R_ob, cm */
    bool   flat;                /* a row of discs of half length R_ob */
    double density, speed;      /* rho, v_st in cm/s */
    double width;               /* b; 0: chosen */
    double upstream, screen;    /* from the obstacle to the source; R_D.  0: chosen */
    double rows;                /* columns of grains to measure over */

    /* Filled by flow_wish: */
    double row;                 /* time between two columns */
    double start, end;          /* of the measurement */
};

/* Everything as in the paper, or smaller for the quick form. */
struct flow flow_paper(const struct figure_job *job);

void flow_wish(struct flow *flow, struct lab_wish *wish);

struct flow_force { double mean, error; bool settled; };

/* The mean force along the stream, by blocks of rows, with its error (measure/stats.h). */
bool flow_force(struct figure_job *job, struct flow *flow, struct flow_force *force,
                struct error *error);

#endif
