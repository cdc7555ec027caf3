/* npy.h - NumPy's array files: numpy.load reads what is written here, and the other way round.
 *
 * A file is a magic word, a Python dictionary in text (type, order, shape) and the bare values,
 * little-endian, last index fastest.  Loading trusts nothing: type, shape and size must agree.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef NPY_H
#define NPY_H

#include "base/error.h"
#include "model/field.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { NPY_DIMENSIONS_MAX = 8, NPY_TYPE_MAX = 1024 };

/* `type` is NumPy's word: "<f8", "<f4", "<i4", "<u4", "<u2", "|u1", ... or a list of records
 * "[('id', '<u4'), ('x', '<f8')]", packed without gaps. */
struct npy {
    char     type[NPY_TYPE_MAX];        /* without blanks */
    size_t   width;                     /* bytes of one item */
    uint32_t dimensions;                /* 0: a single number */
    uint64_t shape[NPY_DIMENSIONS_MAX];
    uint64_t count;                     /* of items: the product of the shape */
    void    *values;
};

/* Writes one whole file. */
bool npy_save(const char *path, const char *type, const uint64_t *shape, uint32_t dimensions,
              const void *values, struct error *error);

/* A map as "<f8" of shape (ny, nx) or (components, ny, nx); row 0 is the lowest. */
bool npy_save_field(const char *path, const struct field *field, struct error *error);

/* Reads any array of fixed-width numbers in C order; the caller frees with npy_free. */
bool npy_load(const char *path, struct npy *npy, struct error *error);
void npy_free(struct npy *npy);

/* Is this the type, blanks aside? */
bool npy_is(const struct npy *npy, const char *type);

/* Bytes of one item of a type; 0 if it is none of the above. */
size_t npy_width(const char *type);

#endif
