/* cli_live.c - `live SCENE|RUN`: a simulation that is watched and steered while it runs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "live/conduct.h"

#include <stdio.h>
#include <stdlib.h>

static void tell(void *context, const char *line, const char *reply, bool failed)
{
    (void)context;
    if (failed) fprintf(stderr, "%s\n", reply);
    else if (reply[0]) printf("%s\n", reply);
    (void)line;
}

static bool carry_out(const struct options *options, struct session *session, struct error *error)
{
    const struct conduct_file file = {.path = options->values[OPTION_commands], .tell = tell,
                                      .signal = &opening_signal};
    if (file.path) return conduct_file(session, &file, error);
    return error_set_code(error, EXIT_USAGE, "live needs --commands FILE here");
}

int cli_live(const struct options *options)
{
    struct error error = {0};
    struct session *session = calloc(1, sizeof *session);
    if (!session || opening_threads(options, &error) == 0) {
        if (!session) error_set(&error, "not enough memory for a session");
        free(session);
        return opening_fail(&error);
    }
    const struct session_request request = {
        .path = options->operands[0], .overrides = options->overrides,
        .override_count = options->override_count, .directory = options->values[OPTION_output],
        .force = options_given(options, OPTION_force),
    };
    opening_catch_signals();
    bool done = session_open(session, &request, &error);
    char directory[FILE_PATH_MAX];
    snprintf(directory, sizeof directory, "%s", session->directory);
    done = done && carry_out(options, session, &error);
    struct error minor = {0};
    done = session_close(session, done ? &error : &minor) && done;
    free(session);
    if (!done) return opening_fail(&error);
    printf("%s\n", directory);
    return EXIT_DONE;
}
