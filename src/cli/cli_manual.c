/* cli_manual.c - `manual [keys]`: the manual pages as scdoc text, from the tables that also do the
 * parsing; the build turns them into sandreel(1) and sandreel-scene(5).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Text in which scdoc's own marks stand for themselves. */
static void print_plain(const char *text)
{
    for (const char *at = text; *at; at++) {
        const bool begins = at == text || at[-1] == '\n';
        if (begins) at += strspn(at, " ");      /* scdoc indents by tabs alone */
        if (!*at) break;
        if (strchr("\\_*~`<>", *at) || (begins && strchr("#-|[]!:.", *at))) putchar('\\');
        putchar(*at);
    }
}

static void print_option(const struct option_row *row)
{
    putchar('*');
    if (row->letter) printf("-%c*, *", row->letter);
    print_plain("--");
    print_plain(row->name);
    putchar('*');
    if (row->value) {
        fputs(" _", stdout);
        for (const char *at = row->value; *at; at++) {
            if (strchr("\\_*~", *at)) putchar('\\');
            putchar(*at);
        }
        putchar('_');
    }
    printf("\n\t");
    print_plain(row->doc);
    printf("\n\n");
}

static void write_command(const struct command *command)
{
    /* In a heading scdoc takes every character for itself. */
    printf("## sandreel %s [OPTIONS] %s\n\n", command->name, command->operands);
    print_plain(command->summary);
    printf(".\n");
    if (*command->details) {
        putchar('\n');
        print_plain(command->details);
    }
    printf("\n");
    for (const uint8_t *id = command->accepts; *id != OPTION_COUNT; id++) {
        print_option(&options_table[*id]);
    }
}

static void write_commands(void)
{
    printf("sandreel(1) \"\" \"sandreel\"\n\n# NAME\n\n"
           "sandreel - simulates two-dimensional granular matter and draws it without a display\n\n"
           "# SYNOPSIS\n\n*sandreel* _COMMAND_ [OPTIONS] _SCENE_|_RUN_\n\n# DESCRIPTION\n\n"
           "_SCENE_ is a scene file (*sandreel-scene*(5)) or the name of a built-in scene; _RUN_ a "
           "directory that *sandreel run* wrote.  No option is needed for a good first result.  "
           "Results go to files and standard output, progress and warnings to standard error.\n\n"
           "Models:\n\n");
    for (const struct model *const *m = model_list; *m; m++) {
        printf("*%s*\n\t", (*m)->name);
        print_plain((*m)->summary);
        printf("\n\n");
    }
    printf("# COMMANDS\n\n");
    for (const struct command *c = cli_commands; c->name; c++) write_command(c);
    printf("# EXIT STATUS\n\n"
           "*0* done++\n*1* failed while running++\n*2* wrong use of the command line++\n"
           "*3* the scene is invalid++\n*4* a comparison or verdict failed++\n"
           "*5* stopped early on purpose, checkpoint kept++\n"
           "*130*, *143* a signal; a checkpoint was written first++\n"
           "*141* the reader of the output left before its end\n\n"
           "# ENVIRONMENT\n\n"
           "*SANDREEL\\_GL*\n\tosmesa or egl: the renderer\n\n"
           "*OMP\\_NUM\\_THREADS*\n\tthreads, where -j does not say\n\n"
           "*NO\\_COLOR*\n\ttakes the colour out of the progress line\n\n"
           "# EXAMPLES\n\n"
           "sandreel run hourglass --quick\n\n"
           "sandreel movie silo --model md,lga --side-by-side -o silo.mp4\n\n"
           "sandreel sweep heap --vary grains.friction=0.1:0.9:0.2 --repeats 3\n\n"
           "# SEE ALSO\n\n*sandreel-scene*(5)\n");
}

static void write_key(const struct key *key)
{
    char limits[300] = "";
    putchar('*');
    print_plain(key->name);
    printf("*\n\t");
    print_plain(key->doc);
    printf("++\n");
    print_plain(key_type_word(key->type));
    if (*key_limits(key, limits, sizeof limits)) {
        printf(", ");
        print_plain(limits);
    }
    if (key->unit && *key->unit && strcmp(key->unit, "1") != 0) {
        printf(" \\[");
        print_plain(key->unit);
        printf("\\]");
    }
    if (!key->fallback) printf("; must be given");
    else if (strcmp(key->fallback, "nan") == 0) printf("; chosen when absent");
    else if (*key->fallback) {
        printf("; default: ");
        print_plain(key->fallback);
    }
    printf("\n\n");
}

static void write_keys(void)
{
    printf("sandreel-scene(5) \"\" \"sandreel\"\n\n# NAME\n\n"
           "sandreel-scene - the files that say what sandreel simulates\n\n# DESCRIPTION\n\n"
           "A scene is a libconfig file: _key_ = _value_; with groups in braces and lists in "
           "parentheses.  What it does not mention does not exist.  *sandreel check* tells "
           "everything that is wrong with it; *sandreel run -s KEY=VALUE* sets any key.\n\n");
    const struct key_group *group;
    for (uint32_t index = 0; (group = opening_key_group(index)); index++) {
        printf("# ");
        for (const char *at = *group->name ? group->name : "top level"; *at; at++) {
            putchar(*at >= 'a' && *at <= 'z' ? *at - 'a' + 'A' : *at);
        }
        printf("\n\n");
        print_plain(group->doc);
        printf("\n\n");
        for (uint32_t k = 0; k < group->count; k++) write_key(&group->keys[k]);
    }
    printf("# SEE ALSO\n\n*sandreel*(1)\n");
}

int cli_manual(const struct options *options)
{
    const char *what = options->operand_count ? options->operands[0] : "";
    if (strcmp(what, "keys") == 0) {
        write_keys();
    } else if (!*what) {
        write_commands();
    } else {
        fprintf(stderr, "sandreel: manual %s: nothing, or keys\n", what);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}
