/* cli.c - the table of commands: what `help` tells, which options each takes, who does it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cli/cli.h"
#include "run/exporter.h"

#define SIMULATING OPTION_model, OPTION_method, OPTION_set, OPTION_seed, OPTION_until, OPTION_quick
#define LOOK                                                                                    \
    OPTION_size, OPTION_color, OPTION_map, OPTION_zoom, OPTION_theme, OPTION_colormap,          \
    OPTION_scale, OPTION_range, OPTION_arrows, OPTION_forces, OPTION_rims, OPTION_spokes,       \
    OPTION_shade, OPTION_title, OPTION_label, OPTION_caption
#define ALWAYS OPTION_threads, OPTION_progress, OPTION_help, OPTION_COUNT

static const uint8_t run_options[] = {OPTION_output, SIMULATING, OPTION_resume, OPTION_time_limit,
    OPTION_accuracy, OPTION_budget, OPTION_dry_run, OPTION_force, OPTION_every, LOOK, ALWAYS};
static const uint8_t frame_options[] = {OPTION_output, OPTION_force, OPTION_time,
    OPTION_reference, OPTION_tolerance, LOOK, SIMULATING, ALWAYS};
static const uint8_t movie_options[] = {OPTION_output, OPTION_force, OPTION_side_by_side,
    OPTION_fps, OPTION_every, LOOK, SIMULATING, ALWAYS};
static const uint8_t live_options[] = {OPTION_web, OPTION_commands, OPTION_output, OPTION_force,
    LOOK, SIMULATING, ALWAYS};
static const uint8_t replay_options[] = {OPTION_output, OPTION_force, OPTION_threads, OPTION_help,
    OPTION_COUNT};
static const uint8_t map_options[] = {OPTION_output, OPTION_force, OPTION_field, OPTION_time,
    OPTION_average, OPTION_as, OPTION_cell, OPTION_kernel, OPTION_width, OPTION_size, OPTION_zoom,
    OPTION_theme, OPTION_colormap, OPTION_scale, OPTION_map_range, OPTION_title, SIMULATING,
    ALWAYS};
static const uint8_t export_options[] = {OPTION_to, OPTION_output, OPTION_force, OPTION_frame,
    OPTION_time, OPTION_field, OPTION_cell, OPTION_kernel, OPTION_width, OPTION_set, OPTION_help,
    OPTION_COUNT};
static const uint8_t figure_options[] = {OPTION_small, OPTION_output, OPTION_force, OPTION_plot_as,
    OPTION_json, ALWAYS};
static const uint8_t plot_options[] = {OPTION_of, OPTION_output, OPTION_force, OPTION_plot_as,
    OPTION_time, SIMULATING, ALWAYS};
static const uint8_t check_options[] = {OPTION_explain, SIMULATING, OPTION_help, OPTION_COUNT};
static const uint8_t scenes_options[] = {OPTION_json, OPTION_help, OPTION_COUNT};
static const uint8_t info_options[] = {OPTION_frame, OPTION_time, OPTION_grain, OPTION_at,
    OPTION_json, OPTION_set, OPTION_quick, OPTION_model, OPTION_help, OPTION_COUNT};
static const uint8_t sweep_options[] = {OPTION_vary, OPTION_random, OPTION_repeats, OPTION_from,
    OPTION_output, OPTION_shard, OPTION_resume, OPTION_force, OPTION_time_limit, SIMULATING,
    ALWAYS};
static const uint8_t help_options[] = {OPTION_help, OPTION_COUNT};
static const uint8_t version_options[] = {OPTION_json, OPTION_help, OPTION_COUNT};
static const uint8_t bench_options[] = {OPTION_effects, OPTION_json, OPTION_output, OPTION_force,
    OPTION_against, OPTION_threads, OPTION_help, OPTION_COUNT};
static const uint8_t cost_options[] = {OPTION_output, OPTION_seeds, OPTION_time_limit, OPTION_json,
    OPTION_set, OPTION_until, OPTION_quick, OPTION_threads, OPTION_help, OPTION_COUNT};
static const uint8_t stress_options[] = {OPTION_quick, OPTION_json, OPTION_threads, OPTION_help,
    OPTION_COUNT};

const struct command cli_commands[] = {
    {"run", "SCENE", "simulates a scene and writes what its `output` asks for",
     "Writes a directory with the resolved scene, a manifest, the log, frames, maps, dumps and\n"
     "checkpoints; its name is the scene's and the model's unless -o says another.\n"
     "`sandreel run DIRECTORY --resume` goes on with an earlier run.\n",
     run_options, 1, 1, cli_run},
    {"frame", "SCENE|RUN", "draws one picture, from a run's dumps or simulated on the fly",
     "Without -t the end is drawn.  The file is NAME.png unless -o says another; one that is\n"
     "there already is overwritten only with --force.  --against REF.png compares: exit code 4,\n"
     "and NAME-difference.png with the differing pixels in red, if any channel of any pixel\n"
     "differs by more than --tolerance.\n",
     frame_options, 1, 1, cli_frame},
    {"movie", "SCENE|RUN...", "films a run, or a scene while it is simulated",
     "-o NAME.mp4, .webm or .gif; ffmpeg must be installed.  --side-by-side puts several models\n"
     "(--model md,lga) or several scenes and runs into one picture; --size is that of one panel.\n",
     movie_options, 1, OPTIONS_OPERANDS_MAX, cli_movie},
    {"live", "SCENE|RUN", "watches and steers a simulation while it runs",
     "In the terminal, unless --web prints an address for a browser.  --commands FILE carries out\n"
     "a file of commands, and ends unless --web goes on.  A run goes on from its newest\n"
     "checkpoint.  The session is written down in a directory, NAME-live unless -o says another;\n"
     "`sandreel replay` repeats it.  docs/live.md lists the commands.\n",
     live_options, 1, 1, cli_live},
    {"replay", "RUN", "repeats a live session from its log, to the same bytes",
     "Writes beside it, RUN-replay unless -o says another.  Exit code 4 if it comes to another\n"
     "state.\n",
     replay_options, 1, 1, cli_replay},
    {"map", "SCENE|RUN", "field maps: density, velocity, granular temperature, ...",
     "A snapshot at -t (default: the end), or the mean over --average T1:T2.\n",
     map_options, 1, 1, cli_map},
    {"export", "RUN", "the grains of a run for other programs",
#define X(name, file, writer, doc) "  " #name ": " doc "\n"
     EXPORTER_FORMATS(X)
#undef X
     "Without --frame or -t all frames are exported.\n",
     export_options, 1, 1, cli_export},
    {"figure", "[ID...]", "makes figures of the four papers again, with a verdict on each",
     "Without an ID it lists them.  ID may be `all`; several make one page, index.html.  All goes\n"
     "into the directory figures unless -o says another: pictures, a table of every curve, and\n"
     "gnuplot's script.  Exit code 4 if a verdict is other than `agrees`.\n",
     figure_options, 0, OPTIONS_OPERANDS_MAX, cli_figure},
    {"plot", "SCENE|RUN", "plots what a run measured, as PNG, SVG, PDF or in the terminal",
     "--of energy, contacts, flux, force, stress, impact, frequency, scattering need the tables\n"
     "of a run; --of anisotropy, structure, pair, heap look at grains, at -t or at the end.  The\n"
     "table and gnuplot's script stay beside the picture, in the run's directory unless -o says\n"
     "another.\n",
     plot_options, 1, 1, cli_plot},
    {"check", "SCENE", "tests a scene and simulates nothing", "Exit code 3 if it has errors.\n",
     check_options, 1, 1, cli_check},
    {"scenes", "", "lists the built-in scenes and the models that can run each", "",
     scenes_options, 0, 0, cli_scenes},
    {"info", "SCENE|RUN", "tells about a run, a scene, or one grain and its contacts",
     "--grain ID or --at X,Y picks the grain, --frame N or -t T the moment.\n",
     info_options, 1, 1, cli_info},
    {"sweep", "SCENE", "a parameter study: one run for each combination of values, as one table",
     "--vary KEY=a:b:step is a grid, KEY=v,w,... a list, KEY=a:b (with --random N) is drawn N\n"
     "times.  Several --vary make all combinations.  Each point is a process of its own, -j of\n"
     "them at a time, without pictures unless -s output.frames=... asks for them.  results.csv\n"
     "has a line for each point: the last value of every column of its log, and the mean from\n"
     "--from on with its error; failed.csv has those that failed.  --resume does what is missing.\n"
     "Shards 1/N ... N/N of one study may run on as many machines; `mpirun -n P sandreel sweep`\n"
     "shares it out over ranks.\n",
     sweep_options, 1, 1, cli_sweep},
    {"help", "[COMMAND|KEY]", "explains a command or a key of scene files",
     "`sandreel help grains` lists the keys of a group, `help grains.restitution` explains one,\n"
     "`help keys` lists them all.\n",
     help_options, 0, 1, cli_help},
    {"completion", "SHELL", "prints what bash, zsh or fish need to complete commands and options",
     "For bash: eval \"$(sandreel completion bash)\"; an installed sandreel needs nothing.\n",
     help_options, 1, 1, cli_completion},
    {"manual", "[keys]", "prints the manual pages as scdoc text: sandreel(1), or sandreel-scene(5)",
     "The pages are made from it when sandreel is built: `man sandreel`.\n",
     help_options, 0, 1, cli_manual},
    {"version", "", "versions of sandreel and its libraries, the renderer, ffmpeg", "",
     version_options, 0, 0, cli_version},
    {"bench", "[NAME...]", "repeatable timings of models, drawing, encoding and maps",
     "The median of several repeats, in processor seconds.  --against OLD.json prints ratios.\n",
     bench_options, 0, OPTIONS_OPERANDS_MAX, cli_bench},
    {"cost", "SCENE", "what accuracy costs: error against wall time, for every model and setting",
     "Writes NAME-cost/ with cost.csv, cost.json and picture.png.  What is compared stands in\n"
     "`measure.cost` of the scene, with what in `measure.reference`.  A setting that takes longer\n"
     "than --time-limit (10 s; with --quick 4 s) is left out; a cheap one is run more often.  The\n"
     "reference is kept in $XDG_CACHE_HOME/sandreel.\n"
     "`sandreel run SCENE --accuracy 1%` then takes the fastest one that is near enough.\n",
     cost_options, 1, 1, cli_cost},
    {"stress", "[CASE...]", "runs the hard cases and tells what each of them held",
     "A case is a scene with a group `hard`: built in as hard/NAME, or a file.  --quick leaves\n"
     "out the slow ones.  Exit code 4 if one fails; it says which grain, where, and when.\n",
     stress_options, 0, OPTIONS_OPERANDS_MAX, cli_stress},
    {0}
};
