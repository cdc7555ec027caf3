/* ranks.h - several processes of one study, started together by mpirun: who takes which point.
 *
 * Rank 0 hands out the points one by one, so fast ranks take more of them.  Alone, or without MPI,
 * there is one rank and nothing to talk about.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef RANKS_H
#define RANKS_H

#include "base/error.h"

#include <stdint.h>

struct ranks {
    int rank, size;
    const uint32_t *points;     /* rank 0: what is to be done; the caller's */
    uint32_t count, next;
    int  serving;               /* rank 0: other ranks that still ask */
    bool parallel;              /* MPI was begun here */
};

/* False if mpirun started several of us, but the program was built without MPI. */
bool ranks_begin(struct ranks *ranks, struct error *error);
void ranks_end(struct ranks *ranks);

/* The next point; UINT32_MAX when there is none left. */
uint32_t ranks_next(struct ranks *ranks);

/* A rank that stops early says so, or rank 0 would wait for it. */
void ranks_leave(struct ranks *ranks);

/* Rank 0 answers those who ask; true while there may be more to answer.  Elsewhere false. */
bool ranks_serve(struct ranks *ranks);

void ranks_wait(struct ranks *ranks);           /* for all others to come here too */

/* The sum over all ranks, for rank 0. */
uint32_t ranks_sum(struct ranks *ranks, uint32_t mine);

#endif
