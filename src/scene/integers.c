/* integers.c - see integers.h.
 *
 * libconfig keeps an integer in 32 bits unless an L follows it, and cuts what is longer without a
 * word: 100000000000 would be 1215752192.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scene/integers.h"

#include "scene/tree.h"

#include <ctype.h>
#include <errno.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char decimal[] = "0123456789", hexadecimal[] = "0123456789abcdefABCDEF";

static bool is_hexadecimal(const char *at)
{
    return at[0] == '0' && (at[1] == 'x' || at[1] == 'X');
}

/* Behind a word or a real number that begins at `at`, as far as its characters go. */
static const char *skip_word(const char *at)
{
    while (isalnum((unsigned char)*at) || *at == '_' || *at == '.') at++;
    return at;
}

const char *integers_long(const char *at, const char **end)
{
    while (*at) {
        const char *quiet = tree_quiet_end(at);
        if (quiet) {
            at = quiet;
            continue;
        }
        if (!isalnum((unsigned char)*at) && *at != '_' && *at != '.') {
            at++;
            continue;
        }
        const char *first = at;
        const bool hex = is_hexadecimal(first);
        const char *last = hex ? first + 2 + strspn(first + 2, hexadecimal)
                               : first + strspn(first, decimal);
        at = skip_word(first);
        if (last == first || last != at) continue;      /* a name, a real number, or marked */
        errno = 0;
        const unsigned long long value = strtoull(first, NULL, hex ? 16 : 10);
        if (errno == 0 && value <= INT32_MAX) continue;
        *end = last;
        return first;
    }
    return NULL;
}

char *integers_marked(const char *text)
{
    const char *end = text, *from = text;
    size_t count = 0;
    for (const char *at = text; (at = integers_long(at, &end)); at = end) count++;
    char *copy = malloc(strlen(text) + 2 * count + 1), *to = copy;
    if (!copy) return NULL;
    for (const char *at = text; (at = integers_long(at, &end)); at = from = end) {
        memcpy(to, from, (size_t)(end - from));
        to += end - from;
        errno = 0;
        strtoll(at, NULL, is_hexadecimal(at) ? 16 : 10);
        const bool real = errno == ERANGE;      /* a hexadecimal one is none, and refused so */
        memcpy(to, real ? ".0" : "L", real ? 2 : 1);
        to += real ? 2 : 1;
    }
    strcpy(to, from);
    return copy;
}
