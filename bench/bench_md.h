/* bench_md.h - how fast soft discs are: a settled bed, the case that other DEM codes are measured
 * on too (gran/hooke/history of LAMMPS).
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BENCH_MD_H
#define BENCH_MD_H

#include "base/error.h"
#include "model/grains.h"

#include <stdbool.h>
#include <stdint.h>

struct bench_md_case {
    uint32_t tiles;             /* of 10,000 discs each, side by side */
    uint32_t steps;             /* measured */
    uint32_t repeats;           /* the best counts: others may use the machine */
    bool     friction;
};

struct bench_md_result {
    uint32_t grains;
    double particle_steps[3];   /* per second of wall time, the best: [1] one thread, [2] two */
    double per_core[3];         /* per processor second of all threads */
    double gain;                /* wall time on one thread / on two, median of neighbouring runs */
    double contacts;            /* per grain, each counted at both */
    uint64_t tangential;        /* forces evaluated */
};

/* One settled tile; the caller frees with grains_free. */
bool bench_md_settle(struct grains *tile, struct error *error);

/* Lays copies of the tile side by side and measures with one and two threads. */
bool bench_md(const struct bench_md_case *what, const struct grains *tile,
              struct bench_md_result *result, struct error *error);

/* Writes the tile as a LAMMPS data file, for a comparison in the same session. */
bool bench_md_export(const struct grains *tile, const char *path, struct error *error);

#endif
