/* integers.h - integers of more than 32 bits keep their value.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef INTEGERS_H
#define INTEGERS_H

/* The first integer from `at` on that libconfig would cut to 32 bits, outside strings and comments;
 * `end` is behind its last digit.  NULL: there is none.  No integer may begin before `at`. */
const char *integers_long(const char *at, const char **end);

/* A copy of the text in which such integers are marked as long, or, beyond 64 bits, written as
 * reals; every line stays where it was.  NULL: not enough memory; free() gives it back. */
char *integers_marked(const char *text);

#endif
