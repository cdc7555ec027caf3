/* key.h - the table of scene keys: one row gives parsing, the default, the limits, `help KEY`,
 * and the resolved scene that a run writes.
 *
 * A group (the top level, `box`, an entry of `grains`, `md`, ...) is a C struct and a table of
 * rows that say where each key lives in it.  Models bring their own group (struct model), so the
 * parser knows none of them.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef KEY_H
#define KEY_H

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum key_type {
    KEY_REAL,                   /* double */
    KEY_COUNT,                  /* uint32_t */
    KEY_WORD64,                 /* uint64_t */
    KEY_BOOL,                   /* bool */
    KEY_CHOICE,                 /* int, index into `choices` "a|b|c" */
    KEY_TEXT,                   /* char[KEY_TEXT_MAX] */
    KEY_VECTOR,                 /* double[2], written (x, y) or [x, y] */
    KEY_BOX,                    /* double[4], written [x0, y0, x1, y1] */
    KEY_RANGE,                  /* double[2], written r (both equal) or [low, high] */
    KEY_REALS,                  /* struct key_reals, written [a, b, ...] */
    KEY_POINTS,                 /* struct key_reals with x and y in turn: ((x, y), (x, y), ...) */
    KEY_TEXTS                   /* struct key_texts, written ["a", "b"] */
};

enum { KEY_TEXT_MAX = 256 };

struct key_reals { uint32_t count; double *values; };           /* owned by the scene's arena */
struct key_texts { uint32_t count; char (*texts)[KEY_TEXT_MAX]; };

struct key {
    const char   *name;
    enum key_type type;
    size_t        offset;       /* in the group's struct */
    const char   *fallback;     /* the default as it would be written; NULL: must be given;
                                 * "nan" (real) marks "chosen when absent"; "" for empty lists */
    double        low, high;    /* limits of every number in it, both allowed; NAN: none */
                                /* low = KEY_POSITIVE: greater than zero */
    const char   *unit;         /* "length", "time", "speed", "1", ... for help */
    const char   *choices;      /* KEY_CHOICE, KEY_TEXT: the words, joined by '|'; NULL: any */
    const char   *doc;          /* one sentence */
};

struct key_group {
    const char       *name;     /* "md"; entries of lists are named by their list, "grains" */
    const char       *doc;
    const struct key *keys;
    uint32_t          count;
    size_t            size;     /* sizeof the struct */
};

#define KEY_POSITIVE DBL_MIN

/* "a number", "two numbers (x, y)", ...: how a value of this type is written. */
const char *key_type_word(enum key_type type);

/* "greater than 0", "0 to 1", "one of white, dark": what is allowed; "" if everything is. */
char *key_limits(const struct key *key, char *text, size_t size);

/* The index of `word` in "a|b|c"; -1 if it is not there. */
int key_choice(const char *choices, const char *word);

/* Copies choice number `index` of "a|b|c". */
char *key_choice_word(const char *choices, int index, char *text, size_t size);

const struct key *key_find(const struct key_group *group, const char *name);    /* NULL: none */

/* Insertions, deletions, replacements and swaps of neighbours that turn one word into the other:
 * how the nearest known key is found.  Words of very different length get the most it can be: the
 * length of the longer. */
uint32_t key_distance(const char *a, const char *b);

#endif
