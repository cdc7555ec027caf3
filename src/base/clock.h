/* clock.h - wall and processor time.  Simulations never read either.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLOCK_H
#define CLOCK_H

double clock_wall(void);        /* seconds, monotonic: not moved by changes of the date */
double clock_process(void);     /* processor seconds of all threads of this process */

#endif
