/* overlap.h - the area that a disc shares with a corner of the plane, in closed form.
 *
 * Differences of four corners give the area in a rectangle, so the parts of a disc that is cut by
 * a grid telescope: they sum to the whole disc to rounding.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef OVERLAP_H
#define OVERLAP_H

/* Area of the unit disc within { x < a, y < b }: 0 .. pi. */
double overlap_corner(double a, double b);

#endif
