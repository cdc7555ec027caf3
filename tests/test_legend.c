/* test_legend.c - a legend stays inside its picture, out of the scene's way, and in no part on
 * top of another, at any size; labels are filled in.
 *
 * The legend is drawn with the real glyphs' widths into an ink of the test's own, which notes the
 * rectangle of every shape instead of drawing it.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "check.h"
#include "draw/ink_font.h"
#include "draw/overlay.h"
#include "draw/overlay_label.h"

enum { MARKS_MAX = 20000 };
enum mark_kind { MARK_SHAPE, MARK_TEXT, MARK_BAR };

struct mark { enum mark_kind kind; double x0, y0, x1, y1; struct ink_color color; char text[80]; };

struct ink {
    struct ink_font *font;
    uint32_t count;
    struct mark marks[MARKS_MAX];
};

static struct ink page;

static void note(struct ink *ink, enum mark_kind kind, double x0, double y0, double x1, double y1,
                 struct ink_color color, const char *text)
{
    CHECK(ink->count < MARKS_MAX);
    struct mark *mark = &ink->marks[ink->count++];
    *mark = (struct mark){kind, fmin(x0, x1), fmin(y0, y1), fmax(x0, x1), fmax(y0, y1), color, ""};
    snprintf(mark->text, sizeof mark->text, "%s", text);
}

/* ---- the ink that takes notes ---- */

struct ink *ink_create(struct error *error)
{
    (void)error;
    return &page;
}

void ink_destroy(struct ink *ink) { ink->count = 0; }

void ink_flush(struct ink *ink, uint32_t width, uint32_t height)
{
    (void)width;
    (void)height;
    ink->count = 0;
}

void ink_line(struct ink *ink, double x0, double y0, double x1, double y1, double width,
              struct ink_color color)
{
    const double h = 0.5 * width;
    note(ink, MARK_SHAPE, fmin(x0, x1) - h, fmin(y0, y1) - h, fmax(x0, x1) + h, fmax(y0, y1) + h,
         color, "line");
}

void ink_arc(struct ink *ink, double cx, double cy, double radius, double angle0, double angle1,
             double width, struct ink_color color)
{
    (void)angle0;
    (void)angle1;
    const double r = radius + 0.5 * width;
    note(ink, MARK_SHAPE, cx - r, cy - r, cx + r, cy + r, color, "arc");
}

void ink_disc(struct ink *ink, double cx, double cy, double radius, struct ink_color color)
{
    note(ink, MARK_SHAPE, cx - radius, cy - radius, cx + radius, cy + radius, color, "disc");
}

void ink_rectangle(struct ink *ink, double x0, double y0, double x1, double y1,
                   struct ink_color color)
{
    note(ink, MARK_SHAPE, x0, y0, x1, y1, color, "rectangle");
}

void ink_plate(struct ink *ink, double x0, double y0, double x1, double y1, double rounding,
               struct ink_color color)
{
    (void)rounding;
    note(ink, MARK_SHAPE, x0, y0, x1, y1, color, "plate");
}

void ink_triangle(struct ink *ink, const double x[3], const double y[3], struct ink_color color)
{
    note(ink, MARK_SHAPE, fmin(x[0], fmin(x[1], x[2])), fmin(y[0], fmin(y[1], y[2])),
         fmax(x[0], fmax(x[1], x[2])), fmax(y[0], fmax(y[1], y[2])), color, "triangle");
}

void ink_arrow(struct ink *ink, double x0, double y0, double x1, double y1, double width,
               struct ink_color color)
{
    ink_line(ink, x0, y0, x1, y1, width, color);
}

void ink_gradient(struct ink *ink, double x0, double y0, double x1, double y1,
                  const uint8_t (*colormap)[3])
{
    CHECK(colormap != NULL);
    note(ink, MARK_BAR, x0, y0, x1, y1, (struct ink_color){0}, "gradient");
}

double ink_text_width(struct ink *ink, double size, const char *text)
{
    double width = 0;
    for (uint32_t code; (code = ink_font_code(&text)) != 0;) {
        width += ink_font_advance(ink->font, code, size);
    }
    return width;
}

/* Letters reach from 0.24 below the base line (g) to 0.76 above it (d) in DejaVu. */
void ink_text(struct ink *ink, double x, double y, double size, enum ink_align align,
              struct ink_color color, const char *text)
{
    CHECK(size >= 1);
    const double width = ink_text_width(ink, size, text);
    if (align != INK_LEFT) x -= align == INK_CENTER ? 0.5 * width : width;
    if (text[0]) note(ink, MARK_TEXT, x, y - 0.76 * size, x + width, y + 0.24 * size, color, text);
}

/* ---- a scene that asks for everything ---- */

static struct scene scene;
static struct grains grains;
static struct field field;

static int make_scene(void **unused)
{
    (void)unused;
    struct error error = {0};
    page.font = ink_font_create(&error);
    if (!page.font) print_error("%s\n", error.text);
    if (!page.font || !grains_create(&grains, 4, 2, &error)) return -1;
    grains.count = 4;
    for (uint32_t i = 0; i < 4; i++) {
        grains.x[i] = 1 + i;
        grains.y[i] = 2;
        grains.vx[i] = 0.5 * i - 0.2;
        grains.radius[i] = 0.5;
    }
    grains.contact_count = 2;
    grains.contacts[0] = (struct contact){0, 1, 1.5f, 2, 3e-3f, 0, 0};
    grains.contacts[1] = (struct contact){1, 2, 2.5f, 2, 1e-3f, 2e-3f, 0};
    if (!field_create(&field, 0, 0, 1, 8, 6, 1, &error)) return -1;
    snprintf(field.label, sizeof field.label,
             "granular temperature (cm^2/s^2), mean t = 1.25 .. 2.5");
    for (int k = 0; k < 48; k++) field.values[k] = k;
    scene.units = UNITS_CGS;
    scene.radius_mean = 0.5;
    scene.gravity[1] = -981;
    snprintf(scene.title, sizeof scene.title, "Discharge of a silo with a rather long title");
    return 0;
}

static int free_scene(void **unused)
{
    (void)unused;
    ink_font_destroy(page.font);
    grains_free(&grains);
    field_free(&field);
    return 0;
}

static struct view full_view(double width, double height, int theme)
{
    struct view view = {
        .size = {width, height}, .color = COLOR_SPEED, .scale = SCALE_SQRT, .theme = theme,
        .colormap = "viridis", .grains = true, .walls = true, .arrows = true, .forces = true,
        .legend = true, .scale_bar = true, .gravity_arrow = true, .title = "{title}",
        .label = "t = {t:.3f} {time_unit}   N = {n}", .arrow_scale = NAN, .force_scale = NAN,
        .text_size = NAN,
    };
    return view;
}

static void draw_legend(const struct view *view, const struct field *shown, double area[4])
{
    const struct picture picture = {
        .scene = &scene, .view = view, .grains = &grains, .field = shown, .time = 12.34567,
        .range = {0, 1}, .field_range = {0, 40},
    };
    overlay_layout(&picture, area);
    const double scale = fmin((area[2] - area[0]) / 8, (area[3] - area[1]) / 6);
    const struct transform t = {scale, -area[0] / scale, 6 + area[1] / scale};
    const double range[2] = {0, 1}, field_range[2] = {0, 40};
    page.count = 0;
    overlay_legend(&page, &picture, &t, range, field_range);
}

static bool overlap(const struct mark *a, const struct mark *b)
{
    const double slack = 0.5;
    return a->x0 < b->x1 - slack && b->x0 < a->x1 - slack && a->y0 < b->y1 - slack
        && b->y0 < a->y1 - slack;
}

static void check_marks(const struct view *view, const double area[4])
{
    const struct mark scene_mark = {MARK_SHAPE, area[0], area[1], area[2], area[3], {0}, "scene"};
    for (uint32_t k = 0; k < page.count; k++) {
        const struct mark *mark = &page.marks[k];
        const bool plate = strcmp(mark->text, "plate") == 0;
        if (mark->x0 < 0 || mark->y0 < 0 || mark->x1 > view->size[0] || mark->y1 > view->size[1]) {
            fail_msg("%gx%g: '%s' at %g %g %g %g leaves the picture", view->size[0], view->size[1],
                     mark->text, mark->x0, mark->y0, mark->x1, mark->y1);
        }
        if (!plate && overlap(mark, &scene_mark)) {
            fail_msg("%gx%g: '%s' lies on the scene", view->size[0], view->size[1], mark->text);
        }
        if (mark->kind == MARK_SHAPE) continue;
        for (uint32_t other = 0; other < page.count; other++) {
            const struct mark *b = &page.marks[other];
            const bool ground = other < k && strcmp(b->text, "plate") == 0;
            const bool frame = mark->kind == MARK_BAR || b->kind == MARK_BAR;
            if (other == k || ground || !overlap(mark, b)) continue;
            if (frame && strcmp(b->text, "rectangle") == 0) continue;   /* a bar's outline */
            fail_msg("%gx%g: '%s' and '%s' overlap", view->size[0], view->size[1], mark->text,
                     b->text);
        }
    }
}

static const double sizes[][2] = {
    {320, 240}, {240, 320}, {400, 300}, {640, 480}, {854, 480}, {1280, 720}, {720, 1280},
    {1920, 1080}, {3840, 600}, {600, 2400}, {8000, 6000}, {16384, 16384}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static void test_nothing_overlaps_or_leaves_the_picture_at_any_size(void **unused)
{
    (void)unused;
    for (int k = 0; k < SIZES; k++) {
        for (int theme = THEME_WHITE; theme <= THEME_TRANSPARENT; theme++) {
            for (int parts = 0; parts < 128; parts++) {
                struct view view = full_view(sizes[k][0], sizes[k][1], theme);
                double area[4];
                if (parts & 1) view.title[0] = 0;
                if (parts & 2) view.label[0] = 0;
                if (parts & 4) view.gravity_arrow = false;
                if (parts & 8) view.scale = SCALE_LOG;
                if (parts & 16) view.forces = false;
                if (parts & 64) snprintf(view.caption, sizeof view.caption, "computed in 1.25 s");
                draw_legend(&view, parts & 32 ? &field : NULL, area);
                CHECK(page.count > 4);
                check_marks(&view, area);
            }
        }
    }
}

static void test_the_scene_keeps_most_of_the_picture(void **unused)
{
    (void)unused;
    for (int k = 0; k < SIZES; k++) {
        const struct view view = full_view(sizes[k][0], sizes[k][1], THEME_WHITE);
        double area[4];
        draw_legend(&view, &field, area);
        const double share = (area[2] - area[0]) * (area[3] - area[1]) / sizes[k][0] / sizes[k][1];
        CHECK(share > (fmin(sizes[k][0], sizes[k][1]) < 400 ? 0.45 : 0.7));
    }
}

static uint32_t texts_with(const char *part)
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < page.count; k++) {
        count += page.marks[k].kind == MARK_TEXT && strstr(page.marks[k].text, part) != NULL;
    }
    return count;
}

static void test_a_legend_names_what_it_shows_with_units(void **unused)
{
    (void)unused;
    const struct view view = full_view(1280, 720, THEME_WHITE);
    double area[4];
    draw_legend(&view, &field, area);
    assert_int_equal(texts_with("speed (cm/s)"), 1);
    assert_int_equal(texts_with("g = 981 cm/s\u00b2"), 1);
    assert_int_equal(texts_with("contact force"), 1);
    assert_int_equal(texts_with(" dyn"), 1);
    assert_int_equal(texts_with("velocity"), 1);
    assert_int_equal(texts_with("t = 12.346 s   N = 4"), 1);
    assert_int_equal(texts_with("1 cm"), 1);
    assert_int_equal(texts_with("granular"), 1);
    uint32_t bars = 0;
    for (uint32_t k = 0; k < page.count; k++) bars += page.marks[k].kind == MARK_BAR;
    assert_int_equal(bars, 2);
}

static void test_reduced_units_count_diameters(void **unused)
{
    (void)unused;
    const struct view view = full_view(1280, 720, THEME_WHITE);
    double area[4];
    scene.units = UNITS_REDUCED;
    draw_legend(&view, NULL, area);
    scene.units = UNITS_CGS;
    assert_int_equal(texts_with(" d"), 1);
    assert_int_equal(texts_with("speed (cm/s)"), 0);
}

/* Values beyond the range's end are told by a triangle, two drawn for its outline. */
static void test_values_outside_the_range_are_marked(void **unused)
{
    (void)unused;
    const struct view view = full_view(1280, 720, THEME_WHITE);
    double area[4];
    for (int fast = 0; fast < 2; fast++) {
        grains.vx[3] = fast ? 1.2 : 0.9;
        draw_legend(&view, NULL, area);
        uint32_t triangles = 0;
        for (uint32_t k = 0; k < page.count; k++) {
            triangles += strcmp(page.marks[k].text, "triangle") == 0;
        }
        assert_int_equal(triangles, fast ? 2 : 0);
    }
}

static void test_a_picture_without_legend_leaves_all_to_the_scene(void **unused)
{
    (void)unused;
    struct view view = {.size = {640, 480}, .color = COLOR_SPEED, .colormap = "viridis"};
    double area[4];
    draw_legend(&view, NULL, area);
    CHECK(page.count == 0);
    CHECK(area[0] == 0 && area[1] == 0 && area[2] == 640 && area[3] == 480);
    view = full_view(64, 48, THEME_WHITE);      /* too small for letters */
    draw_legend(&view, NULL, area);
    CHECK(page.count == 0);
    CHECK(area[2] - area[0] == 64 && area[3] - area[1] == 48);
}

static void test_a_caption_stands_under_the_scene_and_all_else(void **unused)
{
    (void)unused;
    for (int k = 0; k < SIZES; k++) {
        struct view view = full_view(sizes[k][0], sizes[k][1], THEME_WHITE);
        double area[4], lowest = 0;
        snprintf(view.caption, sizeof view.caption, "N = {n} at the end");
        draw_legend(&view, NULL, area);
        const struct mark *caption = NULL;
        for (uint32_t m = 0; m < page.count; m++) {
            if (strcmp(page.marks[m].text, "N = 4 at the end") == 0) caption = &page.marks[m];
            else if (page.marks[m].x0 < area[2]) lowest = fmax(lowest, page.marks[m].y1);
        }
        assert_non_null(caption);
        CHECK(caption->y0 >= area[3]);
        CHECK(caption->y1 > lowest);
    }
}

static void test_the_layout_does_not_move_while_numbers_change(void **unused)
{
    (void)unused;
    const struct view view = full_view(1280, 720, THEME_WHITE);
    struct picture picture = {.scene = &scene, .view = &view, .grains = &grains};
    double first[4], area[4];
    overlay_layout(&picture, first);
    for (picture.time = 0.001; picture.time < 1e7; picture.time *= 7) {
        grains.count = picture.time < 1 ? 0 : 4;
        overlay_layout(&picture, area);
        CHECK(memcmp(first, area, sizeof area) == 0);
    }
    grains.count = 4;
}

static void test_labels_are_filled_in(void **unused)
{
    (void)unused;
    const struct view view = full_view(1280, 720, THEME_WHITE);
    const struct painter_variable variables[] = {{"steps", "12000"}, {"mu", "0.45"}};
    const struct picture picture = {.scene = &scene, .view = &view, .grains = &grains,
                                    .time = 1.25, .variables = variables, .variable_count = 2};
    static const struct { const char *text, *filled; } labels[] = {
        {"t = {t} {time_unit}", "t = 1.25 s"}, {"{t:.3f}|{t:.1e}", "1.250|1.2e+00"},
        {"N = {n}", "N = 4"}, {"{steps} steps, {mu:.1f}", "12000 steps, 0.5"},
        {"{unknown} {", "{unknown} {"}, {"{{t} = {t}", "{t} = 1.25"},
        {"{t:%n}{t:.99f}", "{t:%n}{t:.99f}"},
        {"{units}", "cgs"}, {"", ""}};
    for (size_t k = 0; k < sizeof labels / sizeof *labels; k++) {
        char text[100];
        overlay_label(&picture, labels[k].text, text, sizeof text);
        assert_string_equal(text, labels[k].filled);
    }
    char raised[40];
    overlay_label_unit("kg m/s^2", raised, sizeof raised);
    assert_string_equal(raised, "kg\u00b7m/s\u00b2");
    overlay_label_raise("in 1/cm^3, mean", raised, sizeof raised);
    assert_string_equal(raised, "in 1/cm\u00b3, mean");
    char narrow[6];
    overlay_label(&picture, "{steps}{steps}", narrow, sizeof narrow);
    assert_string_equal(narrow, "12000");
}

static void test_the_time_has_as_many_digits_as_frames_need(void **unused)
{
    (void)unused;
    const struct view view = full_view(1280, 720, THEME_WHITE);
    static const struct { double interval; const char *text; } cases[] = {
        {1, "2"}, {0.5, "2.0"}, {0.05, "2.00"}, {0.001, "2.000"}, {0, "2"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[100];
        scene.output.frames = cases[k].interval;
        const struct picture picture = {.scene = &scene, .view = &view, .time = 2};
        overlay_label(&picture, "{t}", text, sizeof text);
        assert_string_equal(text, cases[k].text);
    }
    scene.output.frames = 0;
}

static void test_arrows_of_many_grains_are_thinned_out(void **unused)
{
    (void)unused;
    struct grains many;
    struct error error;
    CHECK(grains_create(&many, 40000, 0, &error));
    many.count = 40000;
    for (uint32_t i = 0; i < many.count; i++) {
        many.x[i] = 0.5 + i % 200;
        many.y[i] = 0.5 + i / 200;
        many.vx[i] = 1;
        many.radius[i] = 0.5;
    }
    const struct view view = full_view(1200, 1200, THEME_WHITE);
    const struct picture picture = {.scene = &scene, .view = &view, .grains = &many,
                                    .range = {0, 1}};
    const struct transform t = {6, 0, 200};
    page.count = 0;
    overlay_arrows(&page, &picture, &t);
    CHECK(page.count > 600 && page.count < 5000 && page.count % 2 == 0);
    const struct mark *arrow = page.marks + page.count / 2;     /* behind the lines beneath them */
    for (uint32_t k = 0; k < page.count / 2; k++) {             /* a uniform flow stays uniform */
        CHECK_NEAR(arrow[k].x1 - arrow[k].x0, arrow[0].x1 - arrow[0].x0, 0.01);
    }
    grains_free(&many);
}

static void test_force_lines_join_centres_and_widen_with_the_force(void **unused)
{
    (void)unused;
    struct view view = full_view(800, 600, THEME_WHITE);
    view.force_scale = 100;                     /* 3e-3 of force: 0.3 of length */
    const struct picture picture = {.scene = &scene, .view = &view, .grains = &grains};
    const struct transform t = {100, 0, 6};
    page.count = 0;
    overlay_forces(&page, &picture, &t);
    assert_int_equal(page.count, 2);
    const struct mark *weak = &page.marks[0], *strong = &page.marks[1];
    CHECK_NEAR(strong->y1 - strong->y0, 30, 0.01);
    CHECK_NEAR(weak->y1 - weak->y0, sqrt(5) * 10, 0.01);
    CHECK_NEAR(strong->x0 + 15, 100, 0.01);     /* the centres of grains 0 and 1 */
    CHECK_NEAR(strong->x1 - 15, 200, 0.01);
}

static void test_an_open_gate_is_not_drawn_and_a_moving_wall_moves(void **unused)
{
    (void)unused;
    struct wall walls[2] = {
        {.shape = WALL_SEGMENT, .x0 = 1, .y0 = 1, .x1 = 2, .y1 = 1, .opens = 5, .closes = INFINITY,
         .moves_to = INFINITY},
        {.shape = WALL_SEGMENT, .x0 = 1, .y0 = 3, .x1 = 2, .y1 = 3, .vx = 0.5, .opens = INFINITY,
         .closes = INFINITY, .moves_to = INFINITY}};
    scene.walls = walls;
    scene.wall_count = 2;
    const struct view view = full_view(800, 600, THEME_WHITE);
    const struct transform t = {100, 0, 6};
    struct picture picture = {.scene = &scene, .view = &view, .time = 0};
    page.count = 0;
    overlay_walls(&page, &picture, &t);
    assert_int_equal(page.count, 2);
    const double before = page.marks[1].x0;
    picture.time = 6;
    page.count = 0;
    overlay_walls(&page, &picture, &t);
    assert_int_equal(page.count, 1);
    CHECK_NEAR(page.marks[0].x0 - before, 300, 1e-9);
    scene.wall_count = 0;
    scene.walls = NULL;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_overlaps_or_leaves_the_picture_at_any_size),
        cmocka_unit_test(test_the_scene_keeps_most_of_the_picture),
        cmocka_unit_test(test_a_legend_names_what_it_shows_with_units),
        cmocka_unit_test(test_reduced_units_count_diameters),
        cmocka_unit_test(test_values_outside_the_range_are_marked),
        cmocka_unit_test(test_a_picture_without_legend_leaves_all_to_the_scene),
        cmocka_unit_test(test_a_caption_stands_under_the_scene_and_all_else),
        cmocka_unit_test(test_the_layout_does_not_move_while_numbers_change),
        cmocka_unit_test(test_labels_are_filled_in),
        cmocka_unit_test(test_the_time_has_as_many_digits_as_frames_need),
        cmocka_unit_test(test_arrows_of_many_grains_are_thinned_out),
        cmocka_unit_test(test_force_lines_join_centres_and_widen_with_the_force),
        cmocka_unit_test(test_an_open_gate_is_not_drawn_and_a_moving_wall_moves),
    };
    return cmocka_run_group_tests(tests, make_scene, free_scene);
}
