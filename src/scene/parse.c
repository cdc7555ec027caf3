/* parse.c - see parse.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/parse.h"

#include "scene/scene_key.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct parse {
    struct scene    *scene;
    struct findings *findings;
    struct arena    *arena;
};

/* ---- defaults ------------------------------------------------------------------------------ */

/* Reads up to `count` numbers out of "(0, inf)" or "1"; a single one fills all. */
static void default_numbers(const char *text, double *values, uint32_t count)
{
    uint32_t found = 0;
    for (const char *at = text; *at && found < count;) {
        char *end;
        const double value = strtod(at, &end);
        if (end == at) {
            at++;
            continue;
        }
        values[found++] = value;
        at = end;
    }
    for (uint32_t k = found; k < count; k++) values[k] = found ? values[0] : NAN;
}

static void default_set(const struct key *key, void *at)
{
    const char *text = key->fallback;
    switch (key->type) {
    case KEY_REAL:   default_numbers(text ? text : "nan", at, 1); break;
    case KEY_VECTOR:
    case KEY_RANGE:  default_numbers(text ? text : "nan", at, 2); break;
    case KEY_BOX:    default_numbers(text ? text : "nan", at, 4); break;
    case KEY_COUNT:  *(uint32_t *)at = text ? (uint32_t)strtoul(text, NULL, 10) : 0; break;
    case KEY_WORD64: *(uint64_t *)at = text ? strtoull(text, NULL, 0) : 0; break;
    case KEY_BOOL:   *(bool *)at = text && strcmp(text, "true") == 0; break;
    case KEY_CHOICE: {
        const int index = text ? key_choice(key->choices, text) : 0;
        *(int *)at = index < 0 ? 0 : index;
        break;
    }
    case KEY_TEXT:   snprintf(at, KEY_TEXT_MAX, "%s", text ? text : ""); break;
    case KEY_REALS:
    case KEY_POINTS: *(struct key_reals *)at = (struct key_reals){0, NULL}; break;
    case KEY_TEXTS:  *(struct key_texts *)at = (struct key_texts){0, NULL}; break;
    }
}

void parse_defaults(const struct key_group *group, void *target)
{
    for (uint32_t k = 0; k < group->count; k++) {
        default_set(&group->keys[k], (char *)target + group->keys[k].offset);
    }
}

/* ---- values -------------------------------------------------------------------------------- */

static void tell(struct parse *parse, const struct tree *node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void tell(struct parse *parse, const struct tree *node, const char *format, ...)
{
    char text[sizeof parse->findings->list[0].text];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    findings_tell_at(parse->findings, FINDING_ERROR, node->file, node->line, "%s", text);
}

static void tell_type(struct parse *parse, const struct tree *node, const char *path,
                      const struct key *key)
{
    char limits[200] = "";
    if (key->choices) key_limits(key, limits, sizeof limits);
    tell(parse, node, "'%s' must be %s%s%s%s, not %s%s%s", path, key_type_word(key->type),
         limits[0] ? " (" : "", limits, limits[0] ? ")" : "", tree_word(node),
         node->text && node->kind == TREE_TEXT ? " " : "",
         node->text && node->kind == TREE_TEXT ? node->text : "");
}

static bool is_number(const struct tree *node)
{
    return node->kind == TREE_INTEGER || node->kind == TREE_REAL;
}

/* Squares and products of larger numbers overflow, whatever the key. */
static const double number_max = 1e30;

/* One number, within the key's limits. */
static bool take_number(struct parse *parse, const struct tree *node, const char *path,
                        const struct key *key, double *value)
{
    double number = node->real;
    if (node->kind == TREE_TEXT) {
        /* "nan" and "inf" are no numbers to libconfig, but an override may try them. */
        char *end;
        number = node->text ? strtod(node->text, &end) : 0;
        if (!node->text || end == node->text || *end || isfinite(number)) {
            tell_type(parse, node, path, key);
            return false;
        }
    } else if (!is_number(node)) {
        tell_type(parse, node, path, key);
        return false;
    }
    char limits[200];
    if (!isfinite(number)) {
        tell(parse, node, "'%s' is %g, which is no finite number; give one%s", path, number,
             key->fallback ? ", or delete the line for the default" : "");
        return false;
    }
    if ((!isnan(key->low) && number < key->low) || (!isnan(key->high) && number > key->high)) {
        tell(parse, node, "'%s' = %.10g is not allowed; it must be %s (%s)", path, number,
             key_limits(key, limits, sizeof limits), key->doc);
        return false;
    }
    if (fabs(number) > number_max) {
        tell(parse, node, "'%s' = %.10g is too large to compute with; at most %g (%s)", path,
             number, number_max, key->doc);
        return false;
    }
    *value = number;
    return true;
}

static bool take_whole(struct parse *parse, const struct tree *node, const char *path,
                       const struct key *key, double *value)
{
    if (!take_number(parse, node, path, key, value)) return false;
    if (*value == floor(*value) && *value >= 0) return true;
    tell(parse, node, "'%s' = %.10g must be a whole number, 0 or more", path, *value);
    return false;
}

/* Exactly `count` numbers out of a list. */
static void take_numbers(struct parse *parse, const struct tree *node, const char *path,
                         const struct key *key, double *values, uint32_t count)
{
    if (key->type == KEY_RANGE && is_number(node)) {
        if (take_number(parse, node, path, key, &values[0])) values[1] = values[0];
        return;
    }
    if (node->kind != TREE_LIST || tree_count(node) != count) {
        if (node->kind == TREE_LIST) {
            tell(parse, node, "'%s' must be %s, but has %u entries", path, key_type_word(key->type),
                 tree_count(node));
        } else {
            tell_type(parse, node, path, key);
        }
        return;
    }
    const struct tree *child = node->child;
    for (uint32_t k = 0; k < count; k++, child = child->next) {
        take_number(parse, child, path, key, &values[k]);
    }
    if (key->type == KEY_RANGE && values[1] < values[0]) {
        tell(parse, node, "'%s' = (%.10g, %.10g) runs backwards; write the lower one first", path,
             values[0], values[1]);
    }
}

static void take_reals(struct parse *parse, const struct tree *node, const char *path,
                       const struct key *key, struct key_reals *reals)
{
    const uint32_t width = key->type == KEY_POINTS ? 2 : 1;
    if (node->kind != TREE_LIST) {
        tell_type(parse, node, path, key);
        return;
    }
    reals->count = 0;
    if (!arena_array(parse->arena, &reals->values, tree_count(node) * width)) return;
    for (const struct tree *child = node->child; child; child = child->next) {
        if (width == 1) {
            take_number(parse, child, path, key, &reals->values[reals->count]);
        } else if (child->kind == TREE_LIST && tree_count(child) == 2) {
            take_number(parse, child->child, path, key, &reals->values[reals->count]);
            take_number(parse, child->child->next, path, key, &reals->values[reals->count + 1]);
        } else {
            tell(parse, child, "'%s': entry %u must be a point (x, y)", path,
                 reals->count / width + 1);
        }
        reals->count += width;
    }
}

static bool take_text(struct parse *parse, const struct tree *node, const char *path,
                      const struct key *key, char *text)
{
    if (!node->text) {
        tell_type(parse, node, path, key);
        return false;
    }
    if (strlen(node->text) >= KEY_TEXT_MAX) {
        tell(parse, node, "'%s' is longer than %d bytes; shorten it", path, KEY_TEXT_MAX - 1);
        return false;
    }
    snprintf(text, KEY_TEXT_MAX, "%s", node->text);
    return true;
}

static void take_texts(struct parse *parse, const struct tree *node, const char *path,
                       const struct key *key, struct key_texts *texts)
{
    if (node->kind != TREE_LIST && node->kind != TREE_TEXT) {
        tell_type(parse, node, path, key);
        return;
    }
    const struct tree *child = node->kind == TREE_LIST ? node->child : node;
    const uint32_t count = node->kind == TREE_LIST ? tree_count(node) : 1;
    texts->count = 0;
    if (!arena_array(parse->arena, &texts->texts, count)) return;
    for (uint32_t k = 0; k < count; k++, child = child->next) {
        if (take_text(parse, child, path, key, texts->texts[texts->count])) texts->count++;
    }
}

/* The word of `choices` that is closest to what was written; NULL if none is close. */
static const char *nearest_choice(const char *choices, const char *word, char *text, size_t size)
{
    uint32_t best = UINT32_MAX;
    char candidate[64];
    for (int index = 0; key_choice_word(choices, index, candidate, sizeof candidate)[0]; index++) {
        const uint32_t distance = key_distance(word, candidate);
        if (distance >= best) continue;
        best = distance;
        snprintf(text, size, "%s", candidate);
    }
    return best <= 2 ? text : NULL;
}

static bool check_choice(struct parse *parse, const struct tree *node, const char *path,
                         const struct key *key, const char *word)
{
    if (key_choice(key->choices, word) >= 0) return true;
    char limits[300], close[64];
    const char *nearest = nearest_choice(key->choices, word, close, sizeof close);
    tell(parse, node, "'%s' = \"%.60s\" is unknown; it must be %s%s%s%s", path, word,
         key_limits(key, limits, sizeof limits), nearest ? "; did you mean \"" : "",
         nearest ? nearest : "", nearest ? "\"?" : "");
    return false;
}

static void take_value(struct parse *parse, const struct tree *node, const char *path,
                       const struct key *key, void *at)
{
    double number;
    char text[KEY_TEXT_MAX];
    switch (key->type) {
    case KEY_REAL:   take_number(parse, node, path, key, at); break;
    case KEY_VECTOR:
    case KEY_RANGE:  take_numbers(parse, node, path, key, at, 2); break;
    case KEY_BOX:    take_numbers(parse, node, path, key, at, 4); break;
    case KEY_REALS:
    case KEY_POINTS: take_reals(parse, node, path, key, at); break;
    case KEY_TEXTS:  take_texts(parse, node, path, key, at); break;
    case KEY_COUNT:
        if (take_whole(parse, node, path, key, &number)) *(uint32_t *)at = (uint32_t)number;
        break;
    case KEY_WORD64:
        /* All 64 bits count: 0xffffffffffffffff arrives as -1 and is meant. */
        if (node->kind == TREE_INTEGER) *(uint64_t *)at = (uint64_t)node->integer;
        else tell_type(parse, node, path, key);
        break;
    case KEY_BOOL:
        if (node->kind == TREE_BOOL) *(bool *)at = node->integer != 0;
        else tell_type(parse, node, path, key);
        break;
    case KEY_CHOICE:
        if (!take_text(parse, node, path, key, text)) break;
        if (check_choice(parse, node, path, key, text)) *(int *)at = key_choice(key->choices, text);
        break;
    case KEY_TEXT:
        if (!take_text(parse, node, path, key, text)) break;
        if (!key->choices || check_choice(parse, node, path, key, text)) {
            memcpy(at, text, sizeof text);
        }
        break;
    }
}

/* ---- groups -------------------------------------------------------------------------------- */

static void join(char path[TREE_PATH_MAX], const char *above, const char *name)
{
    snprintf(path, TREE_PATH_MAX, "%.150s%s%.90s", above, above[0] ? "." : "", name);
}

static const struct key_group *known_group(const struct scene *scene, uint32_t index)
{
    if (index <= SCENE_SECTIONS) return scene_key_group(index);
    index -= SCENE_SECTIONS + 1;
    return index < scene->settings_count ? scene->settings_groups[index] : NULL;
}

/* Names the nearest key of this group (and at the top, section), or where the key belongs. */
static void tell_unknown(struct parse *parse, const struct tree *node, const char *path,
                         const struct key_group *group)
{
    const char *nearest = "", *home = NULL;
    uint32_t best = UINT32_MAX;
    for (uint32_t k = 0; k < group->count; k++) {
        const uint32_t distance = key_distance(node->name, group->keys[k].name);
        if (distance < best) nearest = group->keys[k].name;
        if (distance < best) best = distance;
    }
    const struct key_group *other;
    for (uint32_t g = 1; (other = known_group(parse->scene, g)); g++) {
        const uint32_t distance = key_distance(node->name, other->name);
        if (group == &scene_key_top && distance < best) {
            nearest = other->name;
            best = distance;
        }
        if (!home && other != group && key_find(other, node->name)) home = other->name;
    }
    if (group != &scene_key_top && key_find(&scene_key_top, node->name)) home = "";
    const size_t length = strlen(node->name);
    if (home && best > 1) {
        if (home[0]) tell(parse, node, "unknown key '%s'; it belongs into '%s'", path, home);
        else tell(parse, node, "unknown key '%s'; it belongs outside of any group", path);
    } else if (best <= 2 || best <= length / 3) {
        tell(parse, node, "unknown key '%s'; did you mean '%s'?", path, nearest);
    } else {
        tell(parse, node, "unknown key '%s'; 'help' lists the keys of %s%s%s", path,
             group->name[0] ? "'" : "a scene", group->name, group->name[0] ? "'" : "");
    }
}

static bool is_section(const struct scene *scene, const char *name)
{
    const struct key_group *group;
    for (uint32_t g = 1; (group = known_group(scene, g)); g++) {
        if (strcmp(group->name, name) == 0) return true;
    }
    return false;
}

static void parse_group(struct parse *parse, const struct tree *node, const char *path,
                        const struct key_group *group, void *target)
{
    parse_defaults(group, target);
    const bool top = group == &scene_key_top;
    if (node && node->kind != TREE_GROUP) {
        tell(parse, node, "'%s' must be a group { key = value; ... }, not %s", path,
             tree_word(node));
        return;
    }
    for (const struct tree *child = node ? node->child : NULL; child; child = child->next) {
        char below[TREE_PATH_MAX];
        join(below, path, child->name);
        const struct key *key = key_find(group, child->name);
        if (key) take_value(parse, child, below, key, (char *)target + key->offset);
        else if (!top || !is_section(parse->scene, child->name)) {
            tell_unknown(parse, child, below, group);
        }
    }
    for (uint32_t k = 0; k < group->count; k++) {
        const struct key *key = &group->keys[k];
        if (key->fallback || !node || tree_member(node, key->name)) continue;
        tell(parse, node, "%s%s'%s' is missing (%s); add %s = ...;", path, path[0] ? ": " : "",
             key->name, key->doc, key->name);
    }
}

static void parse_list(struct parse *parse, const struct tree *node,
                       const struct scene_section *section)
{
    const char *name = section->group->name;
    char *scene = (char *)parse->scene;
    if (!node) return;
    /* A single group instead of a list of one is what everybody means by it. */
    const struct tree *first = node->kind == TREE_LIST ? node->child : node;
    const uint32_t count = node->kind == TREE_LIST ? tree_count(node) : 1;
    if (node->kind != TREE_LIST && node->kind != TREE_GROUP) {
        tell(parse, node, "'%s' must be a list of groups ( { ... }, { ... } ), not %s", name,
             tree_word(node));
        return;
    }
    char *entries = arena_take(parse->arena, count, section->group->size);
    if (!entries) return;
    for (uint32_t k = 0; k < count; k++, first = first->next) {
        char path[TREE_PATH_MAX];
        snprintf(path, sizeof path, "%s.[%u]", name, k);
        parse_group(parse, first, path, section->group, entries + k * section->group->size);
    }
    memcpy(scene + section->offset, &entries, sizeof entries);
    memcpy(scene + section->count_offset, &count, sizeof count);
}

bool parse_scene(struct scene *scene, struct findings *findings)
{
    struct parse parse = {scene, findings, &scene->arena};
    const struct tree *root = scene->places->root;
    parse_group(&parse, root, "", &scene_key_top, scene);
    for (uint32_t s = 0; s < SCENE_SECTIONS; s++) {
        const struct scene_section *section = &scene_key_sections[s];
        const struct tree *node = tree_member(root, section->group->name);
        if (section->list) parse_list(&parse, node, section);
        else parse_group(&parse, node, section->group->name, section->group,
                         (char *)scene + section->offset);
    }
    for (uint32_t g = 0; g < scene->settings_count; g++) {
        const struct key_group *group = scene->settings_groups[g];
        scene->settings[g] = arena_take(&scene->arena, 1, group->size);
        if (!scene->settings[g]) break;
        parse_group(&parse, tree_member(root, group->name), group->name, group,
                    scene->settings[g]);
    }
    return !scene->arena.failed;
}
