/* options.h - the command line, listed once: parsing, `help`, suggestions and completion come from
 * the two tables of options.c.
 *
 * An option that only sets a key of the scene says which, and becomes an override like -s
 * KEY=VALUE, in the order given; so its value is checked in one place, by the scene's keys.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* How the value of an option that sets a key is written there. */
enum option_form { FORM_PLAIN, FORM_WORD, FORM_LIST, FORM_SIZE, FORM_WORDS, FORM_ON,
                   FORM_OPTIONAL };     /* sets no key; --NAME or --NAME=VALUE */

/* X(id, "long", letter or 0, "VALUE" or NULL, "scene key" or NULL, form, "what it does") */
#define OPTIONS(X)                                                                              \
    X(output,    "output",    'o', "PATH",  NULL, FORM_PLAIN, "where the result goes")          \
    X(model,     "model",     0,   "NAME",  "model", FORM_WORD,                                 \
      "the model: see `sandreel scenes`")                                                       \
    X(method,    "method",    0,   "WORD",  NULL, FORM_PLAIN,                                   \
      "a variant of the model: one of the words of its settings, as hertz or gear")             \
    X(set,       "set",       's', "KEY=VALUE", NULL, FORM_PLAIN,                               \
      "changes any key of the scene; may be given again")                                       \
    X(seed,      "seed",      0,   "N",     "seed", FORM_PLAIN, "seed of all random numbers")   \
    X(until,     "until",     0,   "T",     "until", FORM_PLAIN, "simulated time of the end")   \
    X(quick,     "quick",     0,   NULL,    "quick", FORM_ON, "the small form, for a first look") \
    X(threads,   "threads",   'j', "N",     NULL, FORM_PLAIN, "processor threads; default: all") \
    X(resume,    "resume",    0,   NULL,    NULL, FORM_PLAIN, "goes on from the last checkpoint") \
    X(time_limit, "time-limit", 0, "S",     NULL, FORM_PLAIN,                                   \
      "stops after so much wall time (600, 90m, 12h), with a checkpoint and exit code 5")       \
    X(dry_run,   "dry-run",   0,   NULL,    NULL, FORM_PLAIN, "says what it would do, and ends") \
    X(force,     "force",     'f', NULL,    NULL, FORM_PLAIN, "overwrites what is there")       \
    X(progress,  "progress",  0,   "HOW",   NULL, FORM_PLAIN, "auto, bar, plain or none")       \
    X(time,      "time",      't', "T",     NULL, FORM_PLAIN, "at which time; default: the end") \
    X(size,      "size",      0,   "WxH",   "view.size", FORM_SIZE, "of the picture in pixels") \
    X(color,     "color",     0,   "WHAT",  "view.color", FORM_WORD,                            \
      "colour by speed, collisions, spin, species, radius, pressure, none")                     \
    X(map,       "map",       0,   "FIELD", "view.map", FORM_WORD,                              \
      "draws a field beneath the grains")                                                       \
    X(zoom,      "zoom",      0,   "X0,Y0,X1,Y1", "view.window", FORM_LIST, "the part to show") \
    X(theme,     "theme",     0,   "NAME",  "view.theme", FORM_WORD, "white, dark, transparent") \
    X(colormap,  "colormap",  0,   "NAME",  "view.colormap", FORM_WORD,                         \
      "viridis, inferno, cividis, turbo")                                                       \
    X(scale,     "scale",     0,   "NAME",  "view.scale", FORM_WORD, "linear, sqrt, log")       \
    X(range,     "range",     0,   "A,B",   "view.range", FORM_LIST, "of the colours")          \
    X(map_range, "range",     0,   "A,B",   "measure.range", FORM_LIST, "of the maps' colours") \
    X(arrows,    "arrows",    0,   NULL,    "view.arrows", FORM_ON, "velocities as arrows")     \
    X(forces,    "forces",    0,   NULL,    "view.forces", FORM_ON, "contact forces as lines")  \
    X(rims,      "rims",      0,   NULL,    "view.rims", FORM_ON, "dark rims around grains")    \
    X(spokes,    "spokes",    0,   NULL,    "view.spokes", FORM_ON, "spokes that show rotation") \
    X(shade,     "shade",     0,   NULL,    "view.shade", FORM_ON, "grains as lit balls")       \
    X(title,     "title",     0,   "TEXT",  "view.title", FORM_WORD, "a headline")              \
    X(label,     "label",     0,   "TEXT",  "view.label", FORM_WORD,                            \
      "a line of text with {t} {n} {model} {steps} ...")                                        \
    X(caption,   "caption",   0,   "TEXT",  "view.caption", FORM_WORD,                          \
      "the same under the picture")                                                             \
    X(fps,       "fps",       0,   "N",     "output.frame_rate", FORM_PLAIN,                    \
      "frames a second of a movie")                                                             \
    X(every,     "every",     0,   "DT",    "output.frames", FORM_PLAIN,                        \
      "simulated time between frames")                                                          \
    X(side_by_side, "side-by-side", 0, NULL, NULL, FORM_PLAIN,                                  \
      "one panel a model (--model md,lga) or a scene, with its wall time under each")           \
    X(field,     "field",     0,   "LIST",  "measure.fields", FORM_WORDS, "which maps")         \
    X(cell,      "cell",      0,   "LENGTH", "measure.cell", FORM_PLAIN, "grid constant of maps") \
    X(kernel,    "kernel",    0,   "NAME",  "measure.kernel", FORM_WORD, "box, gauss, lucy")    \
    X(width,     "width",     0,   "LENGTH", "measure.width", FORM_PLAIN, "of the kernel")      \
    X(average,   "average",   0,   "T1:T2", NULL, FORM_PLAIN,                                   \
      "mean over this time; default: a snapshot")                                               \
    X(as,        "as",        0,   "LIST",  NULL, FORM_PLAIN, "formats: png,npy,vti,csv")       \
    X(plot_as,   "as",        0,   "LIST",  NULL, FORM_PLAIN, "formats: png,svg,pdf,text")      \
    X(of,        "of",        0,   "WHAT",  NULL, FORM_PLAIN, "what to plot: energy, pair, ...") \
    X(small,     "quick",     0,   NULL,    NULL, FORM_PLAIN,                                   \
      "reduced numbers: each figure within a minute")                                           \
    X(to,        "to",        0,   "LIST",  NULL, FORM_PLAIN,                                   \
      "formats: csv,npy,vtp,vti,lammps,extxyz,h5md; default: csv")                              \
    X(vary,      "vary",      0,   "KEY=VALUES", NULL, FORM_PLAIN,                              \
      "values of a key: a:b:step, or v,w,... or a:b (drawn); may be given again")               \
    X(random,    "random",    0,   "N",     NULL, FORM_PLAIN,                                   \
      "draws the keys that have only a range, N times")                                         \
    X(repeats,   "repeats",   0,   "N",     NULL, FORM_PLAIN,                                   \
      "runs every point N times, with seeds of their own")                                      \
    X(from,      "from",      0,   "T",     NULL, FORM_PLAIN,                                   \
      "means of the log begin here; default: half the time")                                    \
    X(shard,     "shard",     0,   "I/N",   NULL, FORM_PLAIN,                                   \
      "only every N-th point, from the I-th on")                                                \
    X(explain,   "explain",   0,   NULL,    NULL, FORM_PLAIN,                                   \
      "which effects are on, and which off")                                                    \
    X(accuracy,  "accuracy",  0,   "X%",    NULL, FORM_PLAIN,                                   \
      "the fastest setting within this error, by what `sandreel cost` measured")                \
    X(budget,    "budget",    0,   "TIME",  NULL, FORM_PLAIN,                                   \
      "the nearest setting that takes no longer (60s, 10m), by `sandreel cost`")                \
    X(seeds,     "seeds",     0,   "N",     NULL, FORM_PLAIN,                                   \
      "runs of each setting; default: 3 to 16, as many as take a quarter of --time-limit")      \
    X(effects,   "effects",   0,   NULL,    NULL, FORM_PLAIN,                                   \
      "time and bytes per grain with each effect alone, all, none")                             \
    X(frame,     "frame",     0,   "N",     NULL, FORM_PLAIN,                                   \
      "number of a frame; default: the last")                                                   \
    X(grain,     "grain",     0,   "ID",    NULL, FORM_PLAIN, "tells about one grain")          \
    X(at,        "at",        0,   "X,Y",   NULL, FORM_PLAIN,                                   \
      "tells about the grain nearest to a point")                                               \
    X(commands,  "commands",  0,   "FILE",  NULL, FORM_PLAIN,                                   \
      "carries out the commands of a file")                                                     \
    X(web,       "web",       0,   "PORT",  NULL, FORM_OPTIONAL,                                \
      "in a browser: prints an address of this machine alone; any free port if none is given")  \
    X(json,      "json",      0,   NULL,    NULL, FORM_PLAIN, "prints one JSON document")       \
    X(against,   "against",   0,   "OLD.json", NULL, FORM_PLAIN,                                \
      "prints ratios to an earlier bench")                                                      \
    X(reference, "against",   0,   "REF.png", NULL, FORM_PLAIN,                                 \
      "compares with this picture; exit code 4 and a picture of the difference")                \
    X(tolerance, "tolerance", 0,   "N",     NULL, FORM_PLAIN,                                   \
      "grey levels (0 to 255) that any channel may differ by; default: 0")                      \
    X(help,      "help",      'h', NULL,    NULL, FORM_PLAIN, "explains the command")

enum option_id {
#define X(id, name, letter, value, key, form, doc) OPTION_##id,
    OPTIONS(X)
#undef X
    OPTION_COUNT
};

struct option_row {
    const char *name;
    char letter;
    const char *value, *key;
    enum option_form form;
    const char *doc;
};

extern const struct option_row options_table[OPTION_COUNT];

enum { OPTIONS_OVERRIDES_MAX = 256, OPTIONS_OPERANDS_MAX = 64,
       OPTIONS_VARIES_MAX = 16 };

struct options {
    const struct command *command;
    const char *values[OPTION_COUNT];           /* NULL: not given; "" for flags */
    const char *overrides[OPTIONS_OVERRIDES_MAX];
    uint32_t override_count;
    char *owned[OPTIONS_OVERRIDES_MAX];         /* the overrides that were put together here */
    uint32_t owned_count;
    const char *varies[OPTIONS_VARIES_MAX];     /* each --vary */
    uint32_t vary_count;
    const char *operands[OPTIONS_OPERANDS_MAX];
    uint32_t operand_count;
};

struct command {
    const char *name, *operands, *summary;
    const char *details;        /* more lines for `help COMMAND` */
    const uint8_t *accepts;     /* option ids, ends with OPTION_COUNT */
    uint32_t operands_min, operands_max;
    int (*carry_out)(const struct options *options);    /* the exit code */
};

/* False (EXIT_USAGE) with a suggestion for what is unknown. */
bool options_parse(struct options *options, const struct command *command, int count,
                   char **arguments, struct error *error);
void options_free(struct options *options);

bool options_given(const struct options *options, enum option_id id);

/* The value as a number; `fallback` if it was not given. */
bool options_real(const struct options *options, enum option_id id, double fallback, double *value,
                  struct error *error);
bool options_whole(const struct options *options, enum option_id id, uint64_t fallback,
                   uint64_t *value, struct error *error);

/* Two numbers parted by `mark`, as in T1:T2. */
bool options_pair(const struct options *options, enum option_id id, char mark, double pair[2],
                  struct error *error);

/* The nearest of `words` (ends with NULL), if it is near enough to be meant; else NULL. */
const char *options_nearest(const char *word, const char *const *words);

#endif
