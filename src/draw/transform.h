/* transform.h - where a point of the scene lies in the picture: square pixels, y turned over.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRANSFORM_H
#define TRANSFORM_H

struct transform {
    double scale;               /* pixels per length */
    double x0, y1;              /* the scene's point at the picture's upper left corner */
};

static inline double transform_x(const struct transform *t, double x)
{
    return (x - t->x0) * t->scale;
}

static inline double transform_y(const struct transform *t, double y)
{
    return (t->y1 - y) * t->scale;
}

#endif
