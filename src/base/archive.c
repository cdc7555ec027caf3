/* archive.c - see archive.h.
 *
 * A record: hash of the name (8 bytes), width (8), count (8), then the data padded to 8 bytes.
 * Loading walks the records from the last hit onwards and wraps once, so a list that is loaded in
 * the order it was saved costs one comparison a record.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "base/archive.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct record { uint64_t name, width, count; };

uint64_t archive_hash(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *b = bytes;
    for (size_t k = 0; k < size; k++) hash = (hash ^ b[k]) * 1099511628211u;
    return hash;
}

static uint64_t name_hash(const char *name)
{
    return archive_hash(ARCHIVE_HASH_START, name, strlen(name));
}

static size_t padded(size_t size) { return (size + 7) / 8 * 8; }

void archive_fail(struct archive *archive, const char *reason)
{
    if (archive->failed) return;
    archive->failed = true;
    snprintf(archive->reason, sizeof archive->reason, "%s", reason);
}

void archive_begin_save(struct archive *archive)
{
    *archive = (struct archive){.mode = ARCHIVE_SAVE, .hash = ARCHIVE_HASH_START};
}

void archive_begin_hash(struct archive *archive)
{
    *archive = (struct archive){.mode = ARCHIVE_HASH, .hash = ARCHIVE_HASH_START};
}

/* The record at `at` and the bytes it fills in all; 0 if it does not fit into what is left. */
static size_t record_at(const struct archive *archive, size_t at, struct record *record)
{
    if (archive->capacity - at < sizeof *record) return 0;
    memcpy(record, archive->bytes + at, sizeof *record);
    const size_t left = archive->capacity - at - sizeof *record;
    if (record->width == 0 || record->count > left / record->width) return 0;
    const size_t size = padded(record->width * record->count);
    return size <= left ? sizeof *record + size : 0;
}

void archive_begin_load(struct archive *archive, const void *bytes, size_t size)
{
    *archive = (struct archive){.mode = ARCHIVE_LOAD, .hash = ARCHIVE_HASH_START};
    archive->bytes = (unsigned char *)(uintptr_t)bytes;         /* never written while loading */
    archive->capacity = size;
    for (size_t at = 0; at < size;) {
        struct record record;
        const size_t step = record_at(archive, at, &record);
        if (step == 0) {
            archive_fail(archive, "the saved state is torn: its last record is cut off");
            return;
        }
        at += step;
    }
}

void archive_end(struct archive *archive)
{
    if (archive->mode == ARCHIVE_SAVE) free(archive->bytes);
    archive->bytes = NULL;
    archive->size = archive->capacity = 0;
}

static bool reserve(struct archive *archive, size_t more)
{
    if (more <= archive->capacity - archive->size) return true;
    size_t capacity = archive->capacity ? archive->capacity : 4096;
    while (capacity - archive->size < more) capacity *= 2;
    unsigned char *bytes = realloc(archive->bytes, capacity);
    if (!bytes) {
        archive_fail(archive, "not enough memory to save the state");
        return false;
    }
    archive->bytes = bytes;
    archive->capacity = capacity;
    return true;
}

static void save_items(struct archive *archive, const struct record *record, const void *items)
{
    const size_t size = record->width * record->count, room = padded(size);
    if (archive->failed || !reserve(archive, sizeof *record + room)) return;
    unsigned char *at = archive->bytes + archive->size;
    memcpy(at, record, sizeof *record);
    if (size > 0) memcpy(at + sizeof *record, items, size);
    memset(at + sizeof *record + size, 0, room - size);
    archive->size += sizeof *record + room;
}

/* Where the record of this name begins; capacity if there is none.  `size` is the read mark. */
static size_t find_record(const struct archive *archive, uint64_t name, struct record *record)
{
    const size_t starts[2] = {archive->size, 0}, ends[2] = {archive->capacity, archive->size};
    for (int turn = 0; turn < 2; turn++) {
        for (size_t at = starts[turn]; at < ends[turn];) {
            const size_t step = record_at(archive, at, record);
            if (step == 0) return archive->capacity;
            if (record->name == name) return at;
            at += step;
        }
    }
    return archive->capacity;
}

bool archive_has(const struct archive *archive, const char *name)
{
    if (archive->mode != ARCHIVE_LOAD || archive->failed) return true;
    struct record record;
    return find_record(archive, name_hash(name), &record) < archive->capacity;
}

static void load_items(struct archive *archive, const char *name, const struct record *wanted,
                       void *items)
{
    if (archive->failed) return;
    struct record found;
    const size_t at = find_record(archive, wanted->name, &found);
    if (at == archive->capacity) return;                        /* absent: stays neutral */
    if (found.width != wanted->width || found.count != wanted->count) {
        char reason[sizeof archive->reason];
        snprintf(reason, sizeof reason, "'%.40s' holds %llu items of %llu bytes, not %llu of %llu",
                 name, (unsigned long long)found.count, (unsigned long long)found.width,
                 (unsigned long long)wanted->count, (unsigned long long)wanted->width);
        archive_fail(archive, reason);
        return;
    }
    const size_t size = found.width * found.count;
    if (size > 0) memcpy(items, archive->bytes + at + sizeof found, size);
    archive->size = at + sizeof found + padded(size);
}

void archive_items(struct archive *archive, const char *name, void *items, size_t width,
                   size_t count)
{
    if (!items) count = 0;                                      /* an absent effect's array */
    const struct record record = {name_hash(name), width, count};
    switch (archive->mode) {
    case ARCHIVE_SAVE: if (items) save_items(archive, &record, items); break;
    case ARCHIVE_LOAD: if (items) load_items(archive, name, &record, items); break;
    case ARCHIVE_HASH: archive->hash = archive_hash(archive->hash, items, width * count); break;
    }
}

void archive_count(struct archive *archive, const char *name, uint32_t *count, uint32_t limit)
{
    archive_value(archive, name, count);
    if (archive->mode != ARCHIVE_LOAD || *count <= limit) return;
    *count = 0;
    archive_fail(archive, "the saved state holds more grains than this scene has room for");
}
