/* test_draw_painter.c - whole pictures: both OpenGL backends and both ways of drawing grains give
 * the same; grains lie where the scene says and cover what they should.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/rng.h"
#include "draw/canvas.h"
#include "draw/colormap.h"
#include "draw/overlay.h"
#include "draw/painter.h"
#include "check.h"

enum { WIDTH = 320, HEIGHT = 180 };

/* A scene without walls and legend, so that only grains are seen. */
struct stage {
    struct scene   scene;
    struct grains  grains;
    struct picture picture;
};

static void stage_open(struct stage *stage, uint32_t count)
{
    *stage = (struct stage){0};
    struct error error;
    if (!grains_create(&stage->grains, count, 0, &error)) fail_msg("%s", error.text);
    memcpy(stage->scene.box, (double[4]){0, 0, 16, 9}, sizeof stage->scene.box);
    stage->scene.view = (struct view){
        .size = {WIDTH, HEIGHT}, .window = {0, 0, 16, 9}, .color = COLOR_SPEED,
        .range = {0, 1}, .colormap = "viridis", .grains = true, .arrow_scale = NAN,
        .force_scale = NAN, .text_size = NAN,
    };
    stage->picture = (struct picture){.scene = &stage->scene, .view = &stage->scene.view,
        .grains = &stage->grains, .range = {NAN, NAN}, .field_range = {NAN, NAN}};
}

static void stage_close(struct stage *stage)
{
    grains_free(&stage->grains);
}

/* Random grains all over the window and beyond its edges, overlapping where it happens. */
static void stage_fill(struct stage *stage, double radius)
{
    struct rng rng = rng_stream(3, stage->grains.capacity, 0);
    struct grains *const grains = &stage->grains;
    for (uint32_t i = 0; i < grains->capacity; i++) {
        grains->x[i] = 18 * rng_uniform(&rng) - 1;
        grains->y[i] = 11 * rng_uniform(&rng) - 1;
        grains->radius[i] = radius * (0.7 + 0.6 * rng_uniform(&rng));
        grains->vx[i] = rng_uniform(&rng);
        grains->species[i] = (uint16_t)(i % 3);
    }
    grains->count = grains->capacity;
}

static void draw(const struct stage *stage, enum painter_path path, struct image *image)
{
    struct error error = {0};
    struct picture picture = stage->picture;
    picture.path = path;
    const struct view *const view = picture.view;
    struct painter *const painter = painter_create(view, &error);
    if (!painter) fail_msg("%s", error.text);
    if (!image_create(image, (uint32_t)view->size[0], (uint32_t)view->size[1], &error)
        || !painter_frame(painter, &picture, image, &error)) fail_msg("%s", error.text);
    painter_destroy(painter);
}

static bool same(const struct image *a, const struct image *b, int tolerance)
{
    int largest = -1;
    uint64_t differing = 0;
    const bool comparable = image_compare(a, b, tolerance, &largest, &differing);
    if (differing > 0) {
        print_message("largest difference %d, %llu pixels\n", largest,
                      (unsigned long long)differing);
    }
    return comparable && differing == 0;
}

struct look {
    const char *name;
    uint32_t count;
    double radius;
    bool rims, shade;
    int theme, color;
};

/* 20 pixels a length. */
static const struct look looks[] = {
    {"big grains", 30, 1.1, false, false, THEME_WHITE, COLOR_SPEED},
    {"big rimmed grains", 30, 1.1, true, false, THEME_WHITE, COLOR_SPEED},
    {"big lit grains", 60, 0.6, true, true, THEME_DARK, COLOR_SPEED},
    {"lit grains of a few pixels", 1500, 0.15, true, true, THEME_TRANSPARENT, COLOR_SPECIES},
    {"grains of about a pixel", 6000, 0.05, true, true, THEME_WHITE, COLOR_SPEED},
    {"grains below a pixel", 30000, 0.012, true, true, THEME_DARK, COLOR_SPECIES},
    {"one huge grain", 1, 14, true, true, THEME_WHITE, COLOR_NONE},
};
enum { LOOK_COUNT = sizeof looks / sizeof *looks };

static void stage_dress(struct stage *stage, const struct look *look)
{
    stage_open(stage, look->count);
    stage_fill(stage, look->radius);
    stage->scene.view.rims = look->rims;
    stage->scene.view.shade = look->shade;
    stage->scene.view.theme = look->theme;
    stage->scene.view.color = look->color;
}

static void test_opengl_and_the_splatter_agree_within_four_levels(void **unused)
{
    (void)unused;
    for (int k = 0; k < LOOK_COUNT; k++) {
        struct stage stage;
        struct image by_gl, by_splatter;
        stage_dress(&stage, &looks[k]);
        draw(&stage, PAINTER_GL, &by_gl);
        draw(&stage, PAINTER_SPLATTER, &by_splatter);
        if (!same(&by_gl, &by_splatter, 4)) fail_msg("%s: the two ways differ", looks[k].name);
        image_free(&by_gl);
        image_free(&by_splatter);
        stage_close(&stage);
    }
}

/* Is the backend there?  Says so if not. */
static bool backend_there(const char *name)
{
    struct error error = {0};
    setenv("SANDREEL_GL", name, 1);
    struct canvas *const canvas = canvas_create(16, 16, &error);
    if (!canvas) {
        print_message("not compared: %s\n", error.text);
        return false;
    }
    CHECK(strcmp(canvas_backend(canvas), name) == 0);
    canvas_destroy(canvas);
    return true;
}

static void test_osmesa_and_egl_give_identical_pixels(void **unused)
{
    (void)unused;
    const bool both = backend_there("osmesa") && backend_there("egl");
    if (!both) {
        unsetenv("SANDREEL_GL");
        skip();
    }
    for (int k = 0; k < LOOK_COUNT; k++) {
        struct stage stage;
        struct image first, second;
        stage_dress(&stage, &looks[k]);
        stage.scene.view.legend = stage.scene.view.scale_bar = true;
        strcpy(stage.scene.view.title, "both");
        setenv("SANDREEL_GL", "osmesa", 1);
        draw(&stage, PAINTER_GL, &first);
        setenv("SANDREEL_GL", "egl", 1);
        draw(&stage, PAINTER_GL, &second);
        if (!same(&first, &second, 0)) fail_msg("%s: the backends differ", looks[k].name);
        image_free(&first);
        image_free(&second);
        stage_close(&stage);
    }
    unsetenv("SANDREEL_GL");
}

static void test_an_unknown_backend_is_refused_with_its_cure(void **unused)
{
    (void)unused;
    struct error error = {0};
    setenv("SANDREEL_GL", "glx", 1);
    CHECK(canvas_create(16, 16, &error) == NULL);
    unsetenv("SANDREEL_GL");
    assert_int_equal(error.code, EXIT_USAGE);
    CHECK(strstr(error.text, "osmesa") && strstr(error.text, "egl"));
}

static void test_painters_take_turns_also_on_different_backends(void **unused)
{
    (void)unused;
    static const char *const names[] = {"osmesa", "egl", "osmesa"};
    struct stage stage;
    struct error error = {0};
    struct image alone, turn;
    struct painter *painters[3];
    const bool both = backend_there("osmesa") && backend_there("egl");
    unsetenv("SANDREEL_GL");
    stage_open(&stage, 300);
    stage_fill(&stage, 0.3);
    draw(&stage, PAINTER_GL, &alone);
    CHECK(image_create(&turn, WIDTH, HEIGHT, &error));
    for (int k = 0; k < 3; k++) {
        if (both) setenv("SANDREEL_GL", names[k], 1);
        painters[k] = painter_create(&stage.scene.view, &error);
        CHECK(painters[k] != NULL);
    }
    unsetenv("SANDREEL_GL");
    stage.picture.path = PAINTER_GL;
    for (int k = 0; k < 7; k++) {
        memset(turn.rgba, 0, (size_t)WIDTH * HEIGHT * 4);
        CHECK(painter_frame(painters[k % 3], &stage.picture, &turn, &error));
        CHECK(same(&alone, &turn, 0));
    }
    for (int k = 0; k < 3; k++) painter_destroy(painters[k]);
    image_free(&alone);
    image_free(&turn);
    stage_close(&stage);
}

static void test_without_grains_there_is_only_ground(void **unused)
{
    (void)unused;
    for (int theme = THEME_WHITE; theme <= THEME_TRANSPARENT; theme++) {
        struct stage stage;
        struct image image;
        stage_open(&stage, 4);
        stage.scene.view.theme = theme;
        const struct ink_color ground = overlay_ground((enum theme)theme);
        if (theme == THEME_DARK) stage.picture.grains = NULL;   /* none at all: the same */
        draw(&stage, PAINTER_AUTO, &image);
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            assert_int_equal(image.rgba[4 * i + 3], ground.a);
            if (ground.a) CHECK(memcmp(image.rgba + 4 * i, &ground, 3) == 0);
        }
        image_free(&image);
        stage_close(&stage);
    }
}

/* One grain of speed 1/2 on transparent ground: where it lies and what it covers. */
static void grain_find(struct stage *stage, enum painter_path path, double *x, double *y,
                       double *area)
{
    struct image image;
    stage->scene.view.theme = THEME_TRANSPARENT;
    draw(stage, path, &image);
    const uint8_t *const color = colormap_find("viridis")[128];
    *x = *y = *area = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const double alpha = image.rgba[4 * i + 3] / 255.0;
        *area += alpha;
        *x += alpha * (i % WIDTH + 0.5);
        *y += alpha * (i / WIDTH + 0.5);
        /* Straight colours: also at the edge the grain's own, but for the rounding of the
         * premultiplied one and of alpha, half a level each, over alpha. */
        for (int k = 0; k < 3 && alpha > 0.1; k++) {
            CHECK_NEAR(image.rgba[4 * i + (uint32_t)k], color[k], 1 + 1 / alpha);
        }
    }
    *x /= *area;
    *y /= *area;
    image_free(&image);
}

static void test_a_grain_lies_where_the_window_puts_it(void **unused)
{
    (void)unused;
    static const double windows[][4] = {{0, 0, 16, 9}, {2, 1, 10, 5.5}, {4, 2, 5, 7}};
    for (int k = 0; k < 6; k++) {
        struct stage stage;
        stage_open(&stage, 1);
        memcpy(stage.scene.view.window, windows[k % 3], sizeof windows[0]);
        stage.grains.count = 1;
        stage.grains.x[0] = 4.6;
        stage.grains.y[0] = 3.3;
        stage.grains.radius[0] = 0.2;
        stage.grains.vx[0] = 0.5;
        double part[4], x, y, area;
        overlay_layout(&stage.picture, part);
        const double *const w = windows[k % 3];
        const double scale = fmin((part[2] - part[0]) / (w[2] - w[0]),
                                  (part[3] - part[1]) / (w[3] - w[1]));
        grain_find(&stage, k < 3 ? PAINTER_GL : PAINTER_SPLATTER, &x, &y, &area);
        /* The window's middle is in the middle of its part of the picture; y is turned over.
         * Centroids of antialiased discs are good to some hundredths of a pixel. */
        CHECK_NEAR(x, 0.5 * (part[0] + part[2]) + scale * (4.6 - 0.5 * (w[0] + w[2])), 0.05);
        CHECK_NEAR(y, 0.5 * (part[1] + part[3]) - scale * (3.3 - 0.5 * (w[1] + w[3])), 0.05);
        /* Sampling of the edge, and alpha rounded to 1/255. */
        CHECK_NEAR(area / (acos(-1) * 0.04 * scale * scale), 1, 0.02);
        stage_close(&stage);
    }
}

static void test_a_grain_covers_its_area_down_to_below_a_pixel(void **unused)
{
    (void)unused;
    static const double radii[] = {0.2, 0.4, 0.7, 1, 1.5, 3, 6, 20};    /* pixels */
    for (int path = PAINTER_GL; path <= PAINTER_SPLATTER; path++) {
        for (size_t k = 0; k < sizeof radii / sizeof *radii; k++) {
            struct stage stage;
            double area = 0;
            enum { PLACES = 12 };
            stage_open(&stage, PLACES);
            double part[4], x, y;
            overlay_layout(&stage.picture, part);
            const double scale = fmin((part[2] - part[0]) / 16, (part[3] - part[1]) / 9);
            for (int i = 0; i < PLACES; i++) {
                stage.grains.x[i] = 2 + 4 * (i % 4) + (0.37 + 0.231 * i) / scale;
                stage.grains.y[i] = 1.5 + 3 * (i / 4) + (0.11 + 0.417 * i) / scale;
                stage.grains.radius[i] = radii[k] / scale;
                stage.grains.vx[i] = 0.5;
            }
            stage.grains.count = PLACES;
            grain_find(&stage, (enum painter_path)path, &x, &y, &area);
            /* Edges sampled at pixel centres miss up to 4 %, twelve places together a third of
             * it; of the smallest, alpha of about 0.1 on a few pixels is rounded to 1/255. */
            CHECK_NEAR(area / (PLACES * acos(-1) * radii[k] * radii[k]), 1, 0.015);
            stage_close(&stage);
        }
    }
}

static void test_the_same_frame_twice_is_the_same_bytes(void **unused)
{
    (void)unused;
    for (int path = PAINTER_AUTO; path <= PAINTER_SPLATTER; path++) {
        struct stage stage;
        struct image first, second;
        stage_dress(&stage, &looks[3]);
        stage.scene.view.range[0] = NAN;        /* with a range found from the grains */
        stage.scene.view.legend = true;
        draw(&stage, (enum painter_path)path, &first);
        draw(&stage, (enum painter_path)path, &second);
        CHECK(same(&first, &second, 0));
        image_free(&first);
        image_free(&second);
        stage_close(&stage);
    }
}

static void test_a_very_wide_picture_is_drawn_whole(void **unused)
{
    (void)unused;
    struct stage stage;
    struct image image;
    stage_open(&stage, 1);
    stage.scene.view.size[0] = IMAGE_SIDE_MAX;
    stage.scene.view.size[1] = 100;
    memcpy(stage.scene.view.window, (double[4]){0, 0, IMAGE_SIDE_MAX, 100}, 4 * sizeof(double));
    stage.grains.count = 1;
    stage.grains.x[0] = IMAGE_SIDE_MAX - 20.5;
    stage.grains.y[0] = 80.5;
    stage.grains.radius[0] = 5;
    for (int path = PAINTER_GL; path <= PAINTER_SPLATTER; path++) {
        draw(&stage, (enum painter_path)path, &image);
        double part[4];
        overlay_layout(&stage.picture, part);
        const double scale = fmin((part[2] - part[0]) / IMAGE_SIDE_MAX, (part[3] - part[1]) / 100);
        const double x = 0.5 * (part[0] + part[2]) + scale * (0.5 * IMAGE_SIDE_MAX - 20.5);
        const double y = 0.5 * (part[1] + part[3]) - scale * 30.5;
        const uint8_t *const pixel = image.rgba + 4 * ((size_t)y * IMAGE_SIDE_MAX + (size_t)x);
        CHECK(memcmp(pixel, colormap_find("viridis")[0], 3) == 0);
        image_free(&image);
    }
    stage_close(&stage);
}

static void test_a_zoomed_scene_ends_where_the_legend_begins(void **unused)
{
    (void)unused;
    for (int path = PAINTER_GL; path <= PAINTER_SPLATTER; path++) {
        struct stage stage;
        struct image with, without;
        stage_open(&stage, 400);
        stage_fill(&stage, 0.5);
        stage.scene.view.legend = stage.scene.view.scale_bar = true;
        stage.scene.view.size[0] = 640;
        stage.scene.view.size[1] = 360;
        memcpy(stage.scene.view.window, (double[4]){6, 3, 10, 5.25}, 4 * sizeof(double));
        draw(&stage, (enum painter_path)path, &with);
        stage.grains.count = 0;
        draw(&stage, (enum painter_path)path, &without);
        double part[4];
        overlay_layout(&stage.picture, part);
        CHECK(part[2] < 640);
        uint64_t inside = 0;
        for (int y = 0; y < 360; y++) {
            for (int x = 0; x < 640; x++) {
                const size_t at = ((size_t)y * 640 + (size_t)x) * 4;
                if (memcmp(with.rgba + at, without.rgba + at, 4) == 0) continue;
                CHECK(x + 1 > part[0] && x < part[2] && y + 1 > part[1] && y < part[3]);
                inside++;
            }
        }
        /* Discs of this size and number, thrown at random, cover four fifths of the window. */
        CHECK((double)inside > 0.5 * (part[2] - part[0]) * (part[3] - part[1]));
        image_free(&with);
        image_free(&without);
        stage_close(&stage);
    }
}

static void test_grains_that_are_nowhere_are_left_out(void **unused)
{
    (void)unused;
    for (int path = PAINTER_GL; path <= PAINTER_SPLATTER; path++) {
        struct stage stage;
        struct image lost, absent;
        stage_open(&stage, 12);
        stage_fill(&stage, 0.4);
        static const double nowhere[] = {NAN, INFINITY, -INFINITY, 1e300};
        for (int k = 0; k < 4; k++) stage.grains.x[8 + k] = nowhere[k];
        draw(&stage, (enum painter_path)path, &lost);
        stage.grains.count = 8;
        draw(&stage, (enum painter_path)path, &absent);
        CHECK(same(&lost, &absent, 0));
        image_free(&lost);
        image_free(&absent);
        stage_close(&stage);
    }
}

static void test_the_range_is_the_99th_percentile(void **unused)
{
    (void)unused;
    /* Speeds 0.001 .. 1 in an order that is neither up nor down (7 and 1000 have no divisor in
     * common), one grain that raced off, and spins of both signs. */
    struct grains grains;
    struct error error;
    enum { COUNT = 1000 };
    CHECK(grains_create(&grains, COUNT, 0, &error));
    grains.count = COUNT;
    for (int i = 0; i < COUNT; i++) {
        grains.vy[i] = -(i * 7 % COUNT + 1) / 1000.0;
        grains.spin[i] = 2 * grains.vy[i] * (i % 2 ? 1 : -1);
        grains.radius[i] = 1 + 0.5 * (i % 3);
        if (grains.vy[i] == -1) grains.vy[i] = -1e6;
    }
    float values[COUNT];
    double range[2];
    struct view view = {.color = COLOR_SPEED};
    painter_value_all(&view, &grains, values);
    painter_value_range(&view, &grains, values, range);
    CHECK_NEAR(range[0], 0, 0);
    CHECK_NEAR(range[1], 0.99, 1e-6);
    view.color = COLOR_SPIN;
    painter_value_all(&view, &grains, values);
    painter_value_range(&view, &grains, values, range);
    CHECK_NEAR(range[0], -1.98, 1e-6);
    CHECK_NEAR(range[1], 1.98, 1e-6);
    view.color = COLOR_RADIUS;
    painter_value_all(&view, &grains, values);
    painter_value_range(&view, &grains, values, range);
    CHECK_NEAR(range[0], 1, 0);
    CHECK_NEAR(range[1], 2, 0);
    grains_free(&grains);
}

static void test_pressure_is_force_over_perimeter(void **unused)
{
    (void)unused;
    /* Two grains of radius 2 pressed by a force of (3, 4), one of them also by 1 from a wall. */
    struct grains grains;
    struct error error;
    CHECK(grains_create(&grains, 2, 2, &error));
    grains.count = grains.contact_count = 2;
    grains.radius[0] = grains.radius[1] = 2;
    grains.contacts[0] = (struct contact){.i = 0, .j = 1, .fx = 3, .fy = 4};
    grains.contacts[1] = (struct contact){.i = 1, .j = CONTACT_WALL + 5, .fx = 1};
    const struct view view = {.color = COLOR_PRESSURE};
    const double perimeter = 4 * acos(-1);
    CHECK_NEAR(painter_value(&view, &grains, 0), 5 / perimeter, 1e-6);
    CHECK_NEAR(painter_value(&view, &grains, 1), 6 / perimeter, 1e-6);
    float values[2];
    painter_value_all(&view, &grains, values);
    CHECK_NEAR(values[0], 5 / perimeter, 1e-6);
    CHECK_NEAR(values[1], 6 / perimeter, 1e-6);
    grains_free(&grains);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_opengl_and_the_splatter_agree_within_four_levels),
        cmocka_unit_test(test_osmesa_and_egl_give_identical_pixels),
        cmocka_unit_test(test_an_unknown_backend_is_refused_with_its_cure),
        cmocka_unit_test(test_painters_take_turns_also_on_different_backends),
        cmocka_unit_test(test_without_grains_there_is_only_ground),
        cmocka_unit_test(test_a_grain_lies_where_the_window_puts_it),
        cmocka_unit_test(test_a_grain_covers_its_area_down_to_below_a_pixel),
        cmocka_unit_test(test_the_same_frame_twice_is_the_same_bytes),
        cmocka_unit_test(test_a_very_wide_picture_is_drawn_whole),
        cmocka_unit_test(test_a_zoomed_scene_ends_where_the_legend_begins),
        cmocka_unit_test(test_grains_that_are_nowhere_are_left_out),
        cmocka_unit_test(test_the_range_is_the_99th_percentile),
        cmocka_unit_test(test_pressure_is_force_over_perimeter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
