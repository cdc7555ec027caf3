/* cli_export.c - `export RUN --to csv,h5md,...`: the grains of a run for other programs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "run/dumps.h"
#include "run/exporter.h"
#include "run/folder.h"

#include <stdio.h>
#include <string.h>

/* One frame if --frame or -t names it, else all. */
static bool choose_frames(const struct options *options, const struct dumps *dumps,
                          uint32_t *first, uint32_t *last, struct error *error)
{
    uint64_t frame;
    double t;
    *first = 0;
    *last = dumps->index.count - 1;
    if (options_given(options, OPTION_frame)) {
        if (!options_whole(options, OPTION_frame, 0, &frame, error)) return false;
        if (frame > *last) {
            return error_set_code(error, EXIT_USAGE, "--frame %llu: the run kept 0 to %u",
                                  (unsigned long long)frame, *last);
        }
        *first = *last = (uint32_t)frame;
    } else if (options_given(options, OPTION_time)) {
        if (!options_real(options, OPTION_time, 0, &t, error)) return false;
        *first = *last = dumps_nearest(dumps, t);
    }
    return true;
}

static bool export_frames(const struct options *options, const struct dumps *dumps,
                          struct exporter *exporter, struct error *error)
{
    uint32_t first, last;
    if (!choose_frames(options, dumps, &first, &last, error)) return false;
    struct grains grains = {0};
    bool done = true;
    for (uint32_t k = first; done && k <= last; k++) {
        const struct dump_entry *entry = &dumps->index.entries[k];
        done = dumps_load(dumps, k, &grains, error) && grains_sort(&grains, error)
            && exporter_add(exporter, &grains, entry->frame, entry->steps, error);
    }
    grains_free(&grains);
    return done && exporter_commit(exporter, error);
}

int cli_export(const struct options *options)
{
    struct error error = {0};
    struct setup setup = {0};
    struct dumps dumps = {0};
    struct exporter exporter = {0};
    unsigned formats;
    const char *path = options->operands[0], *output = options->values[OPTION_output];
    const char *to = options->values[OPTION_to];
    char directory[FILE_PATH_MAX];
    folder_path(directory, path, "export");
    if (output) snprintf(directory, sizeof directory, "%s", output);
    bool done = exporter_parse(to ? to : "csv", &formats, &error)
        && (setup_is_run(path) || error_set_code(&error, EXIT_USAGE,
            "%s: not a run directory; `sandreel run` makes one", path));
    done = done && opening_load(&setup, options, path, NULL, false, &error)
        && dumps_open(&dumps, path, &error)
        && exporter_open(&exporter, setup.scene, directory, formats,
                         options_given(options, OPTION_force), &error)
        && export_frames(options, &dumps, &exporter, &error);
    if (done) printf("%s\n", directory);
    exporter_close(&exporter);
    dumps_close(&dumps);
    setup_free(&setup);
    return done ? EXIT_DONE : opening_fail(&error);
}
