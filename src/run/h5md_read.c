/* h5md_read.c - see h5md_read.h.
 *
 * The file is a foreign one until it has been looked at: every dataset must have the shape that
 * h5md.c gives it, and a frame that a killed program left half written at the end is passed over.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/h5md_read.h"

#include "run/h5md.h"

#ifdef SANDREEL_HDF5

#include "run/h5md_layout.h"

#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct h5md_read {
    char     path[4096];
    hid_t    file;
    hsize_t  frames, rows;
    bool     failed;            /* a call of the library did, or a dataset has another shape */
};

static bool refuse(const struct h5md_read *reader, struct error *error)
{
    return error_set(error, "%s: not a trajectory that sandreel has written, or one whose end is "
                     "missing", reader->path);
}

/* A dataset of `particles/all`, opened; its extent, which must have `rank` dimensions. */
static hid_t open_set(struct h5md_read *reader, const char *element, const char *part, int rank,
                      hsize_t size[3])
{
    char name[120];
    snprintf(name, sizeof name, "particles/all/%s/%s", element, part);
    const hid_t set = H5Dopen2(reader->file, name, H5P_DEFAULT);
    const hid_t space = set >= 0 ? H5Dget_space(set) : -1;
    const bool fits = space >= 0 && H5Sget_simple_extent_ndims(space) == rank
                   && H5Sget_simple_extent_dims(space, size, NULL) == rank
                   && (rank < 3 || size[2] == 2);
    if (!fits) reader->failed = true;
    if (space >= 0) H5Sclose(space);
    return set;
}

/* Within a frame that is being written the datasets differ in length: the shortest counts. */
static void measure_set(struct h5md_read *reader, const char *element, const char *part, int rank)
{
    hsize_t size[3] = {0};
    const hid_t set = open_set(reader, element, part, rank, size);
    if (set >= 0) H5Dclose(set);
    if (reader->failed) return;
    if (size[0] < reader->frames) reader->frames = size[0];
    if (rank > 1 && size[1] < reader->rows) reader->rows = size[1];
}

static void measure_all(struct h5md_read *reader)
{
    reader->frames = reader->rows = UINT32_MAX - 1;
    measure_set(reader, "position", "step", 1);
    measure_set(reader, "position", "time", 1);
    measure_set(reader, "position", "value", 3);
    measure_set(reader, "velocity", "value", 3);
#define X(name, member, type, dimension) measure_set(reader, #name, "value", 2);
    H5MD_SCALARS(X)
#undef X
}

/* `count` rows of a frame; with rank 1 `count` frames from `frame` on. */
static bool read_rows(struct h5md_read *reader, const char *element, const char *part, int rank,
                      hid_t type, hsize_t frame, hsize_t count, void *values)
{
    hsize_t extent[3] = {0};
    const hsize_t start[3] = {frame, 0, 0}, size[3] = {rank == 1 ? count : 1, count, 2};
    if (count == 0) return true;
    const hid_t set = open_set(reader, element, part, rank, extent);
    const hid_t memory = H5Screate_simple(rank, size, NULL);
    const hid_t space = set >= 0 ? H5Dget_space(set) : -1;
    const bool done = !reader->failed && space >= 0
        && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, size, NULL) >= 0
        && H5Dread(set, type, memory, space, H5P_DEFAULT, values) >= 0;
    if (space >= 0) H5Sclose(space);
    H5Sclose(memory);
    if (set >= 0) H5Dclose(set);
    return done;
}

/* Times grow; where they stop to, or are missing, the rest was never finished. */
static bool list_frames(struct h5md_read *reader, struct dump_index *index, struct error *error)
{
    const size_t count = (size_t)reader->frames;
    double *times = malloc((count + 1) * sizeof *times);
    uint64_t *steps = malloc((count + 1) * sizeof *steps);
    *index = (struct dump_index){.entries = malloc((count + 1) * sizeof *index->entries)};
    bool done = (times && steps && index->entries)
             || error_set(error, "%s: not enough memory", reader->path);
    const hid_t whole = H5T_NATIVE_UINT64;
    done = done && ((read_rows(reader, "position", "time", 1, H5T_NATIVE_DOUBLE, 0, count, times)
                     && read_rows(reader, "position", "step", 1, whole, 0, count, steps))
                    || refuse(reader, error));
    index->capacity = (uint32_t)count + 1;
    for (size_t k = 0; done && k < count; k++) {
        if (!(times[k] > (k ? times[k - 1] : -INFINITY))) break;
        index->entries[index->count++] = (struct dump_entry){.frame = (uint32_t)k,
            .time = times[k], .steps = steps[k], .grains = (uint32_t)reader->rows};
    }
    free(times);
    free(steps);
    return done;
}

static hid_t open_file(const char *path)
{
    /* While it is written, or was when its program was killed, only the second way is open. */
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);      /* nothing is printed below the command line */
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    return file >= 0 ? file : H5Fopen(path, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, H5P_DEFAULT);
}

struct h5md_read *h5md_read_open(const char *path, struct dump_index *index, struct error *error)
{
    struct h5md_read *reader = calloc(1, sizeof *reader);
    if (!reader) {
        error_set(error, "%s: not enough memory", path);
        return NULL;
    }
    snprintf(reader->path, sizeof reader->path, "%s", path);
    reader->file = open_file(path);
    reader->failed = reader->file < 0;
    if (!reader->failed) measure_all(reader);
    bool done = !reader->failed || refuse(reader, error);
    done = done && list_frames(reader, index, error);
    struct grains last = {0};
    if (done && index->count > 0 && !h5md_read_frame(reader, index->count - 1, &last, NULL)) {
        index->count--;
    }
    grains_free(&last);
    if (done) return reader;
    dump_index_free(index);
    h5md_read_close(reader);
    return NULL;
}

/* Ids come first, then rows without a grain. */
static bool count_grains(struct h5md_read *reader, uint32_t frame, uint32_t *count,
                         struct error *error)
{
    uint32_t *ids = malloc(((size_t)reader->rows + 1) * sizeof *ids);
    if (!ids) return error_set(error, "%s: not enough memory", reader->path);
    const bool done = read_rows(reader, "id", "value", 2, H5T_NATIVE_UINT32, frame, reader->rows,
                                ids);
    for (*count = 0; done && *count < reader->rows && ids[*count] != H5MD_NO_ID;) ++*count;
    free(ids);
    return done || refuse(reader, error);
}

/* The two halves of a pair; false also if one is missing, as in a frame that was not finished. */
static bool read_pairs(struct h5md_read *reader, const char *element, uint32_t frame,
                       uint32_t count, double *x, double *y)
{
    double *pairs = malloc(((size_t)count + 1) * 2 * sizeof *pairs);
    bool done = pairs && read_rows(reader, element, "value", 3, H5T_NATIVE_DOUBLE, frame, count,
                                   pairs);
    for (uint32_t k = 0; done && k < count; k++) {
        x[k] = pairs[2 * (size_t)k];
        y[k] = pairs[2 * (size_t)k + 1];
        done = isfinite(x[k]) && isfinite(y[k]);
    }
    free(pairs);
    return done;
}

bool h5md_read_frame(struct h5md_read *reader, uint32_t frame, struct grains *grains,
                     struct error *error)
{
    uint32_t count = 0;
    grains_free(grains);
    /* One more than needed, so that an empty frame has arrays too. */
    if (!count_grains(reader, frame, &count, error)
        || !grains_create(grains, count + 1, 0, error)) {
        return false;
    }
    bool done = read_pairs(reader, "position", frame, count, grains->x, grains->y)
             && read_pairs(reader, "velocity", frame, count, grains->vx, grains->vy);
#define X(name, member, type, dimension) \
    done = done && read_rows(reader, #name, "value", 2, type, frame, count, grains->member);
    H5MD_SCALARS(X)
#undef X
    for (uint32_t k = 0; done && k < count; k++) {
        done = grains->radius[k] > 0 && isfinite(grains->mass[k]) && isfinite(grains->spin[k]);
    }
    grains->count = done ? count : 0;
    return done || error_set(error, "%s: frame %u is not whole", reader->path, frame);
}

void h5md_read_close(struct h5md_read *reader)
{
    if (!reader) return;
    if (reader->file >= 0) H5Fclose(reader->file);
    free(reader);
}

#else

struct h5md_read *h5md_read_open(const char *path, struct dump_index *index, struct error *error)
{
    (void)path;
    *index = (struct dump_index){0};
    h5md_available(error);
    return NULL;
}

bool h5md_read_frame(struct h5md_read *reader, uint32_t frame, struct grains *grains,
                     struct error *error)
{
    (void)reader;
    (void)frame;
    (void)grains;
    return h5md_available(error);
}

void h5md_read_close(struct h5md_read *reader) { (void)reader; }

#endif
