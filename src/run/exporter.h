/* exporter.h - the frames of a run as files of other programs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef EXPORTER_H
#define EXPORTER_H

#include "base/file.h"
#include "model/grains.h"
#include "run/h5md.h"
#include "run/mapper.h"

/* X(name, the file of all frames as text or NULL, its writer, what it is) */
#define EXPORTER_FORMATS(X)                                                             \
    X(csv,    NULL, NULL, "grains_000012.csv: a table a frame, " EXPORTER_COLUMNS)      \
    X(npy,    NULL, NULL, "grains_000012.npy: NumPy records, a file a frame")           \
    X(vtp,    NULL, NULL, "grains_000012.vtp: points for ParaView, a file a frame")     \
    X(vti,    NULL, NULL, "density_000012.vti, ...: field maps, as `measure` says")     \
    X(lammps, "grains.lammpstrj", snapshot_lammps,                                      \
      "grains.lammpstrj: a LAMMPS text dump of all frames")                             \
    X(extxyz, "grains.xyz", snapshot_extxyz,                                            \
      "grains.xyz: extended XYZ of all frames, for ASE and OVITO")                      \
    X(h5md,   NULL, NULL, "trajectory.h5: all frames in HDF5, as H5MD 1.1")

#define EXPORTER_COLUMNS "id,x,y,vx,vy,spin,radius,collision_rate,species"

enum exporter_format {
#define X(name, file, writer, doc) EXPORTER_##name,
    EXPORTER_FORMATS(X)
#undef X
    EXPORTER_FORMAT_COUNT
};

struct exporter {
    const struct scene *scene;
    char     directory[FILE_PATH_MAX];
    unsigned formats;           /* 1 << EXPORTER_... */
    bool     keeps;             /* refuses to overwrite */
    struct file texts[EXPORTER_FORMAT_COUNT];   /* of the formats that hold all frames as text */
    struct mapper mapper;
    struct h5md *h5md;
};

/* "csv,h5md" as a set of bits; false if a word is unknown. */
bool exporter_parse(const char *words, unsigned *formats, struct error *error);

/* Files that are there already are refused unless `force`. */
bool exporter_open(struct exporter *exporter, const struct scene *scene, const char *directory,
                   unsigned formats, bool force, struct error *error);
bool exporter_add(struct exporter *exporter, const struct grains *grains, uint32_t frame,
                  uint64_t steps, struct error *error);

/* The files that hold all frames appear. */
bool exporter_commit(struct exporter *exporter, struct error *error);

/* Frees everything; what was not committed leaves no trace. */
void exporter_close(struct exporter *exporter);

#endif
