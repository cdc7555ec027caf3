/* cli_replay.c - `replay RUN`: repeats a live session from its log, and says whether it came to
 * the same bytes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "live/journal.h"

#include <inttypes.h>
#include <stdio.h>

int cli_replay(const struct options *options)
{
    struct error error = {0};
    struct journal_result result;
    if (opening_threads(options, &error) == 0) return opening_fail(&error);
    const struct journal_replay replay = {
        .run = options->operands[0], .directory = options->values[OPTION_output],
        .force = options_given(options, OPTION_force),
    };
    if (!journal_replay(&replay, &result, &error)) return opening_fail(&error);
    if (result.compared) {
        fprintf(stderr, "%" PRIu64 " commands, and the same last state, %016" PRIx64 "\n",
                result.lines, result.digest);
    } else {
        fprintf(stderr, "%" PRIu64 " commands; the session was cut off, so its last state is "
                "not known\n", result.lines);
    }
    printf("%s\n", result.directory);
    return EXIT_DONE;
}
