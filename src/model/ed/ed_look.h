/* ed_look.h - what the event-driven model shows of itself: grains, contacts, sums.
 *
 * Hard discs touch for no time, so a contact is a matter of definition here.  Two grains, or a
 * grain and a wall, are listed as in contact if their gap is no wider than what the cut-off t_c
 * does not resolve: at their present speed it opens or shuts within t_c, or gravity alone keeps
 * a grain at rest bouncing that high.  With t_c = 0 only what touches by rounding is left.
 *
 * Its force is zero.  A blow is an impulse without a duration; a mean force would need the sum of
 * impulses of every pair over a window, kept while the model runs.  The stress they carry is
 * summed up if the scene asks for it (tally.h).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_LOOK_H
#define ED_LOOK_H

struct counters;
struct grains;

/* Fills a picture of the present, extrapolated: the grains stay as they are.  Contacts stay away if
 * there is no memory to find them. */
void ed_look_observe(const void *state, struct grains *out);

void ed_look_count(const void *state, struct counters *out);

#endif
