/* archive.h - one list of fields serves saving, loading and hashing.
 *
 * A model passes every byte that its future depends on through archive_items(), each under a
 * name.  Saving appends a record (name, width, count, data); loading looks the name up, so a
 * state may be loaded into a scene with more or fewer effects: a record that nobody asks for is
 * passed over, and an array whose record is absent keeps the neutral value that `create` gave
 * it.  A record of another shape than asked for is an error, and so are torn bytes.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ARCHIVE_H
#define ARCHIVE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum archive_mode { ARCHIVE_SAVE, ARCHIVE_LOAD, ARCHIVE_HASH };

struct archive {
    enum archive_mode mode;
    unsigned char *bytes;       /* SAVE: owned by the archive; LOAD: the caller's */
    size_t size, capacity;
    uint64_t hash;              /* of all that passed (HASH), or of the bytes (SAVE, LOAD) */
    bool failed;                /* sticks; test it once, at the end */
    char reason[160];           /* why it failed */
};

void archive_begin_save(struct archive *archive);
void archive_begin_hash(struct archive *archive);

/* `bytes` must stay until the load is over.  Checks the whole chain of records first, so a torn
 * archive fails here and never half-way. */
void archive_begin_load(struct archive *archive, const void *bytes, size_t size);

/* Frees the bytes of a save; harmless otherwise. */
void archive_end(struct archive *archive);

/* Passes `count` items of `width` bytes under `name` (unique within the archive). */
void archive_items(struct archive *archive, const char *name, void *items, size_t width,
                   size_t count);

/* Passes a count that sizes later arrays; a loaded value above `limit` fails the archive. */
void archive_count(struct archive *archive, const char *name, uint32_t *count, uint32_t limit);

/* While loading: is there a record of this name?  True in the other modes. */
bool archive_has(const struct archive *archive, const char *name);

void archive_fail(struct archive *archive, const char *reason);

#define archive_array(archive, name, array, count) \
    archive_items(archive, name, array, sizeof *(array), count)
#define archive_value(archive, name, value) archive_items(archive, name, value, sizeof *(value), 1)

/* FNV-1a, 64 bits; start with ARCHIVE_HASH_START. */
#define ARCHIVE_HASH_START 14695981039346656037u
uint64_t archive_hash(uint64_t hash, const void *bytes, size_t size);

#endif
