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
static char *setting(const struct scene *scene, uint32_t g, uint32_t k)
{
    const struct key *key = &scene->settings_groups[g]->keys[k];
    return scene_write_value(key, (const char *)scene->settings[g] + key->offset);
}

bool pins_needed(const struct scene *base, const struct scene *fresh)
{
    bool same = true;
    for (uint32_t g = 0; same && g < base->settings_count; g++) {
        for (uint32_t k = 0; same && k < base->settings_groups[g]->count; k++) {
            char *a = setting(base, g, k), *b = setting(fresh, g, k);
            same = (!a && !b) || (a && b && strcmp(a, b) == 0);
            free(a);
            free(b);
        }
    }
    return !same;
}

bool pins_put(struct timeline *timeline, const struct scene *base, struct error *error)
{
    bool done = true;
    for (uint32_t g = 0; done && g < base->settings_count; g++) {
        const struct key_group *group = base->settings_groups[g];
        for (uint32_t k = 0; done && k < group->count; k++) {
            char text[KEY_TEXT_MAX * 2], *value = setting(base, g, k);
            if (!value) continue;
            snprintf(text, sizeof text, "%s.%s=%s", group->name, group->keys[k].name, value);
            done = timeline_put(&timeline->overrides, text, error);
            free(value);
        }
    }
    return done;
}
