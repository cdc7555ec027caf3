/* stage.c - see stage.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/stage.h"

#include "base/clock.h"
#include "live/sight.h"
#include "run/look.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct stage {
    struct session *session;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool started, stops;
    uint32_t waiting;           /* watchers that want a picture */
    double rate, last_shown;    /* pictures a second; wall time of the last mailing */
    bool mailed;                /* the mailbox is full */
    struct grains mailbox;      /* the session's thread fills it, the stage empties it */
    struct stage_status status; /* of the mailbox */
    struct view view;
    const struct scene *scene;
    uint64_t look;              /* counts changes that need another film */
    struct stage_frame *newest;
    struct stage_frame *spare;  /* nobody holds it; fresh memory for each picture would cost */
    uint64_t number;
    char trouble[sizeof ((struct error *)0)->text];

    /* The drawing thread's own. */
    struct film film;
    char     film_map[KEY_TEXT_MAX];
    double   film_size[2];
};

static void destroy_frame(struct stage_frame *frame)
{
    if (!frame) return;
    image_free(&frame->image);
    free(frame);
}

/* With the lock held. */
static void drop(struct stage *stage, struct stage_frame *frame)
{
    if (!frame || --frame->holders > 0) return;
    if (!stage->spare) stage->spare = frame;
    else destroy_frame(frame);
}

/* A frame with an image of this size, whatever it shows. */
static struct stage_frame *take_frame(struct stage *stage, const struct image *size,
                                      struct error *error)
{
    pthread_mutex_lock(&stage->lock);
    struct stage_frame *frame = stage->spare;
    stage->spare = NULL;
    pthread_mutex_unlock(&stage->lock);
    if (frame && frame->image.width == size->width && frame->image.height == size->height) {
        return frame;
    }
    destroy_frame(frame);
    frame = calloc(1, sizeof *frame);
    if (!frame) error_set(error, "not enough memory for a picture");
    else if (image_create(&frame->image, size->width, size->height, error)) return frame;
    free(frame);
    return NULL;
}

/* The film of the view in the mailbox; opened anew for another size or map. */
static bool ready_film(struct stage *stage, struct error *error)
{
    struct film *film = &stage->film;
    const struct view *view = &stage->view;
    const bool same = film->painter && strcmp(stage->film_map, view->map) == 0
                   && memcmp(stage->film_size, view->size, sizeof view->size) == 0
                   && memcmp(film->view.range, view->range, sizeof view->range) == 0
                   && film->view.grains == view->grains;
    if (!same) {
        film_close(film);
        memcpy(stage->film_map, view->map, sizeof stage->film_map);
        memcpy(stage->film_size, view->size, sizeof stage->film_size);
        if (!film_open(film, stage->scene, stage->session->sim.model, view, error)) {
            film_close(film);
            return false;
        }
    }
    film->view = *view;
    film->scene = stage->scene;
    return true;
}

/* Draws the mailbox.  The scene cannot be exchanged meanwhile. */
static struct stage_frame *draw(struct stage *stage, struct error *error)
{
    if (!ready_film(stage, error)
        || !film_draw(&stage->film, &stage->mailbox, stage->status.counters.steps, 0, error)) {
        return NULL;
    }
    struct stage_frame *frame = take_frame(stage, &stage->film.image, error);
    if (!frame) return NULL;
    frame->holders = 1;
    frame->status = stage->status;
    /* The picture changes hands, and the film gets another one to draw over. */
    const struct image drawn = stage->film.image;
    stage->film.image = frame->image;
    frame->image = drawn;
    frame->transform = stage->film.transform;
    return frame;
}

static void *work(void *context)
{
    struct stage *stage = context;
    struct error error = {0};
    pthread_mutex_lock(&stage->lock);
    while (!stage->stops) {
        if (!stage->mailed) {
            pthread_cond_wait(&stage->changed, &stage->lock);
            continue;
        }
        pthread_mutex_unlock(&stage->lock);
        pthread_mutex_lock(&stage->session->scene_lock);
        stage->scene = session_scene(stage->session);
        struct stage_frame *frame = draw(stage, &error);
        pthread_mutex_unlock(&stage->session->scene_lock);
        pthread_mutex_lock(&stage->lock);
        stage->mailed = false;
        if (frame) {
            frame->number = ++stage->number;
            drop(stage, stage->newest);
            stage->newest = frame;
        } else {
            snprintf(stage->trouble, sizeof stage->trouble, "%s", error.text);
        }
        pthread_cond_broadcast(&stage->changed);
    }
    pthread_mutex_unlock(&stage->lock);
    film_close(&stage->film);           /* its OpenGL context belongs to this thread */
    return NULL;
}

struct stage *stage_create(struct session *session, struct error *error)
{
    struct stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        error_set(error, "not enough memory for pictures");
        return NULL;
    }
    stage->session = session;
    pthread_mutex_init(&stage->lock, NULL);
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&stage->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    stage->started = pthread_create(&stage->thread, NULL, work, stage) == 0;
    if (stage->started) return stage;
    error_set(error, "cannot start a thread to draw with");
    stage_destroy(stage);
    return NULL;
}

void stage_dismiss(struct stage *stage)
{
    pthread_mutex_lock(&stage->lock);
    stage->stops = true;
    pthread_cond_broadcast(&stage->changed);
    pthread_mutex_unlock(&stage->lock);
}

void stage_destroy(struct stage *stage)
{
    if (!stage) return;
    stage_dismiss(stage);
    if (stage->started) pthread_join(stage->thread, NULL);
    destroy_frame(stage->newest);
    destroy_frame(stage->spare);
    grains_free(&stage->mailbox);
    pthread_cond_destroy(&stage->changed);
    pthread_mutex_destroy(&stage->lock);
    free(stage);
}

bool stage_wants(struct stage *stage, uint64_t version)
{
    pthread_mutex_lock(&stage->lock);
    const bool fresh = stage->newest && stage->newest->status.version == version;
    const bool early = clock_wall() - stage->last_shown < 1 / stage->rate;
    const bool wants = stage->waiting > 0 && !stage->mailed && !fresh && !early;
    pthread_mutex_unlock(&stage->lock);
    return wants;
}

bool stage_show(struct stage *stage, const struct stage_status *status, struct error *error)
{
    struct session *session = stage->session;
    const bool contacts = film_needs_contacts(&session->view);
    if (!look_at(&session->sim, &stage->mailbox, contacts, error)) return false;
    pthread_mutex_lock(&stage->lock);
    stage->view = sight_view(session, &stage->mailbox);
    stage->view.range_from = RANGE_FRAME;
    stage->status = *status;
    stage->mailed = true;
    stage->last_shown = clock_wall();
    pthread_cond_broadcast(&stage->changed);
    pthread_mutex_unlock(&stage->lock);
    return true;
}

const struct stage_frame *stage_await(struct stage *stage, uint64_t after, double seconds,
                                      double rate)
{
    struct timespec end;
    clock_gettime(CLOCK_MONOTONIC, &end);
    const double whole = floor(seconds);
    end.tv_sec += (time_t)whole;
    end.tv_nsec += (long)((seconds - whole) * 1e9);
    if (end.tv_nsec >= 1000000000) {
        end.tv_nsec -= 1000000000;
        end.tv_sec++;
    }
    pthread_mutex_lock(&stage->lock);
    stage->waiting++;
    stage->rate = rate;
    int outcome = 0;
    while (outcome == 0 && !stage->stops && !(stage->newest && stage->newest->number > after)) {
        outcome = pthread_cond_timedwait(&stage->changed, &stage->lock, &end);
    }
    stage->waiting--;
    struct stage_frame *frame = stage->newest && stage->newest->number > after ? stage->newest
                                                                               : NULL;
    if (frame) frame->holders++;
    pthread_mutex_unlock(&stage->lock);
    return frame;
}

void stage_release(struct stage *stage, const struct stage_frame *frame)
{
    pthread_mutex_lock(&stage->lock);
    drop(stage, (struct stage_frame *)(uintptr_t)frame);
    pthread_mutex_unlock(&stage->lock);
}

const char *stage_trouble(struct stage *stage)
{
    return stage->trouble;
}

uint64_t stage_drawn(struct stage *stage)
{
    pthread_mutex_lock(&stage->lock);
    const uint64_t number = stage->number;
    pthread_mutex_unlock(&stage->lock);
    return number;
}
