/* md_flow.h - grains that enter and leave; only between two neighbour lists.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MD_FLOW_H
#define MD_FLOW_H

#include "model/md/md.h"

/* Is a source due, so that the list must be made anew? */
bool md_flow_due(const struct md *md);

/* Takes out what crossed a screen, an open border or entered a sink, and lets in what is due. */
void md_flow_pass(struct md *md);

/* What tells a grain of this species and radius from others; it does not spin. */
struct trait md_flow_trait(const struct species *species, double radius);

/* Appends a grain; false if there is no room. */
bool md_flow_add(struct md *md, const struct source_grain *grain, double spin);

/* Forms the rates of contacts begun when a window is over. */
void md_flow_window(struct md *md);

#endif
