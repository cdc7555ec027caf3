/* ed_check.h - is a state that was loaded one that could have been saved?
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_CHECK_H
#define ED_CHECK_H

#include "model/ed/ed.h"

/* The clock, the grains and what each is made of.  NULL, or what is wrong. */
const char *ed_check_grains(const struct ed *ed);

/* The events and the cells, of a state that goes on with those it was saved with.  Uses `order`
 * and `place`. */
const char *ed_check_events(struct ed *ed);

#endif
