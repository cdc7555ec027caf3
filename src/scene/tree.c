/* tree.c - see tree.h.
 *
 * libconfig wants all values in [brackets] to be of one type, so [0, 0.5] would be an error; as
 * (parentheses) it is none.  Brackets outside strings and comments are therefore read as
 * parentheses, which keeps every line where it was.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scene/tree.h"

#include "scene/include.h"
#include "scene/integers.h"

#include <ctype.h>
#include <libconfig.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *text_copy(struct arena *arena, const char *text)
{
    const size_t size = strlen(text) + 1;
    char *copy = arena_take(arena, size, 1);
    if (copy) memcpy(copy, text, size);
    return copy;
}

const char *tree_quiet_end(const char *at)
{
    if (*at == '"') {
        for (at++; *at && *at != '"'; at++) if (*at == '\\' && at[1]) at++;
        return *at ? at + 1 : at;
    }
    if (*at == '#' || (*at == '/' && at[1] == '/')) return at + strcspn(at, "\n");
    if (*at == '/' && at[1] == '*') {
        const char *end = strstr(at + 2, "*/");
        return end ? end + 2 : at + strlen(at);
    }
    return NULL;
}

static void brackets_to_parentheses(char *text)
{
    for (char *at = text; *at;) {
        const char *end = tree_quiet_end(at);
        if (end) {
            at += end - at;
            continue;
        }
        if (*at == '[') *at = '(';
        if (*at == ']') *at = ')';
        at++;
    }
}

static struct tree *node_take(struct arena *arena, const char *file, int line)
{
    struct tree *node = arena_take(arena, 1, sizeof *node);
    if (!node) return NULL;
    node->file = file;
    node->line = line;
    return node;
}

void tree_append(struct tree *parent, struct tree *node)
{
    struct tree **end = &parent->child;
    while (*end) end = &(*end)->next;
    *end = node;
}

static void take_scalar(struct arena *arena, struct tree *node, config_setting_t *setting)
{
    switch (config_setting_type(setting)) {
    case CONFIG_TYPE_INT:
    case CONFIG_TYPE_INT64:
        node->kind = TREE_INTEGER;
        node->integer = config_setting_get_int64(setting);
        node->real = (double)node->integer;
        break;
    case CONFIG_TYPE_FLOAT:
        node->kind = TREE_REAL;
        node->real = config_setting_get_float(setting);
        break;
    case CONFIG_TYPE_BOOL:
        node->kind = TREE_BOOL;
        node->integer = config_setting_get_bool(setting);
        break;
    default:
        node->kind = TREE_TEXT;
        node->text = text_copy(arena, config_setting_get_string(setting));
        break;
    }
}

/* Copies a setting and all below it.  `file` names the text itself; included files name
 * themselves. */
static struct tree *node_copy(struct arena *arena, config_setting_t *setting, const char *file,
                              int line)
{
    const char *included = config_setting_source_file(setting);
    struct tree *node = node_take(arena, included ? text_copy(arena, included) : file,
                                  line ? line : (int)config_setting_source_line(setting));
    if (!node) return NULL;
    const char *name = config_setting_name(setting);
    if (name) snprintf(node->name, sizeof node->name, "%s", name);
    if (!config_setting_is_aggregate(setting)) {
        take_scalar(arena, node, setting);
        return node;
    }
    node->kind = config_setting_is_group(setting) ? TREE_GROUP : TREE_LIST;
    struct tree **end = &node->child;
    const unsigned count = (unsigned)config_setting_length(setting);
    for (unsigned k = 0; k < count; k++) {
        *end = node_copy(arena, config_setting_get_elem(setting, k), file, line);
        if (!*end) return NULL;
        end = &(*end)->next;
    }
    return node;
}

static void tell_syntax(struct findings *findings, const config_t *config, const char *file)
{
    const char *included = config_error_file(config), *why = config_error_text(config);
    const char *cure = "look at this line and the one before: a ';' , a quote or a bracket";
    if (strstr(why, "duplicate")) cure = "a key may be given once in its group; delete one";
    if (strstr(why, "mismatched")) cure = "write (0.0, 0.5) instead of [0, 0.5]";
    if (strstr(why, "include")) cure = "is the file beside this one, and readable?";
    findings_tell_at(findings, FINDING_ERROR, included ? included : file,
                     config_error_line(config), "%s; %s", why, cure);
}

struct tree *tree_read(struct arena *arena, const char *text, const char *file,
                       const char *include_folder, struct findings *findings)
{
    if (!include_check(text, file, include_folder, findings)) return NULL;
    char *copy = integers_marked(text);
    if (!copy) return NULL;
    brackets_to_parentheses(copy);
    config_t config;
    config_init(&config);
    config_set_include_dir(&config, include_folder);
    struct tree *root = NULL;
    if (config_read_string(&config, copy)) {
        root = node_copy(arena, config_root_setting(&config), file, 0);
        if (root) root->line = 0;
    } else {
        tell_syntax(findings, &config, file);
    }
    config_destroy(&config);
    free(copy);
    return root;
}

struct tree *tree_value(struct arena *arena, const char *text, const char *file, int line)
{
    struct tree *node = NULL;
    char *copy = NULL, *marked = integers_marked(text);
    const bool written = marked && asprintf(&copy, "value = %s;", marked) >= 0;
    free(marked);
    if (!written) {
        arena->failed = true;           /* a text in its place would be a lie */
        return NULL;
    }
    brackets_to_parentheses(copy);
    config_t config;
    config_init(&config);
    const bool sound = !include_used(copy) && config_read_string(&config, copy);
    config_setting_t *root = sound ? config_root_setting(&config) : NULL;
    if (root && config_setting_length(root) == 1) {
        node = node_copy(arena, config_setting_get_elem(root, 0), file, line ? line : -1);
        if (node) node->name[0] = 0;
    }
    config_destroy(&config);
    free(copy);
    if (!node) {
        node = node_take(arena, file, line);
        if (!node) return NULL;
        node->kind = TREE_TEXT;
        node->text = text_copy(arena, text);
    }
    node->file = file;
    if (node->kind > TREE_LIST && !node->text) node->text = text_copy(arena, text);
    return node;
}

struct tree *tree_member(const struct tree *group, const char *name)
{
    if (group->kind != TREE_GROUP) return NULL;
    struct tree *child = group->child;
    while (child && strcmp(child->name, name) != 0) child = child->next;
    return child;
}

struct tree *tree_entry(const struct tree *list, uint32_t index)
{
    if (list->kind != TREE_LIST) return NULL;
    struct tree *child = list->child;
    while (child && index-- > 0) child = child->next;
    return child;
}

uint32_t tree_count(const struct tree *list)
{
    uint32_t count = 0;
    for (const struct tree *child = list->child; child; child = child->next) count++;
    return count;
}

bool tree_step(const char **path, char name[TREE_NAME_MAX], uint32_t *index)
{
    const char *at = *path;
    if (!at) return false;
    if (*at == '.') at++;
    if (*at == 0) return false;
    name[0] = 0;
    if (*at == '[') {
        char *end;
        const unsigned long value = strtoul(at + 1, &end, 10);
        const bool sound = isdigit((unsigned char)at[1]) && *end == ']' && value < UINT32_MAX;
        *index = (uint32_t)value;
        *path = sound ? end + 1 : NULL;
        return sound;
    }
    const size_t length = strcspn(at, ".[");
    if (length == 0 || length >= TREE_NAME_MAX) {
        *path = NULL;
        return false;
    }
    memcpy(name, at, length);
    name[length] = 0;
    *path = at + length;
    return true;
}

const struct tree *tree_nearest(const struct tree *root, const char *path)
{
    const struct tree *node = root;
    char name[TREE_NAME_MAX];
    uint32_t index = 0;
    while (tree_step(&path, name, &index)) {
        const struct tree *next = name[0] ? tree_member(node, name) : tree_entry(node, index);
        if (!next) break;
        node = next;
    }
    return node;
}

const char *tree_word(const struct tree *node)
{
    static const char *const words[] = {
        [TREE_GROUP] = "a group { }", [TREE_LIST] = "a list ( )", [TREE_INTEGER] = "a number",
        [TREE_REAL] = "a number", [TREE_BOOL] = "true or false", [TREE_TEXT] = "a text",
    };
    return words[node->kind];
}
