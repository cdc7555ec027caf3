/* mosaic.c - see mosaic.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/mosaic.h"

#ifdef SANDREEL_TERMINAL

#include <chafa.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct mosaic {
    ChafaCanvasConfig *config;
    ChafaCanvas *canvas;
    ChafaTermInfo *info;
    ChafaPixelMode mode;
    int columns, rows;
};

/* An assumed shape of characters, where the terminal does not tell. */
enum { CELL_WIDTH = 8, CELL_HEIGHT = 16 };

static ChafaCanvasMode choose_colors(const ChafaTermInfo *info)
{
    const char *word = getenv("COLORTERM");
    if (word && (strcmp(word, "truecolor") == 0 || strcmp(word, "24bit") == 0)) {
        return CHAFA_CANVAS_MODE_TRUECOLOR;
    }
    if (chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_SET_COLOR_FGBG_DIRECT)) {
        return CHAFA_CANVAS_MODE_TRUECOLOR;
    }
    return chafa_term_info_have_seq(info, CHAFA_TERM_SEQ_SET_COLOR_FGBG_256)
         ? CHAFA_CANVAS_MODE_INDEXED_240 : CHAFA_CANVAS_MODE_INDEXED_16;
}

/* Sequences that the terminal's name does not promise but its answer does come from the list of
 * all that are usual. */
static ChafaTermInfo *find_info(void)
{
    gchar **variables = g_get_environ();
    ChafaTermDb *db = chafa_term_db_get_default();
    ChafaTermInfo *info = chafa_term_db_detect(db, variables);
    ChafaTermInfo *usual = chafa_term_db_get_fallback_info(db);
    chafa_term_info_supplement(info, usual);
    chafa_term_info_unref(usual);
    g_strfreev(variables);
    return info;
}

struct mosaic *mosaic_create(const struct tty *tty, unsigned spared, const struct image *image,
                             struct error *error)
{
    struct mosaic *mosaic = calloc(1, sizeof *mosaic);
    if (!mosaic) {
        error_set(error, "not enough memory for a picture");
        return NULL;
    }
    const int rows = tty->rows > spared + 1 ? (int)(tty->rows - spared) : 1;
    int cell_width = CELL_WIDTH, cell_height = CELL_HEIGHT;
    if (tty->width >= tty->columns && tty->height >= tty->rows) {
        cell_width = (int)(tty->width / tty->columns);
        cell_height = (int)(tty->height / tty->rows);
    }
    mosaic->columns = (int)tty->columns;
    mosaic->rows = rows;
    chafa_calc_canvas_geometry((int)image->width, (int)image->height, &mosaic->columns,
                               &mosaic->rows, (float)cell_width / (float)cell_height, TRUE, FALSE);
    mosaic->info = find_info();
    mosaic->mode = tty->kitty ? CHAFA_PIXEL_MODE_KITTY
                 : tty->sixel ? CHAFA_PIXEL_MODE_SIXELS : CHAFA_PIXEL_MODE_SYMBOLS;
    mosaic->config = chafa_canvas_config_new();
    chafa_canvas_config_set_geometry(mosaic->config, mosaic->columns, mosaic->rows);
    chafa_canvas_config_set_cell_geometry(mosaic->config, cell_width, cell_height);
    chafa_canvas_config_set_pixel_mode(mosaic->config, mosaic->mode);
    chafa_canvas_config_set_canvas_mode(mosaic->config,
        mosaic->mode == CHAFA_PIXEL_MODE_SYMBOLS ? choose_colors(mosaic->info)
                                                 : CHAFA_CANVAS_MODE_TRUECOLOR);
    chafa_canvas_config_set_work_factor(mosaic->config, 0.1f);  /* quick rather than fine */
    mosaic->canvas = chafa_canvas_new(mosaic->config);
    return mosaic;
}

void mosaic_destroy(struct mosaic *mosaic)
{
    if (!mosaic) return;
    chafa_canvas_unref(mosaic->canvas);
    chafa_canvas_config_unref(mosaic->config);
    chafa_term_info_unref(mosaic->info);
    free(mosaic);
}

const char *mosaic_kind(const struct mosaic *mosaic)
{
    return mosaic->mode == CHAFA_PIXEL_MODE_KITTY ? "kitty"
         : mosaic->mode == CHAFA_PIXEL_MODE_SIXELS ? "sixel" : "characters";
}

void mosaic_show(struct mosaic *mosaic, const struct image *image)
{
    chafa_canvas_draw_all_pixels(mosaic->canvas, CHAFA_PIXEL_RGBA8_UNASSOCIATED, image->rgba,
                                 (int)image->width, (int)image->height, (int)image->width * 4);
    GString *text = chafa_canvas_print(mosaic->canvas, mosaic->info);
    if (mosaic->mode == CHAFA_PIXEL_MODE_KITTY) {
        static const char clear[] = "\033_Ga=d,q=2\033\\";
        tty_write(clear, sizeof clear - 1);
    }
    tty_write("\033[H", 3);
    /* Line by line to the left edge: a line feed alone does not go there in every mode. */
    for (char *at = text->str, *end = at + text->len; at < end;) {
        char *stop = memchr(at, '\n', (size_t)(end - at));
        const size_t length = (size_t)((stop ? stop : end) - at);
        tty_write(at, length);
        if (stop) tty_write("\r\n", 2);
        at += length + (stop != NULL);
    }
    g_string_free(text, TRUE);
    tty_write("\033[0m", 4);
}

#endif
