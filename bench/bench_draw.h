/* bench_draw.h - what a frame costs, in processor milliseconds of all threads together.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BENCH_DRAW_H
#define BENCH_DRAW_H

#include "base/error.h"
#include "draw/painter.h"

#include <stddef.h>
#include <stdint.h>

struct bench_draw_case {
    uint32_t grains, width, height;
    enum painter_path path;
    bool rims, shade;
};

struct bench_draw_result {
    double create_ms;           /* wall time: library, context, shaders, font */
    double first_ms;            /* wall time of the first frame */
    double paint_ms, encode_ms; /* processor time a frame: the least of the repeats */
    size_t bytes;               /* of the PNG file */
};

/* Draws a settled packing coloured by speed, with walls and a legend, `repeats` times. */
bool bench_draw(const struct bench_draw_case *what, uint32_t repeats,
                struct bench_draw_result *result, struct error *error);

#endif
