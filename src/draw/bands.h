/* bands.h - the grains of a picture, sorted into bands of rows.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BANDS_H
#define BANDS_H

#include "base/error.h"
#include "draw/splat.h"

#include <stdbool.h>
#include <stdint.h>

/* All zero is empty and ready.  Fill splats[0..count-1] after bands_reserve(), then sort. */
struct bands {
    struct splat *splats;
    uint32_t  count, capacity;
    uint32_t  rows, band_count;         /* a band's height, and how many there are */
    uint32_t *index;            /* splats of each band, in order, one band after the other */
    uint32_t *starts;           /* where each band begins in `index`; one more than bands */
    uint32_t  index_capacity, starts_capacity;
    struct splat *picked;
    uint32_t  picked_capacity;
};

bool bands_reserve(struct bands *bands, uint32_t count, struct error *error);
void bands_free(struct bands *bands);

/* Sorts into bands of `rows` rows of a picture of this height; a grain that reaches into several
 * is in each of them. */
bool bands_sort(struct bands *bands, uint32_t rows, uint32_t height, struct error *error);

/* The grains of a band: indices into splats. */
const uint32_t *bands_index(const struct bands *bands, uint32_t band, uint32_t *count);

/* The same as one array, valid until the next call. */
const struct splat *bands_pick(struct bands *bands, uint32_t band);

#endif
