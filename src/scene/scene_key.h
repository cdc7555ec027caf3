/* scene_key.h - the sections of a scene file: which group fills which part of struct scene.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SCENE_KEY_H
#define SCENE_KEY_H

#include "scene/scene.h"

struct scene_section {
    const struct key_group *group;
    bool   list;                /* name = ( {...}, {...} ); else name = {...} */
    size_t offset;              /* of the struct, or of the pointer to the array */
    size_t count_offset;        /* lists: of the uint32_t that counts them */
};

enum { SCENE_SECTIONS = 12 };

extern const struct key_group scene_key_top;                    /* keys outside of any group */
extern const struct scene_section scene_key_sections[SCENE_SECTIONS];

#endif
