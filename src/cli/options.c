/* options.c - see options.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/options.h"

#include "base/text.h"
#include "scene/key.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct option_row options_table[OPTION_COUNT] = {
#define X(id, name, letter, value, key, form, doc) {name, letter, value, key, form, doc},
    OPTIONS(X)
#undef X
};

bool options_given(const struct options *options, enum option_id id)
{
    return options->values[id] != NULL;
}

const char *options_nearest(const char *word, const char *const *words)
{
    const char *nearest = NULL;
    uint32_t least = (uint32_t)strlen(word) / 3 + 2;    /* more edits than that: another word */
    for (; *words; words++) {
        const uint32_t distance = key_distance(word, *words);
        if (distance < least) {
            least = distance;
            nearest = *words;
        }
    }
    return nearest;
}

static bool accepts(const struct command *command, int id)
{
    for (const uint8_t *at = command->accepts; *at != OPTION_COUNT; at++) {
        if (*at == id) return true;
    }
    return false;
}

static bool refuse(const struct command *command, const char *word, struct error *error)
{
    const char *names[OPTION_COUNT + 1];
    size_t count = 0;
    for (const uint8_t *at = command->accepts; *at != OPTION_COUNT; at++) {
        names[count++] = options_table[*at].name;
    }
    names[count] = NULL;
    const char *nearest = word[1] == '-' ? options_nearest(word + 2, names) : NULL;
    if (nearest) {
        return error_set_code(error, EXIT_USAGE, "%s: unknown option '%s'; did you mean '--%s'?",
                              command->name, word, nearest);
    }
    return error_set_code(error, EXIT_USAGE, "%s: unknown option '%s'; `sandreel help %s` lists "
                          "its options", command->name, word, command->name);
}

static int find_long(const struct command *command, const char *name, size_t length)
{
    for (int id = 0; id < OPTION_COUNT; id++) {
        const char *known = options_table[id].name;
        if (accepts(command, id) && strlen(known) == length && memcmp(known, name, length) == 0) {
            return id;
        }
    }
    return -1;
}

static int find_letter(const struct command *command, char letter)
{
    for (int id = 0; id < OPTION_COUNT; id++) {
        if (letter && options_table[id].letter == letter && accepts(command, id)) return id;
    }
    return -1;
}

/* A text in quotes, as libconfig reads it. */
static void write_text(FILE *out, const char *text, size_t length)
{
    fputc('"', out);
    for (size_t k = 0; k < length; k++) {
        if (text[k] == '"' || text[k] == '\\') fputc('\\', out);
        fputc(text[k], out);
    }
    fputc('"', out);
}

/* "KEY=VALUE" for an option that sets a key; malloc'ed, NULL without memory. */
static char *make_override(const struct option_row *row, const char *value)
{
    struct text text;
    if (!text_begin(&text)) return text_end(&text, NULL);
    FILE *out = text.stream;
    fprintf(out, "%s=", row->key);
    switch (row->form) {
    case FORM_PLAIN: fputs(value, out); break;
    case FORM_ON: fputs("true", out); break;
    case FORM_OPTIONAL: break;
    case FORM_WORD: write_text(out, value, strlen(value)); break;
    case FORM_LIST: fprintf(out, "(%s)", value); break;
    case FORM_SIZE: {
        const char *mark = strpbrk(value, "xX");
        if (mark) fprintf(out, "(%.*s, %s)", (int)(mark - value), value, mark + 1);
        else fprintf(out, "(%s)", value);
        break;
    }
    case FORM_WORDS:
        fputc('[', out);
        for (const char *at = value; *at;) {
            const size_t length = strcspn(at, ",");
            if (at != value) fputs(", ", out);
            write_text(out, at, length);
            at += length + (at[length] == ',');
        }
        fputc(']', out);
        break;
    }
    return text_end(&text, NULL);
}

static bool add_override(struct options *options, const char *text, struct error *error)
{
    if (options->override_count == OPTIONS_OVERRIDES_MAX) {
        return error_set_code(error, EXIT_USAGE, "more than %d keys set on the command line; put "
                              "them into a scene file", OPTIONS_OVERRIDES_MAX);
    }
    options->overrides[options->override_count++] = text;
    return true;
}

static bool take(struct options *options, int id, const char *value, struct error *error)
{
    const struct option_row *row = &options_table[id];
    options->values[id] = value;
    if (id == OPTION_set) {
        if (strchr(value, '=')) return add_override(options, value, error);
        return error_set_code(error, EXIT_USAGE, "-s %s: needs KEY=VALUE", value);
    }
    if (id == OPTION_vary) {
        if (options->vary_count == OPTIONS_VARIES_MAX) {
            return error_set_code(error, EXIT_USAGE, "more than %d keys varied",
                                  OPTIONS_VARIES_MAX);
        }
        options->varies[options->vary_count++] = value;
        return true;
    }
    /* Several models are the caller's to go through. */
    if (!row->key || (id == OPTION_model && strchr(value, ','))) return true;
    char *text = make_override(row, value);
    if (!text) return error_set(error, "not enough memory for the options");
    if (options->owned_count < OPTIONS_OVERRIDES_MAX) options->owned[options->owned_count++] = text;
    return add_override(options, text, error);
}

/* One word that begins with '-'; may also use up the next one. */
static bool parse_option(struct options *options, char **arguments, int *at, int count,
                         struct error *error)
{
    const struct command *command = options->command;
    const char *word = arguments[*at], *value = NULL;
    int id;
    if (word[1] == '-') {
        const size_t length = strcspn(word + 2, "=");
        id = find_long(command, word + 2, length);
        if (word[2 + length] == '=') value = word + 3 + length;
    } else {
        id = find_letter(command, word[1]);
        if (word[2]) value = word + 2;
    }
    if (id < 0) return refuse(command, word, error);
    const struct option_row *row = &options_table[id];
    if (!row->value) {
        if (!value) return take(options, id, "", error);
        return error_set_code(error, EXIT_USAGE, "--%s takes no value", row->name);
    }
    if (!value && row->form == FORM_OPTIONAL) return take(options, id, "", error);
    if (!value && *at + 1 < count) value = arguments[++*at];
    if (!value) {
        return error_set_code(error, EXIT_USAGE, "--%s needs a value: --%s %s", row->name,
                              row->name, row->value);
    }
    return take(options, id, value, error);
}

bool options_parse(struct options *options, const struct command *command, int count,
                   char **arguments, struct error *error)
{
    *options = (struct options){.command = command};
    bool only_operands = false;
    for (int at = 0; at < count; at++) {
        const char *word = arguments[at];
        if (!only_operands && strcmp(word, "--") == 0) {
            only_operands = true;
        } else if (!only_operands && word[0] == '-' && word[1]) {
            if (!parse_option(options, arguments, &at, count, error)) return false;
        } else if (options->operand_count < OPTIONS_OPERANDS_MAX) {
            options->operands[options->operand_count++] = word;
        }
    }
    if (options_given(options, OPTION_help)) return true;
    if (options->operand_count < command->operands_min) {
        return error_set_code(error, EXIT_USAGE, "%s needs %s; `sandreel help %s` explains it",
                              command->name, command->operands, command->name);
    }
    if (options->operand_count > command->operands_max) {
        return error_set_code(error, EXIT_USAGE, "%s: '%s' is one word too many; `sandreel help "
            "%s` explains the command", command->name, options->operands[command->operands_max],
            command->name);
    }
    return true;
}

void options_free(struct options *options)
{
    for (uint32_t k = 0; k < options->owned_count; k++) free(options->owned[k]);
    options->owned_count = options->override_count = 0;
}

bool options_real(const struct options *options, enum option_id id, double fallback, double *value,
                  struct error *error)
{
    *value = fallback;
    const char *text = options->values[id];
    if (!text) return true;
    char *end;
    *value = strtod(text, &end);
    if (end != text && *end == 0 && isfinite(*value)) return true;
    return error_set_code(error, EXIT_USAGE, "--%s %s: not a number", options_table[id].name, text);
}

bool options_whole(const struct options *options, enum option_id id, uint64_t fallback,
                   uint64_t *value, struct error *error)
{
    *value = fallback;
    const char *text = options->values[id];
    if (!text) return true;
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    if (isdigit((unsigned char)*text) && *end == 0 && errno == 0) return true;
    return error_set_code(error, EXIT_USAGE, "--%s %s: not a whole number", options_table[id].name,
                          text);
}

bool options_pair(const struct options *options, enum option_id id, char mark, double pair[2],
                  struct error *error)
{
    const char *text = options->values[id];
    assert(text);
    char *end;
    pair[0] = strtod(text, &end);
    if (end != text && *end == mark) {
        const char *second = end + 1;
        pair[1] = strtod(second, &end);
        if (end != second && *end == 0 && isfinite(pair[0]) && isfinite(pair[1])) return true;
    }
    return error_set_code(error, EXIT_USAGE, "--%s %s: needs two numbers, %s",
                          options_table[id].name, text, options_table[id].value);
}
