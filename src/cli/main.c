/* main.c - finds the command, parses its options, carries it out.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/jsontext.h"

#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int unknown_command(const char *word)
{
    enum { NAMES_MAX = 64 };
    const char *names[NAMES_MAX];
    size_t count = 0;
    for (const struct command *c = cli_commands; c->name && count < NAMES_MAX - 1; c++) {
        names[count++] = c->name;
    }
    names[count] = NULL;
    const char *nearest = options_nearest(word, names);
    fprintf(stderr, "sandreel: unknown command '%s'", word);
    if (nearest) fprintf(stderr, "; did you mean '%s'?\n", nearest);
    else fprintf(stderr, "; `sandreel help` lists them\n");
    return EXIT_USAGE;
}

/* Threads that wait for each other should sleep.  By default they spin, and where other programs
 * want the processors too, they spin for one that is not running: 10,000 grains on two threads
 * took 21 s in place of 0.6 s.  OpenMP reads its policy before main() begins, so the program starts
 * itself once more, unless its user has chosen; where that fails it goes on as it is. */
static void let_waiting_threads_sleep(char **arguments)
{
    char program[4096];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (getenv("OMP_WAIT_POLICY") || getenv("GOMP_SPINCOUNT") || length <= 0) return;
    program[length] = 0;
    if (setenv("OMP_WAIT_POLICY", "passive", 1) == 0) execv(program, arguments);
}

/* Whoever reads our output has seen enough: `sandreel scenes | head`. */
static bool output_is_unwanted(void)
{
    struct pollfd output = {.fd = STDOUT_FILENO, .events = POLLOUT};
    return poll(&output, 1, 0) == 1 && output.revents & POLLERR;
}

/* A run goes on when nobody reads what it says, and its own exit code comes first.  Else the end is
 * that of every program whose reader left, without a word: by SIGPIPE, which shells call 141. */
static int end(int code)
{
    if (code == EXIT_DONE && jsontext_failed()) {
        fprintf(stderr, "sandreel: not enough memory for all that was to be told\n");
        code = EXIT_FAILED;
    }
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    if (output_is_unwanted()) {
        if (code) return code;
        signal(SIGPIPE, SIG_DFL);
        raise(SIGPIPE);
    }
    fprintf(stderr, "sandreel: standard output could not be written\n");
    return code ? code : EXIT_FAILED;
}

int main(int count, char **arguments)
{
    let_waiting_threads_sleep(arguments);
    jsontext_guard();
    signal(SIGPIPE, SIG_IGN);           /* a reader that ends early ends no run */
    signal(SIGXFSZ, SIG_IGN);           /* and so is a file that grows too large */
    const char *word = count > 1 ? arguments[1] : "help";
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) word = "help";
    if (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0) word = "version";
    const struct command *command = cli_commands;
    while (command->name && strcmp(command->name, word) != 0) command++;
    if (!command->name) return unknown_command(word);
    struct options options;
    struct error error = {0};
    int code;
    if (!options_parse(&options, command, count > 2 ? count - 2 : 0, arguments + 2, &error)) {
        code = opening_fail(&error);
    } else if (options_given(&options, OPTION_help)) {
        options.operands[0] = command->name;
        options.operand_count = 1;
        code = cli_help(&options);
    } else {
        code = command->carry_out(&options);
    }
    options_free(&options);
    return end(code);
}
