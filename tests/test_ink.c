/* test_ink.c - lines, shapes and text cover as many pixels as their geometry says.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/ink.h"

#include "check.h"
#include "draw/canvas.h"
#include "draw/colormap.h"
#include "draw/gl.h"

enum { WIDTH = 200, HEIGHT = 120 };

static struct canvas *canvas;
static struct ink *ink;
static struct image image;
static const struct ink_color black = {0, 0, 0, 255};

static void clear(void)
{
    canvas_begin(canvas);
    gl.ClearColor(1, 1, 1, 1);
    gl.Clear(GL_COLOR_BUFFER_BIT);
}

static int open_canvas(void **unused)
{
    (void)unused;
    struct error error = {0};
    canvas = canvas_create(WIDTH, HEIGHT, &error);
    if (canvas) {
        canvas_begin(canvas);
        ink = ink_create(&error);
    }
    if (!ink) print_error("%s\n", error.text);
    return !ink || !image_create(&image, WIDTH, HEIGHT, &error);
}

static int close_canvas(void **unused)
{
    (void)unused;
    image_free(&image);
    ink_destroy(ink);
    canvas_destroy(canvas);
    return 0;
}

static void finish(void)
{
    ink_flush(ink, WIDTH, HEIGHT);
    canvas_read(canvas, &image);
}

static double darkness(uint32_t x, uint32_t y)
{
    return 1 - image.rgba[4 * (y * WIDTH + x)] / 255.0;
}

/* Pixels' worth of black, and where it is. */
static double blackness(double *mean_x, double *mean_y)
{
    double sum = 0, sum_x = 0, sum_y = 0;
    for (uint32_t y = 0; y < HEIGHT; y++) {
        for (uint32_t x = 0; x < WIDTH; x++) {
            sum += darkness(x, y);
            sum_x += darkness(x, y) * (x + 0.5);
            sum_y += darkness(x, y) * (y + 0.5);
        }
    }
    if (mean_x) *mean_x = sum_x / sum;
    if (mean_y) *mean_y = sum_y / sum;
    return sum;
}

/* The ramp of a distance is exact along a straight edge; what remains are the caps, the corners
 * and the rounding to bytes: 2 per cent and a pixel. */
static void test_a_line_covers_its_length_times_its_width(void **unused)
{
    (void)unused;
    static const double widths[] = {0.3, 1, 2.5, 7};
    for (int k = 0; k < 4; k++) {
        for (int degrees = 0; degrees < 180; degrees += 11) {
            const double a = degrees * M_PI / 180, length = 81, w = widths[k];
            const double dx = 0.5 * length * cos(a), dy = 0.5 * length * sin(a);
            clear();
            ink_line(ink, 100.3 - dx, 60.2 - dy, 100.3 + dx, 60.2 + dy, w, black);
            finish();
            double x, y;
            const double cap = w < 1 ? M_PI * w / 4 : M_PI * w * w / 4, area = length * w + cap;
            CHECK_NEAR(blackness(&x, &y), area, 0.02 * area + 1);
            /* An end that lies a third of a pixel off moves the middle by half of that. */
            CHECK_NEAR(x, 100.3, 0.3);
            CHECK_NEAR(y, 60.2, 0.3);
        }
    }
}

static void test_shapes_cover_their_area(void **unused)
{
    (void)unused;
    const double x[3] = {30, 150, 60}, y[3] = {20, 50, 100};
    clear();
    ink_triangle(ink, x, y, black);
    finish();
    const double triangle = 0.5 * fabs((x[1] - x[0]) * (y[2] - y[0])
                                       - (x[2] - x[0]) * (y[1] - y[0]));
    CHECK_NEAR(blackness(NULL, NULL), triangle, 0.01 * triangle);
    clear();
    ink_disc(ink, 100.5, 60.25, 40, black);
    finish();
    CHECK_NEAR(blackness(NULL, NULL), M_PI * 1600, 0.005 * M_PI * 1600);
    clear();
    ink_rectangle(ink, 10.5, 20, 90, 60.25, black);
    finish();
    CHECK_NEAR(blackness(NULL, NULL), 79.5 * 40.25, 2);
    clear();
    ink_plate(ink, 10, 20, 90, 60, 10, black);
    finish();
    CHECK_NEAR(blackness(NULL, NULL), 80 * 40 - (4 - M_PI) * 100, 3);
    /* A quarter of a ring, drawn whole (small) and by tiles (large), with its two round ends. */
    for (int radius = 15; radius <= 55; radius += 40) {
        clear();
        ink_arc(ink, 100, 60, radius, 0.3, 0.3 + M_PI / 2, 4, black);
        finish();
        const double area = M_PI / 2 * radius * 4 + M_PI * 4;
        CHECK_NEAR(blackness(NULL, NULL), area, 0.02 * area + 1);
    }
}

/* Angles run counter-clockwise although y runs downwards. */
static void test_a_quarter_circle_from_zero_lies_at_the_upper_right(void **unused)
{
    (void)unused;
    clear();
    ink_arc(ink, 100, 60, 40, 0, M_PI / 2, 3, black);
    finish();
    CHECK(darkness(100 + 28, 60 - 29) > 0.5);
    CHECK(darkness(100 + 28, 60 + 28) == 0 && darkness(100 - 29, 60 - 29) == 0);
}

static void test_an_arrow_ends_at_its_point_and_is_widest_at_its_head(void **unused)
{
    (void)unused;
    clear();
    ink_arrow(ink, 20, 60.5, 120, 60.5, 3, black);
    finish();
    CHECK(darkness(21, 60) > 0.9 && darkness(116, 60) > 0.5);
    CHECK(darkness(122, 60) == 0 && darkness(18, 60) == 0);
    double shaft = 0, head = 0;
    for (uint32_t y = 0; y < HEIGHT; y++) shaft += darkness(60, y);
    for (uint32_t x = 100; x < 120; x++) {
        double column = 0;
        for (uint32_t y = 0; y < HEIGHT; y++) column += darkness(x, y);
        head = fmax(head, column);
    }
    CHECK_NEAR(shaft, 3, 0.1);
    CHECK(head > 2 * shaft);
}

static void test_edges_on_the_pixel_grid_are_sharp(void **unused)
{
    (void)unused;
    clear();
    ink_rectangle(ink, 50, 30, 60, 31, black);
    finish();
    for (uint32_t x = 45; x < 65; x++) {
        for (uint32_t y = 28; y < 33; y++) {
            CHECK(darkness(x, y) == (x >= 50 && x < 60 && y == 30 ? 1 : 0));
        }
    }
}

static void test_a_later_shape_covers_an_earlier_one(void **unused)
{
    (void)unused;
    clear();
    ink_disc(ink, 100, 60, 20, black);
    ink_text(ink, 100, 60, 30, INK_CENTER, black, "text");
    ink_rectangle(ink, 20, 10, 180, 110, (struct ink_color){255, 0, 0, 255});
    ink_disc(ink, 50, 60, 20, (struct ink_color){0, 0, 255, 128});
    finish();
    const uint8_t *pixel = image.rgba + 4 * (60 * WIDTH + 100);
    CHECK(pixel[0] == 255 && pixel[1] == 0 && pixel[2] == 0);
    pixel = image.rgba + 4 * (60 * WIDTH + 50);
    CHECK_NEAR(pixel[0], 127, 1);
    CHECK_NEAR(pixel[2], 128, 1);
}

static void test_a_gradient_shows_the_map_from_below_to_above(void **unused)
{
    (void)unused;
    const uint8_t (*map)[3] = colormap_find("viridis");
    clear();
    ink_gradient(ink, 20, 10, 30, 110, map);
    finish();
    for (uint32_t y = 10; y < 110; y++) {
        /* The middle of each line of pixels, between two entries of the map. */
        const double entry = (110 - (y + 0.5)) / 100 * 255;
        for (int c = 0; c < 3; c++) {
            const double low = map[(int)entry][c], high = map[(int)entry + 1][c];
            CHECK_NEAR(image.rgba[4 * (y * WIDTH + 25) + (uint32_t)c], 0.5 * (low + high),
                       0.5 * fabs(high - low) + 1);
        }
    }
    CHECK(darkness(25, 9) == 0 && darkness(25, 110) == 0 && darkness(19, 50) == 0);
}

/* From the first to the last column with ink. */
static void extent(uint32_t *first, uint32_t *last)
{
    *first = WIDTH;
    *last = 0;
    for (uint32_t x = 0; x < WIDTH; x++) {
        for (uint32_t y = 0; y < HEIGHT; y++) {
            if (darkness(x, y) < 0.1) continue;
            if (x < *first) *first = x;
            *last = x;
        }
    }
}

/* The side bearings of N at both ends are a tenth of the size each; a pixel is allowed. */
static void test_text_is_as_wide_as_it_claims(void **unused)
{
    (void)unused;
    for (double size = 9; size < 48; size *= 1.37) {
        const char *text = size < 20 ? "N = 20000 \u00b5N" : "N \u221aN";
        const double width = ink_text_width(ink, size, text);
        for (int align = INK_LEFT; align <= INK_RIGHT; align++) {
            clear();
            ink_text(ink, 100 + 50 * (align - 1), 80, size, (enum ink_align)align, black, text);
            finish();
            uint32_t first, last;
            extent(&first, &last);
            const double left = align == INK_LEFT ? 50
                : align == INK_CENTER ? 100 - width / 2 : 150 - width;
            CHECK_NEAR(first, left + 0.1 * size, 1.2);
            CHECK_NEAR(last + 1, left + width - 0.1 * size, 1.2);
        }
    }
}

static void test_broken_utf8_is_drawn_and_never_read_beyond(void **unused)
{
    (void)unused;
    static const char *const broken[] = {"\xff\xfe", "a\xc3", "\xe2\x82", "\xf0\x9f", "\x80z"};
    for (size_t k = 0; k < sizeof broken / sizeof *broken; k++) {
        clear();
        ink_text(ink, 20, 80, 20, INK_LEFT, black, broken[k]);
        finish();
        CHECK(blackness(NULL, NULL) > 10);
    }
}

static void draw_samples(void)
{
    ink_line(ink, 3, 4, 170, 77, 2.3, black);
    ink_arc(ink, 90, 60, 45, 1, 4, 3, (struct ink_color){200, 20, 20, 255});
    ink_arrow(ink, 20, 100, 180, 20, 2, (struct ink_color){0, 100, 0, 200});
    ink_gradient(ink, 180, 10, 190, 110, colormap_find("turbo"));
    ink_text(ink, 20, 60, 17, INK_LEFT, black, "t = 0.25 s, g = 9.81 m/s\u00b2");
}

static void test_both_backends_draw_the_same_bytes(void **unused)
{
    (void)unused;
    static const char *const names[] = {"osmesa", "egl"};
    struct image pictures[2];
    struct error error = {0};
    char *kept = getenv("SANDREEL_GL") ? strdup(getenv("SANDREEL_GL")) : NULL;
    close_canvas(NULL);
    for (int k = 0; k < 2; k++) {
        setenv("SANDREEL_GL", names[k], 1);
        if (open_canvas(NULL) != 0) fail_msg("%s does not open", names[k]);
        assert_string_equal(canvas_backend(canvas), names[k]);
        clear();
        draw_samples();
        finish();
        CHECK(image_create(&pictures[k], WIDTH, HEIGHT, &error));
        memcpy(pictures[k].rgba, image.rgba, (size_t)WIDTH * HEIGHT * 4);
        close_canvas(NULL);
    }
    if (kept) setenv("SANDREEL_GL", kept, 1);
    else unsetenv("SANDREEL_GL");
    free(kept);
    CHECK(open_canvas(NULL) == 0);
    int largest;
    uint64_t differing;
    CHECK(image_compare(&pictures[0], &pictures[1], 0, &largest, &differing));
    assert_int_equal(differing, 0);
    image_free(&pictures[0]);
    image_free(&pictures[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_line_covers_its_length_times_its_width),
        cmocka_unit_test(test_shapes_cover_their_area),
        cmocka_unit_test(test_a_quarter_circle_from_zero_lies_at_the_upper_right),
        cmocka_unit_test(test_an_arrow_ends_at_its_point_and_is_widest_at_its_head),
        cmocka_unit_test(test_edges_on_the_pixel_grid_are_sharp),
        cmocka_unit_test(test_a_later_shape_covers_an_earlier_one),
        cmocka_unit_test(test_a_gradient_shows_the_map_from_below_to_above),
        cmocka_unit_test(test_text_is_as_wide_as_it_claims),
        cmocka_unit_test(test_broken_utf8_is_drawn_and_never_read_beyond),
        cmocka_unit_test(test_both_backends_draw_the_same_bytes),
    };
    return cmocka_run_group_tests(tests, open_canvas, close_canvas);
}
