/* file.c - see file.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/file.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool file_begin(struct file *file, const char *path, struct error *error)
{
    file->stream = NULL;
    if (strlen(path) >= sizeof file->path) return error_set(error, "%.60s...: path too long", path);
    snprintf(file->path, sizeof file->path, "%s", path);
    snprintf(file->partial, sizeof file->partial, "%s.partial", path);
    file->stream = fopen(file->partial, "wb");
    if (file->stream) return true;
    return error_set(error, "%s: cannot create this file: %s", path, strerror(errno));
}

void file_abandon(struct file *file)
{
    if (!file->stream) return;
    fclose(file->stream);
    file->stream = NULL;
    unlink(file->partial);
}

bool file_commit(struct file *file, struct error *error)
{
    assert(file->stream);
    errno = 0;
    bool done = fflush(file->stream) == 0 && !ferror(file->stream);
    done = done && fsync(fileno(file->stream)) == 0;
    int cause = errno;
    if (fclose(file->stream) != 0) {
        if (done) cause = errno;
        done = false;
    }
    file->stream = NULL;
    if (done && rename(file->partial, file->path) != 0) {
        cause = errno;
        done = false;
    }
    if (done) return true;
    unlink(file->partial);
    return error_set(error, "%s: writing stopped: %s", file->path,
                     cause ? strerror(cause) : "is the disk full?");
}

bool file_save(const char *path, const void *bytes, size_t size, struct error *error)
{
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    fwrite(bytes, 1, size, file.stream);
    return file_commit(&file, error);
}

void *file_load(const char *path, size_t size_max, size_t *size, struct error *error)
{
    struct stat status = {0};
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);    /* no wait for a pipe */
    FILE *stream = file >= 0 ? fdopen(file, "rb") : NULL;
    if (!stream) {
        error_set(error, "%s: cannot open this file: %s", path, strerror(errno));
        if (file >= 0) close(file);
        return NULL;
    }
    char *bytes = NULL;
    if (fstat(fileno(stream), &status) != 0 || !S_ISREG(status.st_mode)) {
        error_set(error, "%s: %s", path, S_ISDIR(status.st_mode) ? "this is a directory, not a file"
                                                                 : "not an ordinary file");
    } else if ((uintmax_t)status.st_size > size_max) {
        error_set(error, "%s: larger than %zu bytes, "
                         "which is more than this can be", path, size_max);
    } else if (!(bytes = malloc((size_t)status.st_size + 1))) {
        error_set(error, "%s: not enough memory to read it", path);
    } else if (fread(bytes, 1, (size_t)status.st_size, stream) != (size_t)status.st_size) {
        error_set(error, "%s: reading stopped before the end", path);
        free(bytes);
        bytes = NULL;
    }
    fclose(stream);
    if (!bytes) return NULL;
    bytes[status.st_size] = 0;
    *size = (size_t)status.st_size;
    return bytes;
}

bool file_exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

bool file_absent(const char *path, struct error *error)
{
    return !file_exists(path) || error_set_code(error, EXIT_USAGE, "%s: is there already; "
        "overwrite it with --force, or name another place with -o", path);
}

bool file_sync(const char *path)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    /* What cannot be synced (some network disks) is on its own. */
    const bool done = fsync(file) == 0 || errno == EINVAL;
    close(file);
    return done;
}

bool file_make_directory(const char *path, struct error *error)
{
    char part[FILE_PATH_MAX];
    if (strlen(path) >= sizeof part) return error_set(error, "%.60s...: path too long", path);
    snprintf(part, sizeof part, "%s", path);
    for (char *at = part + 1;; at++) {
        if (*at != '/' && *at != 0) continue;
        const char kept = *at;
        *at = 0;
        if (mkdir(part, 0777) != 0 && errno != EEXIST) {
            return error_set(error, "%s: cannot make this directory: %s", part, strerror(errno));
        }
        *at = kept;
        if (kept == 0) break;
    }
    struct stat status;
    if (stat(path, &status) == 0 && S_ISDIR(status.st_mode)) return true;
    return error_set(error, "%s: is there already and is no directory", path);
}
