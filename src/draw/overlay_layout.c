/* overlay_layout.c - see overlay_layout.h.  Every length is a multiple of the letters' size, so a
 * legend looks the same at 320x240 and at 8000x6000.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/overlay_layout.h"

#include "draw/overlay.h"

#include <math.h>
#include <string.h>

static const double text_share = 1.0 / 40;      /* of the picture's height */
static const double text_min = 9;               /* below, letters cannot be read */
static const double width_min = 18, height_min = 13;    /* of a picture with a legend, in letters */
static const double column_width = 7, item_width = 13.5, row_height = 1.9;
static const double margin = 0.6, caption_height = 1.9;

static void choose_text(const struct picture *picture, struct layout *layout)
{
    const double chosen = picture->view->text_size;
    const double side = fmin(layout->height, 0.8 * layout->width);
    layout->text = chosen > 0 ? chosen : fmax(text_min, round(side * text_share));
    layout->unit = fmax(layout->text / 18, 0.6);
    layout->small = layout->width < width_min * layout->text
        || layout->height < height_min * layout->text;
}

/* How many letters a text with variables may become: each stands for about eight. */
static double letters(const char *text)
{
    double count = 0;
    bool variable = false;
    for (; *text; text++) {
        if ((*text & 0xc0) == 0x80) continue;           /* inside a UTF-8 letter */
        if (*text == '{') count += 8;
        if (*text == '{') variable = true;
        else if (!variable) count++;
        if (*text == '}') variable = false;
    }
    return count;
}

static void choose_parts(const struct picture *picture, struct layout *layout)
{
    const struct view *view = picture->view;
    layout->grains_bar = view->legend && view->grains && picture->grains
        && view->color != COLOR_NONE;
    layout->field_bar = view->legend && picture->field;
    layout->title = view->title[0] != 0;
    layout->label = view->label[0] != 0;
    layout->caption = view->caption[0] != 0;
    layout->item[LAYOUT_SCALE] = view->scale_bar;
    layout->item[LAYOUT_GRAVITY] = view->gravity_arrow;
    layout->item[LAYOUT_FORCE] = view->legend && view->forces && picture->grains;
    layout->item[LAYOUT_VELOCITY] = view->legend && view->arrows && picture->grains;
}

static void place_top(const struct picture *picture, struct layout *layout)
{
    const struct view *view = picture->view;
    const double needed = 1.3 * letters(view->title) + letters(view->label) + 4;
    layout->one_line = !(layout->title && layout->label)
        || needed * 0.58 * layout->text < layout->top[2] - layout->top[0];
    double height = 0;
    if (layout->title) height += 1.75;
    if (layout->label && !(layout->title && layout->one_line)) height += 1.4;
    if (height > 0) height += 0.75;
    layout->top[3] = height * layout->text;
}

/* The caption stands below all else, the scale bar and the like above it. */
static void place_bottom(struct layout *layout)
{
    if (layout->caption) {
        layout->caption_base = layout->height - 0.7 * layout->text;
        layout->bottom[3] -= caption_height * layout->text;
    }
    uint32_t count = 0;
    for (int item = 0; item < LAYOUT_ITEMS; item++) count += layout->item[item];
    const double width = layout->bottom[2] - layout->bottom[0];
    layout->columns = (uint32_t)fmax(1, floor(width / (item_width * layout->text)));
    layout->rows = (count + layout->columns - 1) / layout->columns;
    layout->item_width = item_width * layout->text;
    if (layout->item_width > width) layout->item_width = width;
    layout->row_height = row_height * layout->text;
    const double height = layout->rows ? layout->rows * layout->row_height + 0.4 * layout->text : 0;
    layout->bottom[1] = layout->bottom[3] - height;
}

void overlay_layout_make(const struct picture *picture, struct layout *layout)
{
    *layout = (struct layout){
        .width = picture->view->size[0],
        .height = picture->view->size[1],
    };
    const double width = layout->width, height = layout->height;
    choose_text(picture, layout);
    if (!layout->small) choose_parts(picture, layout);
    const bool bars = layout->grains_bar || layout->field_bar;
    const double pad = margin * layout->text;
    const double right = bars ? round(width - column_width * layout->text) : width;
    memcpy(layout->column, (double[4]){right, 0, width, height}, sizeof layout->column);
    memcpy(layout->top, (double[4]){pad, 0, right - pad, 0}, sizeof layout->top);
    memcpy(layout->bottom, (double[4]){pad, height, right - pad, height}, sizeof layout->bottom);
    place_top(picture, layout);
    place_bottom(layout);
    const bool foot = layout->rows || layout->caption;
    const bool plain = !bars && layout->top[3] == 0 && !foot;
    const double left = plain ? 0 : pad;
    layout->area[0] = left;
    layout->area[1] = fmax(layout->top[3], left);
    layout->area[2] = right - (bars ? 0 : left);
    layout->area[3] = foot ? layout->bottom[1] : height - left;
}

void overlay_layout(const struct picture *picture, double area[4])
{
    struct layout layout;
    overlay_layout_make(picture, &layout);
    memcpy(area, layout.area, sizeof layout.area);
}
