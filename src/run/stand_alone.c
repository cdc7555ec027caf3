/* stand_alone.c - see stand_alone.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/stand_alone.h"

#include "run/folder.h"
#include "scene/place_file.h"

#include <stdlib.h>
#include <string.h>

static bool copy_file(const char *from, const char *to, struct error *error)
{
    size_t size;
    void *bytes = file_load(from, SIZE_MAX, &size, error);
    const bool done = bytes && file_save(to, bytes, size, error);
    free(bytes);
    return done;
}

/* Copies the file of placement k, and gives the placement its new name. */
static bool keep_file(const struct scene *scene, struct placement *placement, uint32_t k,
                      const char *directory, bool resume, struct error *error)
{
    char from[FILE_PATH_MAX], to[FILE_PATH_MAX];
    if (placement->kind != PLACEMENT_FILE) return true;
    place_file_path(scene, placement, from, sizeof from);
    snprintf(placement->file, sizeof placement->file, "placement%u.txt", k);
    folder_path(to, directory, "%s", placement->file);
    return resume || strcmp(from, to) == 0 || copy_file(from, to, error);
}

bool stand_alone_write(const struct scene *scene, const char *directory, bool resume,
                       const char *path, struct error *error)
{
    struct scene kept = *scene;
    kept.placements = calloc(kept.placement_count + 1, sizeof *kept.placements);
    if (!kept.placements) return error_set(error, "not enough memory to write the scene");
    bool done = true;
    for (uint32_t k = 0; done && k < kept.placement_count; k++) {
        kept.placements[k] = scene->placements[k];
        done = keep_file(scene, &kept.placements[k], k, directory, resume, error);
    }
    done = done && scene_write(&kept, path, error);
    free(kept.placements);
    return done;
}
