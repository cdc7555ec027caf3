/* check.h - what every test needs: cmocka, and comparisons that print the numbers.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define CHECK(condition)                                                                \
    do {                                                                                \
        if (!(condition)) fail_msg("not true: %s", #condition);                         \
    } while (0)

/* |a - b| <= tolerance; says all three numbers when it fails (also for NAN). */
#define CHECK_NEAR(a, b, tolerance)                                                     \
    do {                                                                                \
        const double a_ = (a), b_ = (b), t_ = (tolerance);                              \
        if (!(fabs(a_ - b_) <= t_)) {                                                   \
            fail_msg("%s = %.10g, expected %.10g +- %.3g", #a, a_, b_, t_);             \
        }                                                                               \
    } while (0)

#endif
