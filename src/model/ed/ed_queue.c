/* ed_queue.c - see ed_queue.h: the rarer ways of the calendar.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "model/ed/ed_queue.h"

#include "model/ed/ed.h"

#include <math.h>
#include <string.h>

/* Bucket numbers stay exact integers in a double, and times beyond count as far. */
static const double bucket_number_max = 0x1p52;

bool ed_queue_create(struct ed_queue *queue, uint32_t count_max, struct arena *arena)
{
    uint32_t buckets = 64;
    while (buckets < 4.0 * count_max / ED_BUCKET_FILL && buckets < 1u << 26) buckets *= 2;
    *queue = (struct ed_queue){.mask = buckets - 1};
    /* Every live entry, as many old ones, and one begun block for each bucket. */
    queue->block_count = 2 * (count_max / ED_BLOCK_ROOM) + buckets + 64;
    queue->heap_room = count_max + 4096;
    return arena_array(arena, &queue->buckets, buckets)
        && arena_array(arena, &queue->blocks, queue->block_count)
        && arena_array(arena, &queue->ready, ED_READY_ROOM)
        && arena_array(arena, &queue->heap, queue->heap_room)
        && arena_array(arena, &queue->far, count_max)
        && arena_array(arena, &queue->is_far, count_max);
}

static void set_current(struct ed_queue *queue, int64_t current)
{
    queue->current = current;
    queue->horizon = (double)current + queue->mask + 1.0;
}

void ed_queue_rebuild(struct ed_queue *queue, const struct ed_event *events, uint32_t count,
                      double now, double width)
{
    memset(queue->buckets, 0, (queue->mask + 1u) * sizeof *queue->buckets);
    for (uint32_t b = 0; b < queue->block_count; b++) {
        queue->blocks[b].next = b + 1 < queue->block_count ? b + 1 : 0;
    }
    queue->block_free = 1;                              /* block 0 means none */
    for (uint32_t k = 0; k < queue->far_count; k++) queue->is_far[queue->far[k]] = 0;
    queue->far_count = queue->heap_count = queue->ready_count = 0;
    queue->empty_run = queue->pushed = 0;
    width = fmax(width, now * 0x1p-48);
    queue->per_time = fmin(1 / width, 1e300);
    /* The bucket of the present counts as open: its events go straight into the heap. */
    set_current(queue, (int64_t)fmin(now * queue->per_time, bucket_number_max));
    queue->refile = queue->current + (queue->mask + 1) / 2;
    for (uint32_t i = 0; i < count; i++) ed_queue_put(queue, events[i].due, i);
}

bool ed_queue_put_heap(struct ed_queue *queue, double t, uint32_t i)
{
    if (queue->heap_count == queue->heap_room) return false;
    queue->pushed++;
    const struct ed_due due = {t, i};
    uint32_t at = queue->heap_count++;
    while (at > 0) {
        const uint32_t parent = (at - 1) / 2;
        if (!ed_due_before(due, queue->heap[parent])) break;
        queue->heap[at] = queue->heap[parent];
        at = parent;
    }
    queue->heap[at] = due;
    return true;
}

void ed_queue_drop_heap_top(struct ed_queue *queue)
{
    const struct ed_due due = queue->heap[--queue->heap_count];
    const uint32_t n = queue->heap_count;
    uint32_t at = 0;
    for (uint32_t child = 1; child < n; child = 2 * at + 1) {
        if (child + 1 < n && ed_due_before(queue->heap[child + 1], queue->heap[child])) child++;
        if (!ed_due_before(queue->heap[child], due)) break;
        queue->heap[at] = queue->heap[child];
        at = child;
    }
    queue->heap[at] = due;
}

bool ed_queue_put_block(struct ed_queue *queue, struct ed_bucket *bucket, uint32_t i)
{
    const uint32_t block = queue->block_free;
    if (block == 0) return false;
    queue->block_free = queue->blocks[block].next;
    queue->blocks[block].next = bucket->used ? bucket->block : 0;
    queue->blocks[block].id[0] = i;
    *bucket = (struct ed_bucket){block, 1};
    return true;
}

void ed_queue_put_far(struct ed_queue *queue, uint32_t i)
{
    if (queue->is_far[i]) return;
    queue->is_far[i] = 1;
    queue->far[queue->far_count++] = i;
}

/* Sorts latest first: by insertion, after a rough ordering by time within the bucket. */
static void sort_ready(struct ed_queue *queue)
{
    enum { BINS = 64 };
    struct ed_due unsorted[ED_READY_ROOM];
    uint16_t start[BINS + 1] = {0};
    uint8_t bin[ED_READY_ROOM];
    const uint32_t n = queue->ready_count;
    for (uint32_t k = 0; k < n; k++) {
        unsorted[k] = queue->ready[k];
        const double part = unsorted[k].t * queue->per_time - (double)queue->current;
        const int b = (int)(part * BINS);
        bin[k] = (uint8_t)(BINS - 1 - (b < 0 ? 0 : b > BINS - 1 ? BINS - 1 : b));
        start[bin[k] + 1]++;
    }
    for (uint32_t b = 0; b < BINS; b++) start[b + 1] = (uint16_t)(start[b + 1] + start[b]);
    for (uint32_t k = 0; k < n; k++) queue->ready[start[bin[k]]++] = unsorted[k];
    for (uint32_t k = 1; k < n; k++) {
        const struct ed_due due = queue->ready[k];
        uint32_t at = k;
        while (at > 0 && ed_due_before(queue->ready[at - 1], due)) {
            queue->ready[at] = queue->ready[at - 1];
            at--;
        }
        queue->ready[at] = due;
    }
}

/* Moves grains from `far` into the ring where their event has come near enough. */
static bool refile(struct ed_queue *queue, const struct ed_event *events, uint32_t count)
{
    const uint32_t n = queue->far_count;
    queue->far_count = 0;
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t i = queue->far[k];
        queue->is_far[i] = 0;
        /* Sooner than the present: it was put again since, and that entry counts. */
        if (i >= count || events[i].due * queue->per_time < (double)queue->current) continue;
        if (!ed_queue_put(queue, events[i].due, i)) return false;
    }
    queue->refile = queue->current + (queue->mask + 1) / 2;
    return true;
}

bool ed_queue_open(struct ed_queue *queue, const struct ed_event *events, uint32_t count,
                   double limit, bool *rebuild)
{
    const int64_t next = queue->current + 1;
    if (!((double)next <= limit * queue->per_time)) return false;
    struct ed_bucket *bucket = &queue->buckets[(uint32_t)next & queue->mask];
    queue->empty_run = bucket->used ? 0 : queue->empty_run + 1;
    if (queue->empty_run > queue->mask || (double)next > bucket_number_max) {
        *rebuild = true;
        return false;
    }
    set_current(queue, next);
    queue->pushed = 0;
    if (next >= queue->refile && !refile(queue, events, count)) {
        *rebuild = true;
        return false;
    }
    uint32_t used = bucket->used, block = bucket->block, crowd = 0;
    *bucket = (struct ed_bucket){0, 0};
    while (used) {
        struct ed_block *b = &queue->blocks[block];
        for (uint32_t k = 0; k < used; k++) {
            const uint32_t i = b->id[k];
            if (i >= count) continue;
            const struct ed_due due = {events[i].due, i};
            const double part = due.t * queue->per_time - (double)next;
            if (!(part >= 0 && part < 1)) continue;
            if (queue->ready_count < ED_READY_ROOM) queue->ready[queue->ready_count++] = due;
            else if (!ed_queue_put_heap(queue, due.t, i)) crowd++;
        }
        const uint32_t after = b->next;
        b->next = queue->block_free;
        queue->block_free = block;
        block = after;
        used = after ? ED_BLOCK_ROOM : 0;
    }
    queue->pushed = 0;
    sort_ready(queue);
    *rebuild = crowd > 0;
    return crowd == 0;
}
