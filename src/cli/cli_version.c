/* cli_version.c - `version`: what this program is made of, and what it finds on this machine.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "cli/opening.h"
#include "draw/canvas.h"
#include "run/build.h"
#include "run/movie.h"

#include <jansson.h>
#include <omp.h>
#include <stdio.h>

int cli_version(const struct options *options)
{
    struct error error = {0};
    json_t *root = build_versions();
    json_object_set_new(root, "threads", json_integer(omp_get_max_threads()));
    struct canvas *canvas = canvas_create(16, 16, &error);
    json_object_set_new(root, "gl", json_string(canvas ? canvas_backend(canvas) : "none"));
    json_object_set_new(root, "renderer", json_string(canvas ? canvas_renderer(canvas)
                                                             : error.text));
    if (canvas) canvas_destroy(canvas);
    json_object_set_new(root, "ffmpeg", json_boolean(movie_available(NULL)));
    json_t *models = json_array();
    for (const struct model *const *m = model_list; *m; m++) {
        json_array_append_new(models, json_string((*m)->name));
    }
    json_object_set_new(root, "models", models);
    if (options_given(options, OPTION_json)) {
        json_dumpf(root, stdout, JSON_INDENT(4));
        printf("\n");
        json_decref(root);
        return EXIT_DONE;
    }
    const char *name;
    json_t *value;
    json_object_foreach(root, name, value) {
        if (json_is_string(value)) printf("%-12s %s\n", name, json_string_value(value));
        else if (json_is_integer(value)) printf("%-12s %lld\n", name,
                                                (long long)json_integer_value(value));
        else if (json_is_boolean(value)) printf("%-12s %s\n", name,
                                                json_is_true(value) ? "yes" : "no (needed for "
                                                "movies: sudo apt install ffmpeg)");
    }
    printf("%-12s", "models");
    for (const struct model *const *m = model_list; *m; m++) printf(" %s", (*m)->name);
    printf("\n");
    json_decref(root);
    return EXIT_DONE;
}
