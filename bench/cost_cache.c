/* cost_cache.c - see cost_cache.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench/cost_cache.h"

#include "base/archive.h"
#include "base/text.h"
#include "model/model.h"
#include "run/build.h"
#include "run/folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PROGRAM_MAX = 1 << 28 };

static const char *const left_out[] = {"view", "output", "hard"};

/* Does this line begin a group that says nothing about the simulation? */
static bool begins_left_out(const char *line)
{
    for (size_t k = 0; k < sizeof left_out / sizeof *left_out; k++) {
        const size_t length = strlen(left_out[k]);
        if (strncmp(line, left_out[k], length) == 0
            && strncmp(line + length, " = {", 4) == 0) return true;
    }
    return false;
}

/* The keys of the comparison itself, and what each run of it has of its own. */
static bool left_out_key(const char *line)
{
    static const char *const keys[] = {"model = ", "seed = ", "    cost = ", "    reference = ",
                                       "    settings = "};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        if (strncmp(line, keys[k], strlen(keys[k])) == 0) return true;
    }
    return false;
}

static uint64_t scene_hash(const struct scene *scene)
{
    struct text words;
    const bool told = text_begin(&words) && scene_write_text(scene, words.stream);
    char *text = text_end(&words, NULL);
    if (!told || !text) {
        free(text);
        return 0;
    }
    uint64_t hash = ARCHIVE_HASH_START;
    bool skips = false;
    for (const char *line = text; line && *line;) {
        const size_t length = strcspn(line, "\n"), indent = strspn(line, " ");
        skips = skips || begins_left_out(line);
        if (!skips && line[indent] != '#' && !left_out_key(line)) {
            hash = archive_hash(hash, line, length);
        }
        if (strncmp(line, "};", 2) == 0) skips = false;
        line += length + (line[length] == '\n');
    }
    free(text);
    return hash;
}

uint64_t cost_cache_hash(const char *path, const char *const *overrides, uint32_t count)
{
    const struct key_group *groups[MODEL_MAX];
    const struct scene_request request = {.path = path, .overrides = overrides,
        .override_count = count, .groups = groups, .group_count = model_settings(groups)};
    struct findings *findings = calloc(1, sizeof *findings);
    struct scene *scene = findings ? scene_load(&request, findings) : NULL;
    const uint64_t hash = scene ? scene_hash(scene) : 0;
    if (scene) scene_free(scene);
    free(findings);
    return hash;
}

/* Of the bytes of the running program, read once. */
static uint64_t program_hash(void)
{
    static uint64_t hash;
    struct error ignored;
    size_t size = 0;
    if (hash) return hash;
    void *bytes = file_load("/proc/self/exe", PROGRAM_MAX, &size, &ignored);
    hash = archive_hash(ARCHIVE_HASH_START, build_version, strlen(build_version));
    if (bytes) hash = archive_hash(hash, bytes, size);
    free(bytes);
    return hash;
}

static uint64_t run_hash(const struct scene *scene, unsigned observables)
{
    const struct placed *placed = &scene->placed;
    const uint64_t numbers[] = {scene_hash(scene), scene->seed, program_hash(), observables,
                                sizeof(struct cost_rows)};
    uint64_t hash = archive_hash(ARCHIVE_HASH_START, numbers, sizeof numbers);
    hash = archive_hash(hash, scene->model, strlen(scene->model));
    const double *const arrays[] = {placed->x, placed->y, placed->vx, placed->vy};
    for (int k = 0; k < 4 && placed->count > 0; k++) {
        hash = archive_hash(hash, arrays[k], placed->count * sizeof(double));
    }
    return hash;
}

const char *cost_cache_directory(char directory[FILE_PATH_MAX])
{
    const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    /* A relative path is no valid value of it (XDG base directory specification). */
    if (cache && cache[0] == '/') return folder_path(directory, cache, "sandreel");
    return home && home[0] ? folder_path(directory, home, ".cache/sandreel") : NULL;
}

static char *name_run(char path[FILE_PATH_MAX], const char *directory, uint64_t hash)
{
    return folder_path(path, directory, "run-%016llx", (unsigned long long)hash);
}

/* What a file holds; `seal` tells a whole one from one whose bytes were changed. */
static void pass(struct archive *archive, uint64_t *seal, struct cost_rows *rows)
{
    archive_array(archive, "rows", &rows->values[0][0], sizeof rows->values / sizeof(double));
    archive_value(archive, "wall", &rows->wall);
    archive_value(archive, "cpu", &rows->cpu);
    archive_value(archive, "seal", seal);
}

static uint64_t seal_of(uint64_t hash, const struct cost_rows *rows)
{
    hash = archive_hash(hash, rows->values, sizeof rows->values);
    return archive_hash(hash, &rows->wall, sizeof rows->wall);
}

bool cost_cache_load(const char *directory, const struct scene *scene, unsigned observables,
                     struct cost_rows *rows)
{
    const uint64_t hash = run_hash(scene, observables);
    uint64_t seal = 0;
    char path[FILE_PATH_MAX];
    struct error ignored;
    size_t size;
    if (!directory || !file_exists(name_run(path, directory, hash))) return false;
    void *bytes = file_load(path, 1 << 20, &size, &ignored);
    if (!bytes) return false;
    struct archive archive;
    archive_begin_load(&archive, bytes, size);
    pass(&archive, &seal, rows);
    free(bytes);
    return !archive.failed && seal == seal_of(hash, rows);
}

void cost_cache_save(const char *directory, const struct scene *scene, unsigned observables,
                     const struct cost_rows *rows)
{
    const uint64_t hash = run_hash(scene, observables);
    uint64_t seal = seal_of(hash, rows);
    char path[FILE_PATH_MAX];
    struct error ignored;
    struct archive archive;
    struct cost_rows copy = *rows;
    if (!directory || !file_make_directory(directory, &ignored)) return;
    archive_begin_save(&archive);
    pass(&archive, &seal, &copy);
    if (!archive.failed) {
        file_save(name_run(path, directory, hash), archive.bytes, archive.size, &ignored);
    }
    archive_end(&archive);
}
