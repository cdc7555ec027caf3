/* main.c - finds the command, parses its options, carries it out.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

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

int main(int count, char **arguments)
{
    signal(SIGPIPE, SIG_IGN);           /* a reader that ends early is an error like any other */
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
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    fprintf(stderr, "sandreel: standard output could not be written\n");
    return code ? code : EXIT_FAILED;
}
