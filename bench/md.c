/* md.c - prints how fast soft discs are (bench_md.h): ./bench_md [STEPS [TILES [DATA-FILE]]]
 * DATA-FILE: also writes the settled tile for LAMMPS.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench/bench_md.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    struct error error = {0};
    const uint32_t steps = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 200;
    const uint32_t tiles = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 10;
    struct grains tile;
    if (!bench_md_settle(&tile, &error)
        || (argc > 3 && !bench_md_export(&tile, argv[3], &error))) {
        fprintf(stderr, "%s\n", error.text);
        return EXIT_FAILED;
    }
    for (int friction = 1; friction >= 0; friction--) {
        const struct bench_md_case what = {.tiles = tiles, .steps = steps, .repeats = 15,
                                           .friction = friction};
        struct bench_md_result r;
        if (!bench_md(&what, &tile, &r, &error)) {
            fprintf(stderr, "%s\n", error.text);
            return EXIT_FAILED;
        }
        printf("%u discs, %s: %.2f M particle-steps per core-second on 1 thread, %.2f on 2; "
               "wall: %.2f, %.2f, gain %.3f; contacts %.2f, tangential forces %llu\n", r.grains,
               friction ? "friction with springs" : "no friction", 1e-6 * r.per_core[1],
               1e-6 * r.per_core[2], 1e-6 * r.particle_steps[1], 1e-6 * r.particle_steps[2],
               r.gain, r.contacts,
               (unsigned long long)r.tangential);
        fflush(stdout);
    }
    grains_free(&tile);
    return EXIT_DONE;
}
