/* overlay_label.h - texts with variables, and units as they are printed.  Private to the
 * overlay.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef OVERLAY_LABEL_H
#define OVERLAY_LABEL_H

#include "draw/painter.h"

#include <stddef.h>

/* Replaces {t} {n} {title} {units} {time_unit} {model}, the picture's own variables and {t:.3f}
 * (any number with a printf format of its own); {{ is a brace; what is unknown stays. */
void overlay_label(const struct picture *picture, const char *text, char *out, size_t size);

/* "kg m/s^2" as "kg" with a dot, "m/s" with a raised 2. */
void overlay_label_unit(const char *unit, char *out, size_t size);

/* The same for a sentence, whose blanks stay. */
void overlay_label_raise(const char *text, char *out, size_t size);

#endif
