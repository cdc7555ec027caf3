/* program.c - see program.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/program.h"

#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

bool program_is_there(const char *name)
{
    const char *path = getenv("PATH");
    while (path && *path) {
        const size_t length = strcspn(path, ":");
        char full[FILE_PATH_MAX];
        snprintf(full, sizeof full, "%.*s/%s", (int)length, path, name);
        if (length > 0 && access(full, X_OK) == 0) return true;
        path += length + (path[length] == ':');
    }
    return false;
}

/* In the child: becomes the program.  Only async-signal-safe calls until exec. */
static void become(const char *directory, int input, int complaints, char *const *arguments)
{
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);   /* whose run is killed, its film is of no use */
    signal(SIGPIPE, SIG_DFL);
    const int nothing = open("/dev/null", O_WRONLY);
    dup2(input, STDIN_FILENO);
    dup2(nothing, STDOUT_FILENO);
    dup2(complaints, STDERR_FILENO);
    if (!directory || chdir(directory) == 0) execvp(arguments[0], arguments);
    _exit(127);
}

bool program_start(struct program *program, const char *const *arguments, const char *directory,
                   struct error *error)
{
    *program = (struct program){.pipe = -1, .complaints = tmpfile()};
    if (!program->complaints) {
        return error_set(error, "cannot make a temporary file: %s", strerror(errno));
    }
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return error_set(error, "no pipe: %s", strerror(errno));
    program->process = fork();
    if (program->process == 0) {
        become(directory, ends[0], fileno(program->complaints),
               (char *const *)(uintptr_t)arguments);
    }
    close(ends[0]);
    program->pipe = ends[1];
    if (program->process > 0) return true;
    program->process = 0;
    return error_set(error, "cannot start %s: %s", arguments[0], strerror(errno));
}

/* After a signal the program has so long to read on; it needs milliseconds unless it hangs. */
enum { PATIENCE_MS = 3000 };

/* A signal while the program hangs gives it up: whoever asked for the end must not wait forever.
 * Only a signal lets write() to a pipe return before all is written. */
bool program_send(struct program *program, const void *bytes, size_t size)
{
    const char *at = bytes;
    while (size > 0 && !program->hangs) {
        const ssize_t sent = write(program->pipe, at, size);
        if (sent < 0 && errno != EINTR) return false;
        if (sent > 0) {
            at += sent;
            size -= (size_t)sent;
        }
        struct pollfd room = {.fd = program->pipe, .events = POLLOUT};
        if (size > 0) program->hangs = poll(&room, 1, PATIENCE_MS) == 0;
    }
    return true;
}

bool program_finish(struct program *program)
{
    if (program->pipe >= 0) close(program->pipe);
    program->pipe = -1;
    if (program->process <= 0) return false;
    int status = 0;
    pid_t ended;
    do ended = waitpid(program->process, &status, 0);
    while (ended < 0 && errno == EINTR);
    program->process = 0;
    return ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool program_poll(struct program *program, int *status)
{
    if (waitpid(program->process, status, WNOHANG) != program->process) return false;
    program->process = 0;
    return true;
}

void program_stop(struct program *program)
{
    if (program->process <= 0) return;
    kill(program->process, program->hangs ? SIGKILL : SIGTERM);
    program_finish(program);
}

void program_words(struct program *program, char *words, size_t size)
{
    rewind(program->complaints);
    words[fread(words, 1, size - 1, program->complaints)] = 0;
    for (char *at = words; *at; at++) if (*at == '\n' || *at == '\r') *at = ' ';
}

void program_close(struct program *program)
{
    if (program->pipe >= 0) close(program->pipe);
    if (program->complaints) fclose(program->complaints);
    *program = (struct program){.pipe = -1};
}
