/* checkpoint.c - see checkpoint.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/checkpoint.h"

#include "base/file.h"

#include <stdlib.h>
#include <string.h>

struct header {
    char     magic[8];
    uint32_t version, header_size;
    uint64_t turn;              /* counts up: the larger is the newer */
    uint64_t scene_hash, size, hash;
    uint64_t header_hash;       /* of all before it */
};

static const char magic[8] = "SANDREEL";
enum { VERSION = 1 };

#define SIZE_LIMIT ((size_t)1 << 40)

static uint64_t header_hash(const struct header *header)
{
    return archive_hash(ARCHIVE_HASH_START, header, offsetof(struct header, header_hash));
}

static void turn_path(char *path, size_t size, const char *directory, uint64_t turn)
{
    snprintf(path, size, "%s/%u.checkpoint", directory, (unsigned)(turn % 2));
}

bool checkpoint_save_as(const char *path, uint64_t turn, uint64_t scene_hash,
                        const struct archive *archive, struct error *error)
{
    struct header header = {
        .version = VERSION, .header_size = sizeof header, .turn = turn,
        .scene_hash = scene_hash, .size = archive->size,
        .hash = archive_hash(ARCHIVE_HASH_START, archive->bytes, archive->size),
    };
    memcpy(header.magic, magic, sizeof magic);
    header.header_hash = header_hash(&header);
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    fwrite(&header, sizeof header, 1, file.stream);
    fwrite(archive->bytes, 1, archive->size, file.stream);
    return file_commit(&file, error);
}

bool checkpoint_save(const char *directory, uint64_t turn, uint64_t scene_hash,
                     const struct archive *archive, struct error *error)
{
    char path[FILE_PATH_MAX];
    turn_path(path, sizeof path, directory, turn);
    return file_make_directory(directory, error)
        && checkpoint_save_as(path, turn, scene_hash, archive, error);
}

/* Reads one file; NULL with a reason if it is not a whole checkpoint. */
static char *read_one(const char *path, struct header *header, struct error *error)
{
    size_t size;
    char *bytes = file_load(path, SIZE_LIMIT, &size, error);
    if (!bytes) return NULL;
    const char *reason = NULL;
    if (size < sizeof *header) {
        reason = "too short";
    } else {
        memcpy(header, bytes, sizeof *header);
        if (memcmp(header->magic, magic, sizeof magic) != 0) reason = "not a checkpoint";
        else if (header->version != VERSION) reason = "written by another version of sandreel";
        else if (header->header_hash != header_hash(header)) reason = "its header is damaged";
        else if (header->size != size - sizeof *header) reason = "torn: its end is missing";
        else if (header->hash != archive_hash(ARCHIVE_HASH_START, bytes + sizeof *header,
                                              header->size)) reason = "its bytes are damaged";
    }
    if (!reason) return bytes;
    error_set(error, "%s: cannot go on from this checkpoint: %s", path, reason);
    free(bytes);
    return NULL;
}

bool checkpoint_load(const char *directory, uint64_t scene_hash, void **bytes, size_t *size,
                     uint64_t *turn, struct error *error)
{
    struct header headers[2];
    char *files[2], path[FILE_PATH_MAX];
    struct error reason = {0};
    bool any = false;
    for (unsigned k = 0; k < 2; k++) {
        turn_path(path, sizeof path, directory, k);
        any = any || file_exists(path);
        files[k] = file_exists(path) ? read_one(path, &headers[k], &reason) : NULL;
    }
    const unsigned newest = !files[0] || (files[1] && headers[1].turn > headers[0].turn);
    char *file = files[newest];
    free(files[1 - newest]);
    if (!file) {
        if (any) return error_set(error, "%s", reason.text);
        return error_set(error, "%s: no checkpoint here; run without --resume, and set "
                         "output.checkpoint or output.checkpoint_wall to have one", directory);
    }
    if (headers[newest].scene_hash != scene_hash) {
        free(file);
        return error_set_code(error, EXIT_USAGE, "%s: the checkpoint belongs to another scene or "
            "other settings (only 'until' may differ); resume with the options of the first run, "
            "or start anew with --force", directory);
    }
    *turn = headers[newest].turn;
    *size = headers[newest].size;
    memmove(file, file + sizeof headers[newest], headers[newest].size);
    *bytes = file;
    return true;
}
