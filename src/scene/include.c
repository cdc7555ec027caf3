/* include.c - see include.h.
 *
 * libconfig ends the whole program where it cannot read what it could open, as a directory, and
 * waits for ever for a pipe that nobody writes to.  So each "@include" is looked at first, by the
 * rules of libconfig's scanner: it counts at the beginning of a line, outside strings and comments.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scene/include.h"

#include "base/file.h"
#include "scene/integers.h"
#include "scene/tree.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* libconfig goes 10 deep; files that include each other many times over would take for ever. */
enum { DEPTH_MAX = 10, INCLUDES_MAX = 1000, SIZE_MAX_INCLUDED = 64 << 20 };

struct includes {
    const char *folder;
    struct findings *findings;
    unsigned count;             /* until now, in all files */
};

/* The quote that opens the name if `at`, the beginning of a line, includes a file; else NULL. */
static const char *opening_quote(const char *at)
{
    static const char word[] = "@include";
    at += strspn(at, " \t");
    if (strncmp(at, word, sizeof word - 1) != 0) return NULL;
    at += sizeof word - 1;
    const size_t gap = strspn(at, " \t");
    return gap > 0 && at[gap] == '"' ? at + gap : NULL;
}

/* The next opening quote of an included name, from `at` on; NULL: no more. */
static const char *next_include(const char *begin, const char *at)
{
    while (*at) {
        const char *quote = at == begin || at[-1] == '\n' ? opening_quote(at) : NULL;
        if (quote) return quote;
        const char *end = tree_quiet_end(at);
        at = end ? end : at + 1;
    }
    return NULL;
}

bool include_used(const char *text)
{
    return next_include(text, text) != NULL;
}

/* The name between the quotes; returns what follows it, NULL if it is none. */
static const char *read_name(const char *quote, char name[FILE_PATH_MAX])
{
    size_t length = 0;
    const char *at = quote + 1;
    for (; *at && *at != '"' && length < FILE_PATH_MAX - 1; at++) {
        if (*at == '\\' && *++at != '\\' && *at != '"') return NULL;
        name[length++] = *at;
    }
    name[length] = 0;
    return *at == '"' && length > 0 ? at + 1 : NULL;
}

static int line_of(const char *begin, const char *at)
{
    int line = 1;
    for (; begin < at; begin++) line += *begin == '\n';
    return line;
}

static bool check_text(struct includes *includes, const char *text, const char *file, int depth);

/* Included files are read as they are, so what would be cut there is refused. */
static bool check_integers(struct includes *includes, const char *text, const char *file)
{
    const char *end, *at = integers_long(text, &end);
    if (!at) return true;
    findings_tell_at(includes->findings, FINDING_ERROR, file, line_of(text, at), "%.*s has more "
                     "than 32 bits, which an included file cannot hold without a mark; write "
                     "%.*sL, or a real number", (int)(end - at), at, (int)(end - at), at);
    return false;
}

/* One included file.  False with a reason. */
static bool check_file(struct includes *includes, const char *name, int depth,
                       char why[static 2 * FILE_PATH_MAX])
{
    char path[2 * FILE_PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", includes->folder, name);
    if (name[0] == '/' && !file_exists(path)) snprintf(path, sizeof path, "%s", name);
    if (!file_exists(path)) return true;
    if (depth > DEPTH_MAX || ++includes->count > INCLUDES_MAX) {
        snprintf(why, 2 * FILE_PATH_MAX, "%s: included too often or too deep; "
                                         "does it include itself?", name);
        return false;
    }
    struct error error;
    size_t size;
    char *text = file_load(path, SIZE_MAX_INCLUDED, &size, &error);
    if (!text) {
        snprintf(why, 2 * FILE_PATH_MAX, "cannot include %s", error.text);
        return false;
    }
    const unsigned errors = includes->findings->errors;
    bool sound = strlen(text) == size;
    if (sound) sound = check_text(includes, text, path, depth + 1)
                    && check_integers(includes, text, path);
    else snprintf(why, 2 * FILE_PATH_MAX, "%s holds zero bytes, so it is no scene file", name);
    if (includes->findings->errors > errors) why[0] = 0;        /* told already */
    free(text);
    return sound;
}

static bool check_text(struct includes *includes, const char *text, const char *file, int depth)
{
    const char *at = text;
    for (const char *quote; (quote = next_include(text, at));) {
        char name[FILE_PATH_MAX], why[2 * FILE_PATH_MAX] = "";
        at = read_name(quote, name);
        if (!at) {
            snprintf(why, sizeof why, "this is no name of a file; "
                                      "write @include \"NAME\", and \\\\ for a \\ in it");
        }
        if (at && check_file(includes, name, depth, why)) continue;
        if (why[0]) {
            findings_tell_at(includes->findings, FINDING_ERROR, file, line_of(text, quote), "%s",
                             why);
        }
        return false;
    }
    return true;
}

bool include_check(const char *text, const char *file, const char *folder,
                   struct findings *findings)
{
    struct includes includes = {.folder = folder, .findings = findings};
    return check_text(&includes, text, file, 1);
}
