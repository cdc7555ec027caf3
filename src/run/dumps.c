/* dumps.c - see dumps.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/dumps.h"

#include "measure/dump.h"
#include "run/folder.h"
#include "run/h5md_read.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

static void index_path(const struct dumps *dumps, char path[FILE_PATH_MAX])
{
    folder_path(path, dumps->directory, "index.csv");
}

bool dumps_begin(struct dumps *dumps, const char *run, uint64_t frames, struct error *error)
{
    char path[FILE_PATH_MAX];
    *dumps = (struct dumps){0};
    folder_path(dumps->directory, run, "dump");
    index_path(dumps, path);
    if (!file_make_directory(dumps->directory, error)) return false;
    if (frames == 0) {
        folder_remove(dumps->directory, "index.csv");
        return true;
    }
    if (!dump_index_load(path, &dumps->index, error)) return false;
    if (dumps->index.count < frames) {
        return error_set(error, "%s: %u frames, but the checkpoint knows %llu; it cannot be "
                         "continued", path, dumps->index.count, (unsigned long long)frames);
    }
    dumps->index.count = (uint32_t)frames;
    return dump_index_save(path, &dumps->index, error);
}

/* The index in memory follows the one on the disk, for reading back after the run. */
static bool remember(struct dump_index *index, const struct dump_entry *entry, struct error *error)
{
    if (index->count == index->capacity) {
        const uint32_t capacity = index->capacity ? 2 * index->capacity : 64;
        struct dump_entry *entries = realloc(index->entries, capacity * sizeof *entries);
        if (!entries) return error_set(error, "not enough memory for the index of the dumps");
        index->entries = entries;
        index->capacity = capacity;
    }
    index->entries[index->count++] = *entry;
    return true;
}

bool dumps_add(struct dumps *dumps, const struct grains *grains, uint64_t steps,
               struct error *error)
{
    const struct dump_entry entry = {
        .frame = dumps->index.count, .time = grains->time, .steps = steps,
        .grains = grains->count, .contacts = grains->contacts ? grains->contact_count : 0,
    };
    char path[FILE_PATH_MAX];
    folder_path(path, dumps->directory, "%06u.npy", entry.frame);
    if (!dump_save(path, grains, error)) return false;
    folder_path(path, dumps->directory, "%06u.contacts.npy", entry.frame);
    if (grains->contacts && !dump_save_contacts(path, grains, error)) return false;
    index_path(dumps, path);
    return dump_index_append(path, &entry, error) && remember(&dumps->index, &entry, error);
}

static char *trajectory_path(char path[FILE_PATH_MAX], const char *run)
{
    return folder_path(path, run, "trajectory.h5");
}

bool dumps_kept(const char *run)
{
    char path[FILE_PATH_MAX];
    return file_exists(folder_path(path, run, "dump/index.csv"))
        || file_exists(trajectory_path(path, run));
}

bool dumps_open(struct dumps *dumps, const char *run, struct error *error)
{
    char path[FILE_PATH_MAX];
    *dumps = (struct dumps){0};
    if (!dumps_kept(run)) {
        return error_set(error, "%s: this run kept no grain states; run it again with "
                         "-s output.dump=true, or -s output.trajectory=DT", run);
    }
    folder_path(dumps->directory, run, "dump");
    index_path(dumps, path);
    if (!file_exists(path)) {
        dumps->trajectory = h5md_read_open(trajectory_path(path, run), &dumps->index, error);
        if (!dumps->trajectory) return false;
    } else if (!dump_index_load(path, &dumps->index, error)) {
        return false;
    }
    return dumps->index.count > 0 || error_set(error, "%s: no frame in it", path);
}

bool dumps_load(const struct dumps *dumps, uint32_t k, struct grains *grains,
                struct error *error)
{
    assert(k < dumps->index.count);
    const struct dump_entry *entry = &dumps->index.entries[k];
    char path[FILE_PATH_MAX], contacts[FILE_PATH_MAX];
    if (dumps->trajectory) {
        const bool done = h5md_read_frame(dumps->trajectory, entry->frame, grains, error);
        grains->time = entry->time;
        return done;
    }
    folder_path(path, dumps->directory, "%06u.npy", entry->frame);
    folder_path(contacts, dumps->directory, "%06u.contacts.npy", entry->frame);
    grains_free(grains);
    if (!dump_load(path, file_exists(contacts) ? contacts : NULL, grains, error)) return false;
    grains->time = entry->time;
    return true;
}

uint32_t dumps_nearest(const struct dumps *dumps, double t)
{
    const struct dump_entry *entry = dump_index_nearest(&dumps->index, t);
    return entry ? (uint32_t)(entry - dumps->index.entries) : 0;
}

void dumps_close(struct dumps *dumps)
{
    h5md_read_close(dumps->trajectory);
    dump_index_free(&dumps->index);
    *dumps = (struct dumps){0};
}
