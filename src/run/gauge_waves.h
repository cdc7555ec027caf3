/* gauge_waves.h - density along the longer side of the box, against time: its picture and spectrum.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef GAUGE_WAVES_H
#define GAUGE_WAVES_H

#include "run/gauge.h"

/* A map of the density over time (to the right) and place, in slabs of two mean diameters. */
bool gauge_waves_space_time(struct gauge_job *job, struct chart *chart, struct error *error);

/* Power of the density in slabs of twenty mean diameters over frequency, without the first quarter
 * of the run, with a power law through the middle half of the decades. */
bool gauge_waves_spectrum(struct gauge_job *job, struct chart *chart, struct error *error);

#endif
