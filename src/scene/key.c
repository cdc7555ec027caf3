/* key.c - see key.h: words about keys, for findings and help.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/key.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *key_type_word(enum key_type type)
{
    static const char *const words[] = {
        [KEY_REAL] = "a number", [KEY_COUNT] = "a whole number, 0 or more",
        [KEY_WORD64] = "a whole number, 0 or more", [KEY_BOOL] = "true or false",
        [KEY_CHOICE] = "a word", [KEY_TEXT] = "a text", [KEY_VECTOR] = "two numbers (x, y)",
        [KEY_BOX] = "four numbers (x0, y0, x1, y1)",
        [KEY_RANGE] = "a number or a range (low, high)",
        [KEY_REALS] = "a list of numbers (a, b, ...)",
        [KEY_POINTS] = "a list of points ((x, y), (x, y), ...)",
        [KEY_TEXTS] = "a list of texts (\"a\", \"b\", ...)",
    };
    return words[type];
}

int key_choice(const char *choices, const char *word)
{
    const size_t length = strlen(word);
    int index = 0;
    for (const char *at = choices; at; index++) {
        if (strncmp(at, word, length) == 0 && (at[length] == '|' || at[length] == 0)) return index;
        at = strchr(at, '|');
        if (at) at++;
    }
    return -1;
}

char *key_choice_word(const char *choices, int index, char *text, size_t size)
{
    const char *at = choices;
    while (at && index-- > 0) {
        at = strchr(at, '|');
        if (at) at++;
    }
    snprintf(text, size, "%.*s", at ? (int)strcspn(at, "|") : 0, at ? at : "");
    return text;
}

char *key_limits(const struct key *key, char *text, size_t size)
{
    if (key->choices) {
        size_t used = (size_t)snprintf(text, size, "one of ");
        for (const char *at = key->choices; *at && used + 3 < size; at++) {
            if (*at == '|') {
                text[used++] = ',';
                text[used++] = ' ';
            } else {
                text[used++] = *at;
            }
        }
        text[used < size ? used : size - 1] = 0;
        return text;
    }
    /* Limits that only keep squares from overflowing are nobody's business. */
    const bool low = fabs(key->low) < 1e30, high = fabs(key->high) < 1e30;
    text[0] = 0;
    if (low && key->low == KEY_POSITIVE) {
        if (high) snprintf(text, size, "greater than 0, at most %.10g", key->high);
        else snprintf(text, size, "greater than 0");
    } else if (low && high) {
        snprintf(text, size, "%.10g to %.10g", key->low, key->high);
    } else if (low) {
        snprintf(text, size, "at least %.10g", key->low);
    } else if (high) {
        snprintf(text, size, "at most %.10g", key->high);
    }
    return text;
}

const struct key *key_find(const struct key_group *group, const char *name)
{
    for (uint32_t k = 0; k < group->count; k++) {
        if (strcmp(group->keys[k].name, name) == 0) return &group->keys[k];
    }
    return NULL;
}

/* Words are compared up to WORD_MAX.  Nobody means one that is shorter or longer by LENGTHS_APART,
 * so that its distance need not be found: a scene of nonsense asks for thousands. */
enum { WORD_MAX = 64, LENGTHS_APART = 8 };

uint32_t key_distance(const char *a, const char *b)
{
    const size_t n = strnlen(a, WORD_MAX), m = strnlen(b, WORD_MAX);
    if (n > m + LENGTHS_APART || m > n + LENGTHS_APART) return (uint32_t)(n > m ? n : m);
    uint32_t rows[3][WORD_MAX + 1];             /* the row before the last, the last, this one */
    uint32_t *before = rows[0], *last = rows[1], *row = rows[2];
    for (size_t j = 0; j <= m; j++) {
        last[j] = (uint32_t)j;
        before[j] = 0;
    }
    for (size_t i = 1; i <= n; i++) {
        row[0] = (uint32_t)i;
        for (size_t j = 1; j <= m; j++) {
            const bool same = a[i - 1] == b[j - 1];
            uint32_t best = last[j - 1] + !same;
            if (last[j] + 1 < best) best = last[j] + 1;
            if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped && before[j - 2] + 1 < best) best = before[j - 2] + 1;
            row[j] = best;
        }
        uint32_t *spare = before;
        before = last;
        last = row;
        row = spare;
    }
    return last[m];
}
