/* expression.h - what `expect` weighs: numbers, names, + - * /, parentheses, abs(), comparisons
 * and `and`, as in "grains > 10 and abs(time - 2) <= 0.01".
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef EXPRESSION_H
#define EXPRESSION_H

#include "base/error.h"

#include <stdbool.h>

/* The value of a name; false if there is none of this name. */
typedef bool (*expression_names)(void *context, const char *name, double *value);

/* A comparison gives 1 or 0.  False (EXIT_USAGE) if the text is no expression; deep nesting is
 * refused, so any text is safe. */
bool expression_value(const char *text, expression_names names, void *context, double *value,
                      struct error *error);

#endif
