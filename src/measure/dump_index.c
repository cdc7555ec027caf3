/* dump_index.c - see dump_index.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/dump_index.h"

#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char header[] = "frame,time,steps,grains,contacts\n";

static const size_t bytes_max = (size_t)1 << 30;

enum { LINE_MAX_BYTES = 160 };

static int print_entry(char line[static LINE_MAX_BYTES], const struct dump_entry *entry)
{
    return snprintf(line, LINE_MAX_BYTES, "%06" PRIu32 ",%.17g,%" PRIu64 ",%" PRIu32 ",%" PRIu32
                    "\n", entry->frame, entry->time, entry->steps, entry->grains, entry->contacts);
}

/* Takes a last line without its end away, so that the next one does not run into it. */
static bool mend(const char *path, struct error *error)
{
    FILE *stream = fopen(path, "rb");
    if (!stream) return true;
    const bool torn = fseek(stream, -1, SEEK_END) == 0 && fgetc(stream) != '\n';
    fclose(stream);
    struct dump_index index;
    if (!torn) return true;
    if (!dump_index_load(path, &index, error)) return false;
    const bool done = dump_index_save(path, &index, error);
    dump_index_free(&index);
    return done;
}

bool dump_index_append(const char *path, const struct dump_entry *entry, struct error *error)
{
    char text[sizeof header + LINE_MAX_BYTES];
    if (!mend(path, error)) return false;
    const int file = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0) return error_set(error, "%s: cannot write this file: %s", path, strerror(errno));
    const off_t end = lseek(file, 0, SEEK_END);
    const int first = end == 0 ? snprintf(text, sizeof text, "%s", header) : 0;
    const int size = first + print_entry(text + first, entry);
    errno = 0;
    bool done = end >= 0 && write(file, text, (size_t)size) == size && fsync(file) == 0;
    const int cause = errno;
    if (!done && end >= 0 && ftruncate(file, end) != 0) done = false;   /* mend() will see to it */
    done = close(file) == 0 && done;
    return done || error_set(error, "%s: writing stopped: %s", path,
                             cause ? strerror(cause) : "is the disk full?");
}

bool dump_index_save(const char *path, const struct dump_index *index, struct error *error)
{
    struct file file;
    if (!file_begin(&file, path, error)) return false;
    fputs(header, file.stream);
    for (uint32_t k = 0; k < index->count; k++) {
        char line[LINE_MAX_BYTES];
        print_entry(line, &index->entries[k]);
        fputs(line, file.stream);
    }
    return file_commit(&file, error);
}

static bool reserve_entry(struct dump_index *index)
{
    if (index->count < index->capacity) return true;
    const uint32_t capacity = index->capacity ? 2 * index->capacity : 64;
    struct dump_entry *entries = realloc(index->entries, capacity * sizeof *entries);
    if (!entries) return false;
    index->entries = entries;
    index->capacity = capacity;
    return true;
}

static bool parse_entry(const char *line, struct dump_entry *entry)
{
    int used = 0;
    const int found = sscanf(line, "%" SCNu32 ",%lf,%" SCNu64 ",%" SCNu32 ",%" SCNu32 "%n",
                             &entry->frame, &entry->time, &entry->steps, &entry->grains,
                             &entry->contacts, &used);
    return found == 5 && line[used] == 0 && isfinite(entry->time);
}

static bool parse_lines(const char *path, char *text, struct dump_index *index,
                        struct error *error)
{
    if (strncmp(text, header, sizeof header - 1) != 0) {
        return error_set(error, "%s: not the index of a dump: its first line must be %s", path,
                         "frame,time,steps,grains,contacts");
    }
    char *line = text + sizeof header - 1, *end;
    for (uint32_t number = 2; (end = strchr(line, '\n')) != NULL; line = end + 1, number++) {
        struct dump_entry entry;
        *end = 0;
        if (!parse_entry(line, &entry)) {
            return error_set(error, "%s:%u: not a frame of a dump: '%.60s'; delete the line", path,
                             number, line);
        }
        if (!reserve_entry(index)) return error_set(error, "%s: not enough memory", path);
        index->entries[index->count++] = entry;
    }
    return true;
}

bool dump_index_load(const char *path, struct dump_index *index, struct error *error)
{
    size_t size = 0;
    *index = (struct dump_index){0};
    char *text = file_load(path, bytes_max, &size, error);
    if (!text) return false;
    const bool done = parse_lines(path, text, index, error);
    free(text);
    if (!done) dump_index_free(index);
    return done;
}

const struct dump_entry *dump_index_nearest(const struct dump_index *index, double time)
{
    const struct dump_entry *nearest = NULL;
    for (uint32_t k = 0; k < index->count; k++) {
        const struct dump_entry *entry = &index->entries[k];
        if (!nearest || fabs(entry->time - time) < fabs(nearest->time - time)) nearest = entry;
    }
    return nearest;
}

void dump_index_free(struct dump_index *index)
{
    free(index->entries);
    *index = (struct dump_index){0};
}
