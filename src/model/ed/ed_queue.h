/* ed_queue.h - the calendar of coming events: a ring of buckets, each a slice of time.
 *
 * A bucket holds the indices of grains whose event falls into it, unsorted, in blocks from a
 * common pool.  Nothing is ever unlinked: an entry counts if its grain's event still lies in the
 * bucket when that is opened; only then is the bucket sorted.  Events of the open bucket that
 * arise while it is worked off go into a small heap beside it.  Grains whose event lies beyond
 * the ring wait in `far`.  When the pool or the heap runs full (old entries, crowded buckets), the
 * calendar is made anew from the grains' events, so nothing here is archived.
 *
 * The order of events is by time, then by grain, whatever way they came in.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef ED_QUEUE_H
#define ED_QUEUE_H

#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    ED_BLOCK_ROOM  = 31,
    ED_READY_ROOM  = 1024,      /* sorted entries of the open bucket; more go into the heap */
    ED_BUCKET_FILL = 48         /* entries that a bucket shall hold on average */
};

struct ed_event;

struct ed_block  { uint32_t next, id[ED_BLOCK_ROOM]; };         /* two cache lines */
struct ed_bucket { uint32_t block, used; };     /* first block (0: none), entries in that one */
struct ed_due    { double t; uint32_t id; };

struct ed_queue {
    double   per_time;          /* buckets per unit of time */
    int64_t  current;           /* the open bucket */
    double   horizon;           /* first bucket that lies beyond the ring */
    int64_t  refile;            /* when `current` gets here, `far` is looked through */
    uint32_t mask;              /* buckets in the ring, less one */
    uint32_t empty_run;         /* empty buckets passed in a row */
    uint32_t pushed;            /* entries that came into the heap since the bucket was opened */
    struct ed_bucket *buckets;
    struct ed_block  *blocks;
    uint32_t block_count, block_free;
    uint32_t ready_count;
    struct ed_due *ready;       /* latest first, so that the next is at the end */
    uint32_t heap_count, heap_room;
    struct ed_due *heap;        /* soonest at the top */
    uint32_t far_count;
    uint32_t *far;
    uint8_t  *is_far;           /* by grain: already in `far` */
};

bool ed_queue_create(struct ed_queue *queue, uint32_t count_max, struct arena *arena);

/* Makes the calendar anew at time `now` for the events of `count` grains, with buckets that take
 * `width` of time each. */
void ed_queue_rebuild(struct ed_queue *queue, const struct ed_event *events, uint32_t count,
                      double now, double width);

/* The slow ways of ed_queue_put: false if there is no room, then rebuild. */
bool ed_queue_put_heap(struct ed_queue *queue, double t, uint32_t i);
bool ed_queue_put_block(struct ed_queue *queue, struct ed_bucket *bucket, uint32_t i);
void ed_queue_put_far(struct ed_queue *queue, uint32_t i);

/* Opens the next bucket; false if it begins after `limit` (then nothing is done), or if the
 * calendar must be rebuilt with wider buckets (`rebuild` is then set). */
bool ed_queue_open(struct ed_queue *queue, const struct ed_event *events, uint32_t count,
                   double limit, bool *rebuild);

void ed_queue_drop_heap_top(struct ed_queue *queue);

static inline bool ed_queue_put(struct ed_queue *queue, double t, uint32_t i)
{
    const double place = t * queue->per_time;
    if (!(place < queue->horizon)) {
        ed_queue_put_far(queue, i);
        return true;
    }
    const int64_t k = (int64_t)place;
    if (k <= queue->current) return ed_queue_put_heap(queue, t, i);
    struct ed_bucket *bucket = &queue->buckets[(uint32_t)k & queue->mask];
    if (bucket->used == 0 || bucket->used == ED_BLOCK_ROOM) {
        return ed_queue_put_block(queue, bucket, i);
    }
    queue->blocks[bucket->block].id[bucket->used++] = i;
    return true;
}

static inline bool ed_due_before(struct ed_due a, struct ed_due b)
{
    return a.t < b.t || (a.t == b.t && a.id < b.id);
}

/* The soonest entry of the open bucket, left in place; false if there is none. */
static inline bool ed_queue_first(const struct ed_queue *queue, struct ed_due *first,
                                  bool *from_heap)
{
    const uint32_t n = queue->ready_count;
    if (queue->heap_count == 0) {
        if (n == 0) return false;
        *first = queue->ready[n - 1];
        *from_heap = false;
        return true;
    }
    *from_heap = n == 0 || ed_due_before(queue->heap[0], queue->ready[n - 1]);
    *first = *from_heap ? queue->heap[0] : queue->ready[n - 1];
    return true;
}

#endif
