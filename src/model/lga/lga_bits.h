/* lga_bits.h - the fast form of a lattice gas: planes of bits, 64 nodes a word.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A row of `columns` nodes is seven planes (six directions and the rest grain; of the gmlg nine:
 * three bits tell how many grains rest, the lowest first) of `words` words:
 * node x is bit x / words of word x % words.  So the nodes to the left of a word's nodes are the
 * word before it, and streaming is a load from the next address; only the ends of a row need a
 * shift.  The state is kept once and changed in place: memory is seven or nine bits a node and one
 * for the walls.
 */
#ifndef LGA_BITS_H
#define LGA_BITS_H

#include "model/lga/lga.h"

/* A row on its way has two planes of dice besides: what mirrors, and what a plate stops. */
enum { LGA_PLANES = 7, LGA_RING = 6, LGA_RING_PLANES = LGA_PLANES + 2 };
enum { LGA_PLANE_MIRROR = LGA_PLANES, LGA_PLANE_PLATE };

enum {
    LGA_BITS_LOSS = 1, LGA_BITS_GRAVITY = 2,
    LGA_BITS_RATE = 4,          /* collisions are counted at each node */
    LGA_BITS_WALLS = 8, LGA_BITS_SINKS = 16,
    LGA_BITS_HELD = 32,         /* grains caught by a wall wait inside it */
    LGA_BITS_MIRROR = 64,
    LGA_BITS_VERTICAL = 128,    /* gmlg: gravity points along direction 3 */
    LGA_BITS_TIGHT = 256        /* gmlg: a collision may need more room than a node has */
};

enum { LGA_GMLG_PLANES = 9 };

struct lga_bits {
    uint32_t words, stride;     /* of a plane of the state; of a row with a margin on each side */
    uint32_t last_word, last_bit;   /* of a row: where its last column is */
    uint32_t copy_word, copy_bit;   /* and where the one behind it is, a copy of the first */
    uint32_t depth;             /* planes of a row */
    uint32_t bands;             /* rows are shared out in so many parts */
    uint64_t *planes;           /* [row][plane][word] */
    uint64_t *wall;             /* [row][word], with margins */
    uint64_t *sink;             /* [row][word]; NULL: none */
    uint8_t  *kinds;            /* a row of them for each band, while walls are drawn */
    uint64_t *real;             /* [word]: which bits of a row are its nodes; gmlg, heaps */
    uint64_t *rings;            /* rows after their collisions: [band][LGA_RING][plane][word] */
    bool     *moving;           /* gmlg: which rows on their way hold movers, [band][row] */
    uint64_t *surplus;          /* sandpile: rest grains beyond the first, lowest bit first:
                                 * [row][digit][word] */
    uint32_t digits;            /* of those: two, three if a heap catches grains */
    uint8_t  *spills;           /* [row]: are there any? */
    uint64_t *heap;             /* [row][word], with margins: who belongs to it; NULL: none */
    unsigned effects;
};

struct lga_row_collide {
    uint32_t words, stride;
    unsigned effects;
    uint64_t key;               /* of the row's random words */
    const struct lga_dice *dice;
    const uint64_t *in;
    uint64_t *out, *hits;       /* the row's digits of collisions counted */
    const uint64_t *wall, *wall_left, *wall_right;      /* here, and where a grain would fall */
};

struct lga_row_stream {
    uint32_t words;
    unsigned effects;
    uint64_t *out;
    const uint64_t *from[LGA_DIRECTIONS];       /* where the movers of a direction come from */
    const uint64_t *wall_from[LGA_DIRECTIONS];  /* or the wall that sends others back */
    const uint64_t *own[LGA_RING_PLANES];
    const uint64_t *wall, *sink;
    uint64_t *heap, *surplus;   /* of a sandpile with a heap, and which bits are nodes */
    const uint64_t *real;
    uint8_t *spills;
};

/* The two stages of the sandpile. */
struct lga_row_stop {
    uint32_t words;
    bool held;                  /* grains caught by a wall wait inside it */
    const uint64_t *wall;
    uint64_t key;
    const struct lga_dice *dice;
    uint64_t *planes, *low, *high, *hits;
    uint8_t *spills;
};

struct lga_row_fall {
    uint32_t words, stride;
    bool held, fly, plate;      /* gravity bends movers; a plate may stop what falls onto it */
    const uint64_t *wall;
    uint64_t key;
    const struct lga_dice *dice;
    const uint64_t *in;
    uint64_t *out;
    const uint64_t *wall_left, *wall_right, *taken_left, *taken_right;
    const uint64_t *rest_left, *rest_right;     /* with `fly`: rest grains there */
};

/* Which rest grains lie on the heap or on walls, and so belong to it. */
struct lga_row_bind {
    uint32_t words;
    const uint64_t *rest, *wall;
    const uint64_t *wall_left, *wall_right, *heap_left, *heap_right;    /* of the row below */
    uint64_t *heap;
};

/* The four passes of the gmlg: what room there is; collide and fall; who is let in; stream. */
struct lga_row_survey {
    uint32_t words, stride;
    const uint64_t *planes, *wall, *sink;       /* sink may be NULL */
    uint64_t *room, *full;
};

enum lga_holds { LGA_HOLDS_NOTHING, LGA_HOLDS_REST, LGA_HOLDS_MOVERS };

struct lga_row_gmlg {
    uint32_t words, stride;
    unsigned effects;
    bool held;
    struct lga_dice_source source, ways, friction;
    const struct lga_dice *dice;
    const uint64_t *in, *wall;
    const uint64_t *full[LGA_DIRECTIONS];       /* of the neighbours that are not above */
    uint64_t *out, *hits;
};

struct lga_row_admit {
    uint32_t words, stride;
    bool crowds;                /* there is only so much room */
    struct lga_dice_source source;
    const uint64_t *wall, *real, *room;
    const uint64_t *own;
    const uint64_t *from[LGA_DIRECTIONS];       /* where the movers of a direction come from */
    uint64_t *out;
};

struct lga_row_arrive {
    uint32_t words, stride, apart;      /* planes of `rest` lie so far apart */
    bool held, blocks;          /* some mover may be unable to leave */
    struct lga_dice_source source;
    const struct lga_dice *dice;
    const uint64_t *wall, *sink;
    const uint64_t *own, *own_admitted, *rest;
    const uint64_t *admitted[LGA_DIRECTIONS];   /* was a mover let in where it goes? */
    uint64_t *out;
};

/* One set of instructions; the index is LGA_BITS_LOSS | LGA_BITS_GRAVITY | LGA_BITS_RATE. */
struct lga_kernel {
    void (*roll)(const struct lga_dice *dice, uint64_t key, uint32_t words,
                 uint64_t *const rows[LGA_DICE]);
    uint64_t (*collide[8])(const struct lga_row_collide *row);
    uint64_t (*collide_any)(const struct lga_row_collide *row);
    void (*stream_free)(uint64_t *out, uint32_t words, const uint64_t *const from[LGA_PLANES]);
    uint64_t (*stream_walls)(const struct lga_row_stream *row);
    uint64_t (*stream_any)(const struct lga_row_stream *row);
    uint64_t (*stop)(const struct lga_row_stop *row);
    void (*fall)(const struct lga_row_fall *row);
    uint64_t (*stream_heap)(const struct lga_row_stream *row);
    void (*bind)(const struct lga_row_bind *row);
    enum lga_holds (*survey)(const struct lga_row_survey *row);
    bool (*stirs)(const struct lga_row_gmlg *row);
    uint64_t (*gmlg_free)(const struct lga_row_gmlg *row);
    uint64_t (*gmlg_level)(const struct lga_row_gmlg *row);
    uint64_t (*gmlg_vertical)(const struct lga_row_gmlg *row);
    uint64_t (*gmlg_any)(const struct lga_row_gmlg *row);
    uint64_t (*admit)(const struct lga_row_admit *row);
    uint64_t (*arrive)(const struct lga_row_arrive *row);
};

/* lga_bits_sand.c: the sandpile before its rows are streamed, and its heap after that. */
bool lga_bits_sand_allocate(struct lga *lga);
uint64_t lga_bits_sand_stop(struct lga *lga, const struct lga_kernel *kernel);
void lga_bits_sand_fall(const struct lga *lga, const struct lga_kernel *kernel, uint32_t row,
                        uint64_t *out, uint64_t *scratch);
void lga_bits_sand_settle(struct lga *lga, const struct lga_kernel *kernel);

/* lga_bits_gmlg.c */
bool lga_bits_gmlg_allocate(struct lga *lga);
void lga_bits_gmlg_step(struct lga *lga, const struct lga_kernel *kernel);

bool lga_bits_allocate(struct lga *lga);
void lga_bits_step(struct lga *lga);

/* The kinds of a row's nodes; after the last row the walls' margins are to be joined. */
void lga_bits_set_kinds(struct lga *lga, uint32_t row, const uint8_t *kind);
void lga_bits_join_walls(struct lga *lga);
void lga_bits_rasterise(struct lga *lga, double t);     /* all that from the scene */

struct lga_node lga_bits_node(const struct lga *lga, uint32_t site);
uint64_t *lga_bits_row(const struct lga *lga, uint32_t row);    /* its first plane */
void lga_bits_trim(const struct lga *lga, uint32_t row);    /* clears the copy of the first one */
void lga_bits_clean(const struct lga *lga, uint32_t row);   /* and all that is behind the columns */
uint32_t lga_bits_band(const struct lga *lga, uint32_t band);   /* its first row */
int lga_bits_shift(uint32_t row, int direction);    /* columns to the neighbour there */
uint64_t *lga_bits_wall(const struct lga *lga, uint32_t row);   /* with margins */
uint64_t *lga_bits_heap(const struct lga *lga, uint32_t row);   /* the same */
bool lga_bits_allocate_real(struct lga *lga);
void lga_bits_join(const struct lga *lga, uint64_t *row);       /* fills the margins of a row */
void lga_bits_join_planes(const struct lga *lga, uint64_t *row, uint32_t count);
void lga_bits_set(struct lga *lga, uint32_t site, unsigned moving, unsigned rest);

/* How many grains of a row fly in each direction, and how many rest. */
void lga_bits_sum(const struct lga *lga, uint32_t row, uint64_t sum[LGA_PLANES]);

#endif
