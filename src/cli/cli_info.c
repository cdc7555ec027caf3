/* cli_info.c - `info SCENE|RUN`: a run's manifest, or one grain and its contacts.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/dumps.h"
#include "run/folder.h"
#include "run/portrait.h"
#include "run/recall.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The entry of the dumps that --frame or -t asks for. */
static bool choose_frame(const struct options *options, const struct dumps *dumps, uint32_t *entry,
                         struct error *error)
{
    uint64_t frame;
    double t;
    const uint32_t last = dumps->index.count - 1;
    *entry = last;
    if (options_given(options, OPTION_time)) {
        if (!options_real(options, OPTION_time, 0, &t, error)) return false;
        *entry = dumps_nearest(dumps, t);
    }
    if (!options_whole(options, OPTION_frame, *entry, &frame, error)) return false;
    if (frame > last) {
        return error_set_code(error, EXIT_USAGE, "--frame %llu: the run kept 0 to %u",
                              (unsigned long long)frame, last);
    }
    *entry = (uint32_t)frame;
    return true;
}

static bool choose_grain(const struct options *options, const struct grains *grains, uint32_t *i,
                         struct error *error)
{
    if (grains->count == 0) return error_set(error, "there is no grain in this frame");
    if (options_given(options, OPTION_grain)) {
        uint64_t id;
        if (!options_whole(options, OPTION_grain, 0, &id, error)) return false;
        if (portrait_find(grains, id, i)) return true;
        return error_set_code(error, EXIT_USAGE, "--grain %llu: no grain with this id at t = %.6g "
            "(it has left, or not yet entered)", (unsigned long long)id, grains->time);
    }
    double at[2];
    return options_pair(options, OPTION_at, ',', at, error)
        && portrait_nearest(grains, at[0], at[1], i);
}

/* One line a value, indented by depth; arrays of objects one line an entry. */
static void print_plain(const json_t *value, int depth)
{
    const char *name;
    json_t *entry;
    size_t index;
    json_object_foreach((json_t *)(uintptr_t)value, name, entry) {
        printf("%*s%-*s ", 2 * depth, "", 18 - 2 * depth, name);
        if (json_is_object(entry)) {
            printf("\n");
            print_plain(entry, depth + 1);
            continue;
        }
        if (!json_is_array(entry) || json_array_size(entry) == 0
            || !json_is_object(json_array_get(entry, 0))) {
            char *text = json_dumps(entry, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(9));
            const size_t length = text ? strlen(text) : 0;
            const bool quoted = length >= 2 && text[0] == '"';
            printf("%.*s\n", (int)(quoted ? length - 2 : length), quoted ? text + 1 : text);
            free(text);
            continue;
        }
        printf("\n");
        json_array_foreach(entry, index, value) {
            char *text = json_dumps(value, JSON_REAL_PRECISION(6));
            printf("%*s%s\n", 2 * depth + 2, "", text ? text : "");
            free(text);
        }
    }
}

static void print(const struct options *options, const json_t *root)
{
    if (!options_given(options, OPTION_json)) {
        print_plain(root, 0);
        return;
    }
    json_dumpf(root, stdout, JSON_INDENT(4) | JSON_REAL_PRECISION(15));
    printf("\n");
}

static bool info_grain(const struct options *options, const char *path, struct error *error)
{
    struct dumps dumps;
    struct grains grains = {0};
    uint32_t entry = 0, i = 0;
    bool done = dumps_open(&dumps, path, error)
        && choose_frame(options, &dumps, &entry, error)
        && dumps_load(&dumps, entry, &grains, error)
        && choose_grain(options, &grains, &i, error);
    if (done) {
        json_t *root = json_pack("{s:i}", "frame", (int)dumps.index.entries[entry].frame);
        json_object_update_new(root, portrait_grain(&grains, i));
        if (!grains.contacts) json_object_set_new(root, "contacts",
            json_string("not kept; run again with -s output.contacts=true"));
        print(options, root);
        json_decref(root);
    }
    grains_free(&grains);
    dumps_close(&dumps);
    return done;
}

static bool info_run(const struct options *options, const char *path, struct error *error)
{
    json_t *root = recall_manifest(path, error);
    if (!root) return false;
    struct dumps dumps;
    if (dumps_open(&dumps, path, NULL)) {
        const struct dump_index *index = &dumps.index;
        json_object_set_new(root, "dumps", json_pack("{s:i, s:f, s:f}", "frames", (int)index->count,
            "from", index->entries[0].time, "to", index->entries[index->count - 1].time));
    }
    dumps_close(&dumps);
    print(options, root);
    json_decref(root);
    return true;
}

int cli_info(const struct options *options)
{
    struct error error = {0};
    const char *path = options->operands[0];
    const bool grain = options_given(options, OPTION_grain) || options_given(options, OPTION_at);
    if (!setup_is_run(path) && !grain) return cli_check(options);
    bool done;
    if (!setup_is_run(path)) {
        done = error_set_code(&error, EXIT_USAGE, "%s: not a run directory; --grain and --at look "
            "into the dumps of a run (`sandreel run %s -s output.dump=true`)", path, path);
    } else {
        done = grain ? info_grain(options, path, &error) : info_run(options, path, &error);
    }
    return done ? EXIT_DONE : opening_fail(&error);
}
