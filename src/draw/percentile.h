/* percentile.h - the value below which a share of all values lies.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PERCENTILE_H
#define PERCENTILE_H

#include <stdint.h>

/* The nearest-rank percentile, `share` 0..1; reorders the values, which must not be NAN.  0 of
 * none.  The same values give the same answer in any order. */
double percentile(float *values, uint32_t count, double share);

#endif
