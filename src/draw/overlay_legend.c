/* overlay_legend.c - what surrounds the scene: title and label, and the parts drawn elsewhere.
 *
 * Everything stands in the places of overlay_layout.h.  A text that would leave its place is
 * written smaller, so nothing ever overlaps or is cut off.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/overlay_legend.h"

#include "draw/overlay.h"
#include "draw/overlay_label.h"

#include <math.h>

static const double title_size = 1.3;
enum { TEXT_LENGTH_MAX = 600 };

double overlay_legend_fit(const struct legend *legend, double size, double room, const char *text)
{
    const double width = ink_text_width(legend->ink, size, text);
    return width > room ? fmax(size * room / width, 1) : size;
}

void overlay_legend_plate(const struct legend *legend, double x0, double y0, double x1, double y1)
{
    if (legend->plate.a == 0) return;
    ink_plate(legend->ink, fmax(x0, 1), fmax(y0, 1), fmin(x1, legend->layout.width - 1),
              fmin(y1, legend->layout.height - 1), 0.3 * legend->layout.text, legend->plate);
}

static void draw_line(const struct legend *legend, double x, double y, double size, double room,
                      enum ink_align align, const char *text)
{
    const double s = legend->layout.text, fitted = overlay_legend_fit(legend, size, room, text);
    const double width = ink_text_width(legend->ink, fitted, text);
    const double left = align == INK_RIGHT ? x - width : x;
    if (width > 0) {
        overlay_legend_plate(legend, left - 0.4 * s, y - 1.0 * size, left + width + 0.4 * s,
                             y + 0.4 * size);
    }
    ink_text(legend->ink, left, y, fitted, INK_LEFT, legend->text, text);
}

/* Title at the left, label at the right of one line; or the label below, if it is too long. */
static void draw_top(const struct legend *legend)
{
    const struct layout *layout = &legend->layout;
    const double s = layout->text, room = layout->top[2] - layout->top[0];
    char title[TEXT_LENGTH_MAX], label[TEXT_LENGTH_MAX];
    overlay_label(legend->picture, legend->picture->view->title, title, sizeof title);
    overlay_label(legend->picture, legend->picture->view->label, label, sizeof label);
    double base = 0.35 * s, free_room = room;
    if (layout->title) {
        base += 1.4 * s;
        draw_line(legend, layout->top[0], base, title_size * s,
                  layout->label && layout->one_line ? 0.7 * room : room, INK_LEFT, title);
        const double used = fmin(ink_text_width(legend->ink, title_size * s, title), 0.7 * room);
        if (layout->one_line) free_room = room - used - 1.5 * s;
    }
    if (!layout->label) return;
    if (layout->title && layout->one_line) {
        draw_line(legend, layout->top[2], base, s, free_room, INK_RIGHT, label);
        return;
    }
    draw_line(legend, layout->top[0], base + 1.4 * s, s, room, INK_LEFT, label);
}

static void draw_caption(const struct legend *legend)
{
    const struct layout *layout = &legend->layout;
    char caption[TEXT_LENGTH_MAX];
    if (!layout->caption) return;
    overlay_label(legend->picture, legend->picture->view->caption, caption, sizeof caption);
    draw_line(legend, layout->bottom[0], layout->caption_base, layout->text,
              layout->bottom[2] - layout->bottom[0], INK_LEFT, caption);
}

void overlay_legend(struct ink *ink, const struct picture *picture, const struct transform *t,
                    const double range[2], const double field_range[2])
{
    const enum theme theme = (enum theme)picture->view->theme;
    struct legend legend = {
        .ink = ink, .picture = picture, .t = t, .range = range, .field_range = field_range,
        .text = overlay_text_color(theme),
    };
    if (theme == THEME_TRANSPARENT) legend.plate = (struct ink_color){255, 255, 255, 205};
    overlay_layout_make(picture, &legend.layout);
    legend.rule = fmax(1, round(legend.layout.unit));
    if (legend.layout.small) return;
    draw_top(&legend);
    draw_caption(&legend);
    overlay_legend_bars(&legend);
    overlay_legend_items(&legend);
}
