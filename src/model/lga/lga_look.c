/* lga_look.c - pictures of the lattice: its grains one by one, or sums over the cells of a grid.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/lga/lga_bits.h"

#include "model/grains.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#define SQRT7 2.6457513110645905905

/* Where the grain in place `place` of a node lies: 0 in the centre, 1 + d towards direction d. */
static void place_position(const struct lga *lga, uint32_t site, int place, double *x, double *y)
{
    lga_lattice_position(&lga->lattice, site, x, y);
    if (place > 0) {
        double dx, dy;
        const double turn = asin(sqrt(3) / (2 * SQRT7));        /* 19.1 degrees */
        lga_lattice_vector(&lga->lattice, (place - 1) * M_PI / 3 + turn, &dx, &dy);
        *x += dx / SQRT7;
        *y += dy / SQRT7;
    }
    const double *box = lga->lattice.box;
    if (lga->lattice.wraps_x) *x -= (box[2] - box[0]) * floor((*x - box[0]) / (box[2] - box[0]));
    if (lga->lattice.wraps_y) *y -= (box[3] - box[1]) * floor((*y - box[1]) / (box[3] - box[1]));
}

static void show(const struct lga *lga, struct grains *out, uint32_t id, uint32_t site, int place,
                 bool flies)
{
    double x, y, vx = 0, vy = 0;
    place_position(lga, site, place, &x, &y);
    if (flies) lga_lattice_vector(&lga->lattice, (place - 1) * M_PI / 3, &vx, &vy);
    const double *w = out->window;
    if (w[0] <= w[2] && (x < w[0] || x > w[2] || y < w[1] || y > w[3])) return;
    if (out->count == out->capacity) {
        out->missed++;
        return;
    }
    const uint32_t i = out->count++;
    if (out->id) out->id[i] = id;
    if (out->x) out->x[i] = x;
    if (out->y) out->y[i] = y;
    if (out->vx) out->vx[i] = vx / lga->tick;
    if (out->vy) out->vy[i] = vy / lga->tick;
    if (out->angle) out->angle[i] = 0;
    if (out->spin) out->spin[i] = 0;
    if (out->radius) out->radius[i] = lga->radius;
    if (out->mass) out->mass[i] = lga->mass;
    if (out->collision_rate) out->collision_rate[i] = (float)lga_rate_of(lga, site);
    if (out->species) out->species[i] = 0;
}

/* Grains have no identity, so an id names the place in the lattice: the k-th rest grain of a node,
 * or (k = 7 + d) its mover in direction d.  A grain keeps it for as long as it rests. */
static uint32_t id_of(uint32_t site, int k)
{
    return site * (LGA_ROOM + LGA_DIRECTIONS) + (uint32_t)k;
}

void lga_look_list(const void *state, struct grains *out)
{
    const struct lga *lga = state;
    out->time = lga_step_time(lga);
    out->count = out->contact_count = out->missed = 0;
    for (uint32_t n = 0; n < lga->sites; n++) {
        const struct lga_node node = lga_node_get(lga, n);
        const unsigned moving = node.moving;
        int resting = node.rest;
        if (moving == 0 && resting == 0) continue;
        for (int d = 0; d < LGA_DIRECTIONS; d++) {
            if (moving >> d & 1) show(lga, out, id_of(n, LGA_ROOM + d), n, d + 1, true);
        }
        /* Rest grains: centre first, then places without a mover; without gravity a node may hold
         * more grains than places, and then they share. */
        for (int round = 0; resting > 0; round++) {
            for (int place = 0; place <= LGA_DIRECTIONS && resting > 0; place++) {
                if (round == 0 && place > 0 && moving >> (place - 1) & 1) continue;
                resting--;
                show(lga, out, id_of(n, resting), n, place, false);
            }
        }
    }
}

char lga_look_ground(const void *state, double x, double y)
{
    const struct lga *lga = state;
    const uint8_t kind = lga_node_get(lga, lga_lattice_nearest(&lga->lattice, x, y)).kind;
    return kind == LGA_WALL ? '#' : kind == LGA_SINK ? 'v' : ' ';
}

/* --- sampling --- */

/* A sample in the making.  A row of nodes lies in one row of cells (of columns, if the lattice is
 * turned), a column of nodes in one of two, by the parity of the row. */
struct sampling {
    const struct lga *lga;
    struct field *field;
    uint32_t *row_cell;         /* [row] */
    uint32_t *column_cell[2];   /* [parity][column] */
    double    vx[LGA_STATES], vy[LGA_STATES], square[LGA_STATES], speed[LGA_STATES];
};

enum { OUTSIDE = UINT32_MAX };

/* The cell of a place along one axis: nodes of walls may lie outside of the grid. */
static uint32_t cell_of(double place, double start, double cell, uint32_t count, double period)
{
    if (period > 0) place -= period * floor((place - start) / period);
    const double k = floor((place - start) / cell);
    return k >= 0 && k < count ? (uint32_t)k : OUTSIDE;
}

static uint32_t cell_at(const struct sampling *s, uint32_t row, uint32_t column, bool along_x)
{
    const struct field *field = s->field;
    const struct lga_lattice *lattice = &s->lga->lattice;
    const double *box = lattice->box;
    double x, y;
    lga_lattice_position(lattice, row * lattice->columns + column, &x, &y);
    return along_x ? cell_of(x, field->x0, field->cell, field->nx,
                             lattice->wraps_x ? box[2] - box[0] : 0)
                   : cell_of(y, field->y0, field->cell, field->ny,
                             lattice->wraps_y ? box[3] - box[1] : 0);
}

static void add(const struct sampling *s, uint32_t row, uint32_t column, struct lga_node node)
{
    const struct field *field = s->field;
    const uint32_t r = s->row_cell[row], c = s->column_cell[row & 1][column];
    if (r == OUTSIDE || c == OUTSIDE) return;
    const size_t all = (size_t)field->nx * field->ny;
    double *v = field->values + (s->lga->lattice.turned ? (size_t)c * field->nx + r
                                                        : (size_t)r * field->nx + c);
    const double mass = s->lga->mass, radius = s->lga->radius, count = node.rest
                      + __builtin_popcount(node.moving);
    v[SAMPLE_COUNT * all] += count;
    v[SAMPLE_MASS * all] += count * mass;
    v[SAMPLE_AREA * all] += count * M_PI * radius * radius;
    v[SAMPLE_MOMENTUM_X * all] += mass * s->vx[node.moving];
    v[SAMPLE_MOMENTUM_Y * all] += mass * s->vy[node.moving];
    v[SAMPLE_ENERGY * all] += mass * s->square[node.moving];
    v[SAMPLE_SPEED * all] += s->speed[node.moving];
}

static void add_row(const struct sampling *s, uint32_t row)
{
    const struct lga *lga = s->lga;
    const struct lga_bits *bits = lga->bits;
    const uint32_t columns = lga->lattice.columns, words = lga->words;
    if (!bits) {
        for (uint32_t x = 0; x < columns; x++) {
            const struct lga_node node = lga_node_get(lga, row * columns + x);
            if (node.moving || node.rest) add(s, row, x, node);
        }
        return;
    }
    const uint64_t *planes = lga_bits_row(lga, row);
    for (uint32_t w = 0; w < words; w++) {
        uint64_t any = 0;
        for (uint32_t p = 0; p < bits->depth; p++) any |= planes[p * words + w];
        for (; any; any &= any - 1) {
            const int b = __builtin_ctzll(any);
            struct lga_node node = {0};
            for (uint32_t p = 0; p < bits->depth; p++) {
                const unsigned digit = (unsigned)(planes[p * words + w] >> b & 1);
                if (p < LGA_DIRECTIONS) node.moving |= (uint8_t)(digit << p);
                else node.rest |= (uint8_t)(digit << (p - LGA_DIRECTIONS));
            }
            add(s, row, (uint32_t)b * words + w, node);
        }
    }
}

static void find_velocities(struct sampling *s)
{
    for (int d = 0; d < LGA_DIRECTIONS; d++) {
        double vx, vy;
        lga_lattice_vector(&s->lga->lattice, d * M_PI / 3, &vx, &vy);
        vx /= s->lga->tick;
        vy /= s->lga->tick;
        for (unsigned m = 0; m < LGA_STATES; m++) {
            if (!(m >> d & 1)) continue;
            s->vx[m] += vx;
            s->vy[m] += vy;
            s->square[m] += vx * vx + vy * vy;
            s->speed[m] += hypot(vx, vy);
        }
    }
}

bool lga_look_sample(const void *state, struct field *field)
{
    const struct lga *lga = state;
    const uint32_t rows = lga->lattice.rows, columns = lga->lattice.columns;
    const bool turned = lga->lattice.turned;
    struct sampling s = {.lga = lga, .field = field};
    assert(field->components == SAMPLE_COMPONENTS);
    uint32_t *cells = malloc(((size_t)rows + 2 * (size_t)columns) * sizeof *cells);
    if (!cells) return false;
    s.row_cell = cells;
    for (uint32_t row = 0; row < rows; row++) s.row_cell[row] = cell_at(&s, row, 0, turned);
    for (uint32_t parity = 0; parity < 2; parity++) {
        s.column_cell[parity] = cells + rows + parity * columns;
        for (uint32_t x = 0; x < columns; x++) {
            s.column_cell[parity][x] = cell_at(&s, parity, x, !turned);
        }
    }
    find_velocities(&s);
    /* Whoever takes a row or column of cells takes all of its nodes, in order: no sum depends on
     * the number of threads. */
    const uint32_t count = turned ? field->nx : field->ny;
    #pragma omp parallel for schedule(dynamic, 8)
    for (uint32_t c = 0; c < count; c++) {
        for (uint32_t row = 0; row < rows; row++) if (s.row_cell[row] == c) add_row(&s, row);
    }
    free(cells);
    return true;
}
