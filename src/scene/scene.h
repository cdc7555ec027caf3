/* scene.h - what a scene file says, resolved: the one description that every model, the renderer
 * and the measurements share.
 *
 * A scene is read by scene_load(), complete and checked; nothing changes it afterwards.  Lengths,
 * times and masses are in the scene's own units.  What a scene does not mention does not exist.
 * The structs below are the targets of the key tables in scene_keys.c; docs/scenes.md is written
 * from the same tables.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SCENE_H
#define SCENE_H

#include "base/arena.h"
#include "base/error.h"
#include "scene/effect.h"
#include "scene/findings.h"
#include "scene/key.h"
#include "scene/wall.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum units { UNITS_REDUCED, UNITS_SI, UNITS_CGS };
enum border { BORDER_WALL, BORDER_PERIODIC, BORDER_OPEN };
enum inertia { INERTIA_DISC, INERTIA_SPHERE };

/* One entry of `grains`: a species. */
struct species {
    char   name[KEY_TEXT_MAX];
    double radius[2];           /* uniform between; equal: one radius */
    struct key_reals radii;     /* or: one of these, equally often */
    double density;             /* mass per area: m = density pi R^2 */
    double restitution;         /* of a head-on collision; NAN: from stiffness and damping */
    double stiffness;           /* normal; its meaning is the force law's; NAN: model chooses */
    double damping;             /* normal; NAN: from the restitution */
    double friction;            /* Coulomb coefficient; 0: no friction */
    int    inertia;             /* enum inertia: I = q m R^2, q = 1/2 or 2/5 */
};

enum placement_kind { PLACEMENT_TRIANGULAR, PLACEMENT_SQUARE, PLACEMENT_RANDOM,
                      PLACEMENT_FILE };

/* One entry of `placements`: grains that are there at the start. */
struct placement {
    char   grains[KEY_TEXT_MAX];        /* name of the species; "" = the first */
    int    kind;                /* enum placement_kind */
    char   file[KEY_TEXT_MAX];  /* file: where the grains are listed, beside the scene */
    double region[4];           /* x0 y0 x1 y1; NANs: the box */
    struct key_reals outline;   /* or a polygon, x and y in turn */
    uint32_t count;             /* at most so many; 0: as many as fit */
    double fraction;            /* random: area fraction to reach; NAN: by count */
    double spacing;             /* lattices: distance of centres in diameters of the largest */
    double jitter;              /* lattices: random shift, as a share of the free gap */
    double velocity[2];
    double temperature;         /* granular temperature <v'^2>/2, added at random, zero mean */
    double spin;
};

enum source_kind { SOURCE_POINT, SOURCE_STREAM };

/* One entry of `sources`: grains that enter while it runs. */
struct source {
    char   grains[KEY_TEXT_MAX];
    int    kind;                /* enum source_kind */
    double position[2];         /* point: where; stream: middle of the column at its release */
    double above;               /* point: height above the grains at rest; 0: it does not rise */
    double width;               /* point: spread along x; stream: b, the height of a column */
    double velocity[2];
    double rate;                /* point: grains per time */
    double density;             /* stream: rho of stream (2a, 2b) */
    double jitter;              /* stream: deviation of the vertical gap, relative */
    double from, to;            /* the time in which it is on */
    uint32_t count;             /* at most so many in all; 0: no limit */
};

/* One entry of `walls` or `obstacles` as written; resolved into struct wall. */
struct wall_entry {
    char   shape[KEY_TEXT_MAX];
    struct key_reals points;    /* polyline */
    double center[2], radius;   /* arc, disc */
    double angles[2];           /* arc, degrees */
    double from[2], to[2];      /* row of discs: first and last centre */
    uint32_t count;             /* row of discs: how many; 0: touching */
    double velocity[2], moves[2];
    double amplitude[2], frequency;
    double opens, closes, surface_speed;
    char   grains[KEY_TEXT_MAX];        /* made of this species; "" = the first */
};

enum screen_kind { SCREEN_CIRCLE, SCREEN_LINE };

/* One entry of `screens`: grains that cross it are recorded by angle and removed. */
struct screen {
    int    kind;                /* enum screen_kind */
    double center[2];           /* angles are seen from here; 0 along +x, counter-clockwise */
    double radius;              /* circle: R_D of stream; removed when farther out */
    double x;                   /* line: removed when x exceeds this */
    uint32_t bins;              /* over 360 degrees */
    double from;                /* records from this time on; removes always */
};

/* One entry of `sinks`: a rectangle in which grains vanish. */
struct sink { double region[4]; };

/* One entry of `phases`: keys that change at a time. */
struct phase_entry {
    double time;
    struct key_texts set;
    struct key_reals push;      /* x, y, radius, vx, vy of each push (model/impulse.h), in turn */
};

enum { PHASE_PUSH = 5 };        /* numbers of one push */

enum color_by { COLOR_SPEED, COLOR_COLLISIONS, COLOR_SPIN, COLOR_SPECIES, COLOR_RADIUS,
                COLOR_PRESSURE, COLOR_NONE };
enum scale { SCALE_LINEAR, SCALE_SQRT, SCALE_LOG };
enum theme { THEME_WHITE, THEME_DARK, THEME_TRANSPARENT };
enum range_from { RANGE_RUN, RANGE_FRAME };

/* `view`: how frames look. */
struct view {
    double size[2];             /* pixels */
    double window[4];           /* x0 y0 x1 y1 of the scene; NANs: the box with a margin */
    int    color;               /* enum color_by */
    int    scale;               /* enum scale */
    double range[2];            /* of the colours; NANs: found from the grains */
    int    range_from;          /* enum range_from: 99th percentile of the run, or of each frame */
    char   colormap[KEY_TEXT_MAX];      /* viridis, inferno, cividis, turbo */
    int    theme;               /* enum theme */
    char   map[KEY_TEXT_MAX];   /* a field drawn beneath the grains; "" = none */
    bool   grains, walls, rims, shade;
    bool   arrows;              /* velocity */
    bool   forces;              /* contact forces as line widths */
    bool   spokes;              /* a line from the centre that turns with the grain */
    bool   legend, scale_bar, gravity_arrow;
    char   label[KEY_TEXT_MAX]; /* "t = {t} {time_unit}   N = {n}": see docs/pictures.md */
    char   title[KEY_TEXT_MAX];
    char   caption[KEY_TEXT_MAX];       /* as the label, under the scene */
    double arrow_scale, force_scale;    /* NAN: chosen */
    double text_size;           /* pixels; NAN: from the picture's height */
};

enum kernel { KERNEL_BOX, KERNEL_GAUSS, KERNEL_LUCY };

/* `measure`: field maps and what is gathered while running. */
struct measure {
    struct key_texts fields;    /* names of maps: density, area_fraction, velocity, ... */
    double cell;                /* grid constant; NAN: two mean diameters */
    int    kernel;              /* enum kernel */
    double width;               /* kernel length; NAN: one cell */
    double average[2];          /* maps are averaged from, to; NANs: snapshots */
    double range[2];            /* of the colours of maps; NANs: each map its own */
    bool   collisions;          /* count contacts for each grain */
    double collision_window;    /* over which a rate is formed; NAN: the frame interval */
    bool   collision_counts;    /* contacts of each grain since the start, the elastic ones too */
    bool   impact_parameters;   /* histogram of b/d */
    uint32_t impact_bins;
    bool   stress;              /* what contacts carry, in all and in each cell of the maps' grid */
    struct key_texts cost;      /* by which `sandreel cost` compares: energy, ... */
    char   reference[KEY_TEXT_MAX];     /* and with what: "ed ed.t_c=*0.1"; "": by the effects */
    struct key_texts settings;  /* and which settings; empty: a list for every model */
};

/* `output`: what a run writes and how often; 0 = never. */
struct output {
    double frames, log, maps, trajectory, checkpoint;   /* intervals in simulated time */
    double tallies;             /* ... of histograms; 0: one, of the whole run */
    double checkpoint_wall;     /* seconds of wall time */
    bool   dump;                /* grain states at each frame, .npy */
    bool   contacts;            /* with their contacts */
    char   movie[KEY_TEXT_MAX]; /* a movie written while running, "movie.mp4"; "" = none */
    double frame_rate;          /* of movies, 1/s */
    int    png_level;           /* zlib level */
};

enum hard_end { HARD_REACHED, HARD_REFUSED, HARD_STOPPED };

/* `hard`: what must hold while this scene runs, for the command `stress`. */
struct hard {
    struct key_texts models;    /* "MODEL KEY=VALUE ...", one run each; none: it is no case */
    bool   slow;                /* takes longer than a few seconds */
    int    ends;                /* enum hard_end */
    char   because[KEY_TEXT_MAX];       /* words in the reason for a refusal or stop */
    bool   mass;                /* grains and mass are kept, but for what enters and leaves */
    double momentum;            /* changes at most by this share of sqrt(2 M K) at the start */
    double energy_rises;        /* above its least value, as a share of its own scale */
    double energy_changes;      /* from its first value, as a share of its own scale */
    double overlap;             /* of grains with grains and walls, as a share of a radius */
    double within[4];           /* all centres stay in this rectangle */
    double grains[2];           /* at the end, at least and at most */
    double energy_left[2];      /* kinetic energy at the end as a share of that at the start */
    double travel[2];           /* mean way from where they began to the end, in mean diameters */
    double collisions;          /* at least so many */
    double since;               /* changes, shares and ways are measured from this time on */
    double work;                /* at most so many steps, events or ticks */
    double seconds;             /* of wall time, after which it has failed */
    uint32_t looks;             /* how often everything is compared on the way */
    struct key_texts agrees_with;       /* keys of a second run that must end alike */
    double positions;           /* may differ at most by so many mean diameters (box to box) */
    double energies;            /* kinetic ones may differ at most by this share */
};

/* Grains at the start, placed once; every model begins from the same ones. */
struct placed {
    uint32_t  count;
    double   *x, *y, *vx, *vy, *spin, *radius;
    uint16_t *species;
};

struct scene {
    char   name[KEY_TEXT_MAX];  /* of the file, without folder and ending */
    char   path[KEY_TEXT_MAX];  /* as the user named it */
    char   title[KEY_TEXT_MAX];
    int    units;               /* enum units */
    char   model[KEY_TEXT_MAX];
    uint64_t seed;
    double until;               /* the run's end */
    bool   quick;               /* the small form */
    struct key_texts quick_set; /* what the small form changes */
    uint32_t count_max;         /* most grains ever; 0: the placed ones and room for the sources */
    double overlap_limit;       /* a run ends when an overlap exceeds this share of a radius */

    double box[4];              /* x0 y0 x1 y1 */
    int    left, right, bottom, top;    /* enum border */
    double gravity[2];
    double shear_rate;          /* Lees-Edwards, du_x/dy */

    uint32_t species_count;   struct species   *species;
    uint32_t placement_count; struct placement *placements;
    uint32_t source_count;    struct source    *sources;
    uint32_t wall_entry_count; struct wall_entry *wall_entries;
    uint32_t obstacle_count;  struct wall_entry *obstacles;
    uint32_t screen_count;    struct screen    *screens;
    uint32_t sink_count;      struct sink      *sinks;
    uint32_t phase_entry_count; struct phase_entry *phase_entries;
    struct view    view;
    struct measure measure;
    struct output  output;
    struct hard    hard;

    /* Derived: */
    effects_t effects;
    uint32_t wall_count;      struct wall *walls;       /* borders, walls, obstacles; flat */
    struct placed placed;
    double radius_min, radius_max, radius_mean;         /* over all species that occur */
    uint32_t phase_count;       /* >= 1; phase 0 is this scene at time 0 */
    struct scene **phases;      /* the scene in force in each phase; phases[0] is this one */
    const double *phase_times;  /* when each begins; phase_times[0] = 0 */

    uint32_t settings_count;    /* of models, in the order of `groups` given to scene_load */
    const struct key_group *const *settings_groups;
    void   **settings;
    struct scene_places *places;        /* where each key was given, for findings */
    struct arena arena;         /* owns all of the above */
};

/* What scene_load needs from its caller. */
struct scene_request {
    const char *path;           /* a file, or the name of a built-in scene */
    const char *text;           /* or the text itself (path is then only its name); NULL: read */
    const char *const *overrides;       /* "KEY=VALUE"; applied in order */
    uint32_t    override_count;
    const struct key_group *const *groups;      /* the models' settings */
    uint32_t    group_count;
    bool        place;          /* also place the grains (dense packings take time) */
    const struct scene *grains_of;      /* or take over the grains that this scene has placed; it
                                         * must outlive the new one.  NULL: none */
};

/* Reads, overrides, resolves, checks and places.  NULL if anything is wrong: then `findings` holds
 * every error (and the warnings); with warnings only, the scene is returned.  The caller frees
 * with scene_free. */
struct scene *scene_load(const struct scene_request *request, struct findings *findings);

/* Frees the scene and the scenes of its phases. */
void scene_free(struct scene *scene);

/* The settings of the model called `name`; NULL if that group was not given to scene_load. */
void *scene_settings(const struct scene *scene, const char *name);

/* Writes the resolved scene, every default written out, as a scene file: parsing it gives the
 * same scene (same grains, same bytes). */
bool scene_write(const struct scene *scene, const char *path, struct error *error);

/* The same text into an open stream; false if memory is short. */
bool scene_write_text(const struct scene *scene, FILE *out);

/* The scene in force at time t (phases). */
const struct scene *scene_at(const struct scene *scene, double t);

/* What any phase calls for. */
effects_t scene_effects(const struct scene *scene);

/* Mass and moment of inertia of a grain: m = density pi R^2, I = q m R^2. */
double scene_mass(const struct species *species, double radius);
double scene_inertia(const struct species *species, double radius);

/* "cm", "s", "g", "d" ... of a dimension "length", "time", "speed", "mass", "force", "energy",
 * "1/time", ...; "" in reduced units. */
const char *scene_unit(const struct scene *scene, const char *dimension);

/* Why an effect is on or off: for `check --explain`. */
struct scene_reason { effects_t effect; bool on; char why[240]; };

/* The reason of effect number `index` (0 .. EFFECT_COUNT - 1); false past the last.  An effect that
 * a model's resolve() switched on is told as such. */
bool scene_explain(const struct scene *scene, uint32_t index, struct scene_reason *reason);

/* Every group and key there is, for help: the scene's own groups first.  NULL past the last. */
const struct key_group *scene_key_group(uint32_t index);

#endif
