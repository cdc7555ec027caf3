/* progress.h - one line on a terminal that is written over, plain lines elsewhere; on stderr.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PROGRESS_H
#define PROGRESS_H

#include "run/run.h"

enum progress_how { PROGRESS_AUTO, PROGRESS_BAR, PROGRESS_PLAIN, PROGRESS_NONE };

struct progress {
    enum progress_how how;      /* after progress_begin: never AUTO */
    bool   color;
    double shown;               /* wall time of the last line; 0: none yet */
    bool   line_open;           /* the terminal's line must be ended before other text */
};

/* `word` is auto, bar, plain, none or NULL (auto); false if it is none of these. */
bool progress_begin(struct progress *progress, const char *word, struct error *error);

void progress_show(struct progress *progress, const struct run_status *status);

/* Ends the open line. */
void progress_end(struct progress *progress);

#endif
