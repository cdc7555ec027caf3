/* scene_value.c - see scene_value.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/scene_value.h"

#include "scene/scene_key.h"
#include "scene/tree.h"

#include <stdio.h>
#include <string.h>

struct visitor {
    void (*visit)(void *context, const char *path, const struct key *key, const void *value);
    void *context;
};

static void visit_group(const struct visitor *visitor, const struct key_group *group,
                        const char *prefix, const void *target)
{
    for (uint32_t k = 0; k < group->count; k++) {
        const struct key *key = &group->keys[k];
        char path[TREE_PATH_MAX];
        snprintf(path, sizeof path, "%s%s%s", prefix, *prefix ? "." : "", key->name);
        visitor->visit(visitor->context, path, key, (const char *)target + key->offset);
    }
}

static void visit_list(const struct visitor *visitor, const struct scene_section *section,
                       const struct scene *scene)
{
    const char *entries;
    uint32_t count;
    memcpy(&entries, (const char *)scene + section->offset, sizeof entries);
    memcpy(&count, (const char *)scene + section->count_offset, sizeof count);
    for (uint32_t k = 0; k < count; k++) {
        char prefix[TREE_NAME_MAX];
        snprintf(prefix, sizeof prefix, "%s.[%u]", section->group->name, k);
        visit_group(visitor, section->group, prefix, entries + k * section->group->size);
    }
}

void scene_value_each(const struct scene *scene,
                      void (*visit)(void *context, const char *path, const struct key *key,
                                    const void *value), void *context)
{
    const struct visitor visitor = {visit, context};
    visit_group(&visitor, &scene_key_top, "", scene);
    for (uint32_t s = 0; s < SCENE_SECTIONS; s++) {
        const struct scene_section *section = &scene_key_sections[s];
        if (section->list) visit_list(&visitor, section, scene);
        else visit_group(&visitor, section->group, section->group->name,
                         (const char *)scene + section->offset);
    }
    for (uint32_t g = 0; g < scene->settings_count; g++) {
        visit_group(&visitor, scene->settings_groups[g], scene->settings_groups[g]->name,
                    scene->settings[g]);
    }
}

struct search { const char *path; uint32_t found; const struct key *key; const void *value; };

/* Is `path` what was asked for, perhaps without its "[n]."? */
static bool is_meant(const char *asked, const char *path)
{
    if (strcmp(asked, path) == 0) return true;
    const char *index = strstr(path, ".[");
    if (!index) return false;
    const size_t head = (size_t)(index - path);
    const char *tail = strchr(index, ']') + 1;
    return strncmp(asked, path, head) == 0 && strcmp(asked + head, tail) == 0;
}

static void compare(void *context, const char *path, const struct key *key, const void *value)
{
    struct search *search = context;
    if (!is_meant(search->path, path)) return;
    search->found++;
    search->key = key;
    search->value = value;
}

bool scene_value_find(const struct scene *scene, const char *path, const struct key **key,
                      const void **value)
{
    struct search search = {.path = path};
    scene_value_each(scene, compare, &search);
    *key = search.key;
    *value = search.value;
    return search.found == 1;
}
