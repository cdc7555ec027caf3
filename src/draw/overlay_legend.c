/* overlay_legend.c - colour bars, scale bar, arrow of gravity, keys of forces and velocities,
 * title and label.
 *
 * Everything stands in the places of overlay_layout.h.  A text that would leave its place is
 * written smaller, so nothing ever overlaps or is cut off.  Grains may lie beneath when a view
 * shows more than fits; each part therefore stands on a plate in the colour of the ground.
 */
#include "draw/overlay.h"

#include "draw/colormap.h"
#include "draw/overlay_arrows.h"
#include "draw/overlay_forces.h"
#include "draw/overlay_label.h"
#include "draw/overlay_layout.h"
#include "draw/ticks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sizes in letters of the layout's size. */
static const double tick_size = 0.88, heading_size = 0.92, item_size = 0.92, title_size = 1.3;
static const double capital_height = 0.73;      /* of DejaVu's digits and capitals, per size */
static const double line_spacing = 1.25;

enum { HEADING_LINES = 4, LINE_MAX = 120 };

struct legend {
    struct ink *ink;
    const struct picture *picture;
    const struct transform *t;
    struct layout layout;
    struct ink_color text, plate;
    double rule;                /* width of thin lines: whole pixels */
};

static void legend_begin(struct legend *legend, struct ink *ink, const struct picture *picture,
                         const struct transform *t)
{
    static const uint8_t plate_alpha[] = {
        [THEME_WHITE] = 225, [THEME_DARK] = 225, [THEME_TRANSPARENT] = 205,
    };
    const enum theme theme = (enum theme)picture->view->theme;
    *legend = (struct legend){.ink = ink, .picture = picture, .t = t};
    overlay_layout_make(picture, &legend->layout);
    legend->text = overlay_text_color(theme);
    legend->plate = overlay_ground(theme);
    legend->plate.a = plate_alpha[theme];
    legend->rule = fmax(1, round(legend->layout.unit));
}

static void draw_plate(const struct legend *legend, double x0, double y0, double x1, double y1)
{
    const double rounding = 0.25 * legend->layout.text;
    ink_plate(legend->ink, fmax(x0, 1), fmax(y0, 1), fmin(x1, legend->layout.width - 1),
              fmin(y1, legend->layout.height - 1), rounding, legend->plate);
}

/* The size, at most `size`, at which the text is not wider than `room`. */
static double fit(const struct legend *legend, double size, double room, const char *text)
{
    const double width = ink_text_width(legend->ink, size, text);
    return width > room ? size * room / width : size;
}

/* ---- colour bars ---- */

/* Breaks a text at blanks into lines not wider than `room`; what is still too wide is made
 * smaller when it is drawn.  The last line takes the rest. */
static uint32_t wrap(const struct legend *legend, const char *text, double size, double room,
                     char lines[HEADING_LINES][LINE_MAX])
{
    uint32_t count = 0;
    while (*text && count < HEADING_LINES) {
        size_t taken = 0;
        for (size_t end = 1; end < LINE_MAX; end++) {
            if (text[end] != ' ' && text[end] != 0) continue;
            snprintf(lines[count], LINE_MAX, "%.*s", (int)end, text);
            const bool fits = ink_text_width(legend->ink, size, lines[count]) <= room;
            if (fits || taken == 0 || count == HEADING_LINES - 1) taken = end;
            if (!fits && count < HEADING_LINES - 1) break;
            if (text[end] == 0) break;
        }
        if (taken == 0) taken = strnlen(text, LINE_MAX - 1);
        snprintf(lines[count++], LINE_MAX, "%.*s", (int)taken, text);
        text += taken;
        while (*text == ' ') text++;
    }
    return count;
}

struct bar {
    const char *heading;        /* with unit */
    const uint8_t (*colormap)[3];
    enum scale scale;
    double range[2];
    bool below, above;          /* are there values outside the range? */
    double space[4];            /* x0 y0 x1 y1 that it may fill */
};

/* A small triangle at an end of the bar: some values lie beyond. */
static void draw_end_mark(const struct legend *legend, double x0, double x1, double base,
                          double tip, const uint8_t rgb[3])
{
    const double grow = base < tip ? 1.6 * legend->rule : -1.6 * legend->rule;
    const double middle = 0.5 * (x0 + x1), g = 1.2 * legend->rule;
    ink_triangle(legend->ink, (double[]){x0 - g, x1 + g, middle},
                 (double[]){base, base, tip + grow}, legend->text);
    ink_triangle(legend->ink, (double[]){x0, x1, middle}, (double[]){base, base, tip},
                 (struct ink_color){rgb[0], rgb[1], rgb[2], 255});
}

static void draw_ticks(const struct legend *legend, const struct ticks *ticks, double x, double y0,
                       double y1, double room)
{
    const double s = legend->layout.text, rule = legend->rule;
    double size = tick_size * s;
    for (uint32_t k = 0; k < ticks->count; k++) {
        size = fit(legend, size, room - 0.55 * s, ticks->list[k].text);
    }
    for (uint32_t k = 0; k < ticks->count; k++) {
        const double y = y1 + ticks->list[k].position * (y0 - y1);
        const double edge = fmin(fmax(round(y - 0.5 * rule), y0), y1 - rule);
        ink_rectangle(legend->ink, x, edge, x + round(0.3 * s), edge + rule, legend->text);
        ink_text(legend->ink, x + 0.55 * s, edge + 0.5 * (rule + capital_height * size), size,
                 INK_LEFT, legend->text, ticks->list[k].text);
    }
}

static double draw_heading(const struct legend *legend, const char *heading, double x, double y,
                           double room)
{
    char lines[HEADING_LINES][LINE_MAX];
    const double size = heading_size * legend->layout.text;
    const uint32_t count = wrap(legend, heading, size, room, lines);
    for (uint32_t k = 0; k < count; k++) {
        y += line_spacing * size;
        ink_text(legend->ink, x, y, fit(legend, size, room, lines[k]), INK_LEFT, legend->text,
                 lines[k]);
    }
    return y;
}

static void draw_bar(const struct legend *legend, const struct bar *bar)
{
    const double s = legend->layout.text, rule = legend->rule;
    const double x0 = round(bar->space[0]), x1 = x0 + round(1.1 * s);
    struct ticks ticks;
    const double length_max = bar->space[3] - bar->space[1];
    ticks_make(&ticks, bar->scale, bar->range,
               (uint32_t)fmin(fmax(length_max / (2.6 * s), 2), TICKS_MAX));
    char heading[LINE_MAX];
    snprintf(heading, sizeof heading, "%s", bar->heading);
    double top = draw_heading(legend, heading, x0, bar->space[1] - 0.25 * s,
                              bar->space[2] - bar->space[0]);
    const double mark = 0.75 * s;
    const double y0 = round(top + 0.5 * s + mark), y1 = round(bar->space[3] - mark);
    if (y1 - y0 < 2 * s) return;
    if (bar->above) draw_end_mark(legend, x0, x1, y0, y0 - mark, bar->colormap[COLORMAP_SIZE - 1]);
    if (bar->below) draw_end_mark(legend, x0, x1, y1, y1 + mark, bar->colormap[0]);
    ink_rectangle(legend->ink, x0 - rule, y0 - rule, x1 + rule, y1 + rule, legend->text);
    ink_gradient(legend->ink, x0, y0, x1, y1, bar->colormap);
    draw_ticks(legend, &ticks, x1 + rule, y0, y1, bar->space[2] - x1 - rule);
}

/* "speed (10^3 cm/s)", units and powers raised. */
static void make_heading(char *out, size_t size, const char *name, const char *unit,
                         enum scale scale, const double range[2])
{
    char factor[TICKS_TEXT_MAX] = "", pretty[LINE_MAX];
    struct ticks ticks;
    ticks_make(&ticks, scale, range, TICKS_MAX);
    if (ticks.exponent != 0) ticks_power(factor, ticks.exponent);
    overlay_label_unit(unit, pretty, sizeof pretty);
    const char *blank = factor[0] && pretty[0] ? " " : "";
    if (factor[0] || pretty[0]) snprintf(out, size, "%s (%s%s%s)", name, factor, blank, pretty);
    else snprintf(out, size, "%s", name);
}
