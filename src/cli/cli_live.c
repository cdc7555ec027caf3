/* cli_live.c - `live SCENE|RUN`: a simulation that is watched and steered while it runs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "live/conduct.h"
#include "live/terminal.h"
#include "live/web.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void tell(void *context, const char *line, const char *reply, bool failed)
{
    (void)context;
    if (failed) fprintf(stderr, "%s\n", reply);
    else if (reply[0]) printf("%s\n", reply);
    (void)line;
}

/* Where the page is, also for those who sit elsewhere. */
static void tell_address(const struct web *web)
{
    char host[256] = "HOST";
    gethostname(host, sizeof host - 1);
    printf("%s\n", web_address(web));
    fflush(stdout);
    fprintf(stderr, "from another machine: ssh -L %u:127.0.0.1:%u %s, then the same address\n",
            (unsigned)web_port(web), (unsigned)web_port(web), host);
}

static bool show_web(const struct options *options, struct session *session, struct error *error)
{
    uint64_t port = 0;
    const bool any = options->values[OPTION_web][0] == 0;
    if (!any && !options_whole(options, OPTION_web, 0, &port, error)) return false;
    if (port > UINT16_MAX) {
        return error_set_code(error, EXIT_USAGE, "--web=%s: a port is at most %d",
                              options->values[OPTION_web], UINT16_MAX);
    }
    struct loop *loop = loop_create(session, error);
    struct web *web = loop ? web_open(loop, (uint16_t)port, error) : NULL;
    bool done = web != NULL;
    if (done) {
        tell_address(web);
        done = loop_run(loop, &opening_signal, error);
    }
    web_close(web);
    loop_destroy(loop);
    return done;
}

static bool show_terminal(struct session *session, struct error *error)
{
    struct loop *loop = loop_create(session, error);
    struct terminal *terminal = loop ? terminal_open(loop, error) : NULL;
    const bool done = terminal && loop_run(loop, &opening_signal, error);
    terminal_close(terminal);
    loop_destroy(loop);
    return done;
}

static bool carry_out(const struct options *options, struct session *session, struct error *error)
{
    const struct conduct_file file = {.path = options->values[OPTION_commands], .tell = tell,
                                      .signal = &opening_signal};
    const bool web = options_given(options, OPTION_web);
    if (file.path && !conduct_file(session, &file, error)) return false;
    if (session->ended || (file.path && !web)) return true;
    return web ? show_web(options, session, error) : show_terminal(session, error);
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
