/* lga.h - the inside of the lattice gases: grains hop between the nodes of a triangular lattice.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * `rest` grains lie on a node, and `moving` has a bit for each of the six directions (60 i
 * degrees, counter-clockwise, in the lattice's own frame) in which one flies to the next node
 * within the coming tick.  Three sets of rules share lattice, walls and streaming:
 *
 * fhp2      the gas of Frisch, Hasslacher and Pomeau with at most one rest grain a node; it may
 *           lose energy where a rest grain should be kicked up, and it may fall.
 * sandpile  the same, but head-on and triple collisions may bring all grains to rest, and what is
 *           more than one rest grain on a node walks away; sand piles up, one grain a node.
 * gmlg      up to seven rest grains a node, elastic and inelastic collisions, and exclusion.
 *
 * Two forms hold the state.  In the plain one every node has its bytes; in the fast one a row is
 * seven planes of bits (nine of the gmlg), and 64 nodes a word are computed at once (lga_bits.c).
 * The same random bits give the same lattice in both.
 *
 * Storage: rows of columns, odd rows shifted by half a spacing; a torus.  Where the scene has no
 * periodic border a ring of wall or sink nodes lies around the rest.  In orientation H gravity
 * points between directions 4 and 5 and the lattice stands as stored; in V gravity points along
 * direction 3, and the lattice is turned by +90 degrees into the scene, so rows run along -x and
 * columns along y.
 */
#ifndef LGA_H
#define LGA_H

#include "base/archive.h"
#include "base/arena.h"
#include "base/error.h"
#include "base/rng.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stdint.h>

enum { LGA_DIRECTIONS = 6, LGA_ROOM = 7, LGA_STATES = 1 << LGA_DIRECTIONS };
enum lga_kind { LGA_FLUID, LGA_WALL, LGA_SINK };
enum lga_orientation { LGA_VERTICAL, LGA_HORIZONTAL };
enum lga_method { LGA_GMLG, LGA_FHP2, LGA_SANDPILE };

#define LGA_NONE UINT32_MAX

enum { LGA_LOOP_MIN = 1 << 16 };        /* nodes; below this a second thread does not pay */
enum { LGA_QUEUE = 1 << 20 };           /* nodes that a search for room tries at most */

/* The keys `lga = { ... }` of a scene; NAN: chosen by the model. */
struct lga_settings {
    int    method;
    double spacing, tick;
    double k, g, s, pw, gain;
    bool   frozen_friction;
    int    orientation;         /* enum lga_orientation */
    double p, b, fill;
    bool   fly, strict, heap;
};

/* What a node does in a tick; complete, no NANs. */
struct lga_rule {
    enum lga_method method;
    bool   gravity, vertical;
    double inelastic;           /* k: share of collisions from the inelastic column */
    double fall;                /* g: chance that gravity acts on a node in a tick */
    double friction;            /* s: chance that a grain supported on one side stays */
    bool   frozen;              /* that is drawn once for each contact, not in every tick */
    double wall_stop;           /* pw: chance that a blocked grain stops instead of bouncing */
    double gain;                /* chance that a mover kicks a rest grain up: {i} -> {i-1, i+1} */
    double loss;                /* p: share of lossy collisions of fhp2 and sandpile */
    double smooth;              /* 1 - b: chance that a wall reflects like a mirror */
    bool   fly;                 /* sandpile: gravity bends the way of movers too */
    bool   strict;              /* sandpile: no grain at rest starts towards a mover */
    bool   heap;                /* sandpile: what stops on the plate makes a heap that catches */
};

/* Random bits, one a node and tick for each of these (lga_dice.c); listed in the order in which
 * they are drawn.  A die whose outcome is certain costs no random words. */
enum lga_die_kind {
    LGA_DIE_SIDE,               /* which way a head-on pair turns */
    LGA_DIE_KICK,               /* a mover kicks a rest grain up */
    LGA_DIE_LOSS,               /* a head-on or triple collision ends at rest */
    LGA_DIE_FALL,               /* gravity acts on the node */
    LGA_DIE_FALL_SIDE,          /* and which of the two sides is down */
    LGA_DIE_BEND, LGA_DIE_BEND_SIDE,    /* the same for one of the movers */
    LGA_DIE_MIRROR,             /* walls reflect like mirrors, not back */
    LGA_DIE_PLATE,              /* what falls onto the plate stays there */
    LGA_DIE_PICK_THIRD, LGA_DIE_PICK_FIFTH, LGA_DIE_PICK_COIN, LGA_DIE_PICK_SECOND,
                                /* which of the movers bends that can: one of up to six, alike */
    LGA_DIE_FRICTION_LEFT, LGA_DIE_FRICTION_RIGHT,      /* a grain does not roll to that side */
    LGA_DIE_WAY_THIRD, LGA_DIE_WAY_SIDE,        /* which pairs stop where not all have room */
    LGA_DIE_ADMIT_THIRD, LGA_DIE_ADMIT_FIFTH,   /* who comes to a node that has not room for all */
    LGA_DIE_ADMIT_COIN,         /* six of them */
    LGA_DIE_STOP = LGA_DIE_ADMIT_COIN + 6,      /* a mover that cannot leave stops: a die each */
    LGA_DICE = LGA_DIE_STOP + LGA_DIRECTIONS
};

/* The dice of a row come in stages, each from a stream of its own, so that what one of them draws
 * does not depend on whether others are needed. */
enum lga_stage {
    LGA_STAGE_COLLIDE, LGA_STAGE_FALL, LGA_STAGE_ADMIT, LGA_STAGE_STOP, LGA_STAGE_WAYS,
    LGA_STAGE_FRICTION, LGA_STAGES
};

/* Probability threshold / 2^bits; with bits = 0 never (0) or always (1). */
struct lga_die { uint32_t threshold; int bits; };
struct lga_dice { struct lga_die of[LGA_DICE]; };

/* What becomes of 1/3 and of 1/5: thresholds out of 2^LGA_CUT_BITS. */
enum { LGA_CUT_THIRD = 341, LGA_CUT_FIFTH = 205, LGA_CUT_BITS = 10 };

/* Random words come in blocks of LGA_LANES: as many streams run beside each other. */
enum { LGA_LANES = 8 };

/* Which instructions compute; the bytes are the same. */
enum lga_simd { LGA_SIMD_BASE, LGA_SIMD_AVX2, LGA_SIMD_AVX512, LGA_SIMD_LEVELS };

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
struct lga_table {
    struct lga_case cases[2][LGA_STATES][LGA_ROOM + 1];         /* gmlg */
    struct lga_case sand[2][LGA_STATES][2];                     /* fhp2 and sandpile */
};

/* Collisions of each node, in this window of ticks and in the last whole one; digits are planes of
 * bits, [row][digit][word], lowest first. */
enum { LGA_RATE_DIGITS = 8 };
struct lga_rate {
    uint64_t window, from;      /* ticks, 0: nobody asks; the tick in which this window began */
    uint64_t *now, *last;
};

struct lga {
    struct arena arena;
    const struct scene *scene;
    struct lga_lattice lattice;
    struct lga_rule rule;
    struct lga_table *table;
    struct lga_bits  *bits;     /* the fast form; then the arrays of the plain one are NULL */
    struct lga_dice  dice;
    enum lga_simd    simd;
    double   fill;              /* share of the slots with movers at the start */
    bool     plain;             /* not the fast form: for comparison */
    bool     sinks;             /* some node may be a sink */
    bool     crowded;           /* gmlg: some node may hold more than gravity lets in */
    uint32_t words;             /* of 64 nodes in a row: column x is bit x / words of x % words */
    uint64_t *rolled[LGA_DICE]; /* plain form: the bits of this tick, [row][word] */
    uint32_t sites;
    uint8_t *kind;              /* enum lga_kind; derived from scene and time */
    uint8_t *moving, *rest;     /* the state of the plain form */
    uint8_t *load, *admitted, *hit;     /* within a tick: grains, arrivals let in, had movers */
    uint8_t *moving_next, *rest_next;
    uint8_t *heap;              /* the node belongs to the heap; NULL: there is none, or `bits` */
    uint32_t (*beside)[LGA_DIRECTIONS]; /* the six neighbours */
    uint32_t *queue;            /* search for room: nodes in the order in which they are tried */
    uint32_t queue_length;
    uint64_t *seen;             /* a bit for each node: it is in the queue */

    struct lga_rate rate;

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

/* lga_node.c: one node at a time, in either form. */
struct lga_node { uint8_t moving, rest, kind; };
struct lga_node lga_node_get(const struct lga *lga, uint32_t site);
void lga_node_set(struct lga *lga, uint32_t site, unsigned moving, unsigned rest);
uint32_t lga_node_beside(const struct lga *lga, uint32_t site, int direction);
uint32_t lga_node_load(const struct lga *lga, uint32_t site);   /* grains */

/* Rasterises the scene's walls as they are at time t. */
void lga_node_set_kinds(struct lga *lga, double t);

/* The fluid node nearest to a point and on the same side of every wall; LGA_NONE. */
uint32_t lga_node_home(const struct lga *lga, double t, double x, double y);

/* lga_walk.c: `surplus` grains, not on the lattice now, go from a node to others that have no rest
 * grain; at last resort they take a free slot of the node.  `heap`: they become part of it. */
void lga_walk(struct lga *lga, uint32_t site, uint32_t surplus, bool heap);

/* lga_rate.c: collisions counted, for EFFECT_COLLISION_RATE.  Allocation wants the window set; a
 * row's digits are NULL if nobody asks.  The rate of a node is per time, over the last window. */
bool lga_rate_allocate(struct lga *lga);
uint64_t *lga_rate_row(const struct lga *lga, uint32_t row);
void lga_rate_note(struct lga *lga, uint32_t site);     /* one collision more */
void lga_rate_end_tick(struct lga *lga);
double lga_rate_of(const struct lga *lga, uint32_t site);
void lga_rate_archive(struct lga *lga, struct archive *archive);

/* lga_dice.c */
struct lga_die lga_dice_die(double probability);
struct lga_dice lga_dice_of(const struct lga_rule *rule);
uint32_t lga_dice_words(uint32_t columns);

/* Where a row's random words come from. */
struct lga_dice_source { uint64_t seed, tick; uint32_t row, stage; };
static inline uint64_t lga_dice_key(struct lga_dice_source source)
{
    return rng_keyed(source.seed, source.tick, source.row, source.stage);
}
struct lga_dice_source lga_dice_now(const struct lga *lga, uint32_t row, enum lga_stage stage);
enum lga_stage lga_dice_stage(const struct lga_rule *rule, enum lga_die_kind kind);

enum lga_simd lga_dice_simd(void);      /* the best of this machine */

/* lga_bits.c: the bits of one row.  `out` has a row of `words` for each die that is rolled; those
 * whose outcome is certain are not.  The machine must have the instructions of `simd`. */
void lga_bits_roll(const struct lga_dice *dice, enum lga_simd simd, uint64_t key, uint32_t words,
                   uint64_t *const out[LGA_DICE]);

/* lga_lattice.c: geometry. */
struct lga_lattice lga_lattice_of(const struct scene *scene, double spacing, bool turned);
uint32_t lga_lattice_beside(const struct lga_lattice *lattice, uint32_t site, int direction);
void lga_lattice_join(const struct lga_lattice *lattice, uint32_t (*beside)[LGA_DIRECTIONS]);
void lga_lattice_position(const struct lga_lattice *lattice, uint32_t site, double *x, double *y);
void lga_lattice_vector(const struct lga_lattice *lattice, double angle, double *x, double *y);
uint32_t lga_lattice_nearest(const struct lga_lattice *lattice, double x, double y);

/* The kinds of one row of nodes at time t. */
void lga_lattice_rasterise(const struct lga_lattice *lattice, const struct scene *scene, double t,
                           uint32_t row, uint8_t *kind);

/* Is a node on the same side as (x, y) of every wall that is near to (x, y)? */
bool lga_lattice_same_side(const struct lga_lattice *lattice, const struct scene *scene, double t,
                           uint32_t site, double x, double y);
double lga_lattice_distance(const struct lga_lattice *lattice, uint32_t site, double x, double y);

/* lga_fill.c: grains that come to the lattice from outside. */
bool lga_fill_placed(struct lga *lga, struct error *error);
void lga_fill_sources(struct lga *lga);
void lga_fill_release_trapped(struct lga *lga);

/* lga_look.c: `observe` and `sample` of the model. */
struct field;
struct grains;
void lga_look_list(const void *state, struct grains *out);
bool lga_look_sample(const void *state, struct field *field);
char lga_look_ground(const void *state, double x, double y);

/* lga_step.c: one tick by any rules, and the streaming that they share.  Allocation takes an empty
 * `lga` whose lattice, rule and sites are set. */
bool lga_step_allocate(struct lga *lga);
void lga_step(struct lga *lga);
double lga_step_time(const struct lga *lga);

/* `moving` of a node whose blocked links have sent the movers `stuck` back, as if those had been
 * mirrored instead. */
unsigned lga_step_mirrored(unsigned blocked, unsigned stuck, unsigned moving);

/* lga_plain.c: the random bits of the plain form. */
bool lga_plain_allocate(struct lga *lga);
void lga_plain_roll(struct lga *lga);

/* Counts the collisions of this tick, of which `admitted` tells before anyone is let in. */
void lga_plain_note(struct lga *lga);
bool lga_plain_die(const struct lga *lga, enum lga_die_kind kind, uint32_t site);

/* 0, 1 or 2, alike; one of a set of directions, and of those movers of a node that gravity can
 * bend, all with equal chance. */
struct lga_pick { bool third, fifth, coin, second; };
int lga_plain_third(bool third, bool coin);
int lga_plain_pick(unsigned set, struct lga_pick dice);
int lga_plain_mover(const struct lga *lga, uint32_t site, unsigned able);

/* lga_gmlg.c, lga_sand.c: what happens before streaming, in the plain form. */
void lga_gmlg_collide(struct lga *lga);
bool lga_sand_allocate(struct lga *lga);
void lga_sand_collide(struct lga *lga);
void lga_sand_settle(struct lga *lga);  /* and after it: contacts with the heap */

#endif
