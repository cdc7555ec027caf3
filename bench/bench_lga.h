/* bench_lga.h - how many nodes of a lattice gas are updated a second.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef BENCH_LGA_H
#define BENCH_LGA_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

struct bench_lga_case {
    const char *name;
    const char *method;
    const char *rule;           /* further keys of `lga` */
    double   fill;              /* share of the slots with movers at the start */
    bool     walls, gravity;
    uint32_t side, ticks;       /* nodes along each side; measured */
};

struct bench_lga_result {
    double updates;             /* per processor second */
    double cpu, wall;
    double grains;              /* a node */
};

extern const struct bench_lga_case bench_lga_list[];    /* ends with a NULL name */

bool bench_lga(const struct bench_lga_case *what, struct bench_lga_result *result,
               struct error *error);

#endif
