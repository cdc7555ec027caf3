/* loop.c - see loop.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "live/loop.h"

#include "base/clock.h"
#include "live/conduct.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double status_seconds = 0.05;      /* totals are sums over all grains */
static const double rate_seconds = 0.5;         /* over which the shown rate is taken */
static const double lag_max = 0.2;              /* a brake forgets what the simulation is behind */
static const double nap_seconds = 0.004;        /* while there is nothing to do */

/* Something to be done by the session's own thread; lives on the stack of whoever waits. */
struct order {
    const char *text;           /* a command, or ... */
    void (*answer)(void *context, struct session *session);
    void *context;
    char  *reply;
    size_t size;
    bool   done, failed;
    struct order *next;
};

struct loop {
    struct session *session;
    struct stage *stage;
    pthread_mutex_t lock;
    pthread_cond_t arrived, served;
    struct order *first, **last;
    bool over;
    struct stage_status status;
    char trouble[sizeof ((struct error *)0)->text];

    /* The session's own thread's. */
    double status_mark;
    double rate_mark, rate;
    uint64_t rate_steps;
    bool   braked;              /* the marks below hold */
    double wall_mark, time_mark, speed_mark;
};

struct loop *loop_create(struct session *session, struct error *error)
{
    struct loop *loop = calloc(1, sizeof *loop);
    if (!loop) {
        error_set(error, "not enough memory for a session");
        return NULL;
    }
    loop->session = session;
    loop->last = &loop->first;
    pthread_mutex_init(&loop->lock, NULL);
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&loop->arrived, &attributes);
    pthread_cond_init(&loop->served, &attributes);
    pthread_condattr_destroy(&attributes);
    loop->stage = stage_create(session, error);
    if (loop->stage) return loop;
    loop_destroy(loop);
    return NULL;
}

void loop_destroy(struct loop *loop)
{
    if (!loop) return;
    stage_destroy(loop->stage);
    pthread_cond_destroy(&loop->arrived);
    pthread_cond_destroy(&loop->served);
    pthread_mutex_destroy(&loop->lock);
    free(loop);
}

struct stage *loop_stage(struct loop *loop)
{
    return loop->stage;
}

struct session *loop_session(struct loop *loop)
{
    return loop->session;
}

/* ---- orders ------------------------------------------------------------------------------- */

static bool place_order(struct loop *loop, struct order *order)
{
    pthread_mutex_lock(&loop->lock);
    if (!loop->over) {
        *loop->last = order;
        loop->last = &order->next;
        pthread_cond_signal(&loop->arrived);
        while (!order->done) pthread_cond_wait(&loop->served, &loop->lock);
    } else {
        order->failed = true;
        if (order->size) snprintf(order->reply, order->size, "the session is over");
    }
    pthread_mutex_unlock(&loop->lock);
    return !order->failed;
}

bool loop_ask(struct loop *loop, const char *text, char *reply, size_t size)
{
    struct order order = {.text = text, .reply = reply, .size = size};
    return place_order(loop, &order);
}

bool loop_call(struct loop *loop, void (*answer)(void *context, struct session *session),
               void *context)
{
    struct order order = {.answer = answer, .context = context};
    return place_order(loop, &order);
}

static struct order *next_order(struct loop *loop)
{
    pthread_mutex_lock(&loop->lock);
    struct order *order = loop->first;
    if (order) {
        loop->first = order->next;
        if (!loop->first) loop->last = &loop->first;
    }
    pthread_mutex_unlock(&loop->lock);
    return order;
}

static void carry_out(struct loop *loop, struct order *order)
{
    struct error error = {0};
    if (order->answer) {
        order->answer(order->context, loop->session);
    } else {
        order->failed = !conduct_line(loop->session, order->text, &error);
        if (order->size) snprintf(order->reply, order->size, "%s",
                                  order->failed ? error.text : loop->session->reply);
        loop->status_mark = 0;
        loop->braked = false;
    }
    pthread_mutex_lock(&loop->lock);
    order->done = true;
    pthread_cond_broadcast(&loop->served);
    pthread_mutex_unlock(&loop->lock);
}

void loop_end(struct loop *loop)
{
    char reply[8];
    loop_ask(loop, "quit", reply, sizeof reply);
}

/* ---- what is told ------------------------------------------------------------------------- */

static void tell_trouble(struct loop *loop, const char *text)
{
    pthread_mutex_lock(&loop->lock);
    snprintf(loop->trouble, sizeof loop->trouble, "%s", text);
    pthread_mutex_unlock(&loop->lock);
}

void loop_trouble(struct loop *loop, char *text, size_t size)
{
    pthread_mutex_lock(&loop->lock);
    snprintf(text, size, "%s", loop->trouble);
    loop->trouble[0] = 0;
    pthread_mutex_unlock(&loop->lock);
}

static void take_status(struct loop *loop)
{
    const struct session *session = loop->session;
    const double wall = clock_wall();
    if (wall - loop->status_mark < status_seconds) return;
    loop->status_mark = wall;
    const struct stage_status status = {
        .counters = simulation_count(&session->sim), .until = session_scene(session)->until,
        .speed = session->speed, .rate = session->running ? loop->rate : 0,
        .running = session->running, .version = session->version,
    };
    if (wall - loop->rate_mark > rate_seconds) {
        const uint64_t steps = status.counters.steps;
        loop->rate = steps > loop->rate_steps
                   ? (double)(steps - loop->rate_steps) / (wall - loop->rate_mark) : 0;
        loop->rate_steps = steps;
        loop->rate_mark = wall;
    }
    pthread_mutex_lock(&loop->lock);
    loop->status = status;
    pthread_mutex_unlock(&loop->lock);
}

struct stage_status loop_status(struct loop *loop)
{
    pthread_mutex_lock(&loop->lock);
    const struct stage_status status = loop->status;
    pthread_mutex_unlock(&loop->lock);
    return status;
}

static void show(struct loop *loop)
{
    const struct session *session = loop->session;
    struct error error = {0};
    if (!stage_wants(loop->stage, session->version)) return;
    loop->status_mark = 0;
    take_status(loop);
    const struct stage_status status = loop->status;
    if (!stage_show(loop->stage, &status, &error)) tell_trouble(loop, error.text);
}

/* ---- time --------------------------------------------------------------------------------- */

/* The simulated time that may be reached by now, at the speed that was asked for. */
static double brake(struct loop *loop)
{
    const struct session *session = loop->session;
    const double wall = clock_wall();
    if (!(session->speed < INFINITY) || session->steps_left > 0) return INFINITY;
    if (!loop->braked || loop->speed_mark != session->speed) {
        loop->braked = true;
        loop->speed_mark = session->speed;
        loop->wall_mark = wall;
        loop->time_mark = session->reached;
    }
    const double limit = loop->time_mark + (wall - loop->wall_mark) * session->speed;
    if (limit - session->reached > lag_max * session->speed) {
        loop->wall_mark = wall;
        loop->time_mark = session->reached;
    }
    return fmax(limit, session->reached);
}

static void nap(struct loop *loop, double seconds)
{
    struct timespec end;
    clock_gettime(CLOCK_MONOTONIC, &end);
    end.tv_nsec += (long)(seconds * 1e9);
    if (end.tv_nsec >= 1000000000) {
        end.tv_nsec -= 1000000000;
        end.tv_sec++;
    }
    pthread_mutex_lock(&loop->lock);
    if (!loop->first) pthread_cond_timedwait(&loop->arrived, &loop->lock, &end);
    pthread_mutex_unlock(&loop->lock);
}

static void advance(struct loop *loop)
{
    struct session *session = loop->session;
    struct error error = {0};
    const double start = clock_wall();
    if (!session_piece(session, brake(loop), &error)) tell_trouble(loop, error.text);
    const bool waits = session->speed < INFINITY && clock_wall() - start < nap_seconds / 4
                    && !session->between;
    if (waits) nap(loop, nap_seconds);
}

/* Nobody may wait for a thread that is gone. */
static void refuse_orders(struct loop *loop)
{
    pthread_mutex_lock(&loop->lock);
    loop->over = true;
    for (struct order *order = loop->first; order; order = order->next) {
        order->done = order->failed = true;
        if (order->size) snprintf(order->reply, order->size, "the session is over");
    }
    pthread_cond_broadcast(&loop->served);
    pthread_mutex_unlock(&loop->lock);
}

bool loop_run(struct loop *loop, const volatile sig_atomic_t *signal, struct error *error)
{
    struct session *session = loop->session;
    int number = 0;
    while (!session->ended && !number) {
        for (struct order *order; (order = next_order(loop));) carry_out(loop, order);
        if (session->running) advance(loop);
        else nap(loop, nap_seconds);
        take_status(loop);
        show(loop);
        number = signal ? *signal : 0;
    }
    refuse_orders(loop);
    return !number || error_set_code(error, (enum exit_code)(128 + number),
                                     "stopped by a signal; `sandreel replay %s` repeats the "
                                     "session", session->directory);
}
