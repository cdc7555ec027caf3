/* terminal.c - see terminal.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/terminal.h"

#ifdef SANDREEL_TERMINAL

#include "live/command.h"
#include "live/mosaic.h"
#include "live/prompt.h"
#include "live/tty.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STATUS_ROWS = 3, ESCAPE = 27 };

static const double picture_rate = 10;          /* a second: terminals are slow */
static const double look_seconds = 0.02;        /* for a picture before the keys are asked */
static const double escape_seconds = 0.01;      /* the rest of an arrow key comes at once */

struct terminal {
    struct loop *loop;
    struct tty tty;
    struct mosaic *mosaic;
    struct prompt *prompt;
    uint32_t width, height;     /* of the pictures that the mosaic is for */
    uint64_t shown;
    bool     started, edits;
    bool     over;              /* under lock */
    pthread_mutex_t lock;
    pthread_t thread;
    struct stage_status status;
    const char *model, *work;
    char     title[KEY_TEXT_MAX];
    char     reply[SESSION_REPLY_MAX];
};

static bool is_over(struct terminal *terminal)
{
    pthread_mutex_lock(&terminal->lock);
    const bool over = terminal->over;
    pthread_mutex_unlock(&terminal->lock);
    return over;
}

/* ---- what is shown ------------------------------------------------------------------------ */

/* One of the last lines, cut to the width; 1 is the uppermost of them. */
static void show_line(const struct terminal *terminal, unsigned line, const char *text)
{
    char place[32];
    const unsigned row = terminal->tty.rows - STATUS_ROWS + line;
    snprintf(place, sizeof place, "\033[%u;1H\033[0m\033[K", row);
    tty_write(place, strlen(place));
    const size_t length = strcspn(text, "\n");
    tty_write(text, length < terminal->tty.columns ? length : terminal->tty.columns);
}

static void show_status(struct terminal *terminal)
{
    const struct stage_status *s = &terminal->status;
    const struct counters *now = &s->counters;
    char text[400];
    snprintf(text, sizeof text, " %s  %s  t = %.6g of %.6g  %llu grains  %s  %.3g %s/s",
             terminal->title, terminal->model, now->time, s->until,
             (unsigned long long)now->grains, s->running ? "running" : "at rest", s->rate,
             terminal->work);
    show_line(terminal, 1, text);
    snprintf(text, sizeof text, " energy: %.6g of motion, %.6g of rotation, %.6g potential  "
             "collisions: %llu  out: %llu", now->kinetic_energy, now->rotational_energy,
             now->potential_energy, (unsigned long long)now->collisions,
             (unsigned long long)now->grains_out);
    show_line(terminal, 2, text);
    if (terminal->edits) return;
    show_line(terminal, 3, terminal->reply[0] ? terminal->reply
              : " space: go, pause  . step  , back  arrows + - 0: window  : command  q: quit");
}

static void clear_screen(struct terminal *terminal)
{
    tty_write("\033[2J", 4);
    mosaic_destroy(terminal->mosaic);
    terminal->mosaic = NULL;
}

static void show_frame(struct terminal *terminal, const struct stage_frame *frame)
{
    const struct image *image = &frame->image;
    struct error error;
    const bool same = terminal->width == image->width && terminal->height == image->height;
    if (tty_resized(&terminal->tty) || !same) clear_screen(terminal);
    terminal->width = image->width;
    terminal->height = image->height;
    if (!terminal->mosaic) {
        terminal->mosaic = mosaic_create(&terminal->tty, STATUS_ROWS, image, &error);
    }
    if (terminal->mosaic) mosaic_show(terminal->mosaic, image);
    terminal->status = frame->status;
    terminal->shown = frame->number;
}

/* A picture if a new one comes soon, and the lines below it.  While a command is typed the cursor
 * stays where it is. */
static bool look(void *context)
{
    struct terminal *terminal = context;
    if (is_over(terminal)) return false;
    if (tty_resized(&terminal->tty)) {
        clear_screen(terminal);
        terminal->shown = 0;
    }
    const struct stage_frame *frame = stage_await(loop_stage(terminal->loop), terminal->shown,
                                                  look_seconds, picture_rate);
    const struct stage_status status = loop_status(terminal->loop);
    const bool changed = frame || status.running != terminal->status.running
                      || status.version != terminal->status.version;
    if (!changed) return true;
    if (terminal->edits) tty_write("\0337", 2);
    if (frame) show_frame(terminal, frame);
    terminal->status = status;
    if (!terminal->edits) loop_trouble(terminal->loop, terminal->reply + strlen(terminal->reply),
                                       sizeof terminal->reply - strlen(terminal->reply));
    show_status(terminal);
    if (terminal->edits) tty_write("\0338", 2);
    if (frame) stage_release(loop_stage(terminal->loop), frame);
    return true;
}

/* ---- keys --------------------------------------------------------------------------------- */

static void command(struct terminal *terminal, const char *text)
{
    loop_ask(terminal->loop, text, terminal->reply, sizeof terminal->reply);
    show_status(terminal);
}

/* A screen full of lines; returns what is left of them. */
static const char *show_page(struct terminal *terminal, const char *at)
{
    clear_screen(terminal);
    tty_write("\033[H", 3);
    for (unsigned row = 0; *at && row + 2 < terminal->tty.rows; row++) {
        const size_t length = strcspn(at, "\n");
        tty_write(at, length < terminal->tty.columns ? length : terminal->tty.columns);
        tty_write("\r\n", 2);
        at += length + (at[length] != 0);
    }
    return at;
}

/* Answers of several lines (help) are shown over the picture, page by page. */
static void show_long_reply(struct terminal *terminal)
{
    if (!strchr(terminal->reply, '\n')) return;
    for (const char *at = terminal->reply; *at && !is_over(terminal);) {
        at = show_page(terminal, at);
        show_line(terminal, 3, " any key goes on");
        while (!is_over(terminal) && tty_read(0.1) < 0) {}
    }
    terminal->reply[0] = 0;
    clear_screen(terminal);
    terminal->shown = 0;
}

static void take_line(struct terminal *terminal)
{
    char place[32];
    show_line(terminal, 3, "");
    snprintf(place, sizeof place, "\033[%u;1H\033[?25h", terminal->tty.rows);
    tty_write(place, strlen(place));
    terminal->edits = true;
    const char *text = prompt_read(terminal->prompt);
    tty_again(&terminal->tty);
    terminal->edits = false;
    tty_write("\033[?25l", 6);
    clear_screen(terminal);             /* the line feed has moved everything up */
    terminal->shown = 0;
    terminal->reply[0] = 0;
    if (text && *text) command(terminal, text);
    else show_status(terminal);
    show_long_reply(terminal);
}

/* Arrow keys come as ESC [ A to D. */
static void take_escape(struct terminal *terminal)
{
    static const char *const pans[] = {"pan 0 0.1", "pan 0 -0.1", "pan 0.1 0", "pan -0.1 0"};
    if (tty_read(escape_seconds) != '[') return;
    const int letter = tty_read(escape_seconds);
    if (letter >= 'A' && letter <= 'D') command(terminal, pans[letter - 'A']);
}

static void take_key(struct terminal *terminal, int key)
{
    if (key == ':') {
        take_line(terminal);
        return;
    }
    if (key == ESCAPE) {
        take_escape(terminal);
        return;
    }
    for (const struct command_key *k = command_keys; k->name; k++) {
        if (k->key != key) continue;
        command(terminal, loop_status(terminal->loop).running ? k->running : k->resting);
    }
}

static void *work(void *context)
{
    struct terminal *terminal = context;
    terminal->status = loop_status(terminal->loop);
    show_status(terminal);
    while (!is_over(terminal)) {
        look(terminal);
        for (int key; !is_over(terminal) && (key = tty_read(0)) >= 0;) take_key(terminal, key);
    }
    return NULL;
}

/* ---- opening and closing ------------------------------------------------------------------ */

static bool prepare(struct terminal *terminal, struct session *session, struct error *error)
{
    const struct scene *scene = session->base.scene;
    snprintf(terminal->title, sizeof terminal->title, "%s",
             scene->title[0] ? scene->title : scene->name);
    terminal->model = session->sim.model->name;
    terminal->work = session->sim.model->work;
    if (!tty_open(&terminal->tty, error)) return false;
    terminal->prompt = prompt_create(session, look, terminal, error);
    tty_again(&terminal->tty);          /* libedit has made itself at home */
    return terminal->prompt != NULL;
}

struct terminal *terminal_open(struct loop *loop, struct error *error)
{
    struct terminal *terminal = calloc(1, sizeof *terminal);
    if (!terminal) {
        error_set(error, "not enough memory for a terminal");
        return NULL;
    }
    terminal->loop = loop;
    terminal->tty.line = -1;
    pthread_mutex_init(&terminal->lock, NULL);
    if (prepare(terminal, loop_session(loop), error)) {
        terminal->started = pthread_create(&terminal->thread, NULL, work, terminal) == 0;
        if (terminal->started) return terminal;
        error_set(error, "cannot start a thread for the terminal");
    }
    terminal_close(terminal);
    return NULL;
}

void terminal_close(struct terminal *terminal)
{
    if (!terminal) return;
    pthread_mutex_lock(&terminal->lock);
    terminal->over = true;
    pthread_mutex_unlock(&terminal->lock);
    if (terminal->started) pthread_join(terminal->thread, NULL);
    mosaic_destroy(terminal->mosaic);
    prompt_destroy(terminal->prompt);
    tty_close(&terminal->tty);
    pthread_mutex_destroy(&terminal->lock);
    free(terminal);
}

#else

struct terminal *terminal_open(struct loop *loop, struct error *error)
{
    (void)loop;
    error_set_code(error, EXIT_USAGE, "this sandreel was built without its terminal view; install "
                   "libchafa-dev, libglib2.0-dev and libedit-dev and build again, or use --web");
    return NULL;
}

void terminal_close(struct terminal *terminal) { (void)terminal; }

#endif
