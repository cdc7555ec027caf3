/* bench_ed.h - what a collision of hard discs costs: a square lattice in a periodic box, made a
 * gas by elastic collisions, then timed (processor seconds).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef BENCH_ED_H
#define BENCH_ED_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

struct bench_ed_case {
    uint32_t side;              /* grains: side * side */
    double   fraction;          /* of the area */
    double   restitution;       /* after the equilibration */
    double   settle, collisions;        /* collisions per grain (C/N = 2 C / N) before and during */
    const char *setting;        /* "ed.cell=1.6"; NULL: as it stands */
};

struct bench_ed_result {
    double ns, elastic;         /* per collision */
    double crossings;           /* events besides, per collision: crossings of cells, and contacts
                                 * whose partner has gone elsewhere, which are predicted anew */
    double bytes;               /* per grain, of the state */
    uint64_t collisions;
    double energy;              /* kinetic energy at the end over that at the start of the timing */
    double time;                /* simulated, while timed */
};

bool bench_ed(const struct bench_ed_case *what, struct bench_ed_result *result,
              struct error *error);

#endif
