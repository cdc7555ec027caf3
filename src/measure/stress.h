/* stress.h - the stress of cooperative, eq. 9, as numbers of the whole box and as maps.
 *
 * sigma_ab = (sum over contacts of r_a dP_b / time - sum over grains of m v_a v_b) / area; pressure
 * counts as negative.  The first sum is gathered by the model while it runs (struct tally), so
 * it is a mean over time; the second comes from pictures of the grains.  v is taken about the mean
 * velocity of a cell, or in the whole box about that of all grains (in a sheared box about the
 * imposed profile).
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STRESS_H
#define STRESS_H

#include "base/archive.h"
#include "model/field.h"
#include "model/grains.h"
#include "model/tally.h"

/* X(name, components, label); three components are xx, xy, yy */
#define STRESS_FIELDS(X)                                                                \
    X(stress_collisional, 3, "stress carried by collisions, mean")                      \
    X(stress_kinetic,     3, "stress carried by flying grains")                         \
    X(pressure,           1, "pressure, collisional and kinetic")

enum stress_kind {
#define X(name, components, label) STRESS_##name,
    STRESS_FIELDS(X)
#undef X
    STRESS_KINDS
};

/* The kinetic part for the whole box: xx, xy, yy. */
void stress_kinetic(const struct grains *grains, const struct scene *scene, double out[3]);

struct stress;

struct stress *stress_create(const struct scene *scene, struct error *error);
void stress_destroy(struct stress *stress);

/* Means count from here on; `tally` may lack the sums (a phase that does not ask for them). */
void stress_begin(struct stress *stress, const struct tally *tally, double time);
void stress_add(struct stress *stress, const struct grains *grains);

/* `field` is created here, the caller frees.  NAN where the time since stress_begin is none. */
bool stress_field(const struct stress *stress, enum stress_kind kind, const struct tally *tally,
                  double time, struct field *field, struct error *error);

void stress_archive(struct stress *stress, struct archive *archive);

#endif
