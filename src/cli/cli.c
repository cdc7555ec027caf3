/* cli.c - the table of commands: what `help` tells, which options each takes, who does it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"

#define SIMULATING OPTION_model, OPTION_method, OPTION_set, OPTION_seed, OPTION_until, OPTION_quick
#define LOOK                                                                                    \
    OPTION_size, OPTION_color, OPTION_map, OPTION_zoom, OPTION_theme, OPTION_colormap,          \
    OPTION_scale, OPTION_range, OPTION_arrows, OPTION_forces, OPTION_rims, OPTION_spokes,       \
    OPTION_shade, OPTION_title, OPTION_label
#define ALWAYS OPTION_threads, OPTION_progress, OPTION_help, OPTION_COUNT

static const uint8_t run_options[] = {OPTION_output, SIMULATING, OPTION_resume, OPTION_time_limit,
    OPTION_dry_run, OPTION_force, OPTION_every, LOOK, ALWAYS};
static const uint8_t frame_options[] = {OPTION_output, OPTION_force, OPTION_time,
    OPTION_reference, OPTION_tolerance, LOOK, SIMULATING, ALWAYS};
static const uint8_t movie_options[] = {OPTION_output, OPTION_force, OPTION_side_by_side, OPTION_fps,
    OPTION_every, LOOK, SIMULATING, ALWAYS};
static const uint8_t map_options[] = {OPTION_output, OPTION_force, OPTION_field, OPTION_time, OPTION_average,
    OPTION_as, OPTION_cell, OPTION_kernel, OPTION_width, OPTION_size, OPTION_zoom, OPTION_theme,
    OPTION_colormap, OPTION_scale, OPTION_map_range, OPTION_title, SIMULATING, ALWAYS};
static const uint8_t export_options[] = {OPTION_to, OPTION_output, OPTION_force, OPTION_frame,
    OPTION_time, OPTION_help, OPTION_COUNT};
static const uint8_t check_options[] = {OPTION_explain, SIMULATING, OPTION_help, OPTION_COUNT};
static const uint8_t scenes_options[] = {OPTION_json, OPTION_help, OPTION_COUNT};
static const uint8_t info_options[] = {OPTION_frame, OPTION_time, OPTION_grain, OPTION_at,
    OPTION_json, OPTION_set, OPTION_quick, OPTION_model, OPTION_help, OPTION_COUNT};
static const uint8_t help_options[] = {OPTION_help, OPTION_COUNT};
static const uint8_t version_options[] = {OPTION_json, OPTION_help, OPTION_COUNT};
static const uint8_t bench_options[] = {OPTION_json, OPTION_output, OPTION_force, OPTION_against, OPTION_threads,
    OPTION_help, OPTION_COUNT};

const struct command cli_commands[] = {
    {"run", "SCENE", "simulates a scene and writes what its `output` asks for",
     "Writes a directory with the resolved scene, a manifest, the log, frames, maps, dumps and\n"
     "checkpoints; its name is the scene's and the model's unless -o says another.\n"
     "`sandreel run DIRECTORY --resume` goes on with an earlier run.\n",
     run_options, 1, 1, cli_run},
    {"frame", "SCENE|RUN", "draws one picture, from a run's dumps or simulated on the fly",
     "Without -t the end is drawn.  The file is NAME.png unless -o says another; one that is there\n"
     "already is overwritten only with --force.  --against REF.png compares: exit code 4, and\n"
     "NAME-difference.png with the differing pixels in red, if any channel of any pixel differs\n"
     "by more than --tolerance.\n",
     frame_options, 1, 1, cli_frame},
    {"movie", "SCENE|RUN...", "films a run, or a scene while it is simulated",
     "-o NAME.mp4, .webm or .gif; ffmpeg must be installed.  --side-by-side puts several models\n"
     "(--model md,lga) or several scenes and runs into one picture; --size is that of one panel.\n",
     movie_options, 1, OPTIONS_OPERANDS_MAX, cli_movie},
    {"map", "SCENE|RUN", "field maps: density, velocity, granular temperature, ...",
     "A snapshot at -t (default: the end), or the mean over --average T1:T2.\n",
     map_options, 1, 1, cli_map},
    {"export", "RUN", "the grains of a run for other programs",
     "--to csv: one table a frame, id,x,y,vx,vy,spin,radius,collision_rate,species.  Without\n"
     "--frame or -t all frames are exported.\n",
     export_options, 1, 1, cli_export},
    {"check", "SCENE", "tests a scene and simulates nothing", "Exit code 3 if it has errors.\n",
     check_options, 1, 1, cli_check},
    {"scenes", "", "lists the built-in scenes and the models that can run each", "",
     scenes_options, 0, 0, cli_scenes},
    {"info", "SCENE|RUN", "tells about a run, a scene, or one grain and its contacts",
     "--grain ID or --at X,Y picks the grain, --frame N or -t T the moment.\n",
     info_options, 1, 1, cli_info},
    {"help", "[COMMAND|KEY]", "explains a command or a key of scene files",
     "`sandreel help grains` lists the keys of a group, `help grains.restitution` explains one,\n"
     "`help keys` lists them all.\n",
     help_options, 0, 1, cli_help},
    {"version", "", "versions of sandreel and its libraries, the renderer, ffmpeg", "",
     version_options, 0, 0, cli_version},
    {"bench", "[NAME...]", "repeatable timings of models, drawing, encoding and maps",
     "The median of several repeats, in processor seconds.  --against OLD.json prints ratios.\n",
     bench_options, 0, OPTIONS_OPERANDS_MAX, cli_bench},
    {0}
};
