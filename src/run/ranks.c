/* ranks.c - see ranks.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/ranks.h"

#include <stdlib.h>

/* How many of us mpirun (Open MPI, MPICH, Slurm's PMI) says that it started; 0: it did not. */
static int started_together(void)
{
    static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        const char *text = getenv(names[k]);
        if (text) return atoi(text);
    }
    return 0;
}

static uint32_t take(struct ranks *ranks)
{
    return ranks->next < ranks->count ? ranks->points[ranks->next++] : UINT32_MAX;
}

#ifdef SANDREEL_MPI

#include <mpi.h>

enum { TAG_ASK = 1, TAG_ANSWER };

bool ranks_begin(struct ranks *ranks, struct error *error)
{
    *ranks = (struct ranks){.size = 1};
    if (started_together() < 1) return true;
    if (MPI_Init(NULL, NULL) != MPI_SUCCESS) return error_set(error, "MPI did not begin");
    ranks->parallel = true;
    MPI_Comm_rank(MPI_COMM_WORLD, &ranks->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks->size);
    ranks->serving = ranks->rank == 0 ? ranks->size - 1 : 0;
    return true;
}

void ranks_end(struct ranks *ranks)
{
    if (ranks->parallel) MPI_Finalize();
    ranks->parallel = false;
}

uint32_t ranks_next(struct ranks *ranks)
{
    if (ranks->rank == 0) return take(ranks);
    const int more = 1;
    uint32_t point = UINT32_MAX;
    MPI_Send(&more, 1, MPI_INT, 0, TAG_ASK, MPI_COMM_WORLD);
    MPI_Recv(&point, 1, MPI_UINT32_T, 0, TAG_ANSWER, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return point;
}

void ranks_leave(struct ranks *ranks)
{
    const int more = 0;
    if (ranks->rank == 0) ranks->count = ranks->next;
    else MPI_Send(&more, 1, MPI_INT, 0, TAG_ASK, MPI_COMM_WORLD);
}

bool ranks_serve(struct ranks *ranks)
{
    while (ranks->serving > 0) {
        int asked = 0, more = 0;
        MPI_Status who;
        MPI_Iprobe(MPI_ANY_SOURCE, TAG_ASK, MPI_COMM_WORLD, &asked, &who);
        if (!asked) return true;
        MPI_Recv(&more, 1, MPI_INT, who.MPI_SOURCE, TAG_ASK, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        const uint32_t point = more ? take(ranks) : UINT32_MAX;
        if (more) {
            MPI_Send(&point, 1, MPI_UINT32_T, who.MPI_SOURCE, TAG_ANSWER, MPI_COMM_WORLD);
        }
        if (point == UINT32_MAX) ranks->serving--;
    }
    return false;
}

void ranks_wait(struct ranks *ranks)
{
    if (ranks->parallel) MPI_Barrier(MPI_COMM_WORLD);
}

uint32_t ranks_sum(struct ranks *ranks, uint32_t mine)
{
    uint32_t sum = mine;
    if (ranks->parallel) {
        MPI_Reduce(&mine, &sum, 1, MPI_UINT32_T, MPI_SUM, 0, MPI_COMM_WORLD);
    }
    return sum;
}

#else

bool ranks_begin(struct ranks *ranks, struct error *error)
{
    *ranks = (struct ranks){.size = 1};
    return started_together() < 2 || error_set(error, "this sandreel was built without MPI, so "
        "several of them would do the same work; use --shard i/n, or install libopenmpi-dev and "
        "build it again");
}

void ranks_end(struct ranks *ranks) { ranks->parallel = false; }

uint32_t ranks_next(struct ranks *ranks) { return take(ranks); }

void ranks_leave(struct ranks *ranks) { ranks->count = ranks->next; }

bool ranks_serve(struct ranks *ranks) { return ranks->serving > 0; }

void ranks_wait(struct ranks *ranks) { (void)ranks; }

uint32_t ranks_sum(struct ranks *ranks, uint32_t mine)
{
    (void)ranks;
    return mine;
}

#endif
