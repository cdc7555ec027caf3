/* command.h - the one grammar of a live session: keys, the `:` line, the browser and files of
 * commands all speak it, and session.log is written in it.
 *
 * The table is listed once.  Parsing, help and completion read the arguments as they are written
 * there: forms are parted by '|'; words in capitals stand for numbers, but KEY WHAT FIELD FILE
 * COMMAND for a word and VALUE EXPR for the rest of the line; small letters are written as they
 * are.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef COMMAND_H
#define COMMAND_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What becomes of a command: LOGGED ones change the run, its look or its files, and a replay
 * carries them out again; PASSING ones leave no trace. */
enum command_kind { COMMAND_PASSING, COMMAND_LOGGED };

/* X(name, arguments, kind, what it does) */
#define COMMANDS(X)                                                                             \
    X(pause,   "", PASSING, "holds the simulation")                                             \
    X(go,      "| until T", PASSING, "runs on, or until time T")                                \
    X(step,    "| N", PASSING, "takes N steps (events, ticks) of the model; default: one")      \
    X(speed,   "FACTOR | max", PASSING, "simulated time per second of yours; max: no brake")    \
    X(back,    "| T", LOGGED, "returns to the state kept last, or to the last one kept by T")   \
    X(reset,   "", LOGGED, "returns to the start and forgets every change")                     \
    X(set,     "KEY VALUE", LOGGED, "changes a key of the scene from now on")                   \
    X(get,     "KEY", PASSING, "tells a key of the scene, or a total such as kinetic_energy")   \
    X(color,   "WHAT", LOGGED, "colours grains by speed, spin, species, collisions, ...")       \
    X(map,     "FIELD", LOGGED, "draws a field beneath the grains; none takes it away")         \
    X(zoom,    "FACTOR | FACTOR X Y | X0 Y0 X1 Y1", LOGGED,                                     \
               "shows a part: closer by a factor, about a point, or a rectangle")               \
    X(pan,     "DX DY", LOGGED, "moves the window by these shares of its size")                 \
    X(fit,     "", LOGGED, "shows the whole box again")                                         \
    X(inspect, "ID | X Y", PASSING, "tells about a grain, or the one nearest to a point")       \
    X(follow,  "| ID", LOGGED, "keeps a grain in the middle; without ID no longer")             \
    X(push,    "X Y VX VY | X Y VX VY RADIUS", LOGGED,                                          \
               "gives the grains around a point a velocity")                                    \
    X(gate,    "open | close | open N | close N", LOGGED,                                       \
               "opens or closes the gates, or wall N")                                          \
    X(tilt,    "DEGREES", LOGGED, "turns gravity to this angle from straight down")             \
    X(pour,    "N | N X Y", LOGGED, "lets N grains fall in, at the top or at a point")          \
    X(frame,   "FILE", LOGGED, "saves the picture as FILE.png of the session's folder")         \
    X(movie,   "FILE start | stop | FILE stop", LOGGED, "films from here on; ends the film")    \
    X(checkpoint, "FILE", LOGGED, "saves the state as FILE of the session's folder")            \
    X(expect,  "EXPR", LOGGED, "says whether this holds, as in: expect grains > 10")            \
    X(help,    "| COMMAND", PASSING, "lists the commands, or explains one")                     \
    X(quit,    "", PASSING, "ends the session")

enum command_verb {
#define X(name, arguments, kind, doc) COMMAND_##name,
    COMMANDS(X)
#undef X
    COMMAND_COUNT,
    COMMAND_NONE = COMMAND_COUNT        /* an empty line or a comment */
};

struct command_row { const char *name, *arguments; enum command_kind kind; const char *doc; };

extern const struct command_row command_table[COMMAND_COUNT];

/* Keys of the terminal and of the browser.  X(key, "name for people", while it runs, while it
 * rests, what it does) */
#define COMMAND_KEYS(X)                                                                         \
    X(' ', "space", "pause", "go", "holds and runs on")                                         \
    X('.', ".", "step", "step", "one step")                                                     \
    X(',', ",", "back", "back", "back to the state kept last")                                  \
    X('r', "r", "reset", "reset", "back to the start")                                          \
    X('+', "+", "zoom 1.25", "zoom 1.25", "closer")                                             \
    X('-', "-", "zoom 0.8", "zoom 0.8", "farther")                                              \
    X('0', "0", "fit", "fit", "the whole box")                                                  \
    X('h', "h", "pan -0.1 0", "pan -0.1 0", "to the left")                                      \
    X('l', "l", "pan 0.1 0", "pan 0.1 0", "to the right")                                       \
    X('j', "j", "pan 0 -0.1", "pan 0 -0.1", "downwards")                                        \
    X('k', "k", "pan 0 0.1", "pan 0 0.1", "upwards")                                            \
    X('o', "o", "gate open", "gate open", "opens the gates")                                    \
    X('c', "c", "gate close", "gate close", "closes the gates")                                 \
    X('q', "q", "quit", "quit", "ends")

struct command_key { char key; const char *name, *running, *resting, *doc; };

extern const struct command_key command_keys[];         /* ends with a NULL name */

enum { COMMAND_LINE_MAX = 1000, COMMAND_WORD_MAX = 200, COMMAND_NUMBERS = 5 };

struct command_line {
    enum command_verb verb;
    uint32_t number_count;
    double   numbers[COMMAND_NUMBERS];
    char     literal[16];       /* the last small word of the form: until, max, open, start ... */
    char     word[COMMAND_WORD_MAX];    /* KEY WHAT FIELD FILE COMMAND; "" if the form has none */
    char     rest[COMMAND_LINE_MAX];    /* VALUE EXPR */
};

/* A pure function of the text: at most COMMAND_LINE_MAX - 1 bytes, without control characters.
 * False (EXIT_USAGE) with what is wrong and how the command is written. */
bool command_parse(const char *text, struct command_line *line, struct error *error);

/* "push X Y VX VY | X Y VX VY RADIUS": name and arguments as `help` tells them. */
char *command_usage(enum command_verb verb, char *text, size_t size);

/* The verb of this name; COMMAND_COUNT if there is none. */
enum command_verb command_find(const char *name);

#endif
