/* ledger.h - a table that grows row by row while a run goes, and can be cut back.
 *
 * Rows are flushed when they are whole, so the file can be watched while it grows.  A checkpoint
 * remembers its size; after one is loaded the file is cut back to what the checkpoint knew.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LEDGER_H
#define LEDGER_H

#include "base/archive.h"
#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct ledger {
    FILE    *stream;            /* for fprintf; NULL: none */
    char     path[4096];
    uint64_t size, rows;        /* bytes and rows that are safely written */
    bool     failed;            /* a half row may be in the file: closing cuts it off */
};

/* Creates the file, or opens it for `ledger_resume`. */
bool ledger_open(struct ledger *ledger, const char *path, bool resume, struct error *error);

/* What was written since the last call is whole. */
bool ledger_flush(struct ledger *ledger, struct error *error);

/* Cuts the file back to what the loaded archive knew. */
bool ledger_resume(struct ledger *ledger, struct error *error);

/* Brings the file to the disk, before a checkpoint refers to it. */
bool ledger_sync(struct ledger *ledger, struct error *error);

/* `name` is unique within the archive and short. */
void ledger_archive(struct ledger *ledger, const char *name, struct archive *archive);
void ledger_close(struct ledger *ledger);

#endif
