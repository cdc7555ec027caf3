/* lga.h - the inside of the lattice gas: grains hop between the nodes of a triangular lattice.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A node holds up to seven grains: `rest` of them lie on it, and `moving` has a bit for each of
 * the six directions (60 i degrees, counter-clockwise, in the lattice's own frame) in which one
 * flies to the next node within the coming tick.  The rules are those of the "gravity, many rest
 * particles" gas: FHP-II collisions with any number of rest grains (elastic column), the same
 * with the loss of energy (inelastic column), and exclusion, so that sand has a volume.
 *
 * Storage: rows of columns, odd rows shifted by half a spacing; a torus.  Where the scene has no
 * periodic border a ring of wall or sink nodes lies around the rest.  In orientation H gravity
 * points between directions 4 and 5 and the lattice stands as stored; in V gravity points along
 * direction 3, and the lattice is turned by +90 degrees into the scene, so rows run along -x and
 * columns along y.
 */
#ifndef LGA_H
#define LGA_H

#include "base/arena.h"
#include "base/error.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

enum { LGA_DIRECTIONS = 6, LGA_ROOM = 7, LGA_STATES = 1 << LGA_DIRECTIONS };
enum lga_kind { LGA_FLUID, LGA_WALL, LGA_SINK };
enum lga_orientation { LGA_VERTICAL, LGA_HORIZONTAL };

#define LGA_NONE UINT32_MAX

/* The keys `lga = { ... }` of a scene; NAN: chosen by the model. */
struct lga_settings {
    int    method;
    double spacing, tick;
    double k, g, s, pw, gain;
    int    orientation;         /* enum lga_orientation */
};

/* What a node does in a tick; complete, no NANs. */
struct lga_rule {
    bool   gravity, vertical;
    double inelastic;           /* k: share of collisions from the inelastic column */
    double fall;                /* g: chance that gravity acts on a node in a tick */
    double friction;            /* s: chance that a grain supported on one side stays */
    double wall_stop;           /* pw: chance that a blocked grain stops instead of bouncing */
    double gain;                /* chance that a mover kicks a rest grain up: {i} -> {i-1, i+1} */
};

/* Which node is where. */
struct lga_lattice {
    uint32_t columns, rows;     /* rows is even */
    bool   turned;              /* orientation V */
    double x0, y0;              /* scene position of row 0, column 0 */
    double spacing;             /* as asked for */
    double along, across;       /* scene length of one spacing along a row, and across rows; equal
                                 * to `spacing` but where a periodic border must be met exactly */
    double box[4];
    bool   wraps_x, wraps_y;    /* in the scene's frame */
};

/* What can come out of a collision (lga_table.c), with weights that add up to LGA_WEIGHT. */
enum { LGA_WEIGHT = 12, LGA_OUTCOMES = 6 };
enum lga_column { LGA_ELASTIC, LGA_INELASTIC };
struct lga_outcome { uint8_t moving, rest, weight; };
struct lga_case { uint8_t count; struct lga_outcome outcome[LGA_OUTCOMES]; };    /* 0: unchanged */
struct lga_table { struct lga_case cases[2][LGA_STATES][LGA_ROOM + 1]; };

struct lga {
    struct arena arena;
    const struct scene *scene;
    struct lga_lattice lattice;
    struct lga_rule rule;
    struct lga_table *table;
    uint32_t sites;
    uint8_t *kind;              /* enum lga_kind; derived from scene and time */
    uint8_t *moving, *rest;     /* the state */
    uint8_t *load, *admitted, *hit;     /* within a tick: grains, arrivals let in, had movers */
    uint8_t *moving_next, *rest_next;
    uint32_t (*beside)[LGA_DIRECTIONS]; /* the six neighbours */
    uint32_t *queue, *stamp;    /* search for room */
    uint32_t searches;

    uint64_t seed;
    uint64_t ticks;
    double   tick;              /* duration; time = base_time + (ticks - base_ticks) * tick */
    uint64_t base_ticks;
    double   base_time;
    uint64_t grains_in, grains_out, collisions, refused;
    uint64_t *entered;          /* grains that each source has given */
    uint64_t gates_present;     /* hash of which walls are there: did a gate open? */
    bool     walls_stale, trapped;      /* rasterise again; some wall node holds grains */
    double   mass, radius;      /* of the mean grain */
};

/* lga_table.c */
void lga_table_fill(struct lga_table *table);

/* Momentum of a set of movers in whole units: 2 px, and py / (sqrt(3)/2), of unit speed. */
void lga_table_momentum(unsigned moving, int *twice_x, int *y);

/* lga_lattice.c: geometry. */
struct lga_lattice lga_lattice_of(const struct scene *scene, double spacing, bool turned);
void lga_lattice_join(const struct lga_lattice *lattice, uint32_t (*beside)[LGA_DIRECTIONS]);
void lga_lattice_position(const struct lga_lattice *lattice, uint32_t site, double *x, double *y);
void lga_lattice_vector(const struct lga_lattice *lattice, double angle, double *x, double *y);
uint32_t lga_lattice_nearest(const struct lga_lattice *lattice, double x, double y);

/* The kind of every node at time t. */
void lga_lattice_rasterise(const struct lga_lattice *lattice, const struct scene *scene, double t,
                           uint8_t *kind);

/* The fluid node nearest to a point and on the same side of every wall; LGA_NONE. */
uint32_t lga_lattice_home(const struct lga_lattice *lattice, const struct scene *scene, double t,
                          const uint8_t *kind, double x, double y);

/* lga_fill.c: grains that come to the lattice from outside. */
bool lga_fill_placed(struct lga *lga, struct error *error);
void lga_fill_sources(struct lga *lga);
void lga_fill_release_trapped(struct lga *lga);

/* lga_step.c: the rules.  Takes an empty `lga` whose lattice and sites are set. */
bool lga_step_allocate(struct lga *lga);
void lga_step(struct lga *lga);
double lga_step_time(const struct lga *lga);

#endif
