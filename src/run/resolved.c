/* resolved.c - see resolved.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/resolved.h"

#include "base/archive.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { NAME_MAX_BYTES = 160, SHOWN_MAX = 48 };

/* What a run that goes on may have otherwise: its end, and the room for the grains that come until
 * then.  A key is followed by a blank in the text and by nothing as a name. */
static bool may_differ(const char *key)
{
    static const char *const free_keys[] = {"until", "count_max"};
    bool found = false;
    for (size_t k = 0; k < sizeof free_keys / sizeof *free_keys; k++) {
        const size_t length = strlen(free_keys[k]);
        found = found || (strncmp(key, free_keys[k], length) == 0
                          && (key[length] == ' ' || key[length] == 0));
    }
    return found;
}

uint64_t resolved_hash(const char *text)
{
    uint64_t hash = ARCHIVE_HASH_START;
    while (*text) {
        const size_t length = strcspn(text, "\n"), indent = strspn(text, " ");
        if (text[indent] != '#' && !may_differ(text)) hash = archive_hash(hash, text, length);
        text += length + (text[length] == '\n');
    }
    return hash;
}

/* A walk over the lines of a resolved scene that knows in which group and entry it is. */
struct walk {
    const char *at;
    char     group[64];         /* "" at the top level */
    bool     list;
    unsigned entry;
    char     name[NAME_MAX_BYTES];      /* of the key just met: "grains.[0].radius" */
    const char *value;
    size_t   length;
};

static void enter_group(struct walk *walk, const char *line, size_t length, size_t name)
{
    snprintf(walk->group, sizeof walk->group, "%.*s", (int)name, line);
    walk->list = line[length - 1] == '(';
    walk->entry = 0;
}

/* Goes on to the next key; false at the end. */
static bool walk_on(struct walk *walk)
{
    while (*walk->at) {
        const char *line = walk->at;
        size_t length = strcspn(line, "\n");
        walk->at += length + (line[length] == '\n');
        const size_t indent = strspn(line, " ");
        line += indent;
        length -= indent < length ? indent : length;
        const char *sign = length > 0 ? memchr(line, '=', length) : NULL;
        const char last = length > 0 ? line[length - 1] : 0;
        if (length == 0 || *line == '#') continue;
        if (indent == 0 && (*line == '}' || *line == ')')) walk->group[0] = 0;
        else if (indent > 0 && *line == '}') walk->entry++;
        if (!sign || sign == line) continue;
        const size_t name = (size_t)(sign - line) - (sign[-1] == ' ');
        if (indent == 0 && (last == '{' || last == '(')) {
            enter_group(walk, line, length, name);
            continue;
        }
        char place[100] = "";
        if (walk->list) snprintf(place, sizeof place, "%s.[%u].", walk->group, walk->entry);
        else if (walk->group[0]) snprintf(place, sizeof place, "%s.", walk->group);
        snprintf(walk->name, sizeof walk->name, "%s%.*s", walk->group[0] ? place : "",
                 (int)(name < 60 ? name : 60), line);
        walk->value = sign + 1 + strspn(sign + 1, " ");
        walk->length = (size_t)(line + length - walk->value) - (last == ';');
        return true;
    }
    return false;
}

/* Finds the key of this name; true with its value in `walk`. */
static bool find(struct walk *walk, const char *text, const char *name)
{
    *walk = (struct walk){.at = text};
    while (walk_on(walk)) if (strcmp(walk->name, name) == 0) return true;
    return false;
}

static void add(char *text, size_t size, const char *name, const struct walk *there,
                const struct walk *here)
{
    static const struct walk absent = {.value = "absent", .length = 6};
    if (!there) there = &absent;
    if (!here) here = &absent;
    char piece[NAME_MAX_BYTES + 2 * SHOWN_MAX + 32];
    snprintf(piece, sizeof piece, "%s%s: %.*s there, %.*s here", *text ? "; " : "", name,
             (int)(there->length < SHOWN_MAX ? there->length : SHOWN_MAX), there->value,
             (int)(here->length < SHOWN_MAX ? here->length : SHOWN_MAX), here->value);
    const size_t used = strlen(text);
    if (used + strlen(piece) < size) memcpy(text + used, piece, strlen(piece) + 1);
}

char *resolved_difference(const char *there, const char *here, char *text, size_t size)
{
    struct walk walk = {.at = there}, other;
    text[0] = 0;
    while (walk_on(&walk)) {
        if (may_differ(walk.name)) continue;
        const bool found = find(&other, here, walk.name);
        const bool same = found && other.length == walk.length
                       && memcmp(other.value, walk.value, walk.length) == 0;
        if (!same) add(text, size, walk.name, &walk, found ? &other : NULL);
    }
    walk = (struct walk){.at = here};
    while (walk_on(&walk)) {
        const bool counts = !may_differ(walk.name);
        if (counts && !find(&other, there, walk.name)) add(text, size, walk.name, NULL, &walk);
    }
    return text;
}
