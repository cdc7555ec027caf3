/* folder.h - the directory of a run: where everything lies, and who may write there.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef FOLDER_H
#define FOLDER_H

#include "base/error.h"
#include "base/file.h"

#include <stdint.h>

/* Joins `directory` and a printf'ed name into `path`; returns path. */
char *folder_path(char path[FILE_PATH_MAX], const char *directory, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* "NAME-MODEL", or with "-2", "-3", ... behind when that is taken. */
void folder_choose(char path[FILE_PATH_MAX], const char *name, const char *model);

/* Makes the directory.  One that is there and not empty is refused unless `force`; then what a
 * former run left in it (and nothing else) is removed. */
bool folder_claim(const char *directory, bool force, struct error *error);

/* For a run that goes on: removes the unfinished files of a run that was killed.  False if the
 * directory holds neither a run nor the beginning of one. */
bool folder_reclaim(const char *directory, struct error *error);

/* Is there nothing in the directory but `name`, or not even that? */
bool folder_holds_only(const char *directory, const char *name);

/* Removes the files of a run from one of its folders, and the folder if nothing is left. */
void folder_clear(const char *directory, const char *name);

/* Removes directory/name, a file of the run. */
void folder_remove(const char *directory, const char *name);

#endif
