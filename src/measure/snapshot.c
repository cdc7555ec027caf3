/* snapshot.c - see snapshot.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/snapshot.h"

#include "measure/csv.h"

#include <inttypes.h>

/* What both formats say of a grain, in this order. */
static void write_numbers(FILE *stream, const struct grains *grains, uint32_t k)
{
    const double numbers[] = {
        grains->x[k], grains->y[k], 0, grains->vx[k], grains->vy[k], 0, grains->radius[k],
        grains->mass[k], grains->angle[k], grains->spin[k], (double)grains->collision_rate[k],
    };
    csv_numbers(stream, ' ', numbers, sizeof numbers / sizeof *numbers);
}

static void write_bounds(FILE *stream, double low, double high)
{
    csv_number(stream, low);
    csv_numbers(stream, ' ', &high, 1);
    fputc('\n', stream);
}

void snapshot_lammps(FILE *stream, const struct grains *grains, const struct scene *scene,
                     uint64_t steps)
{
    /* A flat simulation of LAMMPS has a periodic z of any thickness: one diameter. */
    const double *box = scene->box, half = scene->radius_max;
    fputs("ITEM: TIME\n", stream);
    csv_number(stream, grains->time);
    fprintf(stream, "\nITEM: TIMESTEP\n%" PRIu64 "\nITEM: NUMBER OF ATOMS\n%" PRIu32
            "\nITEM: BOX BOUNDS %s %s pp\n", steps, grains->count,
            scene->left == BORDER_PERIODIC ? "pp" : "ff",
            scene->bottom == BORDER_PERIODIC ? "pp" : "ff");
    write_bounds(stream, box[0], box[2]);
    write_bounds(stream, box[1], box[3]);
    write_bounds(stream, -half, half);
    fputs("ITEM: ATOMS id type x y z vx vy vz radius mass angle omegaz rate\n", stream);
    for (uint32_t k = 0; k < grains->count; k++) {
        fprintf(stream, "%" PRIu32 " %u", grains->id[k] + 1, grains->species[k] + 1u);
        write_numbers(stream, grains, k);
        fputc('\n', stream);
    }
}

void snapshot_extxyz(FILE *stream, const struct grains *grains, const struct scene *scene,
                     uint64_t steps)
{
    const double *box = scene->box;
    const double lattice[9] = {box[2] - box[0], 0, 0, 0, box[3] - box[1], 0, 0, 0,
                               2 * scene->radius_max};
    fprintf(stream, "%" PRIu32 "\nLattice=\"", grains->count);
    csv_number(stream, lattice[0]);
    csv_numbers(stream, ' ', lattice + 1, 8);
    fputs("\" Origin=\"", stream);
    csv_number(stream, box[0]);
    csv_numbers(stream, ' ', (const double[]){box[1], 0}, 2);
    fprintf(stream, "\" pbc=\"%c %c F\" Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1:"
            "mass:R:1:angle:R:1:spin:R:1:collision_rate:R:1:id:I:1:type:I:1 Time=",
            scene->left == BORDER_PERIODIC ? 'T' : 'F',
            scene->bottom == BORDER_PERIODIC ? 'T' : 'F');
    csv_number(stream, grains->time);
    fprintf(stream, " Step=%" PRIu64 "\n", steps);
    for (uint32_t k = 0; k < grains->count; k++) {
        fputc('X', stream);
        write_numbers(stream, grains, k);
        fprintf(stream, " %" PRIu32 " %u\n", grains->id[k], (unsigned)grains->species[k]);
    }
}
