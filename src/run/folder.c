/* folder.c - see folder.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

char *folder_path(char path[FILE_PATH_MAX], const char *directory, const char *format, ...)
{
    const int used = snprintf(path, FILE_PATH_MAX, "%s/", directory);
    if (used < 0 || used >= FILE_PATH_MAX) return path;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(path + used, (size_t)(FILE_PATH_MAX - used), format, arguments);
    va_end(arguments);
    return path;
}

void folder_choose(char path[FILE_PATH_MAX], const char *name, const char *model)
{
    snprintf(path, FILE_PATH_MAX, "%s-%s", name, model);
    for (unsigned k = 2; file_exists(path); k++) {
        snprintf(path, FILE_PATH_MAX, "%s-%s-%u", name, model, k);
    }
}

static const char *const folders[] = {"frames", "maps", "dump", "checkpoint"};

bool folder_holds_only(const char *directory, const char *name)
{
    DIR *list = opendir(directory);
    if (!list) return true;
    bool only = true;
    for (struct dirent *entry; only && (entry = readdir(list));) {
        only = strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0
            || strcmp(entry->d_name, name) == 0;
    }
    closedir(list);
    return only;
}

static bool is_empty(const char *directory)
{
    return folder_holds_only(directory, "");
}

/* Only names that a run writes: NAME.ENDING with an ending of ours. */
static bool is_ours(const char *name)
{
    static const char *const endings[] = {".png", ".npy", ".npz", ".vti", ".csv", ".checkpoint",
                                          ".dump", ".json", ".partial"};
    const char *ending = strrchr(name, '.');
    for (size_t k = 0; ending && k < sizeof endings / sizeof *endings; k++) {
        if (strcmp(ending, endings[k]) == 0) return true;
    }
    return false;
}

void folder_remove(const char *directory, const char *name)
{
    char path[FILE_PATH_MAX];
    unlink(folder_path(path, directory, "%s", name));
}

static void sweep_partial(const char *folder)
{
    DIR *list = opendir(folder);
    if (!list) return;
    for (struct dirent *entry; (entry = readdir(list));) {
        const char *ending = strrchr(entry->d_name, '.');
        if (ending && strcmp(ending, ".partial") == 0) folder_remove(folder, entry->d_name);
    }
    closedir(list);
}

bool folder_reclaim(const char *directory, struct error *error)
{
    static const char *const marks[] = {"scene.cfg", "scene.cfg.new", "scene.cfg.new.partial"};
    char path[FILE_PATH_MAX];
    bool found = file_exists(directory) && is_empty(directory);
    for (size_t k = 0; k < sizeof marks / sizeof *marks; k++) {
        found = found || file_exists(folder_path(path, directory, "%s", marks[k]));
    }
    if (!found) {
        return error_set(error, "%s: there is no run here that could go on; run it without "
                         "--resume", directory);
    }
    sweep_partial(directory);
    for (size_t k = 0; k < sizeof folders / sizeof *folders; k++) {
        sweep_partial(folder_path(path, directory, "%s", folders[k]));
    }
    return true;
}

void folder_clear(const char *directory, const char *name)
{
    char folder[FILE_PATH_MAX];
    folder_path(folder, directory, "%s", name);
    DIR *list = opendir(folder);
    if (!list) return;
    for (struct dirent *entry; (entry = readdir(list));) {
        if (is_ours(entry->d_name)) folder_remove(folder, entry->d_name);
    }
    closedir(list);
    rmdir(folder);
}

bool folder_claim(const char *directory, bool force, struct error *error)
{
    if (!file_make_directory(directory, error)) return false;
    if (access(directory, W_OK | X_OK) != 0) {
        return error_set(error, "%s: cannot write into this directory: %s", directory,
                         strerror(errno));
    }
    if (is_empty(directory)) return true;
    if (!force) {
        return error_set_code(error, EXIT_USAGE, "%s: this directory is there already and not "
            "empty; choose another with -o, go on with --resume, or overwrite it with --force",
            directory);
    }
    /* Only a former run is cleared away; anywhere else the files are put beside what is there. */
    char scene[FILE_PATH_MAX], manifest[FILE_PATH_MAX];
    if (!file_exists(folder_path(scene, directory, "scene.cfg"))
        || !file_exists(folder_path(manifest, directory, "manifest.json"))) {
        return true;
    }
    static const char *const files[] = {"scene.cfg", "manifest.json", "log.csv", "broken.png",
                                        "impact.csv", "collisions.csv", "trajectory.h5"};
    for (size_t k = 0; k < sizeof folders / sizeof *folders; k++) {
        folder_clear(directory, folders[k]);
    }
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) folder_remove(directory, files[k]);
    char screen[FILE_PATH_MAX];
    for (unsigned k = 0; file_exists(folder_path(screen, directory, "screen%u.csv", k)); k++) {
        unlink(screen);
    }
    return true;
}
