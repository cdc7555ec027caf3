/* bench_live.c - see bench_live.h.
 *
 * The viewer is this thread, without a browser: what a browser needs to show a picture is its own
 * affair, and usually another machine's.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "bench/bench_live.h"

#include "base/clock.h"
#include "live/loop.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TURNS = 5, KEYS = 15 };      /* the caller repeats it all, too */

static const double turn_seconds = 0.5, pictures_seconds = 3, slow_rate = 10;

static const char scene_text[] =
    "until = 1000.0; box = [0.0, 0.0, 250.0, 140.0]; gravity = (0.0, -1.0); model = \"md\";"
    "grains = ({ radius = 0.5; restitution = 0.8; friction = 0.3; });"
    "placements = ({ kind = \"square\"; spacing = 1.25; temperature = 1.0; count = 20000; });"
    "view = { size = (1280, 720); range = (0.0, 3.0); };";

static void *run(void *loop)
{
    struct error error;
    loop_run(loop, NULL, &error);
    return NULL;
}

static double steps_now(struct loop *loop)
{
    char reply[100];
    return loop_ask(loop, "get steps", reply, sizeof reply) ? strtod(reply, NULL) : NAN;
}

static void rest(double seconds)
{
    usleep((useconds_t)(1e6 * fmax(seconds, 0)));
}

/* Takes pictures for so long, or only waits (rate 0); returns how many. */
static uint64_t watch(struct loop *loop, double seconds, double rate)
{
    const double end = clock_wall() + seconds;
    uint64_t count = 0, last = stage_drawn(loop_stage(loop));
    while (clock_wall() < end && rate > 0) {
        const struct stage_frame *frame = stage_await(loop_stage(loop), last, end - clock_wall(),
                                                      rate);
        if (!frame) break;
        last = frame->number;
        count++;
        stage_release(loop_stage(loop), frame);
    }
    rest(end - clock_wall());
    return count;
}

static double speed(struct loop *loop, double rate)
{
    const double steps = steps_now(loop), wall = clock_wall();
    watch(loop, turn_seconds, rate);
    return (steps_now(loop) - steps) / (clock_wall() - wall);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

static double measure_kept(struct loop *loop)
{
    double ratios[TURNS];
    for (int k = 0; k < TURNS; k++) {
        const double before = speed(loop, 0), watched = speed(loop, slow_rate);
        ratios[k] = 2 * watched / (before + speed(loop, 0));
    }
    return median(ratios, TURNS);
}

/* From the command to a picture that was taken after it. */
static double measure_delay(struct loop *loop)
{
    double delays[KEYS];
    char reply[100];
    for (int k = 0; k < KEYS; k++) {
        const double start = clock_wall();
        loop_ask(loop, k % 2 ? "color spin" : "color speed", reply, sizeof reply);
        const uint64_t version = loop_status(loop).version;
        uint64_t last = stage_drawn(loop_stage(loop));
        for (bool seen = false; !seen;) {
            const struct stage_frame *frame = stage_await(loop_stage(loop), last, 5, 60);
            if (!frame) return NAN;
            last = frame->number;
            seen = frame->status.version > version;
            stage_release(loop_stage(loop), frame);
        }
        delays[k] = 1000 * (clock_wall() - start);
    }
    return median(delays, KEYS);
}

static bool measure(enum bench_live_what what, struct session *session, double *value,
                    struct error *error)
{
    char reply[100];
    pthread_t thread;
    struct loop *loop = loop_create(session, error);
    if (!loop) return false;
    bool done = pthread_create(&thread, NULL, run, loop) == 0
             || error_set(error, "cannot start a thread for a session");
    if (done) {
        loop_ask(loop, "speed max", reply, sizeof reply);
        loop_ask(loop, "go", reply, sizeof reply);
        watch(loop, turn_seconds, slow_rate);           /* the first picture takes longer */
        *value = what == BENCH_LIVE_KEPT ? measure_kept(loop)
               : what == BENCH_LIVE_DELAY ? measure_delay(loop)
               : (double)watch(loop, pictures_seconds, 120) / pictures_seconds;
        loop_end(loop);
        pthread_join(thread, NULL);
    }
    loop_destroy(loop);
    return done;
}

bool bench_live(enum bench_live_what what, double *value, struct error *error)
{
    char directory[] = "/tmp/sandreel-bench-XXXXXX", path[FILE_PATH_MAX];
    static const char *const files[] = {"scene.cfg", "start.cfg", "session.log", "manifest.json"};
    if (!mkdtemp(directory)) return error_set(error, "/tmp: no directory can be made here");
    struct session *session = calloc(1, sizeof *session);
    if (!session) return error_set(error, "not enough memory for a session");
    const struct session_request request = {.path = "bench.cfg", .text = scene_text,
                                            .directory = directory};
    bool done = session_open(session, &request, error) && measure(what, session, value, error);
    struct error minor;
    session_close(session, done ? error : &minor);
    free(session);
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        unlink(folder_path(path, directory, "%s", files[k]));
    }
    rmdir(directory);
    return done;
}
