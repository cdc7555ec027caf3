/* cli.h - the subcommands, one file each; a command returns the exit code.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CLI_H
#define CLI_H

#include "cli/options.h"

/* The list of commands; ends with a NULL name. */
extern const struct command cli_commands[];

int cli_run(const struct options *options);
int cli_frame(const struct options *options);
int cli_movie(const struct options *options);
int cli_live(const struct options *options);
int cli_replay(const struct options *options);
int cli_map(const struct options *options);
int cli_export(const struct options *options);
int cli_figure(const struct options *options);
int cli_plot(const struct options *options);
int cli_check(const struct options *options);
int cli_scenes(const struct options *options);
int cli_info(const struct options *options);
int cli_help(const struct options *options);
int cli_version(const struct options *options);
int cli_completion(const struct options *options);
int cli_manual(const struct options *options);
int cli_sweep(const struct options *options);
int cli_bench(const struct options *options);
int cli_cost(const struct options *options);
int cli_stress(const struct options *options);

#endif
