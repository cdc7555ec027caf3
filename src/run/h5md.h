/* h5md.h - trajectory.h5: the grains at many times in one compressed file, in H5MD 1.1 (de Buyl,
 * Colberg and Hofling, Comput. Phys. Commun. 185, 1546, 2014), read by h5py, MDAnalysis, VMD, ...
 *
 * Grains come in the order of their ids, so a grain keeps its row as long as none leaves.  Where
 * their number changes, rows without a grain hold fill values: id 4294967295, numbers NAN.
 *
 * The file may be read while it grows, and a program that is killed leaves a file that can be
 * read and continued (HDF5's single-writer-multiple-readers mode, SWMR).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef H5MD_H
#define H5MD_H

#include "model/grains.h"
#include "scene/scene.h"

struct h5md;

/* Was the program built with HDF5?  False with the cure. */
bool h5md_available(struct error *error);

/* A new file, written under this name at once. */
struct h5md *h5md_create(const char *path, const struct scene *scene, struct error *error);

/* Goes on with an earlier file of the same scene, cut back to its first `frames` frames: it is
 * replaced by a file that holds just them, or stays as it was (h5md_resume.c). */
struct h5md *h5md_resume(const char *path, uint64_t frames, const struct scene *scene,
                         struct error *error);

/* The grains must be sorted (grains_sort). */
bool h5md_add(struct h5md *h5md, const struct grains *grains, uint64_t steps, struct error *error);

/* Brings all frames to the disk. */
bool h5md_sync(struct h5md *h5md, struct error *error);

/* Gives the file another name; h5md writes on. */
bool h5md_rename(struct h5md *h5md, const char *path, struct error *error);

/* Closes and frees; false if what was left could not be written.  NULL is harmless. */
bool h5md_close(struct h5md *h5md, struct error *error);

#endif
