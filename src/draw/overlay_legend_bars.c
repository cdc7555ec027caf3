/* overlay_legend_bars.c - colour bars with ticks, unit and end marks; or the names of species.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/overlay_legend.h"

#include "draw/colormap.h"
#include "draw/overlay_label.h"
#include "draw/shortage.h"
#include "draw/ticks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sizes in letters of the layout's size. */
static const double tick_size = 0.88, heading_size = 0.88, line_spacing = 1.25;
static const double bar_length_max = 26;

enum { HEADING_LINES = 4, LINE_MAX = 120, HEADING_MAX = 200, UNIT_MAX = 40 };

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
    char heading[HEADING_MAX];  /* with unit */
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
        size = overlay_legend_fit(legend, size, room - 0.55 * s, ticks->list[k].text);
    }
    for (uint32_t k = 0; k < ticks->count; k++) {
        const double y = y1 + ticks->list[k].position * (y0 - y1);
        const double edge = fmin(fmax(round(y - 0.5 * rule), y0), y1 - rule);
        ink_rectangle(legend->ink, x, edge, x + round(0.3 * s), edge + rule, legend->text);
        const double base = edge + 0.5 * (rule + OVERLAY_LEGEND_CAPITAL * size);
        ink_text(legend->ink, x + 0.55 * s, base, size, INK_LEFT, legend->text,
                 ticks->list[k].text);
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
        char *comma = strrchr(lines[k], ',');      /* a line break says the same */
        if (comma && comma[1] == 0) *comma = 0;
        const double fitted = overlay_legend_fit(legend, size, room, lines[k]);
        ink_text(legend->ink, x, y, fitted, INK_LEFT, legend->text, lines[k]);
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
    const double top = draw_heading(legend, bar->heading, x0, bar->space[1] - 0.25 * s,
                                    bar->space[2] - x0);
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
                         const struct bar *bar)
{
    char factor[TICKS_TEXT_MAX] = "", pretty[UNIT_MAX];
    struct ticks ticks;
    ticks_make(&ticks, bar->scale, bar->range, TICKS_MAX);
    if (ticks.exponent != 0) ticks_power(factor, ticks.exponent);
    overlay_label_unit(unit, pretty, sizeof pretty);
    const char *blank = factor[0] && pretty[0] ? "\u00a0" : "";  /* no line ends here */
    if (factor[0] || pretty[0]) snprintf(out, size, "%s (%s%s%s)", name, factor, blank, pretty);
    else snprintf(out, size, "%s", name);
}

static uint32_t heading_lines(const struct legend *legend, const struct bar *bar)
{
    char lines[HEADING_LINES][LINE_MAX];
    return wrap(legend, bar->heading, heading_size * legend->layout.text,
                bar->space[2] - bar->space[0], lines);
}

/* Shares the column among the bars; long ones are shortened and stand in the middle. */
static void place_bars(const struct legend *legend, struct bar bars[2], int count)
{
    const struct layout *layout = &legend->layout;
    const double s = layout->text, top = layout->column[1] + 0.6 * s;
    const double height = (layout->column[3] - 0.6 * s - top) / count;
    for (int k = 0; k < count; k++) {
        struct bar *bar = &bars[k];
        bar->space[0] = layout->column[0] + 0.7 * s;
        bar->space[2] = layout->column[2] - 0.4 * s;
        const double extra = heading_lines(legend, bar) * line_spacing * heading_size * s + 2 * s;
        const double used = fmin(height - 0.6 * s, bar_length_max * s + extra);
        bar->space[1] = top + k * height + 0.5 * (height - used);
        bar->space[3] = bar->space[1] + used;
    }
    const double *first = bars[0].space, *last = bars[count - 1].space;
    overlay_legend_plate(legend, first[0] - 0.4 * s, first[1] - 0.3 * s, first[2] + 0.2 * s,
                         last[3] + 0.3 * s);
}

/* Do values lie outside the range by more than what a tick's width could show? */
static void mark_ends(struct bar *bar, double value)
{
    const double slack = 1e-6 * (bar->range[1] - bar->range[0]);
    if (value > bar->range[1] + slack) bar->above = true;
    if (value < bar->range[0] - slack) bar->below = true;
}

static void grains_bar(const struct legend *legend, struct bar *bar)
{
    const struct picture *picture = legend->picture;
    bar->scale = (enum scale)picture->view->scale;
    bar->range[0] = legend->range[0];
    bar->range[1] = legend->range[1];
    if (bar->scale == SCALE_LOG) bar->range[0] = fmax(bar->range[0], bar->range[1] / 1000);
    make_heading(bar->heading, sizeof bar->heading, painter_value_name(picture->view),
                 scene_unit(picture->scene, painter_value_dimension(picture->view)), bar);
    float *values = shortage_check(malloc((picture->grains->count + 1) * sizeof *values));
    if (!values) return;
    painter_value_all(picture->view, picture->grains, values);
    for (uint32_t i = 0; i < picture->grains->count; i++) mark_ends(bar, (double)values[i]);
    free(values);
}

static void field_bar(const struct legend *legend, struct bar *bar)
{
    const struct field *field = legend->picture->field;
    bar->scale = SCALE_LINEAR;
    bar->range[0] = legend->field_range[0];
    bar->range[1] = legend->field_range[1];
    char label[HEADING_MAX];
    overlay_label_raise(field->label[0] ? field->label : field->name, label, sizeof label);
    make_heading(bar->heading, sizeof bar->heading, label, field->label[0] ? "" : field->unit, bar);
    const size_t count = (size_t)field->nx * field->ny;
    for (size_t k = 0; k < count; k++) {
        const double x = field->values[k];
        mark_ends(bar, field->components == 1 ? x : hypot(x, field->values[count + k]));
    }
}

/* Species have names, not numbers. */
static void draw_species(const struct legend *legend)
{
    const struct scene *scene = legend->picture->scene;
    const double s = legend->layout.text, size = heading_size * s, line = 1.5 * size;
    const double x = legend->layout.column[0] + 0.7 * s;
    const double room = legend->layout.column[2] - 0.4 * s - x - 1.4 * s;
    const double top = legend->layout.top[3] + 0.8 * s;
    const uint32_t fit = (uint32_t)fmax(1, (legend->layout.height - top - s) / line);
    const uint32_t count = scene->species_count < fit ? scene->species_count : fit;
    overlay_legend_plate(legend, x - 0.4 * s, top - 0.4 * s, legend->layout.column[2] - 0.2 * s,
                         top + count * line + 0.2 * s);
    for (uint32_t k = 0; k < count; k++) {
        const uint8_t *rgb = painter_species_color(k);
        char name[KEY_TEXT_MAX];
        if (scene->species[k].name[0]) snprintf(name, sizeof name, "%s", scene->species[k].name);
        else snprintf(name, sizeof name, "species %u", k + 1);
        const double y = top + (k + 0.5) * line;
        ink_disc(legend->ink, x + 0.45 * s, y, 0.45 * s, legend->text);
        ink_disc(legend->ink, x + 0.45 * s, y, 0.45 * s - legend->rule,
                 (struct ink_color){rgb[0], rgb[1], rgb[2], 255});
        ink_text(legend->ink, x + 1.4 * s, y + 0.5 * OVERLAY_LEGEND_CAPITAL * size,
                 overlay_legend_fit(legend, size, room, name), INK_LEFT, legend->text, name);
    }
}

void overlay_legend_bars(const struct legend *legend)
{
    const struct picture *picture = legend->picture;
    const uint8_t (*colormap)[3] = colormap_find(picture->view->colormap);
    struct bar bars[2] = {{.colormap = colormap}, {.colormap = colormap}};
    int count = 0;
    const bool species = legend->layout.grains_bar && picture->view->color == COLOR_SPECIES;
    if (legend->layout.grains_bar && !species) grains_bar(legend, &bars[count++]);
    if (legend->layout.field_bar) field_bar(legend, &bars[count++]);
    if (species) draw_species(legend);
    if (count == 0 || !colormap) return;
    place_bars(legend, bars, count);
    for (int k = 0; k < count; k++) draw_bar(legend, &bars[k]);
}
