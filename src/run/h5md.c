/* h5md.c - see h5md.h.
 *
 * Every element of H5MD has datasets `value`, `step` and `time`; the last two are one pair for all,
 * linked into each.  A frame is one chunk row of each value, so nothing is read to append.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/h5md.h"

#ifdef SANDREEL_HDF5

#include "base/file.h"
#include "run/build.h"
#include "run/h5md_layout.h"

#include <errno.h>
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ELEMENT_position, ELEMENT_velocity,
#define X(name, member, type, dimension) ELEMENT_##name,
    H5MD_SCALARS(X)
#undef X
    ELEMENTS
};

static const struct { const char *name, *dimension; int components; } elements[ELEMENTS] = {
    {"position", "length", 2}, {"velocity", "speed", 2},
#define X(name, member, type, dimension) {#name, dimension, 1},
    H5MD_SCALARS(X)
#undef X
};

enum {
    CHUNK_GRAINS = 8192,        /* rows of a chunk at most: 64 kB of doubles */
    CHUNK_GRAINS_MIN = 64,
    CHUNK_TIMES = 512,
    DEFLATE = 1                 /* higher levels: half the speed for 1 % of the size */
};

struct h5md {
    char    path[FILE_PATH_MAX + 16];
    hid_t   file, group, step, time, values[ELEMENTS];
    hsize_t frames, rows;       /* written; room for grains */
    double *pairs;              /* x and y in turn */
    bool    failed;             /* sticks: a call of the library did */
};

bool h5md_available(struct error *error)
{
    (void)error;
    return true;
}

static bool fail(struct h5md *h5md, const char *what, struct error *error)
{
    return error_set(error, "%s: %s; is the disk full, or the file used by another program?",
                     h5md->path, what);
}

/* Notes a failure; gives back what the library gave. */
static hid_t note(struct h5md *h5md, hid_t result)
{
    if (result < 0) h5md->failed = true;
    return result;
}

static hid_t type_of(int element)
{
    switch (element) {
#define X(name, member, type, dimension) case ELEMENT_##name: return type;
    H5MD_SCALARS(X)
#undef X
    default: return H5T_NATIVE_DOUBLE;
    }
}

/* ---- attributes ---------------------------------------------------------------------------- */

static void put_attribute(struct h5md *h5md, hid_t owner, const char *name, hid_t type,
                          hsize_t count, const void *values)
{
    const hid_t space = count ? H5Screate_simple(1, &count, NULL) : H5Screate(H5S_SCALAR);
    const hid_t attribute = note(h5md, H5Acreate2(owner, name, type, space, H5P_DEFAULT,
                                                  H5P_DEFAULT));
    note(h5md, H5Awrite(attribute, type, values));
    H5Aclose(attribute);
    H5Sclose(space);
}

static void put_text(struct h5md *h5md, hid_t owner, const char *name, const char *text)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text) + 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    put_attribute(h5md, owner, name, type, 0, text);
    H5Tclose(type);
}

/* H5MD writes "m s-1" where we write "m/s". */
static void put_unit(struct h5md *h5md, hid_t dataset, const struct scene *scene,
                     const char *dimension)
{
    char text[64];
    const char *length = scene_unit(scene, "length"), *time = scene_unit(scene, "time");
    const char *unit = scene_unit(scene, dimension);
    if (!*unit) return;
    if (strcmp(dimension, "speed") == 0) snprintf(text, sizeof text, "%s %s-1", length, time);
    else if (strcmp(dimension, "1/time") == 0) snprintf(text, sizeof text, "%s-1", time);
    else snprintf(text, sizeof text, "%s", unit);
    put_text(h5md, dataset, "unit", text);
}

/* ---- a new file ---------------------------------------------------------------------------- */

/* Properties of something new: without the date, so that the same run gives the same bytes. */
static hid_t undated(hid_t class)
{
    const hid_t how = H5Pcreate(class);
    H5Pset_obj_track_times(how, false);
    return how;
}

static hid_t make_group(struct h5md *h5md, hid_t owner, const char *name)
{
    const hid_t how = undated(H5P_GROUP_CREATE);
    const hid_t group = note(h5md, H5Gcreate2(owner, name, H5P_DEFAULT, how, H5P_DEFAULT));
    H5Pclose(how);
    return group;
}

/* /h5md: version, author, creator, and the module that allows units. */
static void write_header(struct h5md *h5md, const struct scene *scene)
{
    static const int version[2] = {1, 1}, module[2] = {1, 0};
    const char *login = getenv("LOGNAME");
    const hid_t root = make_group(h5md, h5md->file, "h5md");
    const hid_t author = make_group(h5md, root, "author");
    const hid_t creator = make_group(h5md, root, "creator");
    put_attribute(h5md, root, "version", H5T_NATIVE_INT, 2, version);
    put_text(h5md, author, "name", login && *login ? login : "unknown");
    put_text(h5md, creator, "name", "sandreel");
    put_text(h5md, creator, "version", build_version);
    if (scene->units != UNITS_REDUCED) {
        const hid_t modules = make_group(h5md, root, "modules");
        const hid_t units = make_group(h5md, modules, "units");
        put_attribute(h5md, units, "version", H5T_NATIVE_INT, 2, module);
        put_text(h5md, units, "system", "SI");
        H5Gclose(units);
        H5Gclose(modules);
    }
    H5Gclose(creator);
    H5Gclose(author);
    H5Gclose(root);
    const hid_t parameters = make_group(h5md, h5md->file, "parameters");
    put_text(h5md, parameters, "scene", scene->name);
    put_text(h5md, parameters, "title", *scene->title ? scene->title : scene->name);
    put_text(h5md, parameters, "model", scene->model);
    put_attribute(h5md, parameters, "seed", H5T_NATIVE_UINT64, 0, &scene->seed);
    H5Gclose(parameters);
}

/* The box.  H5MD knows its edges only; `offset`, our own attribute, is its lower left corner. */
static void write_box(struct h5md *h5md, const struct scene *scene)
{
    const int dimension = 2;
    const double edges[2] = {scene->box[2] - scene->box[0], scene->box[3] - scene->box[1]};
    char boundary[2][9] = {"none", "none"};
    if (scene->left == BORDER_PERIODIC) memcpy(boundary[0], "periodic", 9);
    if (scene->bottom == BORDER_PERIODIC) memcpy(boundary[1], "periodic", 9);
    const hid_t box = make_group(h5md, h5md->group, "box"), type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, sizeof boundary[0]);
    put_attribute(h5md, box, "dimension", H5T_NATIVE_INT, 0, &dimension);
    put_attribute(h5md, box, "boundary", type, 2, boundary);
    put_attribute(h5md, box, "offset", H5T_NATIVE_DOUBLE, 2, scene->box);
    const hid_t space = H5Screate_simple(1, (const hsize_t[]){2}, NULL);
    const hid_t how = undated(H5P_DATASET_CREATE);
    const hid_t set = note(h5md, H5Dcreate2(box, "edges", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                                            how, H5P_DEFAULT));
    H5Pclose(how);
    note(h5md, H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, edges));
    put_unit(h5md, set, scene, "length");
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    H5Gclose(box);
}

/* An extensible dataset without frames yet. */
static hid_t make_dataset(struct h5md *h5md, hid_t owner, const char *name, hid_t type, int rank,
                          const hsize_t chunk[], const void *fill)
{
    const hsize_t size[3] = {0, h5md->rows, 2}, most[3] = {H5S_UNLIMITED, H5S_UNLIMITED, 2};
    const hid_t space = H5Screate_simple(rank, size, most);
    const hid_t how = undated(H5P_DATASET_CREATE);
    note(h5md, H5Pset_chunk(how, rank, chunk));
    note(h5md, H5Pset_shuffle(how));
    note(h5md, H5Pset_deflate(how, DEFLATE));
    note(h5md, H5Pset_fill_value(how, type, fill));
    const hid_t set = note(h5md, H5Dcreate2(owner, name, type, space, H5P_DEFAULT, how,
                                            H5P_DEFAULT));
    H5Pclose(how);
    H5Sclose(space);
    return set;
}

static void make_element(struct h5md *h5md, int element, const struct scene *scene)
{
    static const double none = NAN;
    static const float none_float = NAN;
    static const uint32_t none_whole = H5MD_NO_ID;
    const hid_t type = type_of(element), group = make_group(h5md, h5md->group,
                                                            elements[element].name);
    const void *fill = H5Tget_class(type) == H5T_INTEGER ? (const void *)&none_whole
        : H5Tget_size(type) == sizeof none_float ? (const void *)&none_float : &none;
    const hsize_t chunk[3] = {1, h5md->rows < CHUNK_GRAINS ? h5md->rows : CHUNK_GRAINS, 2};
    h5md->values[element] = make_dataset(h5md, group, "value", type,
                                         elements[element].components == 1 ? 2 : 3, chunk, fill);
    put_unit(h5md, h5md->values[element], scene, elements[element].dimension);
    if (element == 0) {
        const uint64_t zero = 0;
        const hsize_t times[1] = {CHUNK_TIMES};
        h5md->step = make_dataset(h5md, group, "step", H5T_NATIVE_UINT64, 1, times, &zero);
        h5md->time = make_dataset(h5md, group, "time", H5T_NATIVE_DOUBLE, 1, times, &none);
        put_unit(h5md, h5md->time, scene, "time");
    } else {
        note(h5md, H5Olink(h5md->step, group, "step", H5P_DEFAULT, H5P_DEFAULT));
        note(h5md, H5Olink(h5md->time, group, "time", H5P_DEFAULT, H5P_DEFAULT));
    }
    H5Gclose(group);
}

static struct h5md *take(const char *path, struct error *error)
{
    H5dont_atexit();                        /* what is left open after a failure is of no use */
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);  /* nothing is printed below the command line */
    struct h5md *h5md = calloc(1, sizeof *h5md);
    if (!h5md) {
        error_set(error, "%s: not enough memory", path);
        return NULL;
    }
    snprintf(h5md->path, sizeof h5md->path, "%s", path);
    h5md->file = h5md->group = h5md->step = h5md->time = -1;
    for (int e = 0; e < ELEMENTS; e++) h5md->values[e] = -1;
    return h5md;
}

/* The newest format, which single-writer-multiple-readers needs. */
static hid_t access_list(void)
{
    const hid_t how = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(how, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    return how;
}

static struct h5md *ready(struct h5md *h5md, const char *what, struct error *error)
{
    if (!h5md->failed) note(h5md, H5Fstart_swmr_write(h5md->file));
    if (!h5md->failed) return h5md;
    fail(h5md, what, error);
    h5md_close(h5md, NULL);
    return NULL;
}

struct h5md *h5md_create(const char *path, const struct scene *scene, struct error *error)
{
    struct h5md *h5md = take(path, error);
    if (!h5md) return NULL;
    const hid_t how = access_list(), root = undated(H5P_FILE_CREATE);
    h5md->rows = scene->placed.count > CHUNK_GRAINS_MIN ? scene->placed.count : CHUNK_GRAINS_MIN;
    h5md->file = note(h5md, H5Fcreate(path, H5F_ACC_TRUNC, root, how));
    H5Pclose(root);
    H5Pclose(how);
    if (!h5md->failed) {
        write_header(h5md, scene);
        const hid_t particles = make_group(h5md, h5md->file, "particles");
        h5md->group = make_group(h5md, particles, "all");
        write_box(h5md, scene);
        for (int e = 0; e < ELEMENTS; e++) make_element(h5md, e, scene);
        H5Gclose(particles);
    }
    return ready(h5md, "cannot create this trajectory", error);
}

/* ---- frames -------------------------------------------------------------------------------- */

static void set_extent(struct h5md *h5md, hsize_t frames)
{
    const hsize_t size[3] = {frames, h5md->rows, 2};
    note(h5md, H5Dset_extent(h5md->step, size));
    note(h5md, H5Dset_extent(h5md->time, size));
    for (int e = 0; e < ELEMENTS; e++) note(h5md, H5Dset_extent(h5md->values[e], size));
}

/* Writes `count` rows of the last frame. */
static void write_rows(struct h5md *h5md, int element, hsize_t count, const void *values)
{
    const int rank = elements[element].components == 1 ? 2 : 3;
    const hsize_t start[3] = {h5md->frames, 0, 0}, size[3] = {1, count, 2};
    const hid_t memory = H5Screate_simple(rank, size, NULL);
    const hid_t space = note(h5md, H5Dget_space(h5md->values[element]));
    note(h5md, H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, size, NULL));
    if (count) {
        note(h5md, H5Dwrite(h5md->values[element], type_of(element), memory, space, H5P_DEFAULT,
                            values));
    }
    H5Sclose(space);
    H5Sclose(memory);
}

static void write_pairs(struct h5md *h5md, int element, const double *x, const double *y,
                        uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        h5md->pairs[2 * k] = x[k];
        h5md->pairs[2 * k + 1] = y[k];
    }
    write_rows(h5md, element, count, h5md->pairs);
}

static void write_number(struct h5md *h5md, hid_t set, hid_t type, const void *value)
{
    const hsize_t start[1] = {h5md->frames}, size[1] = {1};
    const hid_t memory = H5Screate_simple(1, size, NULL), space = note(h5md, H5Dget_space(set));
    note(h5md, H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, size, NULL));
    note(h5md, H5Dwrite(set, type, memory, space, H5P_DEFAULT, value));
    H5Sclose(space);
    H5Sclose(memory);
}

bool h5md_add(struct h5md *h5md, const struct grains *grains, uint64_t steps, struct error *error)
{
    double *pairs = realloc(h5md->pairs, ((size_t)grains->count + 1) * 2 * sizeof *pairs);
    if (!pairs) return error_set(error, "%s: not enough memory", h5md->path);
    h5md->pairs = pairs;
    if (grains->count > h5md->rows) h5md->rows = grains->count;
    set_extent(h5md, h5md->frames + 1);
    write_number(h5md, h5md->step, H5T_NATIVE_UINT64, &steps);
    write_number(h5md, h5md->time, H5T_NATIVE_DOUBLE, &grains->time);
    write_pairs(h5md, ELEMENT_position, grains->x, grains->y, grains->count);
    write_pairs(h5md, ELEMENT_velocity, grains->vx, grains->vy, grains->count);
#define X(name, member, type, dimension) \
    write_rows(h5md, ELEMENT_##name, grains->count, grains->member);
    H5MD_SCALARS(X)
#undef X
    h5md->frames++;
    return !h5md->failed || fail(h5md, "this frame of the trajectory could not be written", error);
}

bool h5md_sync(struct h5md *h5md, struct error *error)
{
    note(h5md, H5Fflush(h5md->file, H5F_SCOPE_LOCAL));
    if (!file_sync(h5md->path)) h5md->failed = true;
    return !h5md->failed || fail(h5md, "writing stopped", error);
}

bool h5md_rename(struct h5md *h5md, const char *path, struct error *error)
{
    if (rename(h5md->path, path) != 0) {
        return error_set(error, "%s: cannot name this file: %s", path, strerror(errno));
    }
    snprintf(h5md->path, sizeof h5md->path, "%s", path);
    return true;
}

bool h5md_close(struct h5md *h5md, struct error *error)
{
    if (!h5md) return true;
    for (int e = 0; e < ELEMENTS; e++) {
        if (h5md->values[e] >= 0) note(h5md, H5Dclose(h5md->values[e]));
    }
    if (h5md->step >= 0) H5Dclose(h5md->step);
    if (h5md->time >= 0) H5Dclose(h5md->time);
    if (h5md->group >= 0) H5Gclose(h5md->group);
    if (h5md->file >= 0) note(h5md, H5Fclose(h5md->file));
    const bool done = !h5md->failed || fail(h5md, "writing stopped", error);
    free(h5md->pairs);
    free(h5md);
    return done;
}

#else

bool h5md_available(struct error *error)
{
    return error_set(error, "this sandreel was built without HDF5, so it cannot write H5MD; "
                     "install libhdf5-dev and build it again, or use output.dump");
}

struct h5md *h5md_create(const char *path, const struct scene *scene, struct error *error)
{
    (void)path;
    (void)scene;
    h5md_available(error);
    return NULL;
}

bool h5md_add(struct h5md *h5md, const struct grains *grains, uint64_t steps, struct error *error)
{
    (void)h5md;
    (void)grains;
    (void)steps;
    return h5md_available(error);
}

bool h5md_sync(struct h5md *h5md, struct error *error) { return !h5md || h5md_available(error); }

bool h5md_rename(struct h5md *h5md, const char *path, struct error *error)
{
    (void)h5md;
    (void)path;
    return h5md_available(error);
}

bool h5md_close(struct h5md *h5md, struct error *error) { return !h5md || h5md_available(error); }

#endif
