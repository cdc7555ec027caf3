/* prompt.c - see prompt.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/prompt.h"

#ifdef SANDREEL_TERMINAL

#include "live/command.h"
#include "live/tty.h"
#include "scene/scene_value.h"

#include <histedit.h>
#include <stdlib.h>
#include <string.h>

enum { HISTORY_LINES = 500, TEXT_MAX = COMMAND_LINE_MAX };

static const double idle_seconds = 0.02;        /* between two looks at the keyboard */

struct prompt {
    EditLine *editor;
    History  *history;
    struct timeline_texts keys;         /* paths of all keys */
    bool   (*between)(void *context);
    void    *context;
    bool     given_up;
    char     line[TEXT_MAX];
};

/* ---- completion --------------------------------------------------------------------------- */

struct completion { const char *start; size_t length; unsigned count; char *more; size_t size; };

/* Counts a word that begins as typed, and keeps what all of them go on with. */
static void offer(struct completion *c, const char *word)
{
    if (strncmp(word, c->start, c->length) != 0) return;
    const char *rest = word + c->length;
    if (c->count++ == 0) {
        snprintf(c->more, c->size, "%s", rest);
        return;
    }
    size_t same = 0;
    while (c->more[same] && c->more[same] == rest[same]) same++;
    c->more[same] = 0;
}

static void offer_choices(struct completion *c, const char *choices)
{
    while (choices && *choices) {
        char word[KEY_TEXT_MAX];
        const size_t length = strcspn(choices, "|");
        snprintf(word, sizeof word, "%.*s", (int)length, choices);
        offer(c, word);
        choices += length + (choices[length] == '|');
    }
}

static void offer_colors(struct completion *c)
{
    for (uint32_t g = 0; scene_key_group(g); g++) {
        if (strcmp(scene_key_group(g)->name, "view") != 0) continue;
        offer_choices(c, key_find(scene_key_group(g), "color")->choices);
    }
}

static void offer_maps(struct completion *c)
{
    offer(c, "none");
#define X(name, components, dimension, label) offer(c, #name);
    MAPS(X)
#undef X
}

/* What `get` and `expect` know besides keys (teller.c). */
static void offer_totals(struct completion *c)
{
    offer(c, "time");
    offer(c, "energy");
#define X(total, ...) offer(c, #total);
    COUNTERS(X)
    QUANTITIES(X)
#undef X
}

static void offer_commands(struct completion *c)
{
    for (int verb = 0; verb < COMMAND_COUNT; verb++) offer(c, command_table[verb].name);
}

unsigned prompt_complete(const struct prompt *prompt, const char *text, char *more, size_t size)
{
    const char *space = strrchr(text, ' ');
    const char *start = space ? space + 1 : text;
    struct completion c = {start, strlen(start), 0, more, size};
    char verb[COMMAND_WORD_MAX];
    more[0] = 0;
    snprintf(verb, sizeof verb, "%.*s", (int)strcspn(text, " "), text);
    const bool second = space && strchr(text, ' ') == space;
    if (!space) offer_commands(&c);
    if (!second) return c.count;
    switch (command_find(verb)) {
    case COMMAND_get:
        offer_totals(&c);
        __attribute__((fallthrough));
    case COMMAND_set:
        for (uint32_t k = 0; k < prompt->keys.count; k++) offer(&c, prompt->keys.texts[k]);
        break;
    case COMMAND_expect: offer_totals(&c); break;
    case COMMAND_color: offer_colors(&c); break;
    case COMMAND_map:   offer_maps(&c); break;
    case COMMAND_help:  offer_commands(&c); break;
    case COMMAND_gate:  offer_choices(&c, "open|close"); break;
    default: break;
    }
    return c.count;
}

static unsigned char complete(EditLine *editor, int key)
{
    struct prompt *prompt;
    char text[TEXT_MAX], more[KEY_TEXT_MAX + 2];
    (void)key;
    el_get(editor, EL_CLIENTDATA, &prompt);
    const LineInfo *line = el_line(editor);
    snprintf(text, sizeof text, "%.*s", (int)(line->cursor - line->buffer), line->buffer);
    const unsigned count = prompt_complete(prompt, text, more, sizeof more - 1);
    if (count == 1) strcat(more, " ");
    if (!more[0] || el_insertstr(editor, more) != 0) return CC_ERROR;
    return CC_REFRESH;
}

/* ---- the line ----------------------------------------------------------------------------- */

static char *show_prompt(EditLine *editor)
{
    static char text[] = ":";
    (void)editor;
    return text;
}

/* libedit's source of characters: Ctrl-C and Ctrl-D give the line up. */
static int next_character(EditLine *editor, wchar_t *character)
{
    struct prompt *prompt;
    int byte;
    el_get(editor, EL_CLIENTDATA, &prompt);
    while ((byte = tty_read(idle_seconds)) < 0 && prompt->between(prompt->context)) {}
    if (byte == 3 || byte == 4 || byte < 0) {
        prompt->given_up = true;
        byte = '\n';
    }
    *character = byte == '\r' ? L'\n' : (wchar_t)byte;
    return 1;
}

static void add_key(void *context, const char *path, const struct key *key, const void *value)
{
    struct timeline_texts *keys = context;
    (void)key, (void)value;
    timeline_put(keys, path, NULL);
}

struct prompt *prompt_create(const struct session *session, bool (*between)(void *context),
                             void *context, struct error *error)
{
    HistEvent event;
    struct prompt *prompt = calloc(1, sizeof *prompt);
    if (!prompt) {
        error_set(error, "not enough memory for a line of commands");
        return NULL;
    }
    prompt->between = between;
    prompt->context = context;
    scene_value_each(session_scene(session), add_key, &prompt->keys);
    prompt->history = history_init();
    prompt->editor = el_init("sandreel", stdin, stdout, stderr);
    if (!prompt->history || !prompt->editor) {
        error_set(error, "the line of commands cannot be edited on this terminal");
        prompt_destroy(prompt);
        return NULL;
    }
    history(prompt->history, &event, H_SETSIZE, HISTORY_LINES);
    history(prompt->history, &event, H_SETUNIQUE, 1);
    el_set(prompt->editor, EL_CLIENTDATA, prompt);
    el_set(prompt->editor, EL_PROMPT, show_prompt);
    el_set(prompt->editor, EL_EDITOR, "emacs");
    el_set(prompt->editor, EL_SIGNAL, 0);
    el_set(prompt->editor, EL_HIST, history, prompt->history);
    el_set(prompt->editor, EL_GETCFN, next_character);
    el_set(prompt->editor, EL_ADDFN, "complete", "goes on with the word", complete);
    el_set(prompt->editor, EL_BIND, "^I", "complete", NULL);
    return prompt;
}

void prompt_destroy(struct prompt *prompt)
{
    if (!prompt) return;
    if (prompt->editor) el_end(prompt->editor);
    if (prompt->history) history_end(prompt->history);
    timeline_free_texts(&prompt->keys);
    free(prompt);
}

const char *prompt_read(struct prompt *prompt)
{
    int count;
    HistEvent event;
    prompt->given_up = false;
    const char *text = el_gets(prompt->editor, &count);
    if (!text || count <= 0 || prompt->given_up) return NULL;
    snprintf(prompt->line, sizeof prompt->line, "%.*s", (int)strcspn(text, "\n"), text);
    if (prompt->line[0]) history(prompt->history, &event, H_ENTER, prompt->line);
    return prompt->line;
}

#endif
