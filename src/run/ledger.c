/* ledger.c - see ledger.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/ledger.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

bool ledger_open(struct ledger *ledger, const char *path, bool resume, struct error *error)
{
    *ledger = (struct ledger){0};
    snprintf(ledger->path, sizeof ledger->path, "%s", path);
    ledger->stream = fopen(path, resume ? "r+b" : "wb");
    return ledger->stream
        || error_set(error, "%s: cannot open this file: %s", path, strerror(errno));
}

bool ledger_flush(struct ledger *ledger, struct error *error)
{
    errno = 0;
    if (fflush(ledger->stream) != 0 || ferror(ledger->stream)) {
        ledger->failed = true;
        return error_set(error, "%s: writing stopped: %s", ledger->path,
                         errno ? strerror(errno) : "is the disk full?");
    }
    const long at = ftell(ledger->stream);
    if (at >= 0) ledger->size = (uint64_t)at;
    return true;
}

bool ledger_resume(struct ledger *ledger, struct error *error)
{
    bool done = fseek(ledger->stream, 0, SEEK_END) == 0;
    const long end = ftell(ledger->stream);
    if (!done || end < 0 || (uint64_t)end < ledger->size) {
        return error_set(error, "%s: shorter than the checkpoint says; it cannot be continued",
                         ledger->path);
    }
    done = ftruncate(fileno(ledger->stream), (off_t)ledger->size) == 0
        && fseek(ledger->stream, (long)ledger->size, SEEK_SET) == 0;
    return done || error_set(error, "%s: cannot be cut back: %s", ledger->path, strerror(errno));
}

bool ledger_sync(struct ledger *ledger, struct error *error)
{
    if (!ledger_flush(ledger, error)) return false;
    return fsync(fileno(ledger->stream)) == 0
        || error_set(error, "%s: writing stopped: %s", ledger->path, strerror(errno));
}

void ledger_archive(struct ledger *ledger, const char *name, struct archive *archive)
{
    char size[48], rows[48];
    snprintf(size, sizeof size, "%s.size", name);
    snprintf(rows, sizeof rows, "%s.rows", name);
    archive_value(archive, size, &ledger->size);
    archive_value(archive, rows, &ledger->rows);
}

void ledger_close(struct ledger *ledger)
{
    if (ledger->stream) fclose(ledger->stream);
    if (ledger->failed && truncate(ledger->path, (off_t)ledger->size) != 0) {
        unlink(ledger->path);           /* better no table than half a row */
    }
    *ledger = (struct ledger){0};
}
