/* cli_export.c - `export RUN --to csv`: the grains of a run for other programs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "measure/csv.h"
#include "measure/dump.h"
#include "run/dumps.h"
#include "run/folder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool write_frame(const struct dumps *dumps, uint32_t k, const struct scene *scene, bool csv,
                        bool force, const char *directory, struct grains *grains,
                        struct error *error)
{
    char path[FILE_PATH_MAX];
    folder_path(path, directory, "grains_%06u.%s", dumps->index.entries[k].frame,
                csv ? "csv" : "npy");
    if (!force && !file_absent(path, error)) return false;
    if (!dumps_load(dumps, k, grains, error)) return false;
    return csv ? csv_save_grains(path, grains, scene, error) : dump_save(path, grains, error);
}

static bool export_frames(const struct options *options, const struct dumps *dumps,
                   const struct scene *scene, const char *directory, struct error *error)
{
    const char *to = options->values[OPTION_to];
    const bool csv = !to || strcmp(to, "csv") == 0;
    if (!csv && strcmp(to, "npy") != 0) {
        return error_set_code(error, EXIT_USAGE, "--to %s: csv or npy (maps: `sandreel map --as "
                              "vti`)", to);
    }
    uint32_t first = 0, last = dumps->index.count - 1;
    uint64_t frame;
    double t;
    if (options_given(options, OPTION_frame)) {
        if (!options_whole(options, OPTION_frame, 0, &frame, error)) return false;
        if (frame > last) {
            return error_set_code(error, EXIT_USAGE, "--frame %llu: the run kept 0 to %u",
                                  (unsigned long long)frame, last);
        }
        first = last = (uint32_t)frame;
    } else if (options_given(options, OPTION_time)) {
        if (!options_real(options, OPTION_time, 0, &t, error)) return false;
        first = last = dumps_nearest(dumps, t);
    }
    if (!file_make_directory(directory, error)) return false;
    struct grains grains = {0};
    const bool force = options_given(options, OPTION_force);
    bool done = true;
    for (uint32_t k = first; done && k <= last; k++) {
        done = write_frame(dumps, k, scene, csv, force, directory, &grains, error);
    }
    grains_free(&grains);
    return done;
}

int cli_export(const struct options *options)
{
    struct error error = {0};
    struct setup setup = {0};
    struct dumps dumps = {0};
    const char *path = options->operands[0], *output = options->values[OPTION_output];
    char directory[FILE_PATH_MAX];
    folder_path(directory, path, "export");
    if (output) snprintf(directory, sizeof directory, "%s", output);
    bool done = setup_is_run(path) || error_set_code(&error, EXIT_USAGE,
        "%s: not a run directory; `sandreel run` makes one", path);
    done = done && opening_load(&setup, options, path, NULL, false, &error)
        && dumps_open(&dumps, path, &error)
        && export_frames(options, &dumps, setup.scene, directory, &error);
    if (done) printf("%s\n", directory);
    dumps_close(&dumps);
    setup_free(&setup);
    return done ? EXIT_DONE : opening_fail(&error);
}
