/* h5md_read.h - the grains of trajectory.h5 (h5md.h), also while it is being written and after the
 * program that wrote it was killed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef H5MD_READ_H
#define H5MD_READ_H

#include "measure/dump_index.h"
#include "model/grains.h"

struct h5md_read;

/* Opens a trajectory and lists its frames in `index` (the caller's to free); NULL with a sentence
 * if it is not one, or if the program was built without HDF5. */
struct h5md_read *h5md_read_open(const char *path, struct dump_index *index, struct error *error);

/* Loads a frame into `grains` (freed first).  Contacts and counts of collisions are not in the
 * file. */
bool h5md_read_frame(struct h5md_read *reader, uint32_t frame, struct grains *grains,
                     struct error *error);

/* NULL is harmless. */
void h5md_read_close(struct h5md_read *reader);

#endif
