/* snapshot.h - grains as text that other programs read: LAMMPS's dump and extended XYZ.
 *
 * Both hold many snapshots in one file, one after the other, a line for each grain.  Numbers read
 * back to the same bits, and z is 0.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SNAPSHOT_H
#define SNAPSHOT_H

#include "model/grains.h"
#include "scene/scene.h"

#include <stdio.h>

/* A snapshot as `dump custom` writes it, for LAMMPS (read_dump, rerun), OVITO, ASE, VMD: id type
 * x y z vx vy vz radius mass angle omegaz rate; ids and species (`type`) count from 1, as LAMMPS
 * demands. */
void snapshot_lammps(FILE *stream, const struct grains *grains, const struct scene *scene,
                     uint64_t steps);

/* For ASE and OVITO.  All grains are of the chemical dummy "X"; `type` holds the species, counted
 * from 0. */
void snapshot_extxyz(FILE *stream, const struct grains *grains, const struct scene *scene,
                     uint64_t steps);

#endif
