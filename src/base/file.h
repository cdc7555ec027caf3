/* file.h - files that appear whole or not at all.
 *
 * A file is written beside its final name, synced and renamed; until file_commit() nobody sees
 * it, and file_abandon() leaves no trace.  The stream remembers its first failure, so a long list
 * of writes is checked once, at the end.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FILE_H
#define FILE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { FILE_PATH_MAX = 4096 };

struct file {
    FILE *stream;               /* for fprintf and friends */
    char  path[FILE_PATH_MAX];      /* the final name */
    char  partial[FILE_PATH_MAX + 16];  /* the name until it is whole */
};

/* Opens `path` for writing.  False with a sentence if the directory is not there or not
 * writable. */
bool file_begin(struct file *file, const char *path, struct error *error);

/* Flushes, syncs and renames.  False (and no file) if any write failed, as on a full disk. */
bool file_commit(struct file *file, struct error *error);

/* Closes and removes the unfinished file; harmless after a commit. */
void file_abandon(struct file *file);

/* Writes `size` bytes as one whole file. */
bool file_save(const char *path, const void *bytes, size_t size, struct error *error);

/* Reads a whole file into malloc'ed memory with a zero byte behind the last; the caller frees.
 * Refuses more than `size_max` bytes. */
void *file_load(const char *path, size_t size_max, size_t *size, struct error *error);

bool file_exists(const char *path);

/* True if there is no such file yet; else EXIT_USAGE, with --force and -o as the cure. */
bool file_absent(const char *path, struct error *error);

/* Brings a file that another program or a library wrote, or the names in a directory, to the disk.
 * False if it is not there, or the disk is full or broken. */
bool file_sync(const char *path);

/* Makes the directory and its parents; true if it is there already. */
bool file_make_directory(const char *path, struct error *error);

#endif
