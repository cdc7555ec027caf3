/* encoder.c - see encoder.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "run/encoder.h"

#include "base/file.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { THREADS_MAX = 16 };

struct slot { struct image image; struct encoder_job job; };

struct encoder {
    pthread_mutex_t lock;
    pthread_cond_t  arrived, done;      /* work for the threads; room for the drawer */
    struct slot    *slots;              /* a ring: first .. first + count are waiting */
    uint32_t        slot_count, first, count, busy;
    pthread_t       threads[THREADS_MAX];
    uint32_t        thread_count;
    bool            stopping, failed;
    struct error    failure;            /* the first one */
    double          cpu;
};

static bool encode(const struct image *image, const struct encoder_job *job, struct error *error)
{
    struct image_note notes[ENCODER_NOTES];
    for (uint32_t k = 0; k < job->note_count; k++) {
        notes[k] = (struct image_note){job->notes[k].key, job->notes[k].text};
    }
    uint8_t *bytes;
    size_t size;
    if (!image_encode(image, job->level, notes, job->note_count, &bytes, &size, error)) {
        return false;
    }
    const bool done = file_save(job->path, bytes, size, error);
    free(bytes);
    return done;
}

static double thread_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void *work(void *context)
{
    struct encoder *encoder = context;
    struct slot mine = {0};
    pthread_mutex_lock(&encoder->lock);
    for (;;) {
        while (encoder->count == 0 && !encoder->stopping) {
            pthread_cond_wait(&encoder->arrived, &encoder->lock);
        }
        if (encoder->count == 0) break;
        struct slot *slot = &encoder->slots[encoder->first];
        const struct slot taken = *slot;        /* the pictures change places, nothing is copied */
        *slot = mine;
        mine = taken;
        encoder->first = (encoder->first + 1) % encoder->slot_count;
        encoder->count--;
        encoder->busy++;
        pthread_cond_broadcast(&encoder->done);
        pthread_mutex_unlock(&encoder->lock);
        struct error error = {0};
        const double before = thread_seconds();
        const bool done = encode(&mine.image, &mine.job, &error);
        const double spent = thread_seconds() - before;
        pthread_mutex_lock(&encoder->lock);
        encoder->cpu += spent;
        encoder->busy--;
        if (!done && !encoder->failed) {
            encoder->failed = true;
            encoder->failure = error;
        }
        pthread_cond_broadcast(&encoder->done);
    }
    pthread_mutex_unlock(&encoder->lock);
    image_free(&mine.image);
    return NULL;
}

struct encoder *encoder_create(uint32_t threads, struct error *error)
{
    struct encoder *encoder = calloc(1, sizeof *encoder);
    if (encoder) encoder->slot_count = 2;
    if (encoder && threads > 0) encoder->slot_count = threads < THREADS_MAX ? threads + 1 : 17;
    if (encoder) encoder->slots = calloc(encoder->slot_count, sizeof *encoder->slots);
    if (!encoder || !encoder->slots) {
        free(encoder);
        error_set(error, "not enough memory for the encoder");
        return NULL;
    }
    pthread_mutex_init(&encoder->lock, NULL);
    pthread_cond_init(&encoder->arrived, NULL);
    pthread_cond_init(&encoder->done, NULL);
    for (uint32_t k = 0; k < threads && k < THREADS_MAX; k++) {
        /* A machine that grants no (more) threads still encodes, with fewer or in place. */
        if (pthread_create(&encoder->threads[k], NULL, work, encoder) != 0) break;
        encoder->thread_count++;
    }
    return encoder;
}

void encoder_destroy(struct encoder *encoder)
{
    if (!encoder) return;
    pthread_mutex_lock(&encoder->lock);
    encoder->stopping = true;
    pthread_cond_broadcast(&encoder->arrived);
    pthread_mutex_unlock(&encoder->lock);
    for (uint32_t k = 0; k < encoder->thread_count; k++) pthread_join(encoder->threads[k], NULL);
    for (uint32_t k = 0; k < encoder->slot_count; k++) image_free(&encoder->slots[k].image);
    pthread_cond_destroy(&encoder->arrived);
    pthread_cond_destroy(&encoder->done);
    pthread_mutex_destroy(&encoder->lock);
    free(encoder->slots);
    free(encoder);
}

static bool report_failure(const struct encoder *encoder, struct error *error)
{
    if (error) *error = encoder->failure;
    return false;
}

bool encoder_submit(struct encoder *encoder, struct image *image, const struct encoder_job *job,
                    struct error *error)
{
    assert(job->note_count <= ENCODER_NOTES);
    if (encoder->thread_count == 0) {
        const double before = thread_seconds();
        const bool done = encode(image, job, error);
        encoder->cpu += thread_seconds() - before;
        return done;
    }
    pthread_mutex_lock(&encoder->lock);
    while (encoder->count == encoder->slot_count && !encoder->failed) {
        pthread_cond_wait(&encoder->done, &encoder->lock);
    }
    if (encoder->failed) {
        pthread_mutex_unlock(&encoder->lock);
        return report_failure(encoder, error);
    }
    struct slot *slot = &encoder->slots[(encoder->first + encoder->count) % encoder->slot_count];
    struct image spare = slot->image;
    if (spare.width != image->width || spare.height != image->height) {
        image_free(&spare);
        if (!image_create(&spare, image->width, image->height, error)) {
            slot->image = (struct image){0};
            pthread_mutex_unlock(&encoder->lock);
            return false;
        }
    }
    slot->image = *image;
    slot->job = *job;
    *image = spare;
    encoder->count++;
    pthread_cond_signal(&encoder->arrived);
    pthread_mutex_unlock(&encoder->lock);
    return true;
}

bool encoder_wait(struct encoder *encoder, struct error *error)
{
    pthread_mutex_lock(&encoder->lock);
    while (encoder->count > 0 || encoder->busy > 0) {
        pthread_cond_wait(&encoder->done, &encoder->lock);
    }
    const bool done = !encoder->failed;
    pthread_mutex_unlock(&encoder->lock);
    return done || report_failure(encoder, error);
}

double encoder_cpu(struct encoder *encoder)
{
    pthread_mutex_lock(&encoder->lock);
    const double cpu = encoder->cpu;
    pthread_mutex_unlock(&encoder->lock);
    return cpu;
}
