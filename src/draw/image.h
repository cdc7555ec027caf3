/* image.h - pixels in memory, and PNG files of them.  SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMAGE_H
#define IMAGE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct image {
    uint32_t width, height;
    uint8_t *rgba;              /* row 0 is the top; straight (not premultiplied) alpha */
};

struct image_note { const char *key, *text; };  /* a PNG tEXt/iTXt chunk */

enum { IMAGE_SIDE_MAX = 16384 };

bool image_create(struct image *image, uint32_t width, uint32_t height, struct error *error);
void image_free(struct image *image);

/* Copies a picture into its place in a larger one; the part must fit. */
void image_place(struct image *whole, const struct image *part, uint32_t x0, uint32_t y0);

/* Encodes as PNG: RGB when every pixel is opaque, else RGBA; zlib `level` 0..9, of which 1 is the
 * fast one for films (image.c tells what was measured).
 * *bytes is malloc'ed, the caller frees.  Safe to call from several threads at once. */
bool image_encode(const struct image *image, int level, const struct image_note *notes,
                  uint32_t note_count, uint8_t **bytes, size_t *size, struct error *error);

/* Encodes and writes one whole file (base/file.h). */
bool image_save(const struct image *image, const char *path, int level,
                const struct image_note *notes, uint32_t note_count, struct error *error);

/* Reads a PNG of any kind as RGBA.  What the bytes claim to hold takes no memory that they cannot
 * fill. */
bool image_decode(struct image *image, const void *bytes, size_t size, struct error *error);
bool image_load(struct image *image, const char *path, struct error *error);

/* The largest difference of any channel, and how many pixels differ by more than `tolerance`.
 * False if the sizes differ. */
bool image_compare(const struct image *a, const struct image *b, int tolerance, int *largest,
                   uint64_t *differing);

#endif
