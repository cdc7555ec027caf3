/* checkpoint.c - see checkpoint.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/checkpoint.h"

#include "base/file.h"
#include "run/build.h"
#include "run/resolved.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct header {
    char     magic[8];
    uint32_t version, header_size;
    char     program[24];       /* the version of sandreel: another one may compute otherwise */
    uint64_t turn;              /* counts up: the larger is the newer */
    uint64_t scene_size, size;  /* of the two parts behind the header */
    uint64_t hash;              /* of both */
    uint64_t header_hash;       /* of all before it */
};

static const char magic[8] = "SANDREEL";
enum { VERSION = 2 };

#define SIZE_LIMIT ((size_t)1 << 40)

/* A checkpoint that was read: the whole file, and its header. */
struct stored {
    char *file;                 /* NULL: not usable */
    struct header header;
};

static uint64_t header_hash(const struct header *header)
{
    return archive_hash(ARCHIVE_HASH_START, header, offsetof(struct header, header_hash));
}

static void turn_path(char *path, size_t size, const char *directory, uint64_t turn)
{
    snprintf(path, size, "%s/%u.checkpoint", directory, (unsigned)(turn % 2));
}

bool checkpoint_exists(const char *directory)
{
    char path[2][FILE_PATH_MAX];
    for (unsigned k = 0; k < 2; k++) turn_path(path[k], sizeof path[k], directory, k);
    return file_exists(path[0]) || file_exists(path[1]);
}

bool checkpoint_save_as(const char *path, uint64_t turn, const char *scene,
                        const struct archive *archive, struct error *error)
{
    struct header header = {
        .version = VERSION, .header_size = sizeof header, .turn = turn,
        .scene_size = strlen(scene), .size = archive->size,
        .hash = archive_hash(ARCHIVE_HASH_START, scene, strlen(scene)),
    };
    header.hash = archive_hash(header.hash, archive->bytes, archive->size);
    memcpy(header.magic, magic, sizeof magic);
    snprintf(header.program, sizeof header.program, "%s", build_version);
    header.header_hash = header_hash(&header);
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    fwrite(&header, sizeof header, 1, file.stream);
    fwrite(scene, 1, header.scene_size, file.stream);
    fwrite(archive->bytes, 1, archive->size, file.stream);
    return file_commit(&file, error);
}

bool checkpoint_save(const char *directory, uint64_t turn, const char *scene,
                     const struct archive *archive, struct error *error)
{
    char path[FILE_PATH_MAX];
    turn_path(path, sizeof path, directory, turn);
    /* Not its parents: a run directory that has vanished must not come back as a torso. */
    if (mkdir(directory, 0777) != 0 && errno != EEXIST) {
        return error_set(error, "%s: cannot make this directory: %s", directory, strerror(errno));
    }
    return checkpoint_save_as(path, turn, scene, archive, error);
}

/* What is wrong with a file of `size` bytes; NULL if it is a whole checkpoint.  The versions come
 * after the hash of the header, so that a damaged version is not taken for another one; but
 * another layout has its hash elsewhere. */
static const char *defect(const char *file, size_t size, struct header *header)
{
    if (size < sizeof *header) return "too short";
    memcpy(header, file, sizeof *header);
    const size_t behind = size - sizeof *header;
    if (memcmp(header->magic, magic, sizeof magic) != 0) return "not a checkpoint";
    if (header->version != VERSION || header->header_size != sizeof *header) {
        return "another version of sandreel wrote it, in another layout";
    }
    if (header->header_hash != header_hash(header)) return "its header is damaged";
    if (header->scene_size > behind || header->size != behind - header->scene_size) {
        return "torn: its end is missing";
    }
    const uint64_t hash = archive_hash(ARCHIVE_HASH_START, file + sizeof *header, behind);
    return header->hash == hash ? NULL : "its bytes are damaged";
}

/* Reads one file; stored.file stays NULL, with a reason, if it is not a whole checkpoint. */
static struct stored read_one(const char *path, struct error *error)
{
    size_t size;
    struct stored stored = {.file = file_load(path, SIZE_LIMIT, &size, error)};
    if (!stored.file) return stored;
    const char *reason = defect(stored.file, size, &stored.header);
    if (!reason) return stored;
    error_set(error, "%s: cannot go on from this checkpoint: %s", path, reason);
    free(stored.file);
    stored.file = NULL;
    return stored;
}

/* Another version may compute other numbers, so going on would not be the same run. */
static bool belongs_here(const struct stored *stored, const char *directory, const char *scene,
                         struct error *error)
{
    if (strncmp(stored->header.program, build_version, sizeof stored->header.program - 1) != 0) {
        return error_set_code(error, EXIT_USAGE, "%s: sandreel %.24s wrote this checkpoint, and "
            "this is %s, which may compute otherwise; go on with that version, or start anew with "
            "--force", directory, stored->header.program, build_version);
    }
    char *there = malloc(stored->header.scene_size + 1), difference[500];
    if (!there) return error_set(error, "not enough memory to read a checkpoint");
    memcpy(there, stored->file + sizeof stored->header, stored->header.scene_size);
    there[stored->header.scene_size] = 0;
    const bool same = resolved_hash(there) == resolved_hash(scene);
    if (!same) resolved_difference(there, scene, difference, sizeof difference);
    free(there);
    return same || error_set_code(error, EXIT_USAGE, "%s: the checkpoint belongs to another scene "
        "or other settings (only 'until' and 'count_max' may differ): %s; resume with the options "
        "of the first run, or start anew with --force", directory, difference);
}

bool checkpoint_load(const char *directory, const char *scene, void **bytes, size_t *size,
                     uint64_t *turn, struct error *error)
{
    struct stored stored[2] = {{0}};
    char path[FILE_PATH_MAX];
    struct error reason = {0};
    if (!checkpoint_exists(directory)) {
        return error_set(error, "%s: no checkpoint here; run without --resume, and set "
                         "output.checkpoint or output.checkpoint_wall to have one", directory);
    }
    for (unsigned k = 0; k < 2; k++) {
        turn_path(path, sizeof path, directory, k);
        if (file_exists(path)) stored[k] = read_one(path, &reason);
    }
    const unsigned newest = !stored[0].file
                         || (stored[1].file && stored[1].header.turn > stored[0].header.turn);
    char *file = stored[newest].file;
    free(stored[1 - newest].file);
    if (!file) return error_set(error, "%s", reason.text);
    if (!belongs_here(&stored[newest], directory, scene, error)) {
        free(file);
        return false;
    }
    const struct header *header = &stored[newest].header;
    *turn = header->turn;
    *size = header->size;
    memmove(file, file + sizeof *header + header->scene_size, header->size);
    *bytes = file;
    return true;
}
