/* ticks.h - round numbers along a scale, and how to write them.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TICKS_H
#define TICKS_H

#include "scene/scene.h"

#include <stdint.h>

enum { TICKS_MAX = 9, TICKS_TEXT_MAX = 32 };

struct tick {
    double value, position;     /* position on the scale, 0..1, as colormap_position() says */
    char   text[TICKS_TEXT_MAX];        /* UTF-8, in units of 10^exponent */
};

struct ticks {
    uint32_t count;
    int exponent;               /* all texts are to be multiplied by ten to this; usually 0 */
    struct tick list[TICKS_MAX];        /* upwards */
};

/* Ticks at round values inside the range, at most `wanted` (2 to TICKS_MAX) of them: multiples of
 * 1, 2 or 5 times a power of ten (the log scale: 1, 2, 5 times powers of ten). */
void ticks_make(struct ticks *ticks, enum scale scale, const double range[2], uint32_t wanted);

/* The largest of 1, 2, 5 times a power of ten that is not above `value` (> 0). */
double ticks_round_down(double value);

/* A number with so many significant digits and no needless zeros, with a real minus sign and
 * 10 to a power in superscripts where that is shorter. */
void ticks_number(char text[TICKS_TEXT_MAX], double value, int digits);

/* "10" to a power, in superscripts. */
void ticks_power(char text[TICKS_TEXT_MAX], int exponent);

#endif
