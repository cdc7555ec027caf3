/* ed.c - prints what collisions of hard discs cost (bench_ed.h): ./ed [REPEATS [SETTING]]
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/bench_ed.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    const int repeats = argc > 1 ? atoi(argv[1]) : 3;
    const char *setting = argc > 2 ? argv[2] : NULL;
    static const struct bench_ed_case cases[] = {
        {316, 0.25, 1, 5, 10, NULL}, {316, 0.25, 0.8, 5, 20, NULL},
        {100, 0.25, 1, 10, 40, NULL}, {100, 0.25, 0.8, 10, 40, NULL},
        {316, 0.70, 1, 20, 20, NULL}, {100, 0.70, 1, 20, 80, NULL},
        {1000, 0.25, 1, 3, 4, NULL},
    };
    printf("%9s %6s %6s %9s %10s %8s\n", "grains", "nu", "r", "ns", "other", "E/E0");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct bench_ed_case what = cases[k];
        struct bench_ed_result best = {.ns = INFINITY};
        what.setting = setting;
        for (int turn = 0; turn < repeats; turn++) {
            struct bench_ed_result result;
            struct error error;
            if (!bench_ed(&what, &result, &error)) {
                fprintf(stderr, "%s\n", error.text);
                return EXIT_FAILED;
            }
            if (result.ns < best.ns) best = result;
        }
        printf("%9u %6.2f %6.2f %9.1f %10.2f %8.4f\n", what.side * what.side, what.fraction,
               what.restitution, best.ns, best.crossings, best.energy);
        fflush(stdout);
    }
    return EXIT_DONE;
}
