/* cli_completion.c - `completion bash|zsh|fish`: commands, options and the words that an option
 * knows, from the tables that also do the parsing.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "base/asset.h"
#include "run/exporter.h"

#include <stdio.h>
#include <string.h>

/* "a|b|c" becomes "a b c". */
static void print_choices(const char *choices)
{
    for (const char *at = choices; *at; at++) putchar(*at == '|' ? ' ' : *at);
}

/* The key that an option sets; NULL if it sets none. */
static const struct key *key_of(const struct option_row *row)
{
    const struct key_group *group;
    if (!row->key) return NULL;
    const char *dot = strchr(row->key, '.');
    const size_t length = dot ? (size_t)(dot - row->key) : 0;
    for (uint32_t index = 0; (group = opening_key_group(index)); index++) {
        if (strlen(group->name) == length && memcmp(group->name, row->key, length) == 0) {
            return key_find(group, dot ? dot + 1 : row->key);
        }
    }
    return NULL;
}

static void print_models(void)
{
    for (const struct model *const *m = model_list; *m; m++) {
        printf("%s%s", m == model_list ? "" : " ", (*m)->name);
    }
}

static void print_methods(void)
{
    const char *space = "";
    for (const struct model *const *m = model_list; *m; m++) {
        const struct key_group *group = (*m)->settings;
        for (uint32_t k = 0; group && k < group->count; k++) {
            if (!group->keys[k].choices) continue;
            fputs(space, stdout);
            print_choices(group->keys[k].choices);
            space = " ";
        }
    }
}

static const char map_words[] =
#define X(name, components, dimension, label) #name " "
    MAPS(X)
#undef X
    "";

/* The words that an option's value may be, with a blank between; nothing if it may be anything. */
static void print_words(int id)
{
    const struct key *key = key_of(&options_table[id]);
    switch (id) {
    case OPTION_model: print_models(); break;
    case OPTION_method: print_methods(); break;
    case OPTION_progress: fputs("auto bar plain none", stdout); break;
    case OPTION_map:
    case OPTION_field: fputs(map_words, stdout); break;
    case OPTION_to:
#define X(name, file, writer, doc) fputs(#name " ", stdout);
        EXPORTER_FORMATS(X)
#undef X
        break;
    case OPTION_as:
#define X(name, doc) fputs(#name " ", stdout);
        MAPPER_FORMATS(X)
#undef X
        break;
    case OPTION_set:
    case OPTION_vary: {
        const struct key_group *group;
        for (uint32_t index = 0; (group = opening_key_group(index)); index++) {
            for (uint32_t k = 0; k < group->count; k++) {
                printf("%s%s%s= ", group->name, *group->name ? "." : "", group->keys[k].name);
            }
        }
        break;
    }
    default:
        if (key && key->choices) print_choices(key->choices);
    }
}

static bool has_words(int id)
{
    const struct key *key = key_of(&options_table[id]);
    return (key && key->choices) || id == OPTION_model || id == OPTION_method || id == OPTION_set
        || id == OPTION_vary || id == OPTION_progress || id == OPTION_to || id == OPTION_as
        || id == OPTION_map || id == OPTION_field;
}

/* What comes where no option is. */
static void print_operands(const struct command *command)
{
    static const char folder[] = "scenes/";
    if (command->carry_out == cli_help) {
        for (const struct command *c = cli_commands; c->name; c++) printf("%s ", c->name);
        const struct key_group *group;
        for (uint32_t index = 0; (group = opening_key_group(index)); index++) {
            printf("%s ", group->name);
        }
    } else if (command->carry_out == cli_completion) {
        fputs("bash zsh fish", stdout);
    } else if (strstr(command->operands, "SCENE")) {
        for (const struct asset *asset = asset_list; asset->name; asset++) {
            const char *name = asset->name + sizeof folder - 1, *end = strstr(name, ".cfg");
            if (strncmp(asset->name, folder, sizeof folder - 1) != 0 || !end) continue;
            printf("%.*s ", (int)(end - name), name);
        }
    }
}

/* ---- bash ---------------------------------------------------------------------------------- */

static void write_bash(void)
{
    printf("# sandreel - completion for bash\n"
           "_sandreel() {\n"
           "    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} words=\n"
           "    if [ \"$COMP_CWORD\" = 1 ]; then words='");
    for (const struct command *c = cli_commands; c->name; c++) printf("%s ", c->name);
    printf("'\n    else case ${COMP_WORDS[1]}:$prev in\n");
    for (const struct command *c = cli_commands; c->name; c++) {
        for (const uint8_t *id = c->accepts; *id != OPTION_COUNT; id++) {
            const struct option_row *row = &options_table[*id];
            if (!row->value) continue;
            printf("    %s:--%s", c->name, row->name);
            if (row->letter) printf("|%s:-%c", c->name, row->letter);
            printf(") words='");
            print_words(*id);
            printf("'%s;;\n", *id == OPTION_set || *id == OPTION_vary ? "; compopt -o nospace "
                                                                      : " ");
        }
        printf("    %s:*) case $cur in\n        -*) words='", c->name);
        for (const uint8_t *id = c->accepts; *id != OPTION_COUNT; id++) {
            printf("--%s ", options_table[*id].name);
        }
        printf("' ;;\n        *) words='");
        print_operands(c);
        printf("' ;;\n        esac ;;\n");
    }
    printf("    esac; fi\n"
           "    COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
           "}\n"
           "complete -o default -F _sandreel sandreel\n");
}

/* ---- zsh ----------------------------------------------------------------------------------- */

/* Text within single quotes and _arguments' brackets and colons. */
static void print_quoted(const char *text)
{
    for (; *text; text++) {
        if (*text == '\'') fputs("'\\''", stdout);
        else if (strchr("[]:\\", *text)) printf("\\%c", *text);
        else putchar(*text);
    }
}

static void write_zsh_option(int id)
{
    const struct option_row *row = &options_table[id];
    for (int form = row->letter ? 0 : 1; form < 2; form++) {
        const bool many = id == OPTION_set || id == OPTION_vary;
        printf(" \\\n            '%s", many ? "*" : "");
        if (form == 0) printf("-%c", row->letter);
        else printf("--%s", row->name);
        putchar('[');
        print_quoted(row->doc);
        putchar(']');
        if (row->value) {
            putchar(':');
            print_quoted(row->value);
            putchar(':');
            if (has_words(id)) {
                putchar('(');
                print_words(id);
                putchar(')');
            } else if (id == OPTION_output) {
                fputs("_files", stdout);
            }
        }
        putchar('\'');
    }
}

static void write_zsh(void)
{
    printf("#compdef sandreel\n"
           "# sandreel - completion for zsh\n"
           "_sandreel() {\n"
           "    local -a commands\n"
           "    commands=(\n");
    for (const struct command *c = cli_commands; c->name; c++) {
        printf("        '%s:", c->name);
        print_quoted(c->summary);
        printf("'\n");
    }
    printf("    )\n"
           "    if (( CURRENT == 2 )); then\n"
           "        _describe command commands\n"
           "        return\n"
           "    fi\n"
           "    local command=$words[2]\n"
           "    shift words; (( CURRENT-- ))\n"
           "    case $command in\n");
    for (const struct command *c = cli_commands; c->name; c++) {
        printf("    %s)\n        _arguments", c->name);
        for (const uint8_t *id = c->accepts; *id != OPTION_COUNT; id++) write_zsh_option(*id);
        printf(" \\\n            '*:operand:{compadd -- ");
        print_operands(c);
        printf("; _files}'\n        ;;\n");
    }
    printf("    esac\n}\n"
           "if [ \"$funcstack[1]\" = _sandreel ]; then _sandreel \"$@\"; else compdef _sandreel "
           "sandreel; fi\n");
}

/* ---- fish ---------------------------------------------------------------------------------- */

static void print_fish(const char *text)
{
    putchar('\'');
    for (; *text; text++) {
        if (*text == '\'' || *text == '\\') putchar('\\');
        putchar(*text);
    }
    putchar('\'');
}

static void write_fish(void)
{
    printf("# sandreel - completion for fish\n");
    for (const struct command *c = cli_commands; c->name; c++) {
        printf("complete -c sandreel -n __fish_use_subcommand -f -a %s -d ", c->name);
        print_fish(c->summary);
        printf("\ncomplete -c sandreel -n '__fish_seen_subcommand_from %s' -a '", c->name);
        print_operands(c);
        printf("'\n");
        for (const uint8_t *id = c->accepts; *id != OPTION_COUNT; id++) {
            const struct option_row *row = &options_table[*id];
            printf("complete -c sandreel -n '__fish_seen_subcommand_from %s' -l %s", c->name,
                   row->name);
            if (row->letter) printf(" -s %c", row->letter);
            if (row->value) printf(*id == OPTION_output ? " -r" : " -x");
            if (has_words(*id)) {
                printf(" -a '");
                print_words(*id);
                putchar('\'');
            }
            printf(" -d ");
            print_fish(row->doc);
            putchar('\n');
        }
    }
}

int cli_completion(const struct options *options)
{
    static const struct { const char *name; void (*write)(void); } shells[] = {
        {"bash", write_bash}, {"zsh", write_zsh}, {"fish", write_fish},
    };
    for (size_t k = 0; k < sizeof shells / sizeof *shells; k++) {
        if (strcmp(options->operands[0], shells[k].name) != 0) continue;
        shells[k].write();
        return EXIT_DONE;
    }
    fprintf(stderr, "sandreel: completion %s: bash, zsh or fish\n", options->operands[0]);
    return EXIT_USAGE;
}
