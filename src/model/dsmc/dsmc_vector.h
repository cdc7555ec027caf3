/* dsmc_vector.h - grains as vectors (x y vx vy), one or two of them side by side.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef DSMC_VECTOR_H
#define DSMC_VECTOR_H

#include <stdint.h>

typedef float vector4 __attribute__((vector_size(16), may_alias));
typedef int32_t mask4 __attribute__((vector_size(16)));

/* Two records side by side: one register where the processor has wide ones. */
typedef float vector8 __attribute__((vector_size(32), aligned(16), may_alias));
typedef int32_t mask8 __attribute__((vector_size(32)));
typedef uint32_t count8 __attribute__((vector_size(32)));
typedef uint64_t words4 __attribute__((vector_size(32)));

#endif
