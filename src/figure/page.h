/* page.h - one HTML page with all figures: pictures, verdicts, wall times and commands.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PAGE_H
#define PAGE_H

#include "figure/figure.h"

/* Writes directory/index.html; the pictures are those beside it.  Jobs whose figure could not be
 * made have their cause in `failures` (an empty text: it was made). */
bool page_save(const char *directory, const struct figure_job *jobs, const struct error *failures,
               uint32_t count, struct error *error);

#endif
