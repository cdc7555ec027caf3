/* draw.c - prints what frames cost (bench_draw.h): ./draw [REPEATS]
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench/bench_draw.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    const uint32_t repeats = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 5;
    static const uint32_t counts[] = {100, 400, 1000, 5000, 20000, 100000, 1000000};
    printf("%8s %-8s %-12s %7s %7s %7s %8s %9s\n", "grains", "path", "style", "create", "first",
           "paint", "encode", "bytes");
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        for (int form = 0; form < 6; form++) {
            const bool by_gl = form >= 3, rims = form % 3 >= 1, shade = form % 3 == 2;
            if (by_gl && counts[k] > 200000) continue;
            const struct bench_draw_case what = {.grains = counts[k], .width = 1280,
                .height = 720, .path = by_gl ? PAINTER_GL : PAINTER_SPLATTER, .rims = rims,
                .shade = shade};
            struct bench_draw_result result;
            struct error error;
            if (!bench_draw(&what, repeats, &result, &error)) {
                fprintf(stderr, "%s\n", error.text);
                return EXIT_FAILED;
            }
            printf("%8u %-8s %-12s %7.0f %7.0f %7.1f %8.1f %9zu\n", counts[k],
                   by_gl ? "gl" : "splatter", shade ? "rims, shade" : rims ? "rims" : "plain",
                   result.create_ms, result.first_ms, result.paint_ms, result.encode_ms,
                   result.bytes);
            fflush(stdout);
        }
    }
    return EXIT_DONE;
}
