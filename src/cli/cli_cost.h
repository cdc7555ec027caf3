/* cli_cost.h - `run` takes its setting from what `cost` measured.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CLI_COST_H
#define CLI_COST_H

#include "base/file.h"
#include "cli/options.h"

#include <jansson.h>

/* NAME-cost, in the present folder. */
void cli_cost_choose_directory(char directory[FILE_PATH_MAX], const char *scene);

/* Where the cache keeps the table of a scene. */
char *cli_cost_choose_table(char path[FILE_PATH_MAX], const char *cache, uint64_t hash);

/* With --accuracy or --budget: adds the keys of the fastest (nearest) setting that holds it, from
 * NAME-cost/cost.json or the cache, if they are of this very scene.  The keys live in `table`,
 * which the caller gives back with json_decref when the options are no longer used; NULL without
 * these options. */
bool cli_cost_choose(struct options *options, json_t **table, struct error *error);

#endif
