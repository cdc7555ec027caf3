/* overlay_label.c - see overlay_label.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "draw/overlay_label.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_MAX_LENGTH = 40, VALUE_MAX = 300, DECIMALS_MAX = 9 };

static void append(char *out, size_t size, const char *text, size_t length)
{
    const size_t used = strlen(out), room = size - 1 - used;
    memcpy(out + used, text, length < room ? length : room);
    out[used + (length < room ? length : room)] = 0;
}

/* As many decimals as tell two frames apart, the same in every frame of a film. */
static int time_decimals(const struct picture *picture)
{
    const double interval = picture->scene->output.frames;
    if (!(interval > 0)) return -1;
    for (int decimals = 0; decimals < DECIMALS_MAX; decimals++) {
        const double scaled = interval * pow(10, decimals);
        if (scaled > 0.999 && fabs(scaled - round(scaled)) < 1e-6 * scaled) return decimals;
        if (scaled >= 100) return decimals;
    }
    return DECIMALS_MAX;
}

static void time_text(const struct picture *picture, char value[VALUE_MAX])
{
    const int decimals = time_decimals(picture);
    if (decimals < 0) snprintf(value, VALUE_MAX, "%.4g", picture->time);
    else snprintf(value, VALUE_MAX, "%.*f", decimals, picture->time);
}

static bool find_value(const struct picture *picture, const char *name, char value[VALUE_MAX])
{
    static const char *const units[] = {"reduced", "si", "cgs"};
    const struct scene *scene = picture->scene;
    for (uint32_t k = 0; k < picture->variable_count; k++) {
        if (strcmp(picture->variables[k].name, name) != 0) continue;
        snprintf(value, VALUE_MAX, "%s", picture->variables[k].text);
        return true;
    }
    if (strcmp(name, "t") == 0) time_text(picture, value);
    else if (strcmp(name, "n") == 0) {
        snprintf(value, VALUE_MAX, "%u", picture->grains ? picture->grains->count : 0);
    } else if (strcmp(name, "title") == 0) snprintf(value, VALUE_MAX, "%s", scene->title);
    else if (strcmp(name, "model") == 0) snprintf(value, VALUE_MAX, "%s", scene->model);
    else if (strcmp(name, "units") == 0) snprintf(value, VALUE_MAX, "%s", units[scene->units]);
    else if (strcmp(name, "time_unit") == 0) {
        snprintf(value, VALUE_MAX, "%s", scene_unit(scene, "time"));
    } else return false;
    return true;
}

/* Formats a number by ".3f" and the like; anything else is refused. */
static bool format_number(const struct picture *picture, const char *name, const char *format,
                          char value[VALUE_MAX])
{
    char *end;
    const char *at = format;
    if (*at != '.' || !isdigit((unsigned char)at[1])) return false;
    const long digits = strtol(at + 1, &end, 10);
    if (digits > 17 || !strchr("feg", *end) || *end == 0 || end[1] != 0) return false;
    double number = picture->time;
    if (strcmp(name, "t") != 0) {
        char *rest;
        number = strtod(value, &rest);
        if (rest == value || *rest) return false;
    }
    const int precision = (int)digits;
    if (*end == 'f') snprintf(value, VALUE_MAX, "%.*f", precision, number);
    else if (*end == 'e') snprintf(value, VALUE_MAX, "%.*e", precision, number);
    else snprintf(value, VALUE_MAX, "%.*g", precision, number);
    return true;
}

/* Takes "{name}" or "{name:format}" at `text`; its length, or 0 if it is nothing known. */
static size_t take_variable(const struct picture *picture, const char *text, char value[VALUE_MAX])
{
    const char *close = strchr(text, '}');
    if (!close || close - text - 1 >= NAME_MAX_LENGTH) return 0;
    char name[NAME_MAX_LENGTH];
    snprintf(name, sizeof name, "%.*s", (int)(close - text - 1), text + 1);
    char *format = strchr(name, ':');
    if (format) *format++ = 0;
    if (!find_value(picture, name, value)) return 0;
    if (format && !format_number(picture, name, format, value)) return 0;
    return (size_t)(close - text) + 1;
}

/* Variables may be empty ("t = 3 {time_unit}" in reduced units): no blanks are left at the end. */
static void trim(char *out)
{
    size_t length = strlen(out);
    while (length > 0 && out[length - 1] == ' ') out[--length] = 0;
}

void overlay_label(const struct picture *picture, const char *text, char *out, size_t size)
{
    out[0] = 0;
    while (*text) {
        char value[VALUE_MAX];
        size_t taken = 0;
        if (text[0] == '{' && text[1] == '{') {
            append(out, size, text, 1);
            text += 2;
            continue;
        }
        if (*text == '{') taken = take_variable(picture, text, value);
        if (taken > 0) append(out, size, value, strlen(value));
        else append(out, size, text, taken = 1);
        text += taken;
    }
    trim(out);
}

/* Raises the digit behind every ^, and replaces blanks unless `blank` is one itself. */
static void raise_digits(const char *text, const char *blank, char *out, size_t size)
{
    static const char *const raised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074"};
    out[0] = 0;
    for (; *text; text++) {
        if (*text == '^' && text[1] >= '0' && text[1] <= '4') {
            text++;
            append(out, size, raised[*text - '0'], strlen(raised[*text - '0']));
        } else if (*text == ' ') append(out, size, blank, strlen(blank));
        else append(out, size, text, 1);
    }
}

void overlay_label_unit(const char *unit, char *out, size_t size)
{
    raise_digits(unit, "\u00b7", out, size);
}

void overlay_label_raise(const char *text, char *out, size_t size)
{
    raise_digits(text, " ", out, size);
}
