/* gas.c - see gas.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "figure/gas.h"

#include "measure/haff.h"

const char *const gas_names[GAS_KINDS] = {"ED", "DSMC", "HSMC"};

static const double first_time = 0.02;          /* of t0, where curves begin */

struct gas gas_paper(enum gas_kind kind, uint32_t side)
{
    return (struct gas){.kind = kind, .side = side, .fraction = 0.25, .restitution = 0.8,
                        .t_c = 1e-5, .equilibrate = 20};
}

void gas_wish(struct gas *gas, struct lab_wish *wish)
{
    static const char *const models[GAS_KINDS] = {"ed", "dsmc", "dsmc"};
    const uint32_t count = gas->side ? gas->side * gas->side : gas->count;
    const double spacing = sqrt(M_PI / 4 / gas->fraction);
    gas->count = count;
    gas->length = spacing * sqrt(count);
    gas->start = gas->equilibrate / haff_frequency(gas->fraction, 1, 1);
    gas->unit = haff_time(gas->fraction, 1, 1, gas->restitution);
    *wish = (struct lab_wish){.scene = "cooling"};
    lab_set(wish, "model=%s", models[gas->kind]);
    if (gas->kind == GAS_HSMC) lab_set(wish, "dsmc.method=hsmc");
    if (gas->weight > 1) lab_set(wish, "dsmc.weight=%u", gas->weight);
    if (gas->kind == GAS_ED) lab_set(wish, "ed.t_c=%g", gas->t_c);
    lab_set(wish, "box=[0,0,%.12g,%.12g]", gas->length, gas->length);
    lab_set(wish, "placements.[0].count=%u", count);
    /* A lattice that just fits: the last digit of its spacing must not push the last column out. */
    if (gas->side) lab_set(wish, "placements.[0].spacing=%.12g", spacing * (1 - 1e-8));
    else lab_set(wish, "placements.[0].kind=random");
    lab_set(wish, "phases.[0].time=%.8g", gas->start);
    lab_set(wish, "phases.[0].set=[\"grains.[0].restitution=%g\"]", gas->restitution);
}

bool gas_cool(struct lab *lab, const struct gas *gas, double end, uint32_t count,
              struct chart *chart, struct error *error)
{
    if (!lab_go(lab, gas->start, error)) return false;
    const double k0 = lab_count(lab).kinetic_energy;
    for (uint32_t k = 0; k < count; k++) {
        const double t = first_time * pow(end / first_time, (double)k / (count - 1));
        if (!lab_go(lab, gas->start + t * gas->unit, error)) return false;
        chart_point(chart, t, lab_count(lab).kinetic_energy / k0);
    }
    return true;
}

static double law(double t, const void *unused)
{
    (void)unused;
    return haff_energy(t);
}

void gas_law(struct chart *chart, double end)
{
    chart_law(chart, "1/(1 + t/t0)^2", law, NULL, first_time, end, 100);
}
