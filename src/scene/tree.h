/* tree.h - a scene file as it was written: groups, lists and values, each with its place.
 *
 * libconfig parses; its result is copied into this tree, because overrides must be able to add
 * and replace any value, and findings need the place of each.  The tree stays with the scene as
 * its record of where every key was given.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef TREE_H
#define TREE_H

#include "base/arena.h"
#include "scene/findings.h"

#include <stdbool.h>
#include <stdint.h>

enum tree_kind { TREE_GROUP, TREE_LIST, TREE_INTEGER, TREE_REAL, TREE_BOOL, TREE_TEXT };

enum { TREE_NAME_MAX = 64, TREE_PATH_MAX = 256 };

struct tree {
    enum tree_kind kind;
    char        name[TREE_NAME_MAX];    /* "" for entries of lists and the root */
    const char *file;           /* as the user named it; "-s" for an override */
    int         line;           /* 0: none */
    int64_t     integer;        /* INTEGER, BOOL */
    double      real;
    const char *text;           /* TEXT; of an override also the words of any other value */
    struct tree *child, *next;  /* first entry; the entry after this one */
};

/* What the scene keeps. */
struct scene_places { struct tree *root; const char *file; };

/* Parses a whole scene text.  NULL after telling a finding (syntax) or if memory is short.
 * `include_folder` is where @include looks. */
struct tree *tree_read(struct arena *arena, const char *text, const char *file,
                       const char *include_folder, struct findings *findings);

/* Where the comment or the string that begins at `at` ends; NULL if neither begins there. */
const char *tree_quiet_end(const char *at);

/* Parses a single value, as after "key ="; what is no libconfig value is taken as a text. */
struct tree *tree_value(struct arena *arena, const char *text, const char *file, int line);

struct tree *tree_member(const struct tree *group, const char *name);   /* NULL: none */
struct tree *tree_entry(const struct tree *list, uint32_t index);       /* NULL: none */
uint32_t     tree_count(const struct tree *list);

/* The node at "grains.[0].restitution", or the nearest one above it that exists. */
const struct tree *tree_nearest(const struct tree *root, const char *path);

/* Takes the first step off a path: a name, or an index (then name is "" and index set).  False at
 * its end; *path is NULL if the path is malformed. */
bool tree_step(const char **path, char name[TREE_NAME_MAX], uint32_t *index);

/* Adds `node` as the last entry of `parent`. */
void tree_append(struct tree *parent, struct tree *node);

/* "a number", "a text", ... for messages. */
const char *tree_word(const struct tree *node);

#endif
