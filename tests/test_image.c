/* test_image.c - PNG files keep every pixel and note, and broken files are refused.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/image.h"

#include "base/file.h"
#include "base/rng.h"
#include "check.h"

#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/test_image_XXXXXX";
static char path[200];

static int make_folder(void **unused)
{
    (void)unused;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/picture.png", folder);
    return 0;
}

static int remove_folder(void **unused)
{
    (void)unused;
    unlink(path);
    return rmdir(folder);
}

static struct image noise(uint32_t width, uint32_t height, bool opaque)
{
    struct image image;
    struct error error;
    CHECK(image_create(&image, width, height, &error));
    for (uint64_t k = 0; k < (uint64_t)width * height * 4; k++) {
        image.rgba[k] = (uint8_t)rng_keyed(1, k, 0, 0);
        if (opaque && k % 4 == 3) image.rgba[k] = 255;
    }
    return image;
}

static void test_every_pixel_survives_saving_and_loading(void **unused)
{
    (void)unused;
    static const uint32_t sizes[][2] = {{1, 1}, {1, 37}, {41, 1}, {64, 48}, {257, 129}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        for (int level = 0; level <= 9; level += 3) {
            for (int opaque = 0; opaque < 2; opaque++) {
                struct image image = noise(sizes[k][0], sizes[k][1], opaque), back;
                struct error error;
                const int used = level == 3 ? 1 : level;
                CHECK(image_save(&image, path, used, NULL, 0, &error));
                CHECK(image_load(&back, path, &error));
                assert_int_equal(back.width, image.width);
                assert_int_equal(back.height, image.height);
                CHECK(memcmp(back.rgba, image.rgba, (size_t)image.width * image.height * 4) == 0);
                image_free(&image);
                image_free(&back);
            }
        }
    }
}

/* The colour type is byte 25 of a PNG file (PNG specification, IHDR): 2 is RGB, 6 is RGBA. */
static uint8_t colour_type(const struct image *image)
{
    uint8_t *bytes;
    size_t size;
    struct error error;
    CHECK(image_encode(image, 1, NULL, 0, &bytes, &size, &error));
    CHECK(size > 57 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0);
    const uint8_t type = bytes[25];
    free(bytes);
    return type;
}

static void test_one_transparent_pixel_makes_a_picture_rgba(void **unused)
{
    (void)unused;
    struct image image = noise(50, 30, true);
    assert_int_equal(colour_type(&image), PNG_COLOR_TYPE_RGB);
    image.rgba[4 * 1499 + 3] = 254;
    assert_int_equal(colour_type(&image), PNG_COLOR_TYPE_RGB_ALPHA);
    image_free(&image);
}

/* Reads the notes with libpng alone. */
static void test_notes_can_be_read_by_others(void **unused)
{
    (void)unused;
    const struct image_note notes[] = {
        {"Title", "hourglass"}, {"Scene", "grains = ( { radius = 0.5; } );\nseed = 7;\n"},
        {"Comment", "50 \u00b5m, \u03bd = 0.7"}};
    struct image image = noise(20, 10, true);
    uint8_t *bytes;
    size_t size;
    struct error error;
    CHECK(image_encode(&image, 1, notes, 3, &bytes, &size, &error));
    FILE *stream = fmemopen(bytes, size, "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    if (setjmp(png_jmpbuf(png))) fail_msg("libpng refuses the file");
    png_init_io(png, stream);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    png_textp texts;
    int count = 0;
    png_get_text(png, info, &texts, &count);
    assert_int_equal(count, 3);
    for (int k = 0; k < 3; k++) {
        assert_string_equal(texts[k].key, notes[k].key);
        assert_string_equal(texts[k].text, notes[k].text);
    }
    CHECK(texts[0].compression == PNG_TEXT_COMPRESSION_NONE);
    CHECK(texts[2].compression == PNG_ITXT_COMPRESSION_NONE);
    png_destroy_read_struct(&png, &info, NULL);
    CHECK(fclose(stream) == 0);
    free(bytes);
    image_free(&image);
}

/* A grey picture of two pixels, written by libpng alone. */
static void write_grey(int depth, const uint8_t *row)
{
    FILE *stream = fopen(path, "wb");
    CHECK(stream != NULL);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, 2, 1, depth, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_write_row(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    CHECK(fclose(stream) == 0);
}

static void test_grey_of_any_depth_becomes_rgba(void **unused)
{
    (void)unused;
    /* 0 and 1 in one bit; 7 and 200; 0x1234 and 0xffff, of which the upper byte remains. */
    static const struct { int depth; uint8_t row[4], expected[2]; } cases[] = {
        {1, {0x40}, {0, 255}}, {8, {7, 200}, {7, 200}},
        {16, {0x12, 0x34, 0xff, 0xff}, {0x12, 255}}};
    for (size_t k = 0; k < 3; k++) {
        write_grey(cases[k].depth, cases[k].row);
        struct image image;
        struct error error;
        CHECK(image_load(&image, path, &error));
        for (int pixel = 0; pixel < 2; pixel++) {
            for (int c = 0; c < 3; c++) {
                assert_int_equal(image.rgba[4 * pixel + c], cases[k].expected[pixel]);
            }
            assert_int_equal(image.rgba[4 * pixel + 3], 255);
        }
        image_free(&image);
    }
}

static bool loads(const uint8_t *bytes, size_t size)
{
    struct image image;
    struct error error = {0};
    FILE *stream = fopen(path, "wb");
    CHECK(stream && fwrite(bytes, 1, size, stream) == size);
    CHECK(fclose(stream) == 0);
    const bool loaded = image_load(&image, path, &error);
    if (loaded) image_free(&image);
    else CHECK(strstr(error.text, path) != NULL && image.rgba == NULL);
    return loaded;
}

static void test_a_torn_png_is_refused_at_every_length(void **unused)
{
    (void)unused;
    struct image image = noise(9, 7, false);
    uint8_t *bytes;
    size_t size;
    struct error error;
    CHECK(image_encode(&image, 1, NULL, 0, &bytes, &size, &error));
    CHECK(loads(bytes, size));
    for (size_t cut = 0; cut < size; cut++) {
        if (loads(bytes, cut)) fail_msg("%zu of %zu bytes were taken for a picture", cut, size);
    }
    free(bytes);
    image_free(&image);
}

/* Every critical chunk is under a checksum, so no flipped bit may pass for a picture. */
static void test_a_png_with_a_flipped_bit_is_refused(void **unused)
{
    (void)unused;
    struct image image = noise(9, 7, true);
    uint8_t *bytes;
    size_t size;
    struct error error;
    CHECK(image_encode(&image, 1, NULL, 0, &bytes, &size, &error));
    for (size_t k = 0; k < size; k++) {
        bytes[k] ^= (uint8_t)(1u << k % 8);
        if (loads(bytes, size)) fail_msg("byte %zu of %zu was changed unnoticed", k, size);
        bytes[k] ^= (uint8_t)(1u << k % 8);
    }
    free(bytes);
    image_free(&image);
}

static void test_what_cannot_be_a_picture_is_refused_with_a_reason(void **unused)
{
    (void)unused;
    struct image image;
    struct error error = {0};
    CHECK(!image_create(&image, 0, 10, &error));
    CHECK(!image_create(&image, 10, IMAGE_SIDE_MAX + 1, &error));
    CHECK(strstr(error.text, "16384") != NULL);
    CHECK(!image_load(&image, "/nowhere/at/all.png", &error));
    CHECK(strstr(error.text, "/nowhere/at/all.png") != NULL);
    CHECK(!loads((const uint8_t *)"P6 1 1 255 abc", 14));
}

static void test_an_unwritable_place_leaves_no_file(void **unused)
{
    (void)unused;
    struct image image = noise(4, 4, true);
    struct error error = {0};
    CHECK(!image_save(&image, "/nowhere/at/all.png", 1, NULL, 0, &error));
    CHECK(strstr(error.text, "/nowhere/at/all.png") != NULL);
    unlink(path);
    CHECK(mkdir(path, 0700) == 0);      /* a directory stands where the file should be */
    CHECK(!image_save(&image, path, 1, NULL, 0, &error));
    CHECK(rmdir(path) == 0);            /* and nothing was left in it */
    CHECK(!file_exists(path));
    image_free(&image);
}

static void test_comparing_counts_pixels_and_finds_the_largest_difference(void **unused)
{
    (void)unused;
    struct image a = noise(30, 20, true), b = noise(30, 20, true), c = noise(20, 30, true);
    int largest = -1;
    uint64_t differing = 9;
    CHECK(image_compare(&a, &b, 0, &largest, &differing));
    CHECK(largest == 0 && differing == 0);
    for (int k = 0; k < 3; k++) b.rgba[400 * k + k] = (uint8_t)(a.rgba[400 * k + k] ^ (8 << k));
    CHECK(image_compare(&a, &b, 0, &largest, &differing));
    CHECK(largest == 32 && differing == 3);
    CHECK(image_compare(&a, &b, 8, &largest, &differing));
    CHECK(largest == 32 && differing == 2);
    CHECK(!image_compare(&a, &c, 0, &largest, &differing));
    image_free(&a);
    image_free(&b);
    image_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_pixel_survives_saving_and_loading),
        cmocka_unit_test(test_one_transparent_pixel_makes_a_picture_rgba),
        cmocka_unit_test(test_notes_can_be_read_by_others),
        cmocka_unit_test(test_grey_of_any_depth_becomes_rgba),
        cmocka_unit_test(test_a_torn_png_is_refused_at_every_length),
        cmocka_unit_test(test_a_png_with_a_flipped_bit_is_refused),
        cmocka_unit_test(test_what_cannot_be_a_picture_is_refused_with_a_reason),
        cmocka_unit_test(test_an_unwritable_place_leaves_no_file),
        cmocka_unit_test(test_comparing_counts_pixels_and_finds_the_largest_difference),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
