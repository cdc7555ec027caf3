/* image.c - see image.h.
 *
 * Encoding is where a film's time goes, so it does as little as it can: RGB when no pixel is
 * transparent, the filter and the zlib strategy that measured best on pictures of grains (see
 * choose_compression), and one pass over the pixels.  libpng reports failure by longjmp; every
 * call that may jump is inside a function whose locals are not read after the jump, all state
 * lives in a struct of the caller.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/image.h"

#include "base/file.h"

#include <assert.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* A PNG of the largest picture, stored without compression, stays below this. */
static const size_t file_size_max = (size_t)IMAGE_SIDE_MAX * IMAGE_SIDE_MAX * 4 + (64u << 20);

bool image_create(struct image *image, uint32_t width, uint32_t height, struct error *error)
{
    *image = (struct image){.width = width, .height = height};
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX) {
        return error_set(error, "a picture of %ux%u pixels cannot be made: each side must be "
                         "from 1 to %d", width, height, IMAGE_SIDE_MAX);
    }
    image->rgba = calloc((size_t)width * height, 4);
    if (image->rgba) return true;
    return error_set(error, "not enough memory for a picture of %ux%u pixels", width, height);
}

void image_free(struct image *image)
{
    free(image->rgba);
    image->rgba = NULL;
}

void image_place(struct image *whole, const struct image *part, uint32_t x0, uint32_t y0)
{
    assert(x0 + part->width <= whole->width);
    assert(y0 + part->height <= whole->height);
    for (uint32_t y = 0; y < part->height; y++) {
        memcpy(whole->rgba + 4 * ((size_t)(y0 + y) * whole->width + x0),
               part->rgba + 4 * (size_t)y * part->width, 4 * (size_t)part->width);
    }
}

/* ---- encoding ---- */

struct encoder {
    png_structp png;
    png_infop info;
    uint8_t *bytes, *row;       /* the file so far; one line of RGB */
    size_t size, capacity;
    char reason[120];
};

static void remember_reason(png_structp png, png_const_charp message)
{
    char *reason = png_get_error_ptr(png);
    snprintf(reason, 120, "%s", message);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void append_bytes(png_structp png, png_bytep data, size_t count)
{
    struct encoder *encoder = png_get_io_ptr(png);
    if (encoder->size + count > encoder->capacity) {
        size_t capacity = encoder->capacity ? encoder->capacity * 2 : 1 << 16;
        while (capacity < encoder->size + count) capacity *= 2;
        uint8_t *bytes = realloc(encoder->bytes, capacity);
        if (!bytes) png_error(png, "not enough memory");
        encoder->bytes = bytes;
        encoder->capacity = capacity;
    }
    memcpy(encoder->bytes + encoder->size, data, count);
    encoder->size += count;
}

static void flush_nothing(png_structp png) { (void)png; }

static bool image_is_opaque(const struct image *image)
{
    const size_t count = (size_t)image->width * image->height;
    uint8_t all = 255;
    for (size_t k = 0; k < count; k++) all &= image->rgba[4 * k + 3];
    return all == 255;
}

static bool text_is_ascii(const char *text)
{
    for (; *text; text++) if ((unsigned char)*text >= 128) return false;
    return true;
}

static void write_notes(struct encoder *encoder, const struct image_note *notes, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        png_text text = {
            .key = (char *)(uintptr_t)notes[k].key,
            .text = (char *)(uintptr_t)notes[k].text,
        };
        if (text_is_ascii(notes[k].text)) {
            text.compression = PNG_TEXT_COMPRESSION_NONE;
            text.text_length = strlen(notes[k].text);
        } else {
            text.compression = PNG_ITXT_COMPRESSION_NONE;
            text.itxt_length = strlen(notes[k].text);
        }
        png_set_text(encoder->png, encoder->info, &text, 1);
    }
}

/* Measured on 1280x720 pictures, CPU milliseconds and KiB, dense packings of 5,000 and of 100,000
 * grains filling the picture:
 *     no filter, level 1             32  900    45 1413
 *     no filter, Z_RLE               24 1459    21 1591
 *     up filter, Z_RLE               22 1034    34 1539
 *     libpng's default (level 6)     83  953    84 1479
 * Grains are noise to the search for repetitions that the levels above differ in, so level 1 takes
 * the up filter and runs only; who asks for more gets the unfiltered picture, which then packs
 * best. */
static void choose_compression(png_structp png, int level)
{
    png_set_filter(png, PNG_FILTER_TYPE_BASE, level == 1 ? PNG_FILTER_UP : PNG_FILTER_NONE);
    if (level == 1) png_set_compression_strategy(png, Z_RLE);
    png_set_compression_level(png, level);
    png_set_compression_buffer_size(png, 1 << 16);
}

static const uint8_t *row_as_rgb(const struct image *image, uint32_t y, uint8_t *row)
{
    const uint8_t *from = image->rgba + (size_t)y * image->width * 4;
    for (uint32_t x = 0; x < image->width; x++) {
        row[3 * x] = from[4 * x];
        row[3 * x + 1] = from[4 * x + 1];
        row[3 * x + 2] = from[4 * x + 2];
    }
    return row;
}

static bool encode_all(struct encoder *encoder, const struct image *image, bool opaque, int level,
                       const struct image_note *notes, uint32_t note_count)
{
    png_structp png = encoder->png;
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, encoder, append_bytes, flush_nothing);
    png_set_user_limits(png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_set_IHDR(png, encoder->info, image->width, image->height, 8,
                 opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    choose_compression(png, level);
    write_notes(encoder, notes, note_count);
    png_write_info(png, encoder->info);
    for (uint32_t y = 0; y < image->height; y++) {
        png_write_row(png, opaque ? row_as_rgb(image, y, encoder->row)
                                  : image->rgba + (size_t)y * image->width * 4);
    }
    png_write_end(png, encoder->info);
    return true;
}

bool image_encode(const struct image *image, int level, const struct image_note *notes,
                  uint32_t note_count, uint8_t **bytes, size_t *size, struct error *error)
{
    assert(image->rgba);
    assert(level >= 0);
    assert(level <= 9);
    struct encoder encoder = {.row = malloc((size_t)image->width * 3)};
    *bytes = NULL;
    *size = 0;
    snprintf(encoder.reason, sizeof encoder.reason, "not enough memory");
    encoder.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, encoder.reason, remember_reason,
                                          ignore_warning);
    if (encoder.png) encoder.info = png_create_info_struct(encoder.png);
    const bool done = encoder.row && encoder.info
        && encode_all(&encoder, image, image_is_opaque(image), level, notes, note_count);
    png_destroy_write_struct(&encoder.png, &encoder.info);
    free(encoder.row);
    if (!done) {
        free(encoder.bytes);
        return error_set(error, "cannot make a PNG of %ux%u pixels: %s", image->width,
                         image->height, encoder.reason);
    }
    *bytes = encoder.bytes;
    *size = encoder.size;
    return true;
}

bool image_save(const struct image *image, const char *path, int level,
                const struct image_note *notes, uint32_t note_count, struct error *error)
{
    uint8_t *bytes;
    size_t size;
    if (!image_encode(image, level, notes, note_count, &bytes, &size, error)) return false;
    const bool done = file_save(path, bytes, size, error);
    free(bytes);
    return done;
}

/* ---- reading ---- */

/* No deflated byte makes more than 1032 bytes (258 for two bits). */
static const size_t deflate_most = 1032;

struct decoder {
    png_structp png;
    png_infop info;
    const uint8_t *bytes;
    size_t size, used;
    png_bytep *rows;
    char reason[120];
};

static void take_bytes(png_structp png, png_bytep data, size_t count)
{
    struct decoder *decoder = png_get_io_ptr(png);
    if (count > decoder->size - decoder->used) png_error(png, "it ends too early");
    memcpy(data, decoder->bytes + decoder->used, count);
    decoder->used += count;
}

/* Whatever the file holds (palette, grey, 16 bits, a transparent colour), rows come as RGBA. */
static void ask_for_rgba(struct decoder *decoder)
{
    png_structp png = decoder->png;
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, decoder->info);
    if (png_get_rowbytes(png, decoder->info)
        != (size_t)png_get_image_width(png, decoder->info) * 4) {
        png_error(png, "its pixels have an unknown form");
    }
}

static bool decode_all(struct decoder *decoder, struct image *image)
{
    png_structp png = decoder->png;
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, decoder, take_bytes);
    png_set_user_limits(png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(png, 64u << 20);
    png_read_info(png, decoder->info);
    const size_t raw = png_get_rowbytes(png, decoder->info);
    if (raw * png_get_image_height(png, decoder->info) > deflate_most * decoder->size) {
        png_error(png, "it is too short for its size");
    }
    ask_for_rgba(decoder);
    const uint32_t width = png_get_image_width(png, decoder->info);
    const uint32_t height = png_get_image_height(png, decoder->info);
    struct error error;
    if (!image_create(image, width, height, &error)) png_error(png, "not enough memory");
    decoder->rows = malloc(height * sizeof *decoder->rows);
    if (!decoder->rows) png_error(png, "not enough memory");
    for (uint32_t y = 0; y < height; y++) decoder->rows[y] = image->rgba + (size_t)y * width * 4;
    png_read_image(png, decoder->rows);
    png_read_end(png, NULL);
    return true;
}

/* Does every chunk end within the file?  libpng believes a chunk's length before it has read it,
 * and takes up to 2 GB for it. */
static bool chunks_fit(const uint8_t *bytes, size_t size)
{
    enum { SIGNATURE = 8, FRAME = 12 };         /* length, name and checksum of a chunk */
    for (size_t at = SIGNATURE; at + FRAME <= size;) {
        const uint8_t *b = bytes + at;
        const size_t length = (size_t)b[0] << 24 | (size_t)b[1] << 16 | (size_t)b[2] << 8 | b[3];
        if (length > size - at - FRAME) return false;
        at += FRAME + length;
    }
    return true;
}

bool image_decode(struct image *image, const void *bytes, size_t size, struct error *error)
{
    *image = (struct image){0};
    struct decoder decoder = {.bytes = bytes, .size = size};
    if (!chunks_fit(bytes, size)) {
        return error_set(error, "cannot read this as a PNG picture: a part of it is cut off");
    }
    snprintf(decoder.reason, sizeof decoder.reason, "not enough memory");
    decoder.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, decoder.reason, remember_reason,
                                         ignore_warning);
    if (decoder.png) decoder.info = png_create_info_struct(decoder.png);
    const bool done = decoder.info && decode_all(&decoder, image);
    png_destroy_read_struct(&decoder.png, &decoder.info, NULL);
    free(decoder.rows);
    if (done) return true;
    image_free(image);
    return error_set(error, "cannot read this as a PNG picture: %s", decoder.reason);
}

bool image_load(struct image *image, const char *path, struct error *error)
{
    *image = (struct image){0};
    size_t size;
    uint8_t *bytes = file_load(path, file_size_max, &size, error);
    struct error cause = {0};
    if (!bytes) return false;
    const bool done = image_decode(image, bytes, size, &cause);
    free(bytes);
    return done || error_set(error, "%s: %.600s", path, cause.text);
}

/* ---- comparing ---- */

bool image_compare(const struct image *a, const struct image *b, int tolerance, int *largest,
                   uint64_t *differing)
{
    *largest = 0;
    *differing = 0;
    if (a->width != b->width || a->height != b->height) return false;
    const size_t count = (size_t)a->width * a->height;
    for (size_t k = 0; k < count; k++) {
        int difference = 0;
        for (size_t c = 0; c < 4; c++) {
            const int d = abs(a->rgba[4 * k + c] - b->rgba[4 * k + c]);
            if (d > difference) difference = d;
        }
        if (difference > *largest) *largest = difference;
        *differing += difference > tolerance;
    }
    return true;
}
