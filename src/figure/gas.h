/* gas.h - the freely cooling gas of `cooling`, at any size, density and restitution, by any model.
 *
 * Units: a diameter, the mass of a grain, and T = 1 at the start of cooling.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef GAS_H
#define GAS_H

#include "figure/lab.h"

enum gas_kind { GAS_ED, GAS_DSMC, GAS_HSMC, GAS_KINDS };

struct gas {
    enum gas_kind kind;
    uint32_t side;              /* side^2 grains on a square lattice; 0: `count` at random */
    uint32_t count;
    uint32_t weight;            /* of DSMC and HSMC: simulated grains a disc; 0: one */
    double   fraction, restitution;
    double   t_c;               /* of ED */
    double   equilibrate;       /* collisions of a grain before the cooling */
    double   start, unit;       /* when cooling begins; t0 */
    double   length;            /* of the box */
};

extern const char *const gas_names[GAS_KINDS];

/* N = side^2 grains at nu = 0.25, and the r of the papers, 0.8. */
struct gas gas_paper(enum gas_kind kind, uint32_t side);

/* Fills start, unit and length, and writes the keys. */
void gas_wish(struct gas *gas, struct lab_wish *wish);

/* K(t)/K0 against t/t0, as a new curve, at `count` times evenly on a logarithmic scale from 0.02 to
 * `end`; the lab must be fresh. */
bool gas_cool(struct lab *lab, const struct gas *gas, double end, uint32_t count,
              struct chart *chart, struct error *error);

/* Haff's law up to t/t0 = end. */
void gas_law(struct chart *chart, double end);

#endif
