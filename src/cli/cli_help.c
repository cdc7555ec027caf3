/* cli_help.c - `help [COMMAND|KEY]`, from the tables that also do the parsing.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void help_all(void)
{
    printf("sandreel - simulates two-dimensional granular matter and draws it without a display\n\n"
           "usage: sandreel COMMAND [OPTIONS] SCENE|RUN\n\n"
           "SCENE is a scene file or the name of a built-in scene; RUN a directory that `run` "
           "wrote.\n\n");
    for (const struct command *c = cli_commands; c->name; c++) {
        printf("  %-9s %-14s %s\n", c->name, c->operands, c->summary);
    }
    printf("\nTry: sandreel run hourglass --quick\n"
           "     sandreel help run      its options\n"
           "     sandreel help keys     what a scene file may say\n"
           "Models:\n");
    for (const struct model *const *m = model_list; *m; m++) {
        printf("  %-6s %s\n", (*m)->name, (*m)->summary);
    }
}

static void help_command(const struct command *command)
{
    printf("usage: sandreel %s [OPTIONS] %s\n\n%s\n", command->name, command->operands,
           command->summary);
    if (*command->details) printf("\n%s", command->details);
    printf("\n");
    for (const uint8_t *id = command->accepts; *id != OPTION_COUNT; id++) {
        const struct option_row *row = &options_table[*id];
        char left[64], letter[8] = "    ";
        if (row->letter) snprintf(letter, sizeof letter, "-%c, ", row->letter);
        const bool optional = row->form == FORM_OPTIONAL;
        snprintf(left, sizeof left, "%s--%s%s%s%s", letter, row->name,
                 optional ? "[=" : row->value ? " " : "", row->value ? row->value : "",
                 optional ? "]" : "");
        printf("  %-26s %s\n", left, row->doc);
    }
}

static void help_key(const struct key_group *group, const struct key *key, bool all)
{
    char limits[300] = "", name[160];
    key_limits(key, limits, sizeof limits);
    snprintf(name, sizeof name, "%s%s%s", group->name, *group->name ? "." : "", key->name);
    printf("%s%s%s\n", all ? "  " : "", name, all ? "" : "");
    printf("      %s\n      %s%s%s", key->doc, key_type_word(key->type), *limits ? ", " : "",
           limits);
    if (key->unit && *key->unit && strcmp(key->unit, "1") != 0) printf(" [%s]", key->unit);
    if (!key->fallback) printf("; must be given\n");
    else if (strcmp(key->fallback, "nan") == 0) printf("; chosen when absent\n");
    else if (!*key->fallback) printf("; default: none\n");
    else printf("; default: %s\n", key->fallback);
}

static void help_group(const struct key_group *group)
{
    printf("%s - %s\n", *group->name ? group->name : "(top level)", group->doc);
    for (uint32_t k = 0; k < group->count; k++) help_key(group, &group->keys[k], true);
}

/* "grains.[0].restitution" and "grains.restitution" alike: group and key, by their names. */
static bool help_path(const char *word)
{
    char head[64];
    const char *tail = strrchr(word, '.');
    snprintf(head, sizeof head, "%.*s", (int)strcspn(word, "."), word);
    bool found = false;
    const struct key_group *group;
    for (uint32_t index = 0; (group = opening_key_group(index)); index++) {
        const struct key *key = NULL;
        if (tail && strcmp(group->name, head) == 0) key = key_find(group, tail + 1);
        if (!tail && strcmp(group->name, word) == 0) {
            help_group(group);
            return true;
        }
        if (!tail) key = key_find(group, word);
        if (!key) continue;
        help_key(group, key, false);
        found = true;
    }
    return found;
}

static int unknown(const char *word)
{
    const char *tail = strrchr(word, '.'), *last = tail ? tail + 1 : word;
    const char *names[600];
    size_t count = 0;
    for (const struct command *c = cli_commands; c->name; c++) names[count++] = c->name;
    const struct key_group *group;
    for (uint32_t index = 0; (group = opening_key_group(index)); index++) {
        if (*group->name && count < 599) names[count++] = group->name;
        for (uint32_t k = 0; k < group->count && count < 599; k++) {
            names[count++] = group->keys[k].name;
        }
    }
    names[count] = NULL;
    const char *nearest = options_nearest(last, names);
    fprintf(stderr, "sandreel: help: neither a command nor a key: '%s'", word);
    if (nearest) fprintf(stderr, "; did you mean '%s'?\n", nearest);
    else fprintf(stderr, "; `sandreel help` and `sandreel help keys` list them\n");
    return EXIT_USAGE;
}

int cli_help(const struct options *options)
{
    const char *word = options->operand_count ? options->operands[0] : NULL;
    if (!word) {
        help_all();
        return EXIT_DONE;
    }
    for (const struct command *c = cli_commands; c->name; c++) {
        if (strcmp(c->name, word) != 0) continue;
        help_command(c);
        return EXIT_DONE;
    }
    if (strcmp(word, "keys") == 0) {
        const struct key_group *group;
        for (uint32_t index = 0; (group = opening_key_group(index)); index++) help_group(group);
        return EXIT_DONE;
    }
    return help_path(word) ? EXIT_DONE : unknown(word);
}
