/* lga_bits_gmlg.c - the GMLG in planes of bits, row by row.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Four passes follow each other a row apart, so that all of them work in the cache: a row is
 * surveyed (which nodes are full?) before its neighbours collide and fall, they before it is known
 * who is let in, and that before grains stream.  A row in its place is needed last by the survey,
 * three rows ahead of the streaming that overwrites it.  Bands of rows go to threads: each first
 * makes copies of the two rows below and above it, collided, while all rows are as they were.
 *
 * A row that holds no movers, and whose rest grains lie where none can start, passes by as it is:
 * so what is empty or at rest costs little more than the survey.
 */
#include "model/lga/lga_bits.h"

#include <assert.h>
#include <string.h>

/* Planes of a row on its way: six directions, three bits of rest grains, three of room, full. */
enum { PLANE_ROOM = LGA_GMLG_PLANES, PLANE_FULL = PLANE_ROOM + 3, PLANES };

/* Rows of a band on their way: those four that are needed at once, and two copies at each end.
 * Then the admissions of three rows, six planes each. */
enum { AT_ONCE = 4, HALO = 2, SLOTS = AT_ONCE + 2 * HALO, ADMITTED = 3 };

/* Where the row of a node's neighbour in each direction lies. */
static const int above[LGA_DIRECTIONS] = {0, 1, 1, 0, -1, -1};

struct band {
    const struct lga *lga;
    const struct lga_kernel *kernel;
    uint64_t *slots, *admitted;
    bool     *moving, *coming;          /* of each of these: not all planes of movers are zero */
    enum lga_holds holds[SLOTS];        /* what the row holds whose way begins here */
    bool     still[SLOTS];              /* and it stays as it is */
    int64_t  first, rows;               /* of the lattice; in the band */
    ptrdiff_t aside[2][LGA_DIRECTIONS]; /* columns to a neighbour, in even and odd rows */
    uint64_t (*collide)(const struct lga_row_gmlg *row);
    struct lga_row_survey surveying;    /* of each pass what is the same for all rows */
    struct lga_row_gmlg   colliding;
    struct lga_row_admit  admitting;
    struct lga_row_arrive arriving;
    uint64_t collisions, refused, gone;
};

static size_t slot_words(const struct lga_bits *bits) { return (size_t)PLANES * bits->stride; }

static size_t admitted_words(const struct lga_bits *bits)
{
    return (size_t)LGA_DIRECTIONS * bits->stride;
}

static size_t band_words(const struct lga_bits *bits)
{
    return SLOTS * slot_words(bits) + ADMITTED * admitted_words(bits);
}

bool lga_bits_gmlg_allocate(struct lga *lga)
{
    struct lga_bits *bits = lga->bits;
    return arena_array(&lga->arena, &bits->rings, bits->bands * band_words(bits))
        && arena_array(&lga->arena, &bits->moving, (size_t)bits->bands * (SLOTS + ADMITTED))
        && lga_bits_allocate_real(lga);
}

/* Which form of the collisions fits, and what it is told. */
static void choose_collisions(struct band *band)
{
    const struct lga *lga = band->lga;
    const struct lga_kernel *kernel = band->kernel;
    const bool gravity = lga->rule.gravity, vertical = lga->rule.vertical;
    unsigned *effects = &band->colliding.effects;
    if (gravity) *effects |= LGA_BITS_GRAVITY;
    if (vertical) *effects |= LGA_BITS_VERTICAL;
    if (!gravity || lga->crowded) *effects |= LGA_BITS_TIGHT;
    band->collide = !gravity ? kernel->gmlg_free : lga->crowded ? kernel->gmlg_any
                  : vertical ? kernel->gmlg_vertical : kernel->gmlg_level;
}

static struct band band_of(const struct lga *lga, const struct lga_kernel *kernel, uint32_t number)
{
    const struct lga_bits *bits = lga->bits;
    const uint32_t words = bits->words, stride = bits->stride;
    uint64_t *slots = bits->rings + number * band_words(bits) + LGA_LANES;
    bool *moving = bits->moving + (size_t)number * (SLOTS + ADMITTED);
    const int64_t first = lga_bits_band(lga, number);
    struct band band = {
        .lga = lga, .kernel = kernel, .slots = slots,
        .admitted = slots + SLOTS * slot_words(bits), .moving = moving, .coming = moving + SLOTS,
        .first = first, .rows = (int64_t)lga_bits_band(lga, number + 1) - first,
        .surveying = {.words = words, .stride = stride},
        .colliding = {.words = words, .stride = stride, .held = lga->trapped, .dice = &lga->dice,
                      .source = lga_dice_now(lga, 0, LGA_STAGE_COLLIDE),
                      .ways = lga_dice_now(lga, 0, LGA_STAGE_WAYS),
                      .friction = lga_dice_now(lga, 0, LGA_STAGE_FRICTION)},
        .admitting = {.words = words, .stride = stride, .crowds = lga->rule.gravity,
                      .source = lga_dice_now(lga, 0, LGA_STAGE_ADMIT), .real = bits->real},
        .arriving = {.words = words, .stride = stride, .held = lga->trapped,
                     .blocks = lga->rule.gravity || bits->effects & LGA_BITS_WALLS,
                     .source = lga_dice_now(lga, 0, LGA_STAGE_STOP), .dice = &lga->dice}
    };
    for (uint32_t k = 0; k < 2; k++) {
        for (int d = 0; d < LGA_DIRECTIONS; d++) band.aside[k][d] = lga_bits_shift(k, d);
    }
    choose_collisions(&band);
    return band;
}

/* Row k of a band, -2 .. rows + 1, as a row of the lattice. */
static uint32_t row_of(const struct band *band, int64_t k)
{
    const int64_t rows = band->lga->lattice.rows;
    int64_t row = band->first + k;
    while (row < 0) row += rows;
    while (row >= rows) row -= rows;
    return (uint32_t)row;
}

/* The place where row k is kept on its way. */
static uint32_t place_of(const struct band *band, int64_t k)
{
    const int64_t index = k < 0 ? AT_ONCE + HALO + k
                        : k >= band->rows ? AT_ONCE + HALO + (k - band->rows) : k % AT_ONCE;
    assert(index >= 0);
    assert(index < SLOTS);
    return (uint32_t)index;
}

static uint64_t *slot(const struct band *band, int64_t k)
{
    return band->slots + place_of(band, k) * slot_words(band->lga->bits);
}

/* The place of what row k lets in. */
static uint32_t door_of(int64_t k) { return (uint32_t)(k + ADMITTED) % ADMITTED; }

static uint64_t *admitted(const struct band *band, int64_t k)
{
    return band->admitted + door_of(k) * admitted_words(band->lga->bits);
}

/* Clears the planes of movers of a row on its way, unless they are clear. */
static void clear(const struct lga_bits *bits, uint64_t *row, bool *moving)
{
    if (*moving) memset(row - LGA_LANES, 0, admitted_words(bits) * sizeof *row);
    *moving = false;
}

static const uint64_t *sink_row(const struct lga_bits *bits, uint32_t row)
{
    return bits->sink ? bits->sink + (size_t)row * bits->words : NULL;
}

static enum lga_holds survey(struct band *band, uint32_t row, uint64_t *out)
{
    const struct lga *lga = band->lga;
    const struct lga_bits *bits = lga->bits;
    struct lga_row_survey *pass = &band->surveying;
    pass->planes = lga_bits_row(lga, row);
    pass->wall = lga_bits_wall(lga, row);
    pass->sink = sink_row(bits, row);
    pass->room = out + PLANE_ROOM * bits->stride;
    pass->full = out + PLANE_FULL * bits->stride;
    const enum lga_holds holds = band->kernel->survey(pass);
    lga_bits_join(lga, pass->full);
    return holds;
}

/* Row k; `near` are the places of the row below, of the row itself and of the row above.  Its
 * collisions count, unless this is only a `copy`. */
static uint64_t collide(struct band *band, int64_t k, bool copy, uint64_t *const near[3])
{
    const struct lga *lga = band->lga;
    const struct lga_bits *bits = lga->bits;
    const uint32_t row = row_of(band, k), place = place_of(band, k);
    const bool gravity = lga->rule.gravity;
    struct lga_row_gmlg *pass = &band->colliding;
    pass->in = lga_bits_row(lga, row);
    pass->wall = lga_bits_wall(lga, row);
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        pass->full[d] = near[1 + above[d]] + PLANE_FULL * bits->stride + band->aside[row & 1][d];
    }
    band->still[place] = band->holds[place] == LGA_HOLDS_NOTHING
        || (band->holds[place] == LGA_HOLDS_REST && !(gravity && band->kernel->stirs(pass)));
    if (band->still[place]) {
        clear(bits, near[1], &band->moving[place]);
        return 0;
    }
    pass->source.row = pass->ways.row = pass->friction.row = row;
    pass->out = near[1];
    pass->hits = copy ? NULL : lga_rate_row(lga, row);
    const uint64_t collisions = band->collide(pass);
    lga_bits_join_planes(lga, near[1], LGA_DIRECTIONS);
    band->moving[place] = true;
    return collisions;
}

static uint64_t admit(struct band *band, int64_t k)
{
    const struct lga_bits *bits = band->lga->bits;
    const uint32_t row = row_of(band, k), places[3] = {place_of(band, k - 1), place_of(band, k),
                                                       place_of(band, k + 1)};
    uint64_t *out = admitted(band, k), *own = slot(band, k);
    bool *coming = &band->coming[door_of(k)];
    const bool *moving = band->moving;
    if (!moving[places[0]] && !moving[places[1]] && !moving[places[2]]) {
        clear(bits, out, coming);
        return 0;
    }
    *coming = true;
    struct lga_row_admit *pass = &band->admitting;
    pass->source.row = row;
    pass->wall = lga_bits_wall(band->lga, row);
    pass->own = own;
    pass->room = own + PLANE_ROOM * bits->stride;
    pass->out = out;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        const int back = (d + 3) % LGA_DIRECTIONS;
        pass->from[d] = band->slots + places[1 + above[back]] * slot_words(bits)
                      + (uint32_t)d * bits->stride + band->aside[row & 1][back];
    }
    const uint64_t refused = band->kernel->admit(pass);
    lga_bits_join_planes(band->lga, out, LGA_DIRECTIONS);
    return refused;
}

static uint64_t arrive(struct band *band, int64_t k)
{
    const struct lga *lga = band->lga;
    const struct lga_bits *bits = lga->bits;
    const bool still = band->still[place_of(band, k)];
    if (still && !band->coming[door_of(k)]) return 0;
    const uint32_t row = row_of(band, k);
    const uint64_t *const doors[3] = {admitted(band, k - 1), admitted(band, k),
                                      admitted(band, k + 1)};
    struct lga_row_arrive *pass = &band->arriving;
    pass->source.row = row;
    pass->wall = lga_bits_wall(lga, row);
    pass->sink = sink_row(bits, row);
    pass->own = slot(band, k);
    pass->own_admitted = doors[1];
    pass->out = lga_bits_row(lga, row);
    pass->rest = still ? pass->out + 6 * bits->words : pass->own + 6 * bits->stride;
    pass->apart = still ? bits->words : bits->stride;
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        pass->admitted[d] = doors[1 + above[d]] + (uint32_t)d * bits->stride
                          + band->aside[row & 1][d];
    }
    const uint64_t gone = band->kernel->arrive(pass);
    lga_bits_trim(lga, row);
    return gone;
}

/* Rows -2, -1 and rows, rows + 1 of the band, collided.  Rows that they need but that are not kept
 * go into places that are free yet. */
static void prepare_ends(struct band *band)
{
    const int64_t starts[2] = {-HALO, band->rows};
    for (int end = 0; end < 2; end++) {
        uint64_t *place[HALO + 2];
        place[0] = band->slots;
        place[1] = slot(band, starts[end]);
        place[2] = slot(band, starts[end] + 1);
        place[3] = band->slots + slot_words(band->lga->bits);
        for (int i = 0; i < HALO + 2; i++) {
            const int64_t k = starts[end] - 1 + i;
            const enum lga_holds holds = survey(band, row_of(band, k), place[i]);
            if (i > 0 && i <= HALO) band->holds[place_of(band, k)] = holds;
        }
        for (int i = 0; i < HALO; i++) {
            uint64_t *const near[3] = {place[i], place[i + 1], place[i + 2]};
            collide(band, starts[end] + i, true, near);
        }
    }
}

static void pass_band(struct band *band)
{
    int64_t surveyed = 0, collided = 0, let_in = -1;
    for (int64_t k = 0; k < band->rows; k++) {
        for (; let_in <= k + 1; let_in++) {
            for (; collided <= let_in + 1 && collided < band->rows; collided++) {
                for (; surveyed <= collided + 1 && surveyed < band->rows; surveyed++) {
                    band->holds[place_of(band, surveyed)] = survey(band, row_of(band, surveyed),
                                                                   slot(band, surveyed));
                }
                uint64_t *const near[3] = {slot(band, collided - 1), slot(band, collided),
                                           slot(band, collided + 1)};
                band->collisions += collide(band, collided, false, near);
            }
            const uint64_t refused = admit(band, let_in);
            if (let_in >= 0 && let_in < band->rows) band->refused += refused;
        }
        band->gone += arrive(band, k);
    }
}

void lga_bits_gmlg_step(struct lga *lga, const struct lga_kernel *kernel)
{
    const uint32_t bands = lga->bits->bands;
    uint64_t collisions = 0, refused = 0, gone = 0;
    #pragma omp parallel for schedule(static, 1) if (bands > 1)
    for (uint32_t b = 0; b < bands; b++) {
        struct band band = band_of(lga, kernel, b);
        prepare_ends(&band);
    }
    #pragma omp parallel for schedule(static, 1) reduction(+ : collisions, refused, gone) \
        if (bands > 1)
    for (uint32_t b = 0; b < bands; b++) {
        struct band band = band_of(lga, kernel, b);
        pass_band(&band);
        collisions += band.collisions;
        refused += band.refused;
        gone += band.gone;
    }
    lga->collisions += collisions;
    lga->refused += refused;
    lga->grains_out += gone;
}
