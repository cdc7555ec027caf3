/* dsmc.c - prints how many grains are moved on a second (bench_dsmc.h):
 * ./bench_dsmc [ROUNDS [THREADS [CASE]]]
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/bench_dsmc.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
    const int rounds = argc > 1 ? atoi(argv[1]) : 9, threads = argc > 2 ? atoi(argv[2]) : 2;
    printf("%-8s %14s %14s %8s %8s %6s\n", "case", "M/core-second", "M/s on two", "speed-up",
           "bytes", "same");
    for (const struct bench_dsmc_case *c = bench_dsmc_list; c->name; c++) {
        if (argc > 3 && strcmp(argv[3], c->name) != 0) continue;
        struct bench_dsmc_result r[BENCH_DSMC_THREADS] = {0};
        struct error error = {.text = ""};
        if (!bench_dsmc(c, (uint32_t)rounds, threads > 1, r, &error)) {
            fprintf(stderr, "%s: %s\n", c->name, error.text);
            return EXIT_FAILED;
        }
        printf("%-8s %14.1f %14.1f %8.2f %8.1f %6s\n", c->name, 1e-6 * r[0].per_core,
               1e-6 * r[1].per_wall, r[1].per_wall / r[0].per_wall, r[0].bytes,
               threads < 2 ? "-" : r[0].digest == r[1].digest ? "yes" : "NO");
        fflush(stdout);
    }
    return EXIT_DONE;
}
