/* ed_root.h - the first time at which a quantity that is a polynomial in time falls to zero.
 *
 * Under gravity the squared distance of a grain from a corner is a quartic in time.  Its closed
 * roots lose half of the digits near a grazing contact, so the roots are isolated instead: between
 * two zeros of the derivative (found in the same way, one degree lower) a polynomial runs one way
 * and can be bisected safely.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_ROOT_H
#define ED_ROOT_H

enum { ED_ROOT_MAX = 4 };

/* Writes the times in [0, s_max], ascending, at which c[0] + c[1] s + ... + c[degree] s^degree
 * falls through zero: positive (or zero) before, negative after.  Returns how many. */
int ed_root_falls(const double *c, int degree, double s_max, double times[ED_ROOT_MAX]);

#endif
