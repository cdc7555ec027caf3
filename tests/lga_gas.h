/* lga_gas.h - small lattices for the tests of the lattice gas, and how they cool.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LGA_GAS_H
#define LGA_GAS_H

#include "check.h"
#include "model/lga/lga_bits.h"

/* What the seeds of a measurement gave. */
struct sample { double sum, squares; int count; };

static inline void sample_add(struct sample *sample, double value)
{
    sample->sum += value;
    sample->squares += value * value;
    sample->count++;
}

static inline double sample_mean(const struct sample *sample)
{
    return sample->sum / sample->count;
}

/* Standard error of the mean; of a single seed unknown. */
static inline double sample_error(const struct sample *sample)
{
    const double mean = sample_mean(sample), n = sample->count;
    return n > 1 ? sqrt(fmax(0, sample->squares / n - mean * mean) / (n - 1)) : NAN;
}

static inline void sample_tell(const char *where, const char *what, const struct sample *sample,
                               const char *reference)
{
    print_message("    %-28s %-22s %9.4f +- %.4f (%d seeds)  reference %s\n", where, what,
                  sample_mean(sample), sample_error(sample), sample->count, reference);
}

/* A torus of fluid nodes, spacing 1 and tick 1, in the fast form if there is one. */
static inline struct lga *gas(uint32_t columns, uint32_t rows, struct lga_rule rule, uint64_t seed)
{
    struct lga *lga = calloc(1, sizeof *lga);
    lga->lattice = (struct lga_lattice){.columns = columns, .rows = rows, .spacing = 1,
                                        .along = 1, .across = 1, .turned = rule.vertical};
    lga->sites = columns * rows;
    lga->rule = rule;
    lga->seed = seed;
    lga->tick = 1;
    lga->sinks = true;
    CHECK(lga_step_allocate(lga));
    return lga;
}

static inline void gas_free(struct lga *lga)
{
    arena_free(&lga->arena);
    free(lga);
}

/* `kind` of all nodes; NULL: fluid. */
static inline void gas_set_kinds(struct lga *lga, const uint8_t *kind)
{
    uint8_t *fluid = calloc(lga->sites, 1);
    if (!kind) kind = fluid;
    if (!lga->bits) memcpy(lga->kind, kind, lga->sites);
    for (uint32_t y = 0; lga->bits && y < lga->lattice.rows; y++) {
        lga_bits_set_kinds(lga, y, kind + y * lga->lattice.columns);
    }
    if (lga->bits) lga_bits_join_walls(lga);
    free(fluid);
}

/* Uniform in [0, 1). */
static inline double gas_unit(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

static inline unsigned gas_movers(uint64_t *state, double share)
{
    unsigned moving = 0;
    for (int d = 0; d < LGA_DIRECTIONS; d++) moving |= (unsigned)(gas_unit(state) < share) << d;
    return moving;
}

struct totals { int64_t mass, movers, twice_x, y; };

static inline struct totals totals(const struct lga *lga)
{
    struct totals sum = {0};
    for (uint32_t n = 0; n < lga->sites; n++) {
        int x, y;
        const struct lga_node node = lga_node_get(lga, n);
        lga_table_momentum(node.moving, &x, &y);
        sum.movers += __builtin_popcount(node.moving);
        sum.mass += node.rest + __builtin_popcount(node.moving);
        sum.twice_x += x;
        sum.y += y;
    }
    return sum;
}

/* E/E0 at t = 1, 4, 16, 256 of a gas that starts with movers in 0.15 of all slots; mass and
 * momentum are exact in every tick, and if it `never_warms`, so is the fall of the energy.  The
 * reference numbers come from an independent program for the same rules (128 x 128 nodes, one
 * seed), so both sides of the comparison scatter. */
static inline void check_cooling(struct lga_rule rule, bool never_warms, const double expected[4])
{
    static const int times[4] = {1, 4, 16, 256};
    struct sample ratio[4];
    memset(ratio, 0, sizeof ratio);
    enum { SIDE = 128, SEEDS = 3 };
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        struct lga *lga = gas(SIDE, SIDE, rule, seed);
        uint64_t state = seed;
        gas_set_kinds(lga, NULL);
        for (uint32_t n = 0; n < lga->sites; n++) {
            lga_node_set(lga, n, gas_movers(&state, 0.15), 0);
        }
        const struct totals start = totals(lga);
        int64_t before = start.movers;
        for (int t = 1, k = 0; t <= 256; t++) {
            lga_step(lga);
            const struct totals now = totals(lga);
            CHECK(now.mass == start.mass && now.twice_x == start.twice_x && now.y == start.y);
            if (never_warms) CHECK(now.movers <= before);
            before = now.movers;
            if (t != times[k]) continue;
            sample_add(&ratio[k++], (double)now.movers / (double)start.movers);
        }
        gas_free(lga);
    }
    /* The number of movers, 14746 at the start, scatters like the number of collisions that have
     * changed it: at most sqrt(E0 (1 - ratio)) / E0, from the reference's one seed and our three;
     * at late times like the survivors of a start that itself scatters by 1/sqrt(E0). */
    for (int k = 0; k < 4; k++) {
        char when[40], shown[40];
        snprintf(when, sizeof when, "t = %d", times[k]);
        snprintf(shown, sizeof shown, "%.4f", expected[k]);
        sample_tell(when, "E/E0", &ratio[k], shown);
        const double one = sqrt(fmin(1 - expected[k], expected[k]) / 14746.0) + 1 / 14746.0;
        CHECK_NEAR(sample_mean(&ratio[k]), expected[k], 3 * one * sqrt(1 + 1.0 / SEEDS));
    }
}

/* Movers turned by 60 degrees, and mirrored about direction 0. */
static inline unsigned gas_turned(unsigned m) { return (m << 1 | m >> 5) & 0x3f; }

static inline unsigned gas_mirrored(unsigned m)
{
    unsigned out = 0;
    for (int d = 0; d < LGA_DIRECTIONS; d++) if (m >> d & 1) out |= 1u << ((6 - d) % 6);
    return out;
}

/* The weight with which (m, r) becomes (to, rest); what has no entry stays. */
static inline int gas_weight(const struct lga_case *entry, unsigned m, int r, unsigned to, int rest)
{
    int sum = entry->count == 0 && to == m && rest == r ? LGA_WEIGHT : 0;
    for (int k = 0; k < entry->count; k++) {
        if (entry->outcome[k].moving == to && entry->outcome[k].rest == rest) {
            sum += entry->outcome[k].weight;
        }
    }
    return sum;
}

#endif
