/* recall.c - see recall.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/recall.h"

#include "run/folder.h"
#include "run/jsontext.h"
#include "run/setup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

json_t *recall_manifest(const char *run, struct error *error)
{
    char path[FILE_PATH_MAX];
    size_t size;
    char *text = file_load(folder_path(path, run, "manifest.json"), 1 << 24, &size, error);
    if (!text) return NULL;
    json_error_t cause;
    json_t *root = json_loadb(text, size, 0, &cause);
    free(text);
    /* What finds no memory looks to jansson like a mistake in the text. */
    if (!root && (!*cause.text || jsontext_failed())) {
        error_set(error, "%s: not enough memory to read it", path);
    } else if (!root) {
        error_set(error, "%s:%d: not a manifest: %s", path, cause.line, cause.text);
    }
    return root;
}

bool recall_says_done(const json_t *manifest)
{
    const char *status = json_string_value(json_object_get(manifest, "status"));
    return status && strcmp(status, "done") == 0;
}

bool recall_done(const char *run, bool *done, struct error *error)
{
    char path[FILE_PATH_MAX];
    *done = false;
    if (!file_exists(folder_path(path, run, "manifest.json"))) return true;
    json_t *root = recall_manifest(run, error);
    *done = recall_says_done(root);
    json_decref(root);
    return root != NULL;
}

bool recall_range(const char *run, const struct scene *scene, struct view *view,
                  struct error *error)
{
    if (!setup_is_run(run) || !isnan(view->range[0])) return true;
    json_t *root = recall_manifest(run, error);
    if (!root) return false;
    const json_t *range = json_object_get(root, "range"), *color = json_object_get(root, "color");
    const json_t *low = json_array_get(range, 0), *high = json_array_get(range, 1);
    if (json_is_number(low) && json_is_number(high) && scene->view.range_from == RANGE_RUN
        && json_is_integer(color) && json_integer_value(color) == view->color) {
        view->range[0] = json_number_value(low);
        view->range[1] = json_number_value(high);
    }
    json_decref(root);
    return true;
}
