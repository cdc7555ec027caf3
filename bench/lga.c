/* lga.c - prints how many nodes are updated a second (bench_lga.h): ./bench_lga [REPEATS [THREADS]]
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/bench_lga.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    const int repeats = argc > 1 ? atoi(argv[1]) : 3;
    omp_set_num_threads(argc > 2 ? atoi(argv[2]) : 1);
    printf("%-12s %6s %8s %14s %14s\n", "case", "side", "grains", "G/core-second", "G/second");
    for (const struct bench_lga_case *c = bench_lga_list; c->name; c++) {
        double core = 0, wall = 0, grains = 0;
        for (int k = 0; k < repeats; k++) {
            struct bench_lga_result result;
            struct error error = {.text = "not enough memory"};
            if (!bench_lga(c, &result, &error)) {
                fprintf(stderr, "%s: %s\n", c->name, error.text);
                return EXIT_FAILED;
            }
            core = fmax(core, result.updates);
            wall = fmax(wall, (double)c->side * c->side * c->ticks / result.wall);
            grains = result.grains;
        }
        printf("%-12s %6u %8.3f %14.3f %14.3f\n", c->name, c->side, grains, core * 1e-9,
               wall * 1e-9);
        fflush(stdout);
    }
    return EXIT_DONE;
}
