/* pins.c - see pins.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/pins.h"

#include "scene/scene_value.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The value of key k of group g as text; NULL if it was left open.  The caller frees. */
static bool setting(const struct scene *scene, uint32_t g, uint32_t k, char **text)
{
    const struct key *key = &scene->settings_groups[g]->keys[k];
    return scene_write_value(key, (const char *)scene->settings[g] + key->offset, text);
}

static bool no_memory(struct error *error)
{
    return error_set(error, "not enough memory to compare settings");
}

bool pins_needed(const struct scene *base, const struct scene *fresh, bool *needed,
                 struct error *error)
{
    bool same = true, done = true;
    for (uint32_t g = 0; same && g < base->settings_count; g++) {
        for (uint32_t k = 0; same && done && k < base->settings_groups[g]->count; k++) {
            char *a = NULL, *b = NULL;
            done = setting(base, g, k, &a) && setting(fresh, g, k, &b);
            same = (!a && !b) || (a && b && strcmp(a, b) == 0);
            free(a);
            free(b);
        }
    }
    *needed = !same;
    return done || no_memory(error);
}

bool pins_put(struct timeline *timeline, const struct scene *base, struct error *error)
{
    bool done = true;
    for (uint32_t g = 0; done && g < base->settings_count; g++) {
        const struct key_group *group = base->settings_groups[g];
        for (uint32_t k = 0; done && k < group->count; k++) {
            char text[KEY_TEXT_MAX * 2], *value;
            if (!setting(base, g, k, &value)) return no_memory(error);
            if (!value) continue;
            snprintf(text, sizeof text, "%s.%s=%s", group->name, group->keys[k].name, value);
            done = timeline_put(&timeline->overrides, text, error);
            free(value);
        }
    }
    return done;
}
