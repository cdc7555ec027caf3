/* command.c - see command.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/command.h"

#include "scene/key.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct command_row command_table[COMMAND_COUNT] = {
#define X(name, arguments, kind, doc) {#name, arguments, COMMAND_##kind, doc},
    COMMANDS(X)
#undef X
};

const struct command_key command_keys[] = {
#define X(key, name, running, resting, doc) {key, name, running, resting, doc},
    COMMAND_KEYS(X)
#undef X
    {0}
};

/* Beyond this, squares of numbers overflow. */
static const double number_max = 1e30;

enum { TOKEN_MAX = 32 };

enum command_verb command_find(const char *name)
{
    for (int verb = 0; verb < COMMAND_COUNT; verb++) {
        if (strcmp(command_table[verb].name, name) == 0) return (enum command_verb)verb;
    }
    return COMMAND_COUNT;
}

char *command_usage(enum command_verb verb, char *text, size_t size)
{
    const struct command_row *row = &command_table[verb];
    const char *arguments = row->arguments;
    const bool bare = arguments[0] == '|';      /* the first form has no arguments */
    snprintf(text, size, "%s%s%s%s", row->name, *arguments ? " " : "",
             bare ? "[" : "", bare ? arguments + 2 : arguments);
    if (bare && strlen(text) + 1 < size) strcat(text, "]");
    return text;
}

static bool is_one_of(const char *token, const char *words)
{
    return key_choice(words, token) >= 0;
}

static const char *skip_space(const char *at)
{
    return at + strspn(at, " ");
}

/* Copies the word at *at, up to a space (or an equals sign after a KEY), and passes it. */
static bool take_word(const char **at, const char *stops, char *word, size_t size)
{
    const size_t length = strcspn(*at, stops);
    if (length == 0 || length >= size) return false;
    memcpy(word, *at, length);
    word[length] = 0;
    *at += length;
    return true;
}

static bool take_number(const char **at, struct command_line *line)
{
    char word[TOKEN_MAX + 1], *end;
    if (line->number_count == COMMAND_NUMBERS || !take_word(at, " ", word, sizeof word)) {
        return false;
    }
    const double value = strtod(word, &end);
    if (*end || !(fabs(value) <= number_max)) return false;
    line->numbers[line->number_count++] = value;
    return true;
}

/* One argument of a form; passes it in the text. */
static bool take_argument(const char *token, const char **at, struct command_line *line)
{
    if (islower((unsigned char)token[0])) {
        return take_word(at, " ", line->literal, sizeof line->literal)
            && strcmp(line->literal, token) == 0;
    }
    if (is_one_of(token, "VALUE|EXPR")) {
        if (**at == '=' && strcmp(token, "VALUE") == 0) *at = skip_space(*at + 1);
        snprintf(line->rest, sizeof line->rest, "%s", *at);
        *at += strlen(*at);
        return line->rest[0] != 0;
    }
    if (is_one_of(token, "KEY|WHAT|FIELD|FILE|COMMAND")) {
        const char *stops = strcmp(token, "KEY") == 0 ? " =" : " ";
        return take_word(at, stops, line->word, sizeof line->word);
    }
    return take_number(at, line);
}

/* Does the text after the name fit this form, from `form` up to '|' or the end? */
static bool fits(const char *form, const char *text, struct command_line *line)
{
    const enum command_verb verb = line->verb;
    *line = (struct command_line){.verb = verb};
    const char *at = skip_space(text);
    for (form = skip_space(form); *form && *form != '|'; form = skip_space(form)) {
        char token[TOKEN_MAX];
        if (!take_word(&form, " |", token, sizeof token)) return false;
        if (!take_argument(token, &at, line)) return false;
        at = skip_space(at);
    }
    return *at == 0;
}

static bool parse_arguments(const char *text, struct command_line *line, struct error *error)
{
    const char *form = command_table[line->verb].arguments;
    for (;;) {
        if (fits(form, text, line)) return true;
        form = strchr(form, '|');
        if (!form) break;
        form++;
    }
    char usage[200];
    return error_set_code(error, EXIT_USAGE, "'%.60s' is not how %s is written; it reads: %s",
                          skip_space(text), command_table[line->verb].name,
                          command_usage(line->verb, usage, sizeof usage));
}

static bool unknown(const char *name, struct error *error)
{
    const char *nearest = NULL;
    uint32_t least = 3;         /* more slips than two are another word */
    for (int verb = 0; verb < COMMAND_COUNT; verb++) {
        const uint32_t distance = key_distance(name, command_table[verb].name);
        if (distance >= least) continue;
        least = distance;
        nearest = command_table[verb].name;
    }
    return error_set_code(error, EXIT_USAGE, "there is no command '%.40s'; %s%s%s", name,
                          nearest ? "did you mean '" : "`help` lists them",
                          nearest ? nearest : "", nearest ? "'?" : "");
}

bool command_parse(const char *text, struct command_line *line, struct error *error)
{
    *line = (struct command_line){.verb = COMMAND_NONE};
    char trimmed[COMMAND_LINE_MAX], name[COMMAND_WORD_MAX];
    text = skip_space(text);
    size_t length = strnlen(text, sizeof trimmed);
    if (length == sizeof trimmed) {
        return error_set_code(error, EXIT_USAGE, "a command has at most %d bytes",
                              COMMAND_LINE_MAX - 1);
    }
    for (size_t k = 0; k < length; k++) {
        if (!iscntrl((unsigned char)text[k])) continue;
        return error_set_code(error, EXIT_USAGE, "a command is one line without control "
                              "characters, and byte %zu is 0x%02x", k,
                              (unsigned)(unsigned char)text[k]);
    }
    while (length > 0 && text[length - 1] == ' ') length--;
    memcpy(trimmed, text, length);
    trimmed[length] = 0;
    if (length == 0 || trimmed[0] == '#') return true;
    const char *at = trimmed;
    if (!take_word(&at, " ", name, sizeof name)) return unknown(trimmed, error);
    line->verb = command_find(name);
    if (line->verb == COMMAND_COUNT) {
        line->verb = COMMAND_NONE;
        return unknown(name, error);
    }
    return parse_arguments(at, line, error);
}
