/* override.c - see override.h.
 *
 * The path may pass through groups and lists that are not there yet: a name is added to its
 * group, an index one past the end to its list.  Whether the key is known at all is found when
 * the tree is parsed, with the nearest known key.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scene/override.h"

#include <stdio.h>
#include <string.h>

struct override { const char *text,
                 *file; int line; struct findings *findings; struct arena *arena; };

static void tell(const struct override *o, const char *why)
{
    findings_tell_at(o->findings, FINDING_ERROR, o->file, o->line, "'%s': %s", o->text, why);
}

/* Replaces what `node` holds, keeping its name and its place in the list. */
static void replace(struct tree *node, const struct tree *value)
{
    struct tree kept = *node;
    *node = *value;
    memcpy(node->name, kept.name, sizeof kept.name);
    node->next = kept.next;
}

static struct tree *add(const struct override *o, struct tree *parent, const char *name)
{
    struct tree *node = arena_take(o->arena, 1, sizeof *node);
    if (!node) return NULL;
    node->kind = TREE_GROUP;
    node->file = o->file;
    node->line = o->line;
    memcpy(node->name, name, TREE_NAME_MAX);
    tree_append(parent, node);
    return node;
}

/* A node made on the way becomes what the next step needs; a value in the way is an error. */
static bool fit_kind(const struct override *o, struct tree *node, bool fresh, bool list)
{
    const enum tree_kind wanted = list ? TREE_LIST : TREE_GROUP;
    if (fresh) node->kind = wanted;
    if (node->kind == wanted) return true;
    tell(o, list ? "an index [n] is used where there is no list"
                 : "a name is used where there is no group; entries of lists are written "
                   "list.[0].key");
    return false;
}

/* The child that the step names, made if it is not there. */
static struct tree *descend(const struct override *o, struct tree *node, const char *name,
                            uint32_t index, bool *fresh)
{
    struct tree *child = name[0] ? tree_member(node, name) : tree_entry(node, index);
    *fresh = !child;
    if (child) return child;
    if (!name[0] && index != tree_count(node)) {
        char why[120];
        snprintf(why, sizeof why, "this list has %u entries, so its next one is [%u]",
                 tree_count(node), tree_count(node));
        tell(o, why);
        return NULL;
    }
    char padded[TREE_NAME_MAX] = "";
    snprintf(padded, sizeof padded, "%s", name);
    return add(o, node, padded);
}

/* "grains.restitution" for the only species is as clear as "grains.[0].restitution". */
static struct tree *only_entry(struct tree *node, const char *name)
{
    const bool single = node->kind == TREE_LIST && node->child && !node->child->next;
    return single && name[0] && node->child->kind == TREE_GROUP ? node->child : node;
}

void override_apply(struct tree *root, struct arena *arena, const char *text, const char *file,
                    int line, struct findings *findings)
{
    const struct override o = {text, file, line, findings, arena};
    const char *equals = strchr(text, '=');
    char path[TREE_PATH_MAX], name[TREE_NAME_MAX];
    if (!equals || equals == text || (size_t)(equals - text) >= sizeof path) {
        tell(&o, "this must read KEY=VALUE, for example grains.[0].restitution=0.7");
        return;
    }
    size_t length = (size_t)(equals - text);
    while (length > 0 && text[length - 1] == ' ') length--;
    snprintf(path, sizeof path, "%.*s", (int)length, text);
    const char *at = path;
    struct tree *node = root;
    bool fresh = false;
    uint32_t index = 0;
    while (tree_step(&at, name, &index)) {
        node = only_entry(node, name);
        if (!fit_kind(&o, node, fresh, name[0] == 0)) return;
        node = descend(&o, node, name, index, &fresh);
        if (!node) return;
    }
    if (!at || node == root) {
        tell(&o, "the key is malformed; it must read group.key or list.[0].key");
        return;
    }
    const char *value = equals + 1 + strspn(equals + 1, " ");
    const struct tree *given = tree_value(arena, value, file, line);
    if (given) replace(node, given);
}
