/* scatter.h - what an obstacle scatters onto a screen, by angle (stream, section III A).
 *
 * Angles are degrees from the direction of the stream, which points along +x: 0 lies right behind
 * the obstacle.  Mass is dm / dTheta per radian over the mass that entered, so its integral is the
 * share that has crossed the screen; momentum |p| and angular momentum L are means per grain.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SCATTER_H
#define SCATTER_H

#include "base/arena.h"
#include "base/error.h"
#include "model/tally.h"

#include <stdbool.h>
#include <stdint.h>

struct scatter {
    uint32_t bins;
    double   width;             /* of a bin, degrees */
    double  *angle;             /* middle of each bin */
    double  *count;             /* grains */
    double  *mass, *mass_error; /* dm(Theta); error of counting, that of one grain if none came */
    double  *momentum, *spin;   /* |p|(Theta), L(Theta); NAN without grains */
    struct arena arena;
};

/* `mass_in` is m_st, the mass that entered (struct tally).  The caller frees. */
bool scatter_create(const struct tally_screen *screen, double mass_in, struct scatter *out,
                    struct error *error);

/* Both sides of the symmetric stream together, angles above 0 only: dm(Theta) + dm(-Theta), the
 * mean of |p| over both, and the mean of L(Theta) and -L(-Theta). */
bool scatter_fold(const struct scatter *scatter, struct scatter *folded, struct error *error);
void scatter_free(struct scatter *scatter);

struct scatter_peak {
    double angle, angle_error;  /* where the mass is largest, degrees; NAN if no peak is found */
    double height, height_error;
    uint32_t bins;              /* that the parabola was fitted to */
};

/* The maximum of the mass by a parabola through the bins within `reach` degrees of it.  Where the
 * points scatter more than counting explains, the errors are raised to match. */
struct scatter_peak scatter_peak(const struct scatter *scatter, double reach);

#endif
